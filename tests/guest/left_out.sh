#!/bin/sh
# left_out.sh COMPILER: what a Binner's options leave out is not in the program. Where nothing is inlined, every
# function that anything calls has a symbol, and the sizes tell, too. A file that is not optimised has no vectors.
set -eu
compiler=$1
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

compile() {
    "$compiler" -std=c++20 -I "$here/../../include" -c "$here/left_out.cpp" "$@"
}
compile -O1 -fno-inline -o "$work/off.o"
compile -O1 -fno-inline -DALL_OPTIONS -o "$work/on.o"
nm -C "$work/off.o" >"$work/off"
nm -C "$work/on.o" >"$work/on"

# Functions of the depth test, of sharing work among threads, of slices, of budgets. The Binner with all
# options has each of them: a name that is nowhere would prove nothing.
for function in tiles_met arrange_cells store_boxes tile_edges find_edges mask_lights share_rows share_steps \
    build_shares SlicedFootprints RankedFootprints SliceTable::find \
    find_depth_buckets arrange_slab store_met_boxes Budget; do
    grep -qw "$function" "$work/on" || { echo "no $function with all options on" >&2; exit 1; }
    if grep -w "$function" "$work/off"; then
        echo "$function is there with all options off" >&2
        exit 1
    fi
done

# Kernels of the scalar tier, which LIGHTBIN_NO_SCALAR leaves out where the compiler may use vectors everywhere.
if [ "$(uname -m)" = x86_64 ]; then
    for define in SIMD SCALAR; do
        compile -O1 -fno-inline -march=x86-64-v2 -DALL_OPTIONS -DLIGHTBIN_NO_$define -o "$work/no_$define.o"
        nm -C "$work/no_$define.o" >"$work/no_$define"
    done
    for kernel in project_lights bin_blocks find_depth_buckets; do
        grep -q "::scalar::$kernel\>" "$work/no_SIMD" || { echo "there is no scalar $kernel" >&2; exit 1; }
        if grep "::scalar::$kernel\>" "$work/no_SCALAR"; then
            echo "a scalar $kernel is there with LIGHTBIN_NO_SCALAR" >&2
            exit 1
        fi
    done
    compile -O0 -o "$work/unoptimised.o"
    grep -q '::avx2::' "$work/off" || { echo "there are no kernels of AVX2" >&2; exit 1; }
    if nm -C "$work/unoptimised.o" | grep -E '::(simd128|avx2|avx512)::'; then
        echo "these kernels of vectors are there without optimisation" >&2
        exit 1
    fi
fi

text() { size "$1" | awk 'NR == 2 { print $1 }'; }
off=$(text "$work/off.o")
on=$(text "$work/on.o")
echo "$off bytes with all options off, $on with all on"
[ $((100 * off)) -lt $((80 * on)) ]
