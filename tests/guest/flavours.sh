#!/bin/sh
# flavours.sh GCC CLANG: what detail/base/abi_tag.hpp names the library's namespace. Flags that let compilers use vectors of
# another level give another name, and so does what chooses other kernels.
set -eu
gcc=$1 clang=$2
include=$(cd "$(dirname "$0")/../../include" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
printf '#include <lightbin/detail/base/abi_tag.hpp>\nname LIGHTBIN_ABI_TAG\n' >"$work/file.cpp"

count=0
# named NAME COMPILER FLAG...
named() {
    expected=built_for_$1
    shift
    name=$("$@" -std=c++20 -I "$include" -E "$work/file.cpp" | sed -n 's/^name //p')
    [ "$name" = "$expected" ] || { echo "$*: $name, and not $expected" >&2; exit 1; }
    count=$((count + 1))
}

for compiler in "$gcc -m64" "$clang --target=x86_64-linux-gnu"; do
    # shellcheck disable=SC2086  # a word a flag, here and below
    while read -r name flags; do
        named $name $compiler $flags
    done <<END
baseline
baseline -march=x86-64 -msse3
ssse3 -march=core2
sse41 -msse4.1
sse42 -march=x86-64-v2
avx -march=sandybridge
avx_fma -march=bdver2
avx_fma -mfma
avx2 -mavx2
avx2_fma -march=x86-64-v3
avx2_fma -march=znver3
avx512 -mavx512f
avx512_vl -march=x86-64-v4
avx512_vl -march=skylake-avx512
avx512_vbmi2 -march=icelake-client
avx512_vbmi2 -march=sapphirerapids
avx2_fma_no_simd -march=haswell -DLIGHTBIN_NO_SIMD
sse42_no_scalar -march=x86-64-v2 -DLIGHTBIN_NO_SCALAR
baseline_in_c -DLIGHTBIN_IMPLEMENTATION
END
done
while read -r name target flags; do
    # shellcheck disable=SC2086
    named $name "$clang" --target=$target $flags
done <<END
baseline aarch64-linux-gnu
sve aarch64-linux-gnu -march=armv8-a+sve
sve2 aarch64-linux-gnu -march=armv9-a
baseline arm-linux-gnueabihf -march=armv6
neon arm-linux-gnueabihf -march=armv7-a -mfpu=neon
baseline wasm32
simd128 wasm32 -msimd128
baseline riscv64-linux-gnu -march=rv64gc
vectors riscv64-linux-gnu -march=rv64gcv
baseline powerpc64-linux-gnu -mcpu=pwr5
vectors powerpc64-linux-gnu -mcpu=pwr8
baseline s390x-linux-gnu -march=z10
z11 s390x-linux-gnu -march=z13
z14 s390x-linux-gnu -march=z16
END
echo "$count sets of flags are named"
