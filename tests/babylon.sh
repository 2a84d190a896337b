#!/bin/sh
# Tests the npm package's adapter for Babylon.js in a browser: `sh tests/babylon.sh` on Debian 12, as root or with sudo.
# Installs what is missing, builds the package, fetches Babylon.js, and runs it in headless Chromium on a software
# renderer. Takes about four minutes, and some more the first time.
#   --bench  prints the times of frames with Babylon's own clustered lights and with lightbin's instead
#   --serve  shows 2,900 moving lights with both instead, at http://localhost:8000/tests/page.html
set -eu
me=tests/babylon.sh
cd "$(dirname "$0")/.."
. tests/packages.sh
takes "nothing, --bench, --serve" "--bench|--serve" "$@"

build_npm_package chromium

tests=build/babylon-tests
fetch_npm $tests @babylonjs/core@9.35.0 playwright-core@1.65.1
case ${1-} in
--bench) exec node tests/babylon/bench.mjs ;;
--serve) exec node tests/server.mjs 8000 tests/babylon ;;
esac
run_node_tests tests/babylon/pictures.mjs $tests/pictures.log
