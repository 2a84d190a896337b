#!/bin/sh
# Tests the table of cameras in docs/javascript.md against Babylon.js and gl-matrix: `sh tests/cameras.sh` on Debian 12,
# as root or with sudo. Installs what is missing, builds the npm package, fetches both libraries, and makes views of
# their own matrices in node. Takes about two minutes, and some more the first time.
set -eu
me=tests/cameras.sh
cd "$(dirname "$0")/.."
. tests/packages.sh
takes "" "" "$@"

install_packages nodejs emscripten node-acorn binaryen
command -v npm >/dev/null || install_packages npm
make_build_folder
sh packaging/npm/build.sh

tests=build/camera-tests
fetch_npm $tests gl-matrix@3.4.3 @babylonjs/core@9.35.0
export MODULES="$PWD/$tests/node_modules" LIGHTBIN="$PWD/build/npm/lightbin"
node --test-reporter=spec tests/npm/cameras.mjs >$tests/cameras.log 2>&1 || failed=yes
grep -E '^(✔|✖|    at |  [A-Z])' $tests/cameras.log || true
[ -z "${failed-}" ] || fail "not every test passed; the log is $tests/cameras.log"
echo "$me: every test passed"
