#!/bin/sh
# Tests the table of cameras in docs/javascript.md against Babylon.js and gl-matrix: `sh tests/cameras.sh` on Debian 12,
# as root or with sudo. Installs what is missing, builds the npm package, fetches both libraries, and makes views of
# their own matrices in node. Takes about two minutes, and some more the first time.
set -eu
me=tests/cameras.sh
cd "$(dirname "$0")/.."
. tests/packages.sh
takes "" "" "$@"

build_npm_package

tests=build/camera-tests
fetch_npm $tests gl-matrix@3.4.3 @babylonjs/core@9.35.0
run_node_tests tests/npm/cameras.mjs $tests/cameras.log
