#!/bin/sh
# compile.sh COMPILER: the headers give no warning: each alone, and all of them used, with and without exceptions
# and assertions, as C++20 and as C++23.
set -eu
compiler=$1
here=$(cd "$(dirname "$0")" && pwd)
include=$here/../../include
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

compile() {
    "$compiler" -I "$include" -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror "$@" || {
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
    "-std=c++20 -O2 -DLIGHTBIN_NO_SIMD" "-std=c++2b -fsyntax-only"; do
    # shellcheck disable=SC2086  # several flags
    compile $flags -c -o "$work/object.o" -DUNIT=unit "$here/use_everything.cpp"
done
compile -std=c++20 -fsyntax-only "$here/hostile_macros.cpp"

# Under -ffast-math lights could be missed, so the headers refuse and say why.
if refusal=$("$compiler" -I "$include" -std=c++20 -ffast-math -fsyntax-only "$here/hostile_macros.cpp" 2>&1); then
    echo "$compiler accepts -ffast-math" >&2
    exit 1
fi
echo "$refusal" | grep -q 'error.*lightbin: -ffast-math'

# In x87's wider registers other bytes would come out. (clang has no such switch for x86-64.)
case $compiler in
g++*)
    if refusal=$("$compiler" -I "$include" -std=c++20 -mfpmath=387 -fsyntax-only "$here/hostile_macros.cpp" 2>&1); then
        echo "$compiler accepts x87 arithmetic" >&2
        exit 1
    fi
    echo "$refusal" | grep -q 'error.*lightbin: .*x87'
    ;;
esac

echo "$compiler: $count headers, no warning"
