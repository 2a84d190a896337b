#!/bin/sh
# two_units.sh COMPILER EMULATOR MAIN PLAIN TUNED: object files of a program with a unit for every x86-64 and one for AVX2
# alone. Linked in either order, the plain unit runs on a processor without AVX, as the linker takes none of the other
# one's functions for it; and no function of the library has a name that does not tell the flags.
set -eu
compiler=$1 emulator=$2 main=$3 plain=$4 tuned=$5
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

named() { # named OBJECT FLAVOUR: all of the library's functions that other units may have too are named so
    nm -C "$1" | grep -E ' [WVu] .*lightbin' >"$work/shared"
    [ -s "$work/shared" ] || { echo "$1 has no function of the library" >&2; exit 1; }
    # Some names are too long for nm to read.
    if grep -vE "lightbin::$2::|8lightbin[0-9]+$2" "$work/shared"; then
        echo "these of $1 are not named after $2" >&2
        exit 1
    fi
}
named "$plain" built_for_baseline
named "$tuned" 'built_for_avx2[a-z0-9_]*'

for order in "$plain $tuned" "$tuned $plain"; do
    # shellcheck disable=SC2086  # two objects
    "$compiler" -static "$main" $order -o "$work/program"
    "$emulator" -cpu Nehalem "$work/program"
    "$emulator" -cpu Haswell "$work/program" both
done
