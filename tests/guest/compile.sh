#!/bin/sh
# compile.sh COMPILER: the headers give no warning, each alone, with or without exceptions, assertions and
# optimisation, as C++20 and as C++23.
set -eu
compiler=$1
here=$(cd "$(dirname "$0")" && pwd)
include=$here/../../include
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

compile() {
    "$compiler" -I "$include" -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror -c -o "$work/object.o" "$@" || {
        echo "$compiler refuses: $*" >&2
        exit 1
    }
}

count=0
for header in $(cd "$include" && find lightbin -name '*.hpp'); do
    for flags in "" "-fno-exceptions -fno-rtti"; do
        # Twice, as two other headers would include it.
        printf '#include <%s>\n#include <%s>\n' "$header" "$header" >"$work/header.cpp"
        # shellcheck disable=SC2086  # several flags
        compile -std=c++20 $flags "$work/header.cpp"
    done
    count=$((count + 1))
done
[ "$count" -gt 0 ]

for flags in "-std=c++20 -O2" "-std=c++20 -O3 -DNDEBUG -fno-exceptions -fno-rtti" "-std=c++2b -O0"; do
    # shellcheck disable=SC2086
    compile $flags -DUNIT=unit "$here/use_everything.cpp"
done
echo "$compiler: $count headers, no warning"
