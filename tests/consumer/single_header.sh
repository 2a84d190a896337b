#!/bin/sh
# single_header.sh COMPILER: the single header is made twice the same, is to the compiler what the headers are that it is
# made of, and serves a program of two units.
set -eu
export LC_ALL=C
compiler=$1
here=$(cd "$(dirname "$0")" && pwd)
include=$here/../../include
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

single=$work/single/lightbin/lightbin.hpp
sh "$here/../../packaging/single_header.sh" "$single"
sh "$here/../../packaging/single_header.sh" "$work/again.hpp"
cmp "$single" "$work/again.hpp"

echo '#include <lightbin/lightbin.hpp>' >"$work/single.cpp"
cd "$include"
{
    printf '#include <lightbin/lightbin.hpp>\n#if !defined(LIGHTBIN_CORE_ONLY)\n'
    printf '#include <%s>\n' lightbin/*.hpp
    echo '#endif'
} >"$work/headers.cpp"

# same FILTER FLAG...: what the preprocessor makes of both, through the filter
same() {
    filter=$1
    shift
    "$compiler" -std=c++20 -E "$@" -I "$work/single" "$work/single.cpp" | $filter >"$work/single.txt"
    "$compiler" -std=c++20 -E "$@" -I . "$work/headers.cpp" | $filter >"$work/headers.txt"
    cmp "$work/single.txt" "$work/headers.txt"
    grep -qi lightbin "$work/single.txt"
}
words() { tr -s '[:space:]' '\n'; }
macros() { grep LIGHTBIN | sort; }
assertion='-DLIGHTBIN_ASSERT(condition)=check(condition)' # the standard one names file and line
same words -P "$assertion"
same words -P "$assertion" -DLIGHTBIN_NO_SIMD
same words -P "$assertion" -DLIGHTBIN_CORE_ONLY
same macros -dM

"$compiler" -std=c++20 -I "$work/single" "$here/main.cpp" "$work/single.cpp" -o "$work/program"
"$work/program"
