# SPDX-License-Identifier: MIT
# A scene's plots of the report, by page.sh: ARG1 is `methods` or `endings`, ARG2 the scene.
scene = "$1 == \"".ARG2."\""
rows(which, what) = "< awk -F, '".scene." && ".which." { print ".what." }' report.csv"
set datafile separator whitespace
set logscale xy
set xlabel "ms a frame" offset 0, 0.6
set key maxcols 4 font ",13" samplen 0.5 width -3 Left reverse
set tics (.01, .02, .05, .1, .2, .5, 1, 2, 5, 10, 20, 50, 100, 200, 500)
if (ARG1 eq "methods") {
    methods = "plain|box|clusters|clusters+box|z-bins|masks|masks+z-bins|flat loop|flat loop+Z"
    method(i) = system("echo '".methods."' | cut -d '|' -f ".i)
    points(i) = rows("$4 == \"".method(i)."\"", "$5, $10, $15, $11, $12")
    # What takes 25 times as long as the best is named by the table alone.
    least = real(system("awk -F, '".scene." && $15 { print $10 }' report.csv | sort -g | head -n 1"))
    set xrange [0.8 * least : 25 * least]
    set yrange [1 : *] noextend
    set offsets 0, 0, graph 0.05, 0
    set ylabel "light evaluations over needed" offset 1.5, 0
    set linetype 5 linecolor rgb "#c4393f"
    set linetype 6 linecolor rgb "#2a9d4e"
    set linetype 7 linecolor rgb "#8cc63f"
    set for [i = 8 : 9] linetype i linecolor rgb "#808080" pointtype i - 4
    set ytics (1, 1.2, 1.5, 2, 3, 5, 7, 10, 15, 20, 30, 50, 70, 100)
    set bars 0
    plot rows("$17 == 1", "$10, $15")." | sort -g" using 1:2 with steps linecolor black linewidth 3 title "front", \
        for [i = 1 : 9] points(i) using 2:3:4:5 with xerrorbars linetype i linewidth 0.6 pointtype 0 notitle, \
        for [i = 1 : 9] points(i) using 2:3 with linespoints linetype i title method(i), \
        for [i = 1 : 9] points(i) using 2:3:1 with labels offset 0.9, 0.5 font ",12" textcolor linetype i notitle
} else {
    ends(window) = rows("$4 == \"ends ".window."\"", "1 / $20, $10, $21, $22")
    set ylabel "difference, white = 1" offset 1.5, 0
    plot ends("smooth") using 2:3 with linespoints linetype 1 title "smooth end", \
        ends("smooth") using 2:4 with linespoints linetype 3 title "smooth, mean restored", \
        ends("smooth") using 2:4:(sprintf("1/%g", $1)) with labels offset 0, -0.7 font ",12" textcolor linetype 3 notitle
}
