#!/bin/sh
# languages.sh LIBRARY: lightbin.h has no warning as C99, C11 and C++11 to 17, with gcc and clang, and the program of
# each language has the promises kept by LIBRARY, a shared library of the C side.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
library=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# try COMPILER STANDARD LANGUAGE FLAG...: builds and runs the program of contract.c; a warning is an error
try() {
    compiler=$1
    standard=$2
    language=$3
    shift 3
    "$compiler" -std="$standard" -pedantic -Wall -Wextra -Wconversion -Wshadow -Wundef -Werror "$@" -DLIGHTBIN_SHARED \
        -I "$here/../../include" -o "$work/program" -x "$language" "$here/contract.c" -x none "$library" \
        -Wl,-rpath,"$(dirname "$library")"
    "$work/program" >/dev/null
    echo "$compiler -std=$standard"
}

for compiler in gcc clang-14 clang-19; do
    for standard in c99 c11; do
        try $compiler $standard c -Wstrict-prototypes
    done
done
for compiler in g++ clang++-14 clang++-19; do
    for standard in c++11 c++14 c++17 c++20; do
        try $compiler $standard c++
    done
done

# The page's program.
awk '/^```c$/ { inside = 1; next } /^```/ { inside = 0 } inside' "$here/../../docs/c.md" >"$work/page.c"
gcc -std=c99 -pedantic -Wall -Wextra -Werror -DLIGHTBIN_SHARED -I "$here/../../include" -o "$work/program" "$work/page.c" "$library" \
    -Wl,-rpath,"$(dirname "$library")"
"$work/program" | grep -q '^20 x 20 tiles, [1-9]'
