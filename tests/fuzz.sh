#!/bin/sh
# sh tests/fuzz.sh [SECONDS]: fuzzes the binning, the shader generators and the C side for so long each (60 if not
# given), under AddressSanitizer and UndefinedBehaviorSanitizer. Starts from the corpus in tests/fuzz, which the normal tests replay,
# and leaves what it found in build/fuzz: inputs that fail, and a minimised corpus to put in the old one's place.
set -eu
me=tests/fuzz.sh
cd "$(dirname "$0")/.."
. tests/packages.sh
takes "a number of seconds" "[1-9][0-9]*" "$@"
install_packages clang-14 libclang-rt-14-dev libboost-dev libgmp-dev python3

seconds=${1:-60}
work=build/fuzz
make_build_folder
mkdir -p $work
for target in binning shader c; do
    clang++-14 -std=c++20 -O1 -g -Iinclude -fno-omit-frame-pointer -fsanitize=fuzzer,address,undefined \
        -fno-sanitize-recover=all tests/fuzz/$target.cpp -lgmp -o $work/fuzz_$target || fail "$target.cpp does not compile"
done

# unpack CORPUS FOLDER, pack FOLDER CORPUS: between one file, in which the length of each input comes first, and files
unpack() {
    python3 - "$@" <<'END'
import pathlib, sys
data = pathlib.Path(sys.argv[1]).read_bytes()
while data:
    end = 2 + int.from_bytes(data[:2], 'little')
    pathlib.Path(sys.argv[2], str(len(data))).write_bytes(data[2:end])
    data = data[end:]
END
}
pack() {
    python3 - "$@" <<'END'
import pathlib, sys
inputs = [path.read_bytes() for path in pathlib.Path(sys.argv[1]).iterdir()]
pathlib.Path(sys.argv[2]).write_bytes(b''.join(len(i).to_bytes(2, 'little') + i for i in inputs))
END
}

failed=
# fuzz NAME LONGEST_INPUT
fuzz() {
    mkdir -p "$work/$1" "$work/$1_failures"
    unpack "tests/fuzz/$1.corpus" "$work/$1"
    echo "$me: fuzzing $1 for $seconds s"
    "$work/fuzz_$1" -max_len="$2" -timeout=30 -max_total_time="$seconds" \
        -artifact_prefix="$work/$1_failures/" "$work/$1" >"$work/$1.log" 2>&1 || failed="$failed $1"
    tail -n 1 "$work/$1.log"
    rm -rf "$work/$1_small"
    mkdir "$work/$1_small"
    "$work/fuzz_$1" -merge=1 -max_len="$2" -artifact_prefix="$work/$1_failures/" "$work/$1_small" "$work/$1" >>"$work/$1.log" 2>&1 || true
    pack "$work/$1_small" "$work/$1.corpus"
}
fuzz binning 700
fuzz shader 260
fuzz c 900
[ -z "$failed" ] || fail "failed:$failed; the inputs and logs are in $work"
echo "$me: nothing found; $work/*.corpus are the minimised corpora"
