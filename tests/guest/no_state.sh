#!/bin/sh
# no_state.sh OBJECT...: the object files, which use the whole library, hold no variable that could be written to.
set -eu
[ $# -gt 0 ]
for object in "$@"; do
    sections=$(objdump -h "$object")
    # .data.rel.ro is constant once loaded; DW.ref is the compiler's way to its exception handling.
    written=$(echo "$sections" | awk '$2 ~ /^\.t?(data|bss)/ && $2 !~ /\.data\.rel\.ro|\.DW\.ref\./ && $3 !~ /^0+$/')
    [ -z "$written" ] || { echo "$object:"; echo "$written"; exit 1; }
    echo "$sections" | grep -q '\.text'
done
