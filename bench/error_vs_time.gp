# SPDX-License-Identifier: MIT
# Draws error_vs_time.csv: gnuplot error_vs_time.gp, where the table lies. One column a scene; above, what the
# lists hold too much; below, the light evaluations a pixel that its lights do not need. Left and down is better.
set datafile separator ","
scenes = system("tail -n +2 error_vs_time.csv | cut -d, -f1 | uniq")
rungs = system("tail -n +2 error_vs_time.csv | cut -d, -f4,5 | awk '!seen[$0]++'")
columns = words(scenes)

# A colour a depth test, dashes and open points for silhouettes.
tests = "none interval box split_box"
colours = "#888888 #d95f02 #1b6ca8 #2a9d4e"
style(rung) = sum [i = 1 : 4] (rung[strstrt(rung, ",") + 1:*] eq word(tests, i) ? i : 0) + (rung[1:1] eq "s" ? 4 : 0)
do for [i = 1 : 4] {
    set linetype i linecolor rgb word(colours, i) linewidth 1.6 pointtype 7 pointsize 0.7
    set linetype i + 4 linecolor rgb word(colours, i) linewidth 1.6 dashtype 2 pointtype 6 pointsize 0.7
}
title_of(rung) = rung[1:strstrt(rung, ",") - 1]." + ".rung[strstrt(rung, ",") + 1:*]
rows_of(scene, rung) = "< grep '^".scene.",[0-9]*,[0-9]*,".rung.",' error_vs_time.csv"

do for [kind in "png svg"] {
    # Sizes in pixels; text that is read in a page 900 pixels wide.
    width = 330 * columns + 40
    if (kind eq "png") { set terminal pngcairo size width, 800 font "sans,11" background "white" }
    if (kind eq "svg") { set terminal svg size width, 800 font "sans,13" background "white" }
    set output "error_vs_time.".kind
    set multiplot layout 2, columns margins 75.0 / width, 0.99, 0.16, 0.95 spacing 0.035, 0.06
    set logscale xy
    set grid linecolor "#dddddd"
    set format y "%g"
    set format x "%g"
    set offsets graph 0.04, graph 0.04, graph 0.06, graph 0.04
    unset key
    do for [part = 1 : 2] {
        do for [column = 1 : columns] {
            scene = word(scenes, column)
            set title (part == 1 ? scene : "") offset 0, -0.6
            set xlabel (part == 2 ? "time of a build [us]" : "")
            set ylabel (column > 1 ? "" : part == 1 ? "entries beyond the exact set [%]" : "evaluations a pixel beyond the needed")
            unset key
            if (part == 2 && column == 1) { set key at screen 0.5, 0.045 center horizontal maxrows 2 samplen 2.5 width 1 }
            plot for [rung in rungs] rows_of(scene, rung) using 18:(part == 1 ? 100 * $11 : $15 - $16) \
                with linespoints linetype style(rung) title title_of(rung)
        }
    }
    unset multiplot
}
