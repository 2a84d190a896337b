#!/bin/sh
# refused.sh COMPILER: each mistake of refused.cpp does not compile, and the one error that there is says what its comment does.
set -eu
compiler=$1
here=$(cd "$(dirname "$0")" && pwd)
. "$here/one_error.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# All that the mistakes have in common, compiled once.
case $compiler in
clang*) compiled=pch ;;
*) compiled=gch ;;
esac
sed -n '/^#include/p' "$here/refused.cpp" >"$work/headers.hpp"
"$compiler" -std=c++20 -I "$here/../../include" -x c++-header "$work/headers.hpp" -o "$work/headers.hpp.$compiled"

compile() {
    "$compiler" -std=c++20 -I "$here/../../include" -include "$work/headers.hpp" "$here/refused.cpp" "$@"
}
compile -DMISTAKE=0 -o "$work/program"

mistakes=$(grep -oE 'MISTAKE == [0-9]+' "$here/refused.cpp" | grep -oE '[0-9]+')
count=0
for mistake in $mistakes; do
    one_error error: "$(sed -nE "s,.*MISTAKE == $mistake  // (.*),\1,p" "$here/refused.cpp")" "mistake $mistake by $compiler" \
        compile -fsyntax-only "-DMISTAKE=$mistake"
    count=$((count + 1))
done
[ "$mistake" -eq "$count" ]
echo "$compiler: $count mistakes, each refused by name"
