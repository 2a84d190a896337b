#!/bin/sh
# sh examples/raylib.sh [--check] [RAYLIB]: 1,000 lights in a raylib program, on Debian as root or with sudo. Installs
# the packages that are missing, builds examples/raylib/lights.c in build/raylib, and runs it.
#   --check   draws frames off screen by masks and by every light, and compares them byte by byte; needs no display
#   RAYLIB    the folder of raylib's sources, or the prefix that it is installed in; without it, the raylib that
#             pkg-config knows, or Debian's libraylib-dev, which Debian 14 and later have
set -eu
me=examples/raylib.sh
here=$(pwd)
cd "$(dirname "$0")/.."
. tests/packages.sh

takes "a folder, --check" "--check|[^-].*" "$@"
check=
raylib=
for word; do
    case $word in
    --check) check=yes ;;
    *) raylib=$(cd "$here" && cd "$word" 2>/dev/null && pwd) || fail "there is no folder $word" ;;
    esac
done

install_packages g++ cmake make pkgconf libepoxy-dev libgl1-mesa-dri ${check:+xvfb}
make_build_folder
built=$(pwd)/build/raylib
mkdir -p "$built"

# built_from FOLDER NAME [OPTION...]: builds what a folder has, and installs it in build/raylib/installed.
built_from() {
    folder=$1 name=$2
    shift 2
    echo "$me: building $name in build/raylib"
    { cmake -S "$folder" -B "$built/$name" -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX="$built/installed" "$@" &&
        cmake --build "$built/$name" -j "$(nproc)" && cmake --install "$built/$name"; } >"$built/$name.log" 2>&1 ||
        { cat "$built/$name.log"; fail "$name could not be built"; }
}

if [ -f "$raylib/src/raylib.h" ]; then
    install_packages libgl-dev libxrandr-dev libxinerama-dev libxcursor-dev libxi-dev
    built_from "$raylib" raylib -DBUILD_EXAMPLES=OFF
    raylib=$built/installed
elif [ -z "$raylib" ] && ! pkg-config --exists raylib; then
    apt-cache show libraylib-dev >/dev/null 2>&1 || fail "this distribution has no raylib (Debian has it from 14 on):" \
        "get its sources from www.raylib.com, and give their folder"
    install_packages libraylib-dev
fi
if [ -n "$raylib" ]; then
    found=$(find "$raylib" -name raylib.pc -print -quit)
    [ -n "$found" ] || fail "$raylib has neither src/raylib.h nor a raylib.pc"
    PKG_CONFIG_PATH=${found%/*}
fi
built_from . lightbin -DLIGHTBIN_C=ON -DLIGHTBIN_TESTS=OFF -DLIGHTBIN_EXAMPLES=OFF
PKG_CONFIG_PATH=$built/installed/lib/pkgconfig:${PKG_CONFIG_PATH-}
export PKG_CONFIG_PATH

# shellcheck disable=SC2046  # one word an option
gcc -std=c99 -O2 -Wall -Wextra examples/raylib/lights.c -o "$built/lights" \
    $(pkg-config --static --cflags --libs raylib lightbin-c epoxy) -lpthread -ldl
[ -z "$check" ] || exec sh tests/renderers/on_xvfb.sh Xvfb "$built/lights" --check "$built/lights.png"
exec "$built/lights"
