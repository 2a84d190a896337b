#!/bin/sh
# Tests the npm package's adapter for PlayCanvas in a browser: `sh tests/playcanvas.sh` on Debian 12, as root or with
# sudo. Installs what is missing, builds the package, fetches PlayCanvas, and runs it in headless Chromium on a software
# renderer. Takes about three minutes, and some more the first time.
#   --serve  shows 5,000 moving lights instead, with PlayCanvas' own clusters and with lightbin, at
#            http://localhost:8000/tests/page.html
set -eu
me=tests/playcanvas.sh
cd "$(dirname "$0")/.."
. tests/packages.sh
takes "nothing, --serve" "--serve" "$@"

build_npm_package chromium

tests=build/playcanvas-tests
fetch_npm $tests playcanvas@2.23.0 playwright-core@1.65.1
[ $# -eq 0 ] || exec node tests/server.mjs 8000 tests/playcanvas
run_node_tests tests/playcanvas/pictures.mjs $tests/pictures.log
