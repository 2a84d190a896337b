#!/bin/sh
# Times the binning: `sh bench/run.sh [--quick]` on Debian 12, as root or with sudo. Installs the packages that are
# missing, builds in build/bench, prints the ratios to the flat baseline and writes build/bench/binning.csv. Leave the
# machine alone while it runs.
set -eu
me=bench/run.sh
cd "$(dirname "$0")/.."
. tests/packages.sh

install_packages g++ cmake ninja-build libglm-dev libbenchmark-dev

make_build_folder
echo "$me: building in build/bench"
{ cmake --preset bench && cmake --build --preset bench; } >build/bench.log 2>&1 ||
    { cat build/bench.log; fail "the build failed"; }
echo "$me: $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1), $(nproc) cores; $(c++ --version | head -n 1)"
cd build/bench
./bench/binning "$@"
echo "$me: wrote build/bench/binning.csv"
