#!/bin/sh
# The library includes nothing but itself, the compiler's own instruction headers, and the C++ standard library, whose
# headers alone are lower-case words without an ending. (lightbin.h includes two of C. The file that abi_tag.hpp names
# for older standards is none.)
set -eu
cd "$(dirname "$0")/../../include"
includes=$(grep -rnE '^[[:space:]]*#[[:space:]]*(include|import)' lightbin)
foreign=$(echo "$includes" | grep -vE '#include <([a-z_]+|([eisx]mm)?intrin\.h|arm_neon\.h|wasm_simd128\.h|lightbin/[a-z_/0-9]+\.(hpp|inl|h)|std(def|int)\.h)>$|"lightbin wants C') || true
[ -z "$foreign" ] || { echo "$foreign"; exit 1; }
echo "$(echo "$includes" | wc -l) includes, none foreign"
