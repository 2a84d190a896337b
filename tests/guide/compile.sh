#!/bin/sh
# compile.sh COMPILER: every block of C++ in the README and the guide compiles, as it stands there.
set -eu
compiler=$1
cd "$(dirname "$0")/../.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
awk -f tests/guide/blocks.awk README.md docs/*.md >"$work/blocks.cpp"
# Kernels are the other tests'. What a block leaves unused, its reader uses.
"$compiler" -std=c++20 -fsyntax-only -DLIGHTBIN_NO_SIMD -Wall -Wextra -Wconversion -Werror -Wno-unused -Wno-shadow \
    -I include -I tests/guide "$work/blocks.cpp"
echo "$(grep -c '^#line' "$work/blocks.cpp") blocks of code compile"
