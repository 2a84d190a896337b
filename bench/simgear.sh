#!/bin/sh
# sh bench/simgear.sh FOLDER: the clustered shading of SimGear, FlightGear's engine, beside the same with lightbin in
# it: times of both in turns, and the lights that its shader does not find. FOLDER has SimGear's source, 2024.1, as
# `apt-get source simgear` unpacks it where Debian's sid is a source. docs/simgear.md has a result. A minute, on
# Debian 12, as root or with sudo. Leave the machine alone while it runs.
set -eu
me=bench/simgear.sh
here=$(pwd)
cd "$(dirname "$0")/.."
. tests/packages.sh
takes "a folder" "[^-].*" "$@"
[ $# -eq 1 ] || fail "takes the folder of SimGear's source; --help says more"
case $1 in /*) source=$1 ;; *) source=$here/$1 ;; esac
viewer=$source/simgear/scene/viewer
[ -f "$viewer/ClusteredShading.cxx" ] || fail "there is no simgear/scene/viewer/ClusteredShading.cxx in $1"

install_packages g++ libopenscenegraph-dev
make_build_folder
out=build/simgear
mkdir -p $out
for file in cxx hxx; do
    sed 's/ClusteredShading/OwnShading/g' "$viewer/ClusteredShading.$file" >$out/OwnShading.$file
    sed 's/ClusteredShading/LightbinShading/g' "$viewer/ClusteredShading.$file" >$out/LightbinShading.$file
done
# What is changed in SimGear: a member, and a call in the place of its own lists.
sed -i -e '/^#include <simgear.scene.model.SGLight.hxx>/a #include "light_lists.hpp"' \
    -e '/std::atomic<int> *_global_light_count;/a LightLists _lists;' $out/LightbinShading.hxx
sed -i -e '/^    updateSubfrusta();/,/^    \/\/ Force upload/c \
    _lists.fill(*_camera, _tile_size, _depth_slices, _zNear, _zFar, _point_bounds, _spot_bounds, *_clusters,\
                *_indices);' \
    $out/LightbinShading.cxx
grep -q '_lists.fill' $out/LightbinShading.cxx || fail "this SimGear has no such update()"

compile() {
    standard=$1
    shift
    g++ "-std=$standard" -O2 -DNDEBUG -Iinclude -Ibench/simgear/stand_ins -Ibench/simgear -I$out -I"$viewer" -c "$@"
}
compile c++20 bench/simgear/light_lists.cpp -o $out/light_lists.o
for file in $out/OwnShading.cxx $out/LightbinShading.cxx bench/simgear/simgear.cpp; do
    compile c++17 "$file" -o "$out/$(basename "$file").o"
done
g++ $out/*.o -losg -pthread -o $out/simgear
echo "$me: $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1), $(nproc) cores; $(g++ --version | head -n 1)"
./$out/simgear
