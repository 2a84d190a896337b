#!/bin/sh
# The light evaluations that the docs state, and what ending lights costs a picture, are those of the committed report. A range
# is from the least to the greatest of its scenes; those of more than twice the median stand behind it by name.
set -eu
export LC_ALL=C
cd "$(dirname "$0")/../.."
report=bench/results/zen4/report.csv

# of METHOD TILE COLUMN: each scene's value, in the report's order
of() {
    awk -F, -v method="$1" -v tile="$2" -v name="$3" '
        NR == 1 { for (i = 1; i <= NF; ++i) if ($i == name) column = i }
        $4 == method && $5 == tile { print $column, $1 }' $report
}

failed=
# has FILE LINE WORDS: the line of the file that has LINE has WORDS, too, and no brackets behind them
has() {
    grep -F -- "$2" "$1" | grep -F -- "$3" | grep -qvF -- "$3 (" && return
    echo "$1: where it says \"$2\", $report has \"$3\""
    failed=yes
}

# ratio FILE LINE METHOD TILE
ratio() {
    has "$1" "$2" "$(of "$3" "$4" ratio | sort -g | awk '
        function short(x) { return sprintf(x < 9.95 ? "%.1f" : "%.0f", x) }
        { value[NR] = $1; scene[NR] = $2 }
        END {
            for (most = NR; value[most] > 2 * value[int((NR + 1) / 2)]; --most)
                names = " " scene[most] " " short(value[most]) (names == "" ? "" : "," names)
            print short(value[1]) " to " short(value[most]) (names == "" ? "" : " (" substr(names, 2) ")")
        }')"
}
# shellcheck disable=SC2016  # Markdown's backquotes
{
    ratio docs/depth.md '`depth_test`, 16-pixel tiles' box 16
    ratio docs/depth.md '`Slicing::clusters` with `depth_test`' clusters+box 64
    ratio docs/depth.md '`Slicing::z_bins`, 1,024 bins' z-bins 32
    has docs/depth.md 'no depth method, 16-pixel tiles' "$(of plain 16 ratio | awk '$2 == "top-down" { printf "%.1f (%s)", $1, $2 }')"
}

# row LINE METHOD TILE COLUMN: a row of the table in bench/README.md
row() {
    has bench/README.md "| $1 | " "| $1 | $(of "$2" "$3" "$4" |
        awk '{ printf "%s%.*f", NR == 1 ? "" : " | ", $1 < 99.95 ? 1 : 0, $1 }') |"
}
for way in plain:16 box:16 clusters:64 clusters+box:64 z-bins:32; do
    row "${way%:*}, ${way#*:} px" "${way%:*}" "${way#*:}" evals
done
row needed plain 16 needed

# docs/range.md: of each scene what white / 64 does, with a smooth window, and the first cutoff that keeps 1 % of RMSE
endings=$(awk -F, '
    NR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i }
    $column["method"] != "ends smooth" { next }
    {
        scene = $1
        part = sprintf("%.0f", 1 / $column["cutoff"])
        restored = $column["rmse_restored"]
        evaluations = sprintf("%.0f", $column["evals"])
        if (!(scene in lights)) order[++count] = scene
        lights[scene] = $2
        if (part == 64) start[scene] = sprintf("%.2f | %.2f | %s", $column["rmse"], restored, evaluations)
        if (restored <= 0.01 && !(scene in kept)) kept[scene] = "white / " part " | " evaluations
        if (part == 1024) last[scene] = sprintf("no: %.3f at white / 1,024 | %s", restored, evaluations)
    }
    END {
        for (i = 1; i <= count; ++i) {
            scene = order[i]
            end = scene in kept ? kept[scene] : last[scene]
            print "| " scene ", " lights[scene] " | " start[scene] " | " end " |"
        }
    }' $report)
while read -r line; do
    grep -qxF -- "$line" docs/range.md && continue
    echo "docs/range.md lacks what $report has: $line"
    failed=yes
done <<END
$endings
END
[ -z "$failed" ] || exit 1
echo "the docs say what $report has"
