#!/bin/sh
# stability.sh PROGRAM: bench/stability in few cases. It reports every family of conditions, each with formulas
# of the textbooks and the library; the library misses nothing; and what is known to break a formula in float breaks it.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
"$1" --tiny
awk -F, '
NR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i; next }
function get(name) { return $column[name] }
{ ++lines[get("family")] }
get("formula") == "lightbin" {
    ++ours[get("family")]
    if (get("missed_with_our_margin") != 0) wrong("the library misses " get("missed_with_our_margin"))
    if (!(get("exact_tiles") > 0)) wrong("no light is in view")
}
get("formula") == "quadratic" && get("family") == "eye_plane" && get("condition") == "1e-6" {
    if (get("precision") == "float" && !(get("error") > 1)) wrong("the quadratic formula holds in float: " get("error"))
    if (get("precision") == "double" && !(get("error") < 0.01)) wrong("the quadratic formula breaks in double: " get("error"))
    ++known
}
function wrong(what) { print $1 ", " $2 ": " what; ++failed }
END {
    split("ordinary 1 grazing 13 eye_plane 8 near_front 13 near_behind 13 far_over_near 13 slices 6 scale 13 origin 10 fov 10 " \
          "tiles 6 denormals 8 flushed 8", families, " ")
    for (i = 1; i in families; i += 2) {
        name = families[i]
        if (ours[name] != families[i + 1]) wrong("of " name " there are " ours[name] + 0 " conditions")
        if (!(lines[name] > 2 * ours[name])) wrong("of " name " there are no textbook formulas")
    }
    if (known != 2) wrong("the quadratic formula is not there")
    exit failed > 0
}' stability.csv
grep -q '^!\[.*(stability.gp stability.csv grazing ' stability.page
