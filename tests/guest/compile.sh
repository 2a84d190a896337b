#!/bin/sh
# compile.sh COMPILER: the headers give no warning, used all of them, with and without exceptions and assertions, as
# C++20 and as C++23. What g++ says may depend on how it optimises: two_units.sh has it make code, with the same warnings and
# all that this script leaves out. What clang says comes from reading and from the first, unoptimised code; microsoft.sh has
# it optimise.
# By one compiler each public header is read alone, too: where one lacks an include, it does so with all that read the same
# standard library. Every file of detail/, which users do not include, is read alone by open_alone.sh.
set -eu
compiler=$1
here=$(cd "$(dirname "$0")" && pwd)
include=$here/../../include
. "$here/hostile_macros.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# More than most users have on, so that none of them is told of what is not theirs.
case $compiler in
clang*) # all but what no C++20 of any length is without, and what an older one of them does not know
    warnings="-Weverything -Wno-c++98-compat -Wno-c++98-compat-pedantic -Wno-padded -Wno-unsafe-buffer-usage
        -Wno-switch-default -Wno-unknown-warning-option" ;;
*)
    warnings="@$here/gcc_warnings.txt" ;;
esac

compile() {
    # shellcheck disable=SC2086  # several flags
    "$compiler" -I "$include" $warnings -Werror "$@" || {
        echo "$compiler refuses: $*" >&2
        exit 1
    }
}
# all FLAG...: all headers used, with the vector kernels, which an optimised file has
all() {
    compile -O1 "$@" -o "$work/object.o" -DUNIT=unit "$here/use_everything.cpp"
}

count=0
case $compiler in
g++*)
    for header in $(cd "$include" && echo lightbin/*.hpp); do
        # Twice, as two other headers would include it.
        printf '#include <%s>\n#include <%s>\n' "$header" "$header" >"$work/header.cpp"
        compile -std=c++20 -O1 -fsyntax-only "$work/header.cpp"
        count=$((count + 1))
    done
    ;;
esac

all -std=c++2b -fsyntax-only
all -std=c++20 -fsyntax-only -DLIGHTBIN_NO_SIMD
case $compiler in
clang*)
    all -std=c++20 -fsyntax-only -DNDEBUG -fno-exceptions -fno-rtti
    # clang 19 warns of its own features for some processors, whatever the file.
    own=
    "$compiler" -Werror -march=native -x c++ -fsyntax-only /dev/null 2>/dev/null || own=-w
    all -std=c++20 -Xclang -disable-llvm-passes -c -march=native $own
    # 64-bit ARM, whose vectors it takes otherwise than g++.
    all --target=aarch64-linux-gnu -std=c++20 -fsyntax-only
    ;;
esac
hostile_macros >"$work/hostile_macros.cpp"
compile -w -std=c++20 -fsyntax-only "$work/hostile_macros.cpp"

# Under -ffast-math lights could be missed, so the headers refuse and say why.
if refusal=$("$compiler" -I "$include" -std=c++20 -ffast-math -fsyntax-only "$work/hostile_macros.cpp" 2>&1); then
    echo "$compiler accepts -ffast-math" >&2
    exit 1
fi
echo "$refusal" | grep -q 'error.*lightbin: -ffast-math'

# In x87's wider registers other bytes would come out. (clang has no such switch for x86-64.)
case $compiler in
g++*)
    if refusal=$("$compiler" -I "$include" -std=c++20 -mfpmath=387 -fsyntax-only "$work/hostile_macros.cpp" 2>&1); then
        echo "$compiler accepts x87 arithmetic" >&2
        exit 1
    fi
    echo "$refusal" | grep -q 'error.*lightbin: .*x87'
    ;;
esac

echo "$compiler: no warning, $count headers alone"
