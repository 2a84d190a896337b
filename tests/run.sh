#!/bin/sh
# Runs every test: `sh tests/run.sh` on Debian 12, as root or with sudo. Installs the packages that are missing,
# configures and builds in build/dev, runs the tests.
set -eu
me=tests/run.sh
cd "$(dirname "$0")/.."
. tests/packages.sh

compilers="g++ clang-14 clang-19" # the last two to see that they have no warning to give either
tools="cmake ninja-build"
arm="g++-aarch64-linux-gnu qemu-user-static" # the NEON tier, in an emulator
x86_32="g++-12-multilib" # a machine of 32 bits
libraries="doctest-dev libglm-dev"
oracle="libboost-dev libgmp-dev"
examples="libcli11-dev libtinygltf-dev libstb-dev libepoxy-dev libegl-dev libglfw3-dev"
opengl="libgl1-mesa-dri libgles2" # Mesa draws where there is no GPU
shaders="glslang-dev glslang-tools spirv-tools" # the first names files of the second
# shellcheck disable=SC2086  # one word a package
install_packages $compilers $tools $arm $x86_32 $libraries $oracle $examples $opengl $shaders

echo "$me: configuring and building in build/dev"
jobs=$(nproc)
make_build_folder
cmake --preset dev >build/dev.log 2>&1 || { cat build/dev.log; fail "the configuration failed"; }
cmake --build --preset dev -j "$jobs" -- --quiet || fail "the build failed"

echo "$me: running the tests, which takes a few minutes"
failed=
ctest --preset dev -j "$jobs" >build/dev-tests.log 2>&1 || failed=yes
# What each failed test said, and the summary; no line for those that passed.
grep -vE '^ *(Start +[0-9]+: |[0-9]+/[0-9]+ Test +#.* Passed )' build/dev-tests.log
[ -z "$failed" ] || fail "not every test passed; the full log is build/dev-tests.log"
echo "$me: every test passed"
