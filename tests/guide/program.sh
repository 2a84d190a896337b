#!/bin/sh
# program.sh COMPILER: the README's program has at most 25 lines, compiles as it stands, and prints what stands below it.
set -eu
compiler=$1
cd "$(dirname "$0")/../.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# block LANGUAGE: the lines of the README's first block in the language
block() {
    awk -v fence="\`\`\`$1" '$0 == fence { inside = 1; next } /^```/ && inside { exit } inside' README.md
}
block cpp >"$work/street.cpp"
block text >"$work/expected"
[ "$(wc -l <"$work/street.cpp")" -le 25 ]
"$compiler" -std=c++20 -Wall -Wextra -Werror -I include "$work/street.cpp" -o "$work/street"
"$work/street" | diff "$work/expected" -
echo "the program of $(wc -l <"$work/street.cpp") lines prints $(wc -l <"$work/expected") lines"
