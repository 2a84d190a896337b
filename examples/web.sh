#!/bin/sh
# sh examples/web.sh [--build] [--port N]: lightbin in a browser, on Debian 12, as root or with sudo. Installs the packages
# that are missing, makes a folder of static files, build/web, and serves it to this machine alone.
#   --build   makes the folder and ends
#   --port N  where to serve (default: 8000; 0: any that is free)
set -eu
me=examples/web.sh
cd "$(dirname "$0")/.."
. tests/packages.sh

port=8000
serve=yes
while [ $# -gt 0 ]; do
    case $1 in
    --build) serve= ;;
    --port)
        [ $# -gt 1 ] || fail "--port wants a number"
        port=$2
        shift
        ;;
    -h | --help) help ;;
    *) fail "cannot do '$1': it takes --build, --port N or --help" ;;
    esac
    shift
done

install_packages make python3 emscripten node-acorn binaryen esbuild nodejs libglm-dev libtinygltf-dev \
    nlohmann-json3-dev
make_build_folder
echo "$me: building in build/web, which takes about two minutes the first time"
make -s -j "$(nproc)" -f examples/web/web.mk 2>build/web.log || { cat build/web.log; fail "the build failed"; }
echo "$me: build/web has $(du -bc build/web/* | sed -n '$s/\t.*//p') bytes in all"
[ -n "$serve" ] || exit 0
exec python3 examples/web/serve.py build/web "$port"
