#!/bin/sh
# Draws a scene: `sh examples/run.sh [SCENE.glb] [options]` on Debian 12, as root or with sudo. Installs the
# packages that are missing, builds the example programs in build/examples, hands everything to tiled_forward
# (--help lists its options), which writes a picture and names it.
set -eu
me=examples/run.sh
here=$(pwd)
cd "$(dirname "$0")/.."
. tests/packages.sh

build="g++ cmake ninja-build"
libraries="libglm-dev libcli11-dev libtinygltf-dev libstb-dev libepoxy-dev libegl-dev libglfw3-dev"
opengl="libgl1-mesa-dri libgles2" # Mesa draws where there is no GPU
# shellcheck disable=SC2086  # one word a package
install_packages $build $libraries $opengl

make_build_folder
echo "$me: building in build/examples"
{ cmake --preset examples && cmake --build --preset examples -j "$(nproc)"; } >build/examples.log 2>&1 ||
    { cat build/examples.log; fail "the build failed"; }
program=$(pwd)/build/examples/examples/tiled_forward
cd "$here"
exec "$program" "$@"
