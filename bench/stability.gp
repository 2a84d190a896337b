# SPDX-License-Identifier: MIT
# Largest errors by condition, a curve a formula: a script for page.gp, its arguments stability.csv, a family's name, a
# title, and what is varied. The conditions are decades, or given by hand: they stand at equal distances, each with its name.
csv = ARG1
family = ARG2
curves = system(sprintf("awk -F, '$1 == \"%s\" { name = $4 \"@\" $5; gsub(/ /, \"~\", name); if (!seen[name]++) print name }' %s", family, csv))
# The number of the condition, its name, and the error: where there is none a gap, and no less than the axis shows.
rows(curve) = sprintf("< awk -F, '$1 == \"%s\" { name = $4 \"@\" $5; gsub(/ /, \"~\", name); if (name == \"%s\") print ++n \",\" $2 \",\" ($8 == \"\" ? \"NaN\" : $8 < 1e-7 ? 1e-7 : $8) }' %s", family, curve, csv)
title_of(curve) = is_double(curve) ? "" : system(sprintf("echo '%s' | tr '~' ' ' | sed 's/@.*//'", curve))
is_ours(curve) = curve[1:8] eq "lightbin"
is_double(curve) = curve[strlen(curve) - 5:] eq "double"
set logscale y
set format y "10^{%T}"
set yrange [1e-7:5000]
set xtics rotate by -50 noenhanced
set title ARG3 noenhanced offset 0, -0.5
set xlabel ARG4 noenhanced offset 0, 0.4
set offsets 0.3, 0.3, 0, 0
set ylabel family eq "far_over_near" || family eq "slices" ? "slices" : "pixels" offset 1
set arrow from graph 0, first 1 to graph 1, first 1 nohead linecolor rgb "#808080" linewidth 1
# A colour a formula, which stands twice: dots where it is computed in double.
do for [i = 1:4] { set linetype 10 + i linecolor rgb word(colours, i) linewidth 1.6 pointtype 7 pointsize 0.5 dashtype 3 }
set linetype 9 linecolor rgb word(colours, 9) linewidth 3 pointtype 7 pointsize 0.7
linetype_of(i) = is_ours(word(curves, i)) ? 9 : (i + 1) / 2 + (is_double(word(curves, i)) ? 10 : 0)
plot for [i = 1:words(curves)] rows(word(curves, i)) using 1:3:xticlabels(2) with linespoints \
    linetype linetype_of(i) title title_of(word(curves, i))
