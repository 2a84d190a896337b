#!/bin/sh
# sh tests/same_bytes.sh [COMMIT] [--inputs N]: whether the library gives the same light lists as at a COMMIT (HEAD
# if not named): of N random inputs (20,000) of all families, with and without depth test, in tiles, clusters and
# z-bins, on all tiers of this machine, with ids of 16 and 32 bits, on one thread and on several. Says which inputs
# differ. A version is built and run in build/same_bytes; what a commit gave is kept there. Takes some minutes.
set -eu
me=tests/same_bytes.sh
cd "$(dirname "$0")/.."
. tests/packages.sh

commit=HEAD
inputs=20000
while [ $# -gt 0 ]; do
    case $1 in
    -h | --help) help ;;
    --inputs)
        [ $# -gt 1 ] || fail "--inputs needs a number"
        inputs=$2
        shift
        ;;
    -*) fail "cannot do '$1': it takes a commit, --inputs or --help" ;;
    *) commit=$1 ;;
    esac
    shift
done
case $inputs in
'' | *[!0-9]* | 0) fail "--inputs takes a number from 1 on, not '$inputs'" ;;
esac
name=$(git rev-parse --verify --quiet "$commit^{commit}") || fail "there is no commit '$commit'"
compiler=${CXX:-g++}
work=build/same_bytes
make_build_folder
mkdir -p $work

# build FOLDER PROGRAM: this working tree's engine and hash.cpp with the library in FOLDER.
build() {
    for part in engine hash; do
        "$compiler" -std=c++20 -O2 -DORACLE_EVERY_WAY -I"$1/include" -c tests/oracle/$part.cpp -o "$2.$part.o"
    done
    "$compiler" "$2.engine.o" "$2.hash.o" -o "$2"
}

# The same lines were made with the same inputs. They are numbered from 0.
kind=$(cat tests/oracle/hash.cpp tests/oracle/engine.cpp tests/oracle/*.hpp | cksum | cut -d ' ' -f 1)
before=$work/$name.$kind
if [ ! -s "$before" ] || [ "$(tail -n 1 "$before" | cut -d ' ' -f 1)" -lt $((inputs - 1)) ]; then
    echo "$me: building $(git log -1 --format='%h %s' "$name")"
    rm -rf $work/old
    mkdir $work/old
    git archive "$name" include | tar -x -C $work/old
    build $work/old $work/hash_old
    echo "$me: running it"
    $work/hash_old "$inputs" >"$before.part"
    mv "$before.part" "$before"
fi
echo "$me: building the working tree"
build . $work/hash_new
echo "$me: running it"
$work/hash_new "$inputs" >$work/now

awk -v inputs="$inputs" '$1 < inputs' "$before" >$work/then
if cmp -s $work/then $work/now; then
    echo "$me: the same lists as at $(git log -1 --format=%h "$name"), of $inputs inputs"
    exit
fi
diff $work/then $work/now >$work/differences || true
sed -n '/^[<>]/s/ lists .*//p' $work/differences | sed 's/^[<>] //' | sort -un | head -n 50
count=$(sed -n 's/^> \([0-9]*\) .*/\1/p' $work/differences | sort -u | wc -l)
fail "$count inputs differ; all of them: $work/differences"
