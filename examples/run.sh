#!/bin/sh
# Draws a scene: `sh examples/run.sh [SCENE.glb] [options]` on Debian 12, as root or with sudo. Installs the
# packages that are missing, builds the example programs in build/examples, hands everything to tiled_forward, which
# writes a picture and names it. With --advise it measures what each part of binning saves in this scene on this
# machine, and says which to leave out.
# `sh examples/run.sh --replay FILE [-o PNG]` takes a frame that lightbin::dump() wrote: it makes the lists again, draws
# how many lights each tile has, names the lights and cells that cost most, and checks in exact arithmetic that no light
# is missed. It fails where the lists differ, or a light is missed.
set -eu
me=examples/run.sh
here=$(pwd)
cd "$(dirname "$0")/.."
. tests/packages.sh

# The program's options, a line each, as its source has them.
options() {
    awk '/app\.add_(option|flag)\(/ { inside = 1; name = text = "" }
        inside {
            ends = sub(/"\).*/, "\"")
            while (match($0, /"[^"]*"/)) {
                word = substr($0, RSTART + 1, RLENGTH - 2)
                $0 = substr($0, RSTART + RLENGTH)
                if (name == "") name = word
                else text = text word
            }
            if (ends) printf "  %-18s %s\n", name, text
            if (ends) inside = 0
        }' examples/tiled_forward/main.cpp
}
case " $* " in
*" -h "* | *" --help "*) (help) && options && exit ;;
esac
names=$(options | sed -n 's/^  \(-[^ ]*\).*/\1/p' | tr ',\n' '||')
takes "a scene, --replay, the options that --help lists" "--replay|(${names%|})(=.*)?|-[0-9.].*|-o.*|[^-].*" "$@"

name=tiled_forward exact=
if [ "${1-}" = --replay ]; then
    shift
    name=replay
    exact="libboost-dev libgmp-dev nlohmann-json3-dev"
fi
build="g++ cmake ninja-build"
libraries="libglm-dev libcli11-dev libtinygltf-dev libstb-dev libepoxy-dev libegl-dev libglfw3-dev"
opengl="libgl1-mesa-dri libgles2" # Mesa draws where there is no GPU
# shellcheck disable=SC2086  # one word a package
install_packages $build $libraries $opengl $exact

make_build_folder
echo "$me: building in build/examples"
{
    cmake --preset examples &&
        cmake --build --preset examples ${exact:+--target replay} -j "$(nproc)"
} >build/examples.log 2>&1 ||
    { cat build/examples.log; fail "the build failed"; }
program=$(pwd)/build/examples/examples/$name
cd "$here"
exec "$program" "$@"
