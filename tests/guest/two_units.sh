#!/bin/sh
# two_units.sh COMPILER EMULATOR HEADERS: the same source twice in one program, use_everything.cpp for every x86-64 and for
# AVX2 alone, with flags that differ in all that could matter. Linked in either order, the first unit runs on a processor
# without AVX, as the linker takes none of the other one's functions for it; and no function of the library has a name that
# does not tell the flags. Neither unit has a warning, optimised or not, nor a variable that could be written to. HEADERS is a
# folder with header-only libraries that the source needs.
set -eu
compiler=$1 emulator=$2 headers=$3
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# unit NAME FLAG...: an object file of the source
unit() {
    name=$1
    shift
    "$compiler" -std=c++20 "@$here/gcc_warnings.txt" -I "$here/../../include" -isystem "$headers" "$@" -DUNIT="${name}_unit" \
        -c "$here/use_everything.cpp" -o "$work/$name.o"
    # .data.rel.ro is constant once loaded; DW.ref is the compiler's way to its exception handling.
    objdump -h "$work/$name.o" >"$work/sections"
    grep -q '\.text' "$work/sections"
    if awk '$2 ~ /^\.t?(data|bss)/ && $2 !~ /\.data\.rel\.ro|\.DW\.ref\./ && $3 !~ /^0+$/' "$work/sections" | grep .; then
        echo "in the $name unit these are variables" >&2
        exit 1
    fi
}
unit plain -O1
unit tuned -O2 -DNDEBUG -march=haswell -fno-exceptions -fno-rtti
"$compiler" -std=c++20 -c "$here/two_units.cpp" -o "$work/main.o"

named() { # named UNIT FLAVOUR: all of the library's functions that other units may have too are named so
    nm -C "$work/$1.o" | grep -E ' [WVu] .*lightbin' >"$work/shared"
    # Some names are too long for nm to read.
    if grep -vE "lightbin::$2::|8lightbin[0-9]+$2" "$work/shared"; then
        echo "these of the $1 unit are not named after $2" >&2
        exit 1
    fi
}
named plain built_for_baseline
named tuned 'built_for_avx2[a-z0-9_]*'

for order in "plain tuned" "tuned plain"; do
    # shellcheck disable=SC2046,SC2086  # two objects
    "$compiler" -static "$work/main.o" $(printf "$work/%s.o " $order) -o "$work/program"
    "$emulator" -cpu Nehalem "$work/program"
    "$emulator" -cpu Haswell "$work/program" both
done
echo "no warning, no variable, the same bytes in either order"
