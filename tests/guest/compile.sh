#!/bin/sh
# compile.sh COMPILER: the headers give no warning: each alone, and all of them used, with and without exceptions
# and assertions, as C++20 and as C++23.
set -eu
compiler=$1
here=$(cd "$(dirname "$0")" && pwd)
include=$here/../../include
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# More than most users have on, so that none of them is told of what is not theirs.
case $compiler in
clang*) # all but what no C++20 of any length is without, and what an older one of them does not know
    warnings="-Weverything -Wno-c++98-compat -Wno-c++98-compat-pedantic -Wno-padded -Wno-unsafe-buffer-usage
        -Wno-switch-default -Wno-unknown-warning-option" ;;
*)
    warnings="-Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wuseless-cast -Wcast-align=strict -Wfloat-equal
        -Wswitch-enum -Wdouble-promotion -Wsign-conversion -Wold-style-cast -Wduplicated-cond -Wduplicated-branches
        -Wlogical-op -Wundef -Wextra-semi -Wformat=2 -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-qual
        -Wmissing-declarations -Wredundant-decls -Wzero-as-null-pointer-constant -Wunused-macros" ;;
esac

compile() {
    # shellcheck disable=SC2086  # several flags
    "$compiler" -I "$include" $warnings -Werror "$@" || {
        echo "$compiler refuses: $*" >&2
        exit 1
    }
}

count=0
for header in $(cd "$include" && find lightbin -name '*.hpp'); do
    # Twice, as two other headers would include it.
    printf '#include <%s>\n#include <%s>\n' "$header" "$header" >"$work/header.cpp"
    compile -std=c++20 -fsyntax-only "$work/header.cpp"
    count=$((count + 1))
done
[ "$count" -gt 0 ]

for flags in "-std=c++20 -O2" "-std=c++20 -O3 -DNDEBUG -fno-exceptions -fno-rtti" "-std=c++20 -O2 -march=native" \
    "-std=c++20 -O1 -DLIGHTBIN_NO_SIMD" "-std=c++2b -fsyntax-only"; do
    # shellcheck disable=SC2086  # several flags
    compile $flags -c -o "$work/object.o" -DUNIT=unit "$here/use_everything.cpp"
done
compile -w -std=c++20 -fsyntax-only "$here/hostile_macros.cpp"

# Under -ffast-math lights could be missed, so the headers refuse and say why.
if refusal=$("$compiler" -I "$include" -std=c++20 -ffast-math -fsyntax-only "$here/hostile_macros.cpp" 2>&1); then
    echo "$compiler accepts -ffast-math" >&2
    exit 1
fi
echo "$refusal" | grep -q 'error.*lightbin: -ffast-math'

echo "$compiler: $count headers, no warning"
