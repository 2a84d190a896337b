#!/bin/sh
# sh tests/campaign.sh [LIGHTS [ROUNDS]]: the oracle at length. LIGHTS (1,000,000) of each family of stiff and extreme
# inputs, with the library built in many ways; ROUNDS (5) of the spheres, spots and boxes before every kind of camera,
# in two builds. Writes build/campaign/campaign.md. Takes some hours on one core.
set -eu
me=tests/campaign.sh
cd "$(dirname "$0")/.."
. tests/packages.sh
takes "numbers" "[1-9][0-9]*" "$@"
install_packages g++ clang-14 clang-19 libboost-dev libgmp-dev doctest-dev libglm-dev

lights=${1:-1000000}
rounds=${2:-5}
work=build/campaign
make_build_folder
rm -rf $work
mkdir -p $work
common="-std=c++20 -Iinclude"
failed=

# run NAME PROGRAM ARGUMENT...: in NAME.txt what the program prints
run() {
    echo "$me: $1"
    log=$work/$(echo "$1" | tr ' =+' '_').txt
    shift
    nice -n 19 "$@" >"$log" 2>"$log.errors" || failed="$failed $log"
}

# families COMPILER FLAGS: a row of the table
families() {
    # shellcheck disable=SC2086  # several flags
    "$1" $common $2 tests/oracle/families.cpp -lgmp -o $work/families
    run "families, $1 $2" $work/families "$lights"
    awk -v build="$1 $2" 'NF == 6 { lights += $2; proofs += $3; exact += $4; missed += $5; wrong += $6 }
        END { printf "| %s | %.3g | %.3g | %.3g | %d | %d |\n", build, lights, proofs, exact, missed, wrong }' "$log" \
        >>$work/families.md
}
families g++ -O2
families g++ -O0
families g++ "-O3 -march=native"
families clang++-14 -O2
families clang++-19 "-O3 -march=native"

g++ $common -O1 -c tests/doctest_main.cpp -o $work/doctest_main.o
# shapes COMPILER FLAGS: three rows of the table
shapes() {
    for kind in spheres spots boxes; do
        # shellcheck disable=SC2086  # several flags
        "$1" $common $2 tests/oracle/$kind.cpp $work/doctest_main.o -lgmp -o $work/$kind
        run "$kind, $1 $2" env LIGHTBIN_ROUNDS="$rounds" $work/$kind
        sed -n 's/.*MESSAGE: [a-z_ ]*: \([0-9]*\) verdicts, \([0-9]*\) [a-z ]*, \([0-9]*\) [a-z ]*, \([0-9]*\) missed.*/\1 \2 \3 \4/p' "$log" |
            awk -v build="$kind, $1 $2" '{ verdicts += $1; shape += $2; open += $3; missed += $4 }
                END { printf "| %s | %.3g | %.3g | %d | %d |\n", build, verdicts, shape, open, missed }' >>$work/shapes.md
    done
}
shapes g++ -O2
shapes clang++-19 "-O3 -march=native"

# A million views with an oblique near plane.
# shellcheck disable=SC2086  # several flags
g++ $common -O2 tests/oracle/depth.cpp $work/doctest_main.o -lgmp -o $work/depth
run "oblique near planes" env LIGHTBIN_ROUNDS=250 $work/depth "--test-case=oblique*"

{
    echo "# Campaign: the oracle at length"
    echo
    echo "Made by \`sh tests/campaign.sh $lights $rounds\` on $(date -u +%Y-%m-%d), at commit $(git rev-parse --short HEAD)," \
        "$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)."
    echo
    echo "The families of tests/oracle/families.hpp, $lights lights each: lists with and without a depth test, and masks"
    echo "with and without z-bins. Every instruction set of the machine gave the scalar one's bytes, and so did a run on the"
    echo "caller's threads. A proof says that a sphere does not meet a tile, or tiles side by side, that lack it."
    echo
    echo "| build | lights | proofs | in rationals | misses | other complaints |"
    echo "| --- | --- | --- | --- | --- | --- |"
    cat $work/families.md
    echo
    echo "Spheres, spots and boxes in view and world space, before 19 kinds of camera: in tiles without and with a depth"
    echo "test, in clusters and z-bins. A verdict says that a light does not meet cells whose lists lack it. Some spots are"
    echo "left open: no certificate was found."
    echo
    echo "| lights and build | verdicts | not by the light's ball alone | left open | misses |"
    echo "| --- | --- | --- | --- | --- |"
    cat $work/shapes.md
    echo
    echo "Oblique near planes: $(sed -n 's/.*MESSAGE: //p' $work/oblique_near_planes.txt)."
} >$work/campaign.md
[ -z "$failed" ] || fail "something was found, see$failed"
echo "$me: nothing found; $work/campaign.md has the tables"
