#!/bin/sh
# Tests the page of examples/web in a browser: `sh tests/web.sh` on Debian 12, as root or with sudo. Installs what is
# missing, builds the page, and runs it in headless Chromium on a software renderer, with WebGL 2 and with WebGPU.
# Leaves pictures in build/web-tests. Takes about two minutes, and some more the first time.
set -eu
me=tests/web.sh
cd "$(dirname "$0")/.."
. tests/packages.sh
takes "" "" "$@"

install_packages chromium fonts-dejavu-core nodejs libtinygltf-dev
command -v npm >/dev/null || install_packages npm
sh examples/web.sh --build

tests=build/web-tests
fetch_npm $tests playwright-core@1.65.1

failed=
node --no-warnings tests/web/lists.mjs build/web || failed=yes
for part in page pictures; do
    echo "$me: $part"
    node --test-reporter=spec tests/web/$part.mjs >$tests/$part.log 2>&1 || failed=yes
    grep -E '^(✔|✖|[0-9a-z]+ .*(bytes|ms)|    at |  [A-Z])' $tests/$part.log || true
done
[ -z "$failed" ] || fail "not every test passed; the logs are $tests/*.log"
echo "$me: every test passed; pictures: $(echo $tests/*.png)"
