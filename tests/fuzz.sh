#!/bin/sh
# sh tests/fuzz.sh [SECONDS]: fuzzes the binning, the shader generators and the C side for so long each (60 if not
# given), under AddressSanitizer and UndefinedBehaviorSanitizer. Starts from the corpus in tests/fuzz, which the normal tests replay,
# and leaves what it found in build/fuzz: inputs that fail, and a minimised corpus to put in the old one's place.
set -eu
me=tests/fuzz.sh
cd "$(dirname "$0")/.."
. tests/packages.sh
takes "a number of seconds" "[1-9][0-9]*" "$@"
install_packages clang-14 libclang-rt-14-dev libboost-dev libgmp-dev

seconds=${1:-60}
work=build/fuzz
make_build_folder
mkdir -p $work
compile() {
    clang++-14 -std=c++20 -O1 -g -Iinclude -fno-omit-frame-pointer -fsanitize=fuzzer-no-link,address,undefined \
        -fno-sanitize-recover=all -c "$@" -o "$work/$(basename "$1" .cpp).o" || fail "$1 does not compile"
}
for source in oracle/judge oracle/engine fuzz/binning fuzz/shader; do
    compile tests/$source.cpp
done
compile tests/fuzz/c.cpp -DLIGHTBIN_NO_SIMD
clang++-14 -fsanitize=fuzzer,address,undefined $work/binning.o $work/judge.o $work/engine.o -lgmp -o $work/fuzz_binning
clang++-14 -fsanitize=fuzzer,address,undefined $work/shader.o -o $work/fuzz_shader
clang++-14 -fsanitize=fuzzer,address,undefined $work/c.o -o $work/fuzz_c
clang++-14 -std=c++20 -O1 -DNO_TARGET tests/fuzz/replay.cpp -o $work/pack

failed=
# fuzz NAME LONGEST_INPUT
fuzz() {
    mkdir -p "$work/$1" "$work/$1_failures"
    "$work/pack" --unpack "tests/fuzz/$1.corpus" "$work/$1"
    echo "$me: fuzzing $1 for $seconds s"
    "$work/fuzz_$1" -max_len="$2" -timeout=30 -max_total_time="$seconds" \
        -artifact_prefix="$work/$1_failures/" "$work/$1" >"$work/$1.log" 2>&1 || failed="$failed $1"
    tail -n 1 "$work/$1.log"
    rm -rf "$work/$1_small"
    mkdir "$work/$1_small"
    "$work/fuzz_$1" -merge=1 -max_len="$2" -artifact_prefix="$work/$1_failures/" "$work/$1_small" "$work/$1" >>"$work/$1.log" 2>&1 || true
    "$work/pack" --pack "$work/$1_small" "$work/$1.corpus"
}
fuzz binning 700
fuzz shader 260
fuzz c 900
[ -z "$failed" ] || fail "failed:$failed; the inputs and logs are in $work"
echo "$me: nothing found; $work/*.corpus are the minimised corpora"
