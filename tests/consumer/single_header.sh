#!/bin/sh
# single_header.sh COMPILER: each single header is made twice the same, and is to the compiler what the headers are that
# it is made of. That of all headers serves a program of two units. That of C is included as C99, and more than once.
set -eu
export LC_ALL=C
compiler=$1
here=$(cd "$(dirname "$0")" && pwd)
include=$here/../../include
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# make WHAT NAME: lightbin/NAME in the folder WHAT
make() {
    sh "$here/../../packaging/single_header.sh" "$work/$1/lightbin/$2" "$1"
    sh "$here/../../packaging/single_header.sh" "$work/again" "$1"
    cmp "$work/$1/lightbin/$2" "$work/again"
    echo "#include <lightbin/$2>" >"$work/$1.cpp"
}
make all lightbin.hpp
make core lightbin.hpp
make c lightbin.h
cd "$include"
{
    printf '#include <lightbin/lightbin.hpp>\n#if !defined(LIGHTBIN_CORE_ONLY)\n'
    printf '#include <%s>\n' lightbin/*.hpp
    echo '#endif'
} >"$work/headers.cpp"

# same WHAT HEADERS FILTER FLAG...: what the preprocessor makes of both, through the filter
same() {
    what=$1 headers=$2 filter=$3
    shift 3
    "$compiler" -std=c++20 -O1 -E "$@" -I "$work/$what" "$work/$what.cpp" | $filter >"$work/single.txt"
    "$compiler" -std=c++20 -O1 -E "$@" -I . "$work/$headers.cpp" | $filter >"$work/headers.txt"
    cmp "$work/single.txt" "$work/headers.txt"
    grep -qi lightbin "$work/single.txt"
}
words() { tr -s '[:space:]' '\n'; }
macros() { grep LIGHTBIN | sort; }
assertion='-DLIGHTBIN_ASSERT(condition)=check(condition)' # the standard one names file and line
same all headers words -P "$assertion"
same all headers words -P "$assertion" -DLIGHTBIN_NO_SIMD
same all headers words -P "$assertion" -DLIGHTBIN_CORE_ONLY
same all headers macros -dM
same core core words -P "$assertion"
same core core macros -dM
for left_out in '' _SHADERS _CULL_SHADERS; do
    same c c words -P "$assertion" -DLIGHTBIN_IMPLEMENTATION "-DLIGHTBIN_NO$left_out"
done
same c c words -P

"$compiler" -std=c++20 -I "$work/all" "$here/main.cpp" "$work/all.cpp" -o "$work/program"
"$work/program"

cat "$work/c.cpp" "$work/c.cpp" >"$work/twice.c"
${CC:-cc} -std=c99 -pedantic -Wall -Wextra -Werror -fsyntax-only -I "$work/c" "$work/twice.c"
{
    cat "$work/c.cpp"
    echo '#define LIGHTBIN_IMPLEMENTATION'
    cat "$work/twice.c"
} >"$work/implementation.cpp"
"$compiler" -std=c++20 -fsyntax-only -I "$work/c" "$work/implementation.cpp"
