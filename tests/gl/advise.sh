#!/bin/sh
# advise.sh TILED_FORWARD COMPILER [ARGUMENT...]: runs it with --advise, and sees that what it prints fits on a screen, has
# a verdict on each part, and ends with lines of C++ that compile and do as is advised.
set -eu
program=$1
compiler=$2
shift 2
root=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$program" --advise "$@" >"$work/said" 2>"$work/errors"
cat "$work/said"
[ ! -s "$work/errors" ] || { cat "$work/errors"; exit 1; }

awk '
function complain(what) { print "WRONG: " what; bad = 1 }
length($0) > 100 { complain("more than 100 columns: " $0) }
BEGIN {
    count = split("tiles,masks,pre-pass,depth test,clusters,z-bins", parts, ",")
}
in_code { code = code $0 "\n"; next }
/^code$/ { in_code = 1; next }
/^(OpenGL|costs|overdraw|view) / { ++heads[$1] }
/^advised / { advised = $0; sub(/^advised +[0-9.]+ ms a frame: /, "", advised) }
{
    for (i = 1; i <= count; ++i)
        if (substr($0, 1, 13) == sprintf("%-13s", parts[i])) {
            ++rows[i]
            verdict = substr($0, 14)
            if (verdict !~ /^(keep: saves|leave out: would cost) [0-9.]+ ms +instead: ./) complain("no verdict: " $0)
            kept[parts[i]] = verdict ~ /^keep/
        }
}
# Of pairs PART=WORD, with a bar between them: the word is there where the part is kept, and only there.
function has(where, pairs,    count, pair, of, i) {
    count = split(pairs, pair, "|")
    for (i = 1; i <= count; ++i) {
        split(pair[i], of, "=")
        if (kept[of[1]] != (index(where, substr(pair[i], length(of[1]) + 2)) > 0))
            complain(of[1] " is not as the verdict has it in: " where)
    }
}
END {
    if (NR > 40) complain(NR " lines")
    for (i = 1; i <= count; ++i)
        if (rows[i] != 1) complain(parts[i] " is there " rows[i] + 0 " times")
    for (i = split("OpenGL,costs,overdraw,view", names, ","); i > 0; --i)
        if (heads[names[i]] != 1) complain("no line of " names[i])
    if (advised == "" || code == "") complain("something is missing")
    if (kept["pre-pass"] && kept["clusters"]) complain("a pre-pass and clusters")
    has(advised, "tiles= px|masks=, masks|depth test=, depth test|clusters=, clusters|z-bins=, z_bins")
    size = ".tile_size = " advised + 0 "}"
    has(code, "tiles={" size "|tiles=, " size "|masks=MaskBinner|masks=.masks = true|depth test=.depth_test = true")
    has(code, "clusters=Slicing::clusters|z-bins=Slicing::z_bins|pre-pass=.bounds = ")
    exit bad
}' "$work/said"

{
    echo '#include "given.hpp"'
    echo '#include <lightbin/box.hpp>'
    echo '#include <lightbin/spot.hpp>'
    echo 'lightbin::Sphere to_sphere(const Lamp&);'
    echo 'lightbin::Spot to_spot(const Lamp&);'
    echo 'lightbin::Box to_box(const Decal&);'
    echo 'void advised() {'
    sed '1,/^code$/d' "$work/said"
    echo '}'
} >"$work/advised.cpp"
"$compiler" -std=c++20 -fsyntax-only -DLIGHTBIN_NO_SIMD -Wall -Wextra -Wconversion -Werror -Wno-unused -I "$root/include" \
    -I "$root/tests/guide" "$work/advised.cpp"
