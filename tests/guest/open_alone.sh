#!/bin/sh
# open_alone.sh COMPILER: every file of the library can be opened alone, by an editor's language server or by ctags. Each header, and
# the file of each kernel as the scalar tier's text, compiles by itself without a warning; and namespaces are opened in the way
# that ctags understands, which finds no definition in "namespace lightbin::inline NAME {".
set -eu
compiler=$1
cd "$(dirname "$0")/../../include"
hidden=$(grep -rnE '^namespace [a-z:]*::inline ' lightbin) || true
[ -z "$hidden" ] || { echo "$hidden: ctags finds nothing in it"; exit 1; }
files=$(grep -rlE '^#pragma once' lightbin | sort)
echo "$files" | grep -q '\.inl$'
echo "$files" | xargs -P 2 -n 1 sh -c '
    echo "#include <$2>" | "$1" -std=c++20 -O1 -Wall -Wextra -Werror -fsyntax-only -I . -x c++ - || { echo "$2 does not open alone"; exit 255; }
' - "$compiler"
echo "$(echo "$files" | wc -l) files, each opens alone"
