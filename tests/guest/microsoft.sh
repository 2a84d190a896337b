#!/bin/sh
# microsoft.sh HEADERS: clang 19, as a compiler for Windows by Microsoft's rules, makes code of the whole library, the wide
# kernels included. The C++ library is LLVM's, the C library MinGW's, so nothing is linked or run. HEADERS is a folder
# with header-only libraries that the source needs.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

clang++-19 --target=x86_64-pc-windows-msvc -fms-compatibility-version=19.38 -fgnuc-version=4.2.1 -std=c++20 -O1 \
    -D_LIBCPP_NO_VCRUNTIME -nostdinc++ -isystem /usr/lib/llvm-19/include/c++/v1 \
    -isystem /usr/x86_64-w64-mingw32/include -isystem "$1" -include "$here/microsoft.hpp" \
    -I "$here/../../include" -Wall -Wextra -Werror -Wno-error=#warnings -DUNIT=unit \
    -c "$here/use_everything.cpp" -o "$work/object.obj" 2>"$work/said" || { cat "$work/said"; exit 1; }

for registers in xmm ymm zmm; do
    used=$(objdump -d "$work/object.obj" | grep -c "%$registers") || true
    echo "$used instructions with $registers registers"
    [ "$used" -gt 500 ]
done
