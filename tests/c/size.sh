#!/bin/sh
# size.sh [--check]: what each part of the C side costs, in KB of code and seconds of the processor's time to compile
# with g++ -O2: the table of docs/c.md, in about nine minutes. With --check it compiles two forms alone, all of it and
# plain tiles of spheres, and fails if their code exceeds 560 and 100 KB, or if the second does not work or does not
# refuse the rest by name.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# compile NAME DEFINE...: an object file of the C side without some parts
compile() {
    name=$1
    shift
    # shellcheck disable=SC2046,SC2116  # a word a define
    g++ -std=c++20 -O2 -Wall -Wextra -Werror -I "$here/../../include" $(for define in "$@"; do echo "-DLIGHTBIN_NO_$define"; done) \
        -c "$here/../../packaging/lightbin.cpp" -o "$work/$name.o"
}
code_of() {
    size -A "$work/$1.o" | awk '$1 ~ /^\.text/ { sum += $2 } END { print sum }'
}
all="SPOTS BOXES U16 DEPTH_TEST DEPTH_SLICES SHADERS CULL_SHADERS DUMP"

if [ "${1-}" = --check ]; then
    compile whole
    # shellcheck disable=SC2086  # a word a part
    compile plain $all
    echo "code: $(code_of whole) bytes in all, $(code_of plain) bytes for plain tiles of spheres"
    [ "$(code_of whole)" -le 560000 ]
    [ "$(code_of plain)" -le 100000 ]
    cc -std=c99 -pedantic -Wall -Wextra -Werror -I "$here/../../include" -c "$here/left_out.c" -o "$work/left_out.o"
    g++ "$work/left_out.o" "$work/plain.o" -o "$work/left_out"
    "$work/left_out"

    # Without exceptions and RTTI.
    g++ -std=c++20 -O1 -fno-exceptions -fno-rtti -Wall -Wextra -Werror -I "$here/../../include" -DLIGHTBIN_NO_SIMD \
        -c "$here/../../packaging/lightbin.cpp" -o "$work/no_exceptions.o"
    cc -std=c99 -I "$here/../../include" -c "$here/contract.c" -o "$work/contract.o"
    g++ "$work/contract.o" "$work/no_exceptions.o" -o "$work/contract"
    "$work/contract"
    exit
fi

# Sets `spent` to the processor's time of all compilers so far, in milliseconds.
count_spent() {
    times >"$work/times" # of this shell's children: in $(...) there would be none
    spent=$(awk 'NR == 2 { split($1, part, /[ms]/); printf "%d", 1000 * (60 * part[1] + part[2]) }' "$work/times")
}

# row NAME LABEL DEFINE...: a line of the table, against the whole
row() {
    name=$1
    label=$2
    shift 2
    count_spent
    begin=$spent
    compile "$name" "$@"
    count_spent
    spent=$((spent - begin))
    if [ "$name" = whole ]; then
        whole_bytes=$(code_of whole)
        whole_ms=$spent
    fi
    awk -v label="$label" -v bytes="$(code_of "$name")" -v ms=$spent -v whole="$whole_bytes" -v whole_ms="$whole_ms" 'BEGIN {
        printf "| %s | %.0f | %.0f | %.0f | %.0f |\n", label, bytes / 1000, (whole - bytes) / 1000, ms / 1000, (whole_ms - ms) / 1000 }'
}
echo "| without | KB of code | saved | seconds to compile | saved |"
echo "| --- | --- | --- | --- | --- |"
row whole "(all of it)"
for part in $all; do
    row "$part" "\`LIGHTBIN_NO_$part\`" "$part"
done
row kinds "spots and boxes" SPOTS BOXES
# shellcheck disable=SC2086  # a word a part
row plain "all of these: plain tiles of spheres" $all
