#!/bin/sh
# sh tests/campaign.sh [LIGHTS] [LIGHTS_IN_OTHER_BUILDS]: the oracle's families at length, the library built in many
# ways, one whole viewport of 16384 x 16384 one-pixel tiles (8 GB of memory), spots and boxes. Writes
# build/campaign/campaign.md;
# tests/campaign.md is a copy of one that was worth keeping. Defaults: 2,500,000 lights a family with g++ -O2 and 1,250,000
# in each of the other builds, so ten million cases a family or more in all; they take about an hour on one core.
# sh tests/campaign.sh spots [ROUNDS]: spots alone; the rest of the report is that of tests/campaign.md. 14 rounds, the
# default, are over ten million verdicts by certificates with g++ -O2; a fifth of that in each of the other builds. Some 15
# minutes on one core.
# sh tests/campaign.sh boxes [ROUNDS]: boxes alone; writes build/campaign/boxes.md, that part of the report. 5 rounds, the
# default, are over ten million verdicts. Some seven minutes on one core.
set -eu
me=tests/campaign.sh
cd "$(dirname "$0")/.."
. tests/packages.sh
takes "numbers, spots, boxes" "[1-9][0-9]*|spots|boxes" "$@"
install_packages g++ clang-14 clang-19 libboost-dev libgmp-dev doctest-dev libglm-dev

work=build/campaign
make_build_folder
mkdir -p $work
common="-std=c++20 -Iinclude"
failed=

# verdicts_of LOG: what shape_proof.hpp counted, a camera kind a line: kind|verdicts|by_shape|open|missed
verdicts_of() {
    sed -n 's/.*MESSAGE: \([a-z_ ]*\): \([0-9]*\) verdicts, \([0-9]*\) not by balls alone, \([0-9]*\) left open, \([0-9]*\) missed/\1|\2|\3|\4|\5/p' \
        "$1"
}
# spots_with NAME COMPILER FLAGS ROUNDS: tests/oracle/spots.cpp at length; what it counted, a camera kind a line, in NAME.spots
spots_with() {
    echo "$me: spots, $2 $3: $4 rounds of each camera kind"
    # shellcheck disable=SC2086  # several flags
    "$2" $common $3 tests/oracle/spots.cpp $work/doctest_main.o -lgmp -o "$work/spots_$1" || fail "$1 does not compile"
    LIGHTBIN_ROUNDS=$4 nice -n 19 "$work/spots_$1" >"$work/spots_$1.log" || failed="$failed $work/spots_$1.log"
    verdicts_of "$work/spots_$1.log" | tr ' |' '_ ' >"$work/$1.spots"
    [ "$(wc -l <"$work/$1.spots")" -ge 20 ] || fail "spots, $2 $3: camera kinds are missing, see $work/spots_$1.log"
    echo "$2 $3" >"$work/$1.spots_name"
}
spot_table() {
    awk -v name="$2" '{ verdicts += $2; certificates += $3; open += $4; missed += $5 }
        END { printf "| %s | %.3g | %.3g | %d | %d |\n", name, verdicts, certificates, open, missed }' "$1"
}
# by_line TABLE FILE: a row of the table for each line, named by its first word
by_line() {
    while read -r line; do
        echo "$line" >$work/line
        "$1" $work/line "$(echo "${line%% *}" | tr _ ' ')"
    done <"$2"
}
# spots ROUNDS: all builds, and that part of the report in spots.md
spots() {
    few=$((($1 + 4) / 5))
    rm -f $work/*.spots
    g++ $common -O1 -c tests/doctest_main.cpp -o $work/doctest_main.o
    spots_with 1_gcc_O2 g++ "-O2" "$1"
    spots_with 2_gcc_scalar g++ "-O2 -DLIGHTBIN_NO_SIMD" $few
    spots_with 3_gcc_native g++ "-O3 -march=native" $few
    spots_with 4_clang14_O2 clang++-14 "-O2" $few
    spots_with 5_clang19_native clang++-19 "-O3 -march=native" $few
    {
        echo "## Spots"
        echo
        echo "Made by \`sh tests/campaign.sh spots $1\` on $(date -u +%Y-%m-%d), at commit $(git rev-parse --short HEAD)," \
            "$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)."
        echo
        echo "Spots in view and world space, random, at the eye, huge, touching and of any bits, in tiles without and"
        echo "with a depth test, clusters and z-bins. A verdict says that a spot does not meet a cell whose list lacks"
        echo "it, though the ball of its range may reach the tile. By certificates: where the ball alone does not tell."
        echo
        echo "| build | verdicts | by certificates | left open | misses |"
        echo "| --- | --- | --- | --- | --- |"
        for result in $work/*.spots; do
            spot_table "$result" "$(cat "${result}_name")"
        done
        echo
        echo "By camera kind, g++ -O2:"
        echo
        echo "| cameras | verdicts | by certificates | left open | misses |"
        echo "| --- | --- | --- | --- | --- |"
        by_line spot_table $work/1_gcc_O2.spots
    } >$work/spots.md
}
# boxes ROUNDS: tests/oracle/boxes.cpp at length, and that part of the report in boxes.md
boxes() {
    echo "$me: boxes, $1 rounds of each camera kind"
    begin=$(date +%s)
    g++ $common -O1 -c tests/doctest_main.cpp -o $work/doctest_main.o
    g++ $common -O2 tests/oracle/boxes.cpp $work/doctest_main.o -lgmp -o $work/boxes || fail "boxes.cpp does not compile"
    LIGHTBIN_ROUNDS=$1 nice -n 19 $work/boxes >$work/boxes.log || failed="$failed $work/boxes.log"
    {
        echo "## Boxes"
        echo
        echo "Made by \`sh tests/campaign.sh boxes $1\` on $(date -u +%Y-%m-%d), at commit $(git rev-parse --short HEAD)," \
            "$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1), g++ -O2, in $((($(date +%s) - begin + 59) / 60)) minutes."
        echo
        echo "Boxes and balls cut by boxes in view and world space: random, flat, thin, sheared, huge, tapered, around the eye, at"
        echo "the near plane, touching and of any bits, on the rungs that the spots are on. A verdict says that a light does not"
        echo "meet cells whose lists lack it. None is left open: what double precision can't prove is decided in rationals."
        echo
        echo "| cameras | verdicts | not by balls alone | misses |"
        echo "| --- | --- | --- | --- |"
        verdicts_of $work/boxes.log | awk -F '|' '{ gsub("_", " "); printf "| %s | %s | %s | %s |\n", $1, $2, $3, $5 }'
    } >$work/boxes.md
    [ "$(grep -c '^| [a-z ]* | [0-9]' $work/boxes.md)" -ge 20 ] || fail "boxes: camera kinds are missing, see $work/boxes.log"
}
if [ "${1-}" = boxes ]; then
    boxes "${2:-5}"
    [ -z "$failed" ] || fail "something was found, see$failed"
    echo "$me: nothing found; $work/boxes.md has the table"
    exit
fi
if [ "${1-}" = spots ]; then
    spots "${2:-14}"
    sed '/^## Spots$/,$d' tests/campaign.md >$work/campaign.md
    cat $work/spots.md >>$work/campaign.md
    sed -n '/^## Boxes$/,$p' tests/campaign.md >>$work/campaign.md
    [ -z "$failed" ] || fail "something was found, see$failed"
    echo "$me: nothing found; $work/campaign.md has the table"
    exit
fi

lights=${1:-2500000}
others=${2:-1250000}
for part in judge campaign; do
    g++ $common -O2 -c tests/oracle/$part.cpp -o $work/$part.o || fail "$part.cpp does not compile"
done

# build NAME COMPILER FLAGS: the program with the library so built
build() {
    # shellcheck disable=SC2086  # several flags
    "$2" $common $3 -c tests/oracle/engine.cpp -o "$work/engine_$1.o" || fail "$1 does not compile"
    g++ $work/judge.o $work/campaign.o "$work/engine_$1.o" -lgmp -o "$work/campaign_$1"
    echo "$2 $3" >"$work/$1.flags"
}
# run NAME LIGHTS [flush|whole]: the families, or the whole viewport; a line each in NAME.txt
run() {
    name=$1${3:+_$3}
    case ${3:-} in
    flush) how=", FTZ and DAZ set" ;;
    whole) how=", one scene of 16384 x 16384 one-pixel tiles" ;;
    *) how= ;;
    esac
    echo "$(cat "$work/$1.flags")$how" >"$work/$name.name"
    echo "$me: $(cat "$work/$name.name"): $2 lights a family"
    nice -n 19 "$work/campaign_$1" "$2" ${3:-} >"$work/$name.part" 2>"$work/$name.log" ||
        failed="$failed $work/$name.log"
    mv "$work/$name.part" "$work/$name.txt"
}
rm -f $work/*.txt
build 1_gcc_O2 g++ "-O2"
build 2_gcc_O0 g++ "-O0"
build 3_gcc_native g++ "-O3 -march=native"
build 4_clang14_O2 clang++-14 "-O2"
build 5_clang19_native clang++-19 "-O3 -march=native"
run 1_gcc_O2 "$lights"
run 1_gcc_O2 "$others" flush
run 1_gcc_O2 "$((others < 50000 ? others : 50000))" whole
run 2_gcc_O0 "$others"
run 3_gcc_native "$others"
run 3_gcc_native "$others" flush
run 4_clang14_O2 "$others"
run 5_clang19_native "$others"

g++ $common -O2 -I. tests/platforms/lists.cpp tests/platforms/garbage.cpp -o $work/lists
echo "$me: tiers and workers, random cases"
nice -n 19 $work/lists 1000 >$work/lists.log || failed="$failed $work/lists.log"

echo "$me: every header alone, and the adversary"
sh tests/guest/compile.sh g++ alone >$work/headers.log || failed="$failed $work/headers.log"
g++ $common -O2 tests/hunt/main.cpp -o $work/hunt
nice -n 19 $work/hunt --seconds 300 --seed 1 >$work/hunt.log || failed="$failed $work/hunt.log"

spots 14
boxes 5

for compiler in g++ clang++-14 clang++-19; do
    if echo '#include <lightbin/lightbin.hpp>' | "$compiler" $common -ffast-math -x c++ -fsyntax-only - 2>$work/refusal; then
        fail "$compiler -ffast-math is not refused"
    fi
    grep -q 'error.*lightbin: -ffast-math' $work/refusal || fail "$compiler refuses -ffast-math for another reason"
done

# Sums and tables. A case: a light of a family in one rung's lists.
table() {
    awk -v name="$2" '{ cases += $2; proofs += $3; exact += $4; misses += $5; other += $6 - ($5 < 5 ? $5 : 5) }
        END { printf "| %s | %.3g | %.3g | %.3g | %d | %d |\n", name, cases, proofs, exact, misses, other }' "$1"
}
{
    echo "# Campaign: families of stiff and extreme inputs at length"
    echo
    echo "Made by \`sh tests/campaign.sh $lights $others\` on $(date -u +%Y-%m-%d), at commit $(git rev-parse --short HEAD)," \
        "$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1). tests/oracle/families.hpp has the generators."
    echo
    echo "$(wc -l <$work/1_gcc_O2.txt) families, $lights lights each with g++ -O2 and $others in the other builds."
    echo
    echo "A case is a light in the lists without or with a depth test. In each, every instruction set of the machine gave"
    echo "the scalar tier's bytes, and so did a run on the caller's threads. A proof says that a sphere does not meet"
    echo "a block of tiles that lack it; those that double precision could not give were decided in rationals. Under FTZ and DAZ an input that is denormal counts as the 0"
    echo "that the processor takes it for. With -ffast-math the header refuses to compile (g++, clang 14, clang 19)."
    echo
    echo "| build | cases | proofs | in rationals | misses | other complaints |"
    echo "| --- | --- | --- | --- | --- | --- |"
    for result in $work/*.txt; do
        table "$result" "$(cat "${result%.txt}.name")"
    done
    echo
    echo "By family, $(cat $work/1_gcc_O2.name):"
    echo
    echo "| family | cases | proofs | in rationals | misses | other complaints |"
    echo "| --- | --- | --- | --- | --- | --- |"
    by_line table $work/1_gcc_O2.txt
    echo
    cat $work/spots.md
    echo
    cat $work/boxes.md
} >$work/campaign.md
[ -z "$failed" ] || fail "something was found, see$failed"
echo "$me: nothing found; $work/campaign.md has the table"
