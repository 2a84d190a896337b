# SPDX-License-Identifier: MIT
# A scene's plots of the report, by page.sh: ARG1 is `methods` or `endings`, ARG2 the scene.
only(what) = "< awk -F, '$1 == \"".ARG2."\" && $4 == \"\\\"".what."\\\"\" { print $5, $10, $15, $11, $12 }' report.csv"
ends(window) = "< awk -F, '$1 == \"".ARG2."\" && $4 == \"ends ".window."\" { print 1 / $20, $10, $21, $22 }' report.csv"
set datafile separator whitespace
set logscale xy
set xlabel "ms a frame" offset 0, 0.6
if (ARG1 eq "methods") {
    methods = "plain|silhouette|interval|box|split_box|clusters|clusters+box|z-bins|flat loop|flat loop+Z|planes a tile|planes a tile+Z"
    method(i) = system("echo '".methods."' | cut -d '|' -f ".i)
    set ylabel "light evaluations over needed" offset 1.5, 0
    set yrange [1 : *]
    set for [i = 10 : 12] linetype i linecolor rgb "#7a7a7a"
    plot "< awk -F, '$1 == \"".ARG2."\" && $17 == 1 { print $10, $15 }' report.csv | sort -g" \
            with lines linecolor black linewidth 1 title "front", \
        for [i = 1 : 12] only(method(i)) using 2:3:4:5 with xerrorbars linetype i linewidth 1 pointtype 0 notitle, \
        for [i = 1 : 12] only(method(i)) using 2:3 with linespoints linetype i title method(i), \
        for [i = 1 : 12] only(method(i)) using 2:3:1 with labels offset 0, 0.6 font ",10" notitle
} else {
    set ylabel "difference, white = 1" offset 1.5, 0
    plot ends("hard") using 2:3 with linespoints linetype 2 title "hard end", \
        ends("smooth") using 2:3 with linespoints linetype 1 title "smooth end", \
        ends("smooth") using 2:4 with linespoints linetype 3 title "smooth, mean restored", \
        ends("smooth") using 2:4:(sprintf("1/%g", $1)) with labels offset 0, -0.7 font ",10" notitle
}
