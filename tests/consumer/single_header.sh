#!/bin/sh
# single_header.sh COMPILER: the single header is made twice the same, is to the compiler what the headers are that it is made
# of, and serves a program of two units.
set -eu
compiler=$1
here=$(cd "$(dirname "$0")" && pwd)
include=$here/../../include
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

single=$work/single/lightbin/lightbin.hpp
sh "$here/../../packaging/single_header.sh" "$single"
sh "$here/../../packaging/single_header.sh" "$work/again.hpp"
cmp "$single" "$work/again.hpp"

echo '#include <lightbin/lightbin.hpp>' >"$work/unit.cpp"
(cd "$include" && find lightbin -maxdepth 1 -name '*.hpp' | sort | sed 's/.*/#include <&>/') >"$work/headers.cpp"

# preprocessed FOLDER FILE FLAG...: what a compiler reads, a word a line
preprocessed() {
    folder=$1 file=$2
    shift 2
    "$compiler" -std=c++20 -E -I "$folder" "$@" "$work/$file" | tr -s '[:space:]' '\n'
}
# same FLAG...
same() {
    preprocessed "$work/single" unit.cpp "$@" >"$work/single.txt"
    cat "$work/unit.cpp" "$work/headers.cpp" >"$work/all.cpp"
    preprocessed "$include" all.cpp "$@" | cmp - "$work/single.txt"
    grep -q lightbin "$work/single.txt"
}
assertion='-DLIGHTBIN_ASSERT(condition)=check(condition)' # the standard one names file and line
same -P "$assertion"
same -P -DNDEBUG -DLIGHTBIN_NO_SIMD
same -dM "$assertion" # the macros that are left

"$compiler" -std=c++20 -I "$work/single" "$here/main.cpp" "$work/unit.cpp" -o "$work/program"
"$work/program"
