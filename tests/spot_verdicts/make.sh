#!/bin/sh
# sh tests/spot_verdicts/make.sh: makes tests/spot_verdicts/verdicts.txt again, on Debian 12, as root or with sudo. Some
# ten seconds. The same compiler and C library give the same bytes.
set -eu
me=tests/spot_verdicts/make.sh
cd "$(dirname "$0")/../.."
. tests/packages.sh
takes "" "" "$@"
install_packages g++ libboost-dev libgmp-dev
make_build_folder
work=build/spot_verdicts
mkdir -p $work
g++ -std=c++20 -O2 tests/spot_verdicts/make.cpp -lgmp -o $work/make || fail "it does not compile"
$work/make >$work/verdicts.txt
mv $work/verdicts.txt tests/spot_verdicts/verdicts.txt
echo "$me: wrote tests/spot_verdicts/verdicts.txt, $(wc -c <tests/spot_verdicts/verdicts.txt) bytes"
