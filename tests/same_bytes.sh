#!/bin/sh
# sh tests/same_bytes.sh [COMMIT [SCENES]]: whether the library gives the same lists as at a COMMIT (HEAD if not named):
# compiles tests/platforms/lists.cpp with the headers of both, and compares the hashes that it prints for SCENES
# (1,000) random scenes, one for each option. Says which differ. Works in build/same_bytes. Takes some minutes.
set -eu
me=tests/same_bytes.sh
cd "$(dirname "$0")/.."
. tests/packages.sh
takes "a commit and a number of scenes" "[^-].*" "$@"

name=$(git rev-parse --verify --quiet "${1:-HEAD}^{commit}") || fail "there is no commit '$1'"
work=build/same_bytes
make_build_folder
rm -rf $work
mkdir -p $work/then
git archive "$name" include | tar -x -C $work/then

# hashes NAME FOLDER: what lists.cpp prints with the headers in FOLDER
hashes() {
    echo "$me: building and running $1"
    "${CXX:-g++}" -std=c++20 -O2 -I"$2/include" -I. tests/platforms/lists.cpp tests/platforms/garbage.cpp -o "$work/$1.lists"
    "$work/$1.lists" "${scenes}" >"$work/$1.txt" || fail "the lists differ by the instruction set, see $work/$1.txt"
}
scenes=${2:-1000}
hashes then $work/then
hashes now .
diff $work/then.txt $work/now.txt || fail "these lists differ from those at $(git log -1 --format='%h %s' "$name")"
echo "$me: the same lists as at $(git log -1 --format=%h "$name"), of $scenes scenes"
