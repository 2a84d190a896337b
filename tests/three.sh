#!/bin/sh
# Tests the npm package's adapters for three.js in a browser: `sh tests/three.sh` on Debian 12, as root or with sudo.
# Installs what is missing, builds the package, fetches three.js, and runs it in headless Chromium on a software
# renderer. Takes about seven minutes, and some more the first time.
#   --serve  shows pages with 5,000 moving lights instead: http://localhost:8000/tests/page.html for WebGLRenderer,
#            /webgpu_page.html for WebGPURenderer, /webgpu_page.html#webgl for that with WebGL 2
set -eu
me=tests/three.sh
cd "$(dirname "$0")/.."
. tests/packages.sh
takes "nothing, --serve" "--serve" "$@"

build_npm_package chromium

tests=build/three-tests
fetch_npm $tests three@0.187.0 playwright-core@1.65.1
[ $# -eq 0 ] || exec node tests/server.mjs 8000 tests/three
run_node_tests tests/three/pictures.mjs $tests/pictures.log
run_node_tests tests/three/webgpu.mjs $tests/webgpu.log
