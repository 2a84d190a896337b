#!/bin/sh
# sh tests/mutants.sh [--check] [NUMBER...]: can the proof fail? Breaks the library in one place at a time, each as somebody
# might by mistake, builds a proof with it, and expects that to complain. The mutants are in tests/mutants.txt. Some ten
# minutes on two cores; what each proof said is in build/mutants.
#   NUMBER   those mutants alone, counted from 1
#   --check  only looks whether each mutant still finds the code that it breaks, in a second
set -eu
me=tests/mutants.sh
cd "$(dirname "$0")/.."
. tests/packages.sh
takes "numbers of mutants, --check" "[1-9][0-9]*|--check|--one" "$@"
work=build/mutants
[ "${1-}" != --check ] || exec python3 tests/mutate.py

# Builds and runs the proof of one mutant, which is expected to fail. A line that does not start with "caught" is a hole in
# the proof.
try() {
    place=$work/$1
    rm -rf "$place"
    mkdir -p "$place"
    proof=$(python3 tests/mutate.py "$1" "$place")
    flags="-std=c++20 -O1 -w -I$place/include"
    arguments=
    case $proof in
    cull)
        sources="-Iexamples/tiled_forward tests/shader/cull_gl.cpp examples/tiled_forward/gl_context.cpp
            examples/tiled_forward/gl_program.cpp -lepoxy"
        arguments=430
        ;;
    cull_hunt)
        sources="-DLIGHTBIN_NO_SIMD -Iexamples/tiled_forward tests/shader/cull_hunt.cpp bench/gpu/device.cpp
            examples/tiled_forward/gl_context.cpp examples/tiled_forward/gl_program.cpp -lepoxy -lgmp"
        arguments=300
        ;;
    cull_twin)
        # shellcheck disable=SC2086  # several flags
        g++ $flags tests/shader/cull_twin_text.cpp -o "$place/text" && "$place/text" >"$place/cull_twin_text.inc"
        sources="-I$place tests/shader/cull_twin.cpp"
        arguments=1000
        ;;
    views | clusters | masks) sources="tests/unit/$proof.cpp $work/doctest_main.o" ;;
    lists) sources="-I. tests/platforms/lists.cpp tests/platforms/garbage.cpp" ;;
    families) sources="tests/oracle/families.cpp -lgmp" arguments=8000 ;;
    *) sources="tests/oracle/$proof.cpp $work/doctest_main.o -lgmp" ;;
    esac
    # shellcheck disable=SC2086  # several flags and files
    g++ $flags $sources -o "$place/proof" 2>"$place/log" || {
        echo "DOES NOT COMPILE: mutant $1, see $place/log"
        return
    }
    # shellcheck disable=SC2086  # or none
    if LIGHTBIN_CAMERAS="symmetric world_space" "$place/proof" $arguments >"$place/log" 2>&1; then
        echo "SURVIVES $proof: mutant $1, see tests/mutants.txt"
    else
        echo "caught by $proof: mutant $1"
    fi
    rm -rf "$place/include" "$place/proof"
}

if [ "${1-}" = --one ]; then
    try "$2"
    exit
fi

install_packages g++ python3 libboost-dev libgmp-dev doctest-dev libglm-dev libepoxy-dev libegl1 libgl1-mesa-dri
export GALLIVM_PERF=nopt  # what Mesa makes of the shaders runs shortly
python3 tests/mutate.py || fail "a mutant does not find its code: see tests/mutants.txt"
make_build_folder
mkdir -p $work
g++ -std=c++20 -O1 -c tests/doctest_main.cpp -o $work/doctest_main.o
numbers=${*:-$(seq "$(grep -cv '^#\|^$' tests/mutants.txt)")}
echo "$me: $(echo "$numbers" | wc -w) mutants"
# shellcheck disable=SC2086  # several numbers
printf '%s\n' $numbers | xargs -P "$(nproc)" -n 1 sh $me --one | tee $work/report
! grep -v '^caught' $work/report >/dev/null || fail "not every mutant is caught"
echo "$me: every mutant is caught"
