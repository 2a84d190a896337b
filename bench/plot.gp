# SPDX-License-Identifier: MIT
# Draws a table of the reports as PNG and SVG: gnuplot -e 'report="error_vs_time"' plot.gp, or "cutoff", where
# REPORT.csv lies. One column of panels a scene; a curve is the rows of one scene that have the curve's words.
set datafile separator ","

if (report eq "error_vs_time") {
    heading = "What each method lists too much, by the time of a build: tiles of 64, 32, 16, 8 pixels from left to right"
    # A colour a depth test, dashes for silhouettes.
    curves = system("tail -n +2 error_vs_time.csv | cut -d, -f4,5 | awk '!seen[$0]++'")
    rows_of(scene, curve) = "< grep '^".scene.",[0-9]*,[0-9]*,".curve.",' error_vs_time.csv"
    tests = "none interval box split_box"
    hue(curve) = sum [i = 1 : 4] (curve[strstrt(curve, ",") + 1:*] eq word(tests, i) ? i : 0)
    dash(curve) = curve[1:1] eq "s" ? 2 : 1
    title_of(curve) = curve[1:strstrt(curve, ",") - 1]." + ".curve[strstrt(curve, ",") + 1:*]
    x_of(row) = column(18)
    y_of(row, curve) = column(row == 1 ? 11 : 16)
    x_label(row) = row == 1 ? "" : "build [us]"
    y_label(row) = row == 1 ? "excess: entries / exact - 1" : "evaluations a pixel too many"
    x_low(row) = 2
    x_high(row) = 2000
    y_low(row) = row == 1 ? 5e-4 : 0.1
    y_high(row) = row == 1 ? 30 : 100
    emphasised(curve) = NaN
}
if (report eq "cutoff") {
    heading = "What ending lights at a cutoff does to the picture: white / 2 to white / 4096 from left to right, rings at white / 64"
    # A colour a window, a dash a measure.
    curves = "hard,7 smooth,7 hard,8 smooth,8 hard,10 smooth,10"
    rows_of(scene, curve) = "< grep '^".scene.",[0-9]*,".window_of(curve).",' cutoff.csv"
    window_of(curve) = curve[1:strstrt(curve, ",") - 1]
    measure_of(curve) = int(curve[strstrt(curve, ",") + 1:*])
    hue(curve) = window_of(curve) eq "hard" ? 2 : 3
    dash(curve) = measure_of(curve) == 7 ? 1 : measure_of(curve) == 8 ? 2 : 3
    measure_name(measure) = measure == 7 ? "RMSE" : measure == 8 ? "largest" : "RMSE, mean added back"
    title_of(curve) = window_of(curve).": ".measure_name(measure_of(curve))
    x_of(row) = row == 1 ? column(11) : column(6) / 1000
    y_of(row, curve) = column(measure_of(curve))
    x_label(row) = row == 1 ? "light evaluations a pixel" : "lists and shading [ms]"
    y_label(row) = "difference, white = 1"
    x_low(row) = row == 1 ? 0.12 : 0.3
    x_high(row) = 1300
    y_low(row) = 1e-3
    y_high(row) = 3
    emphasised(curve) = column(4) > 0.0156 && column(4) < 0.0157 ? 1 : NaN
}

scenes = system("tail -n +2 ".report.".csv | cut -d, -f1 | uniq")
panels = words(scenes)
width = 280.0 * panels + 100
height = 860.0
colours = "#777777 #d95f02 #1b6ca8 #2a9d4e"
do for [i = 1 : 4] {
    set linetype i linecolor rgb word(colours, i) linewidth 2.4 pointtype 7 pointsize 0.8 dashtype 1
    set linetype i + 4 linecolor rgb word(colours, i) linewidth 2 pointtype 6 pointsize 0.8 dashtype 2
    set linetype i + 8 linecolor rgb word(colours, i) linewidth 2 pointtype 2 pointsize 0.5 dashtype 3
}
style(curve) = hue(curve) + 4 * (dash(curve) - 1)

do for [kind in "png svg"] {
    if (kind eq "png") { set terminal pngcairo enhanced size width, height font "sans,15" }
    if (kind eq "svg") { set terminal svg enhanced size width, height font "sans,17" background "white" }
    set output report.".".kind
    set multiplot title heading noenhanced
    set logscale xy
    set format xy "10^{%T}"
    set grid linetype -1 linecolor rgb "#dddddd" linewidth 1 dashtype 1
    unset mxtics; unset mytics
    unset key
    do for [row = 1 : 2] {
        set tmargin at screen 0.90 - 0.42 * (row - 1)
        set bmargin at screen 0.60 - 0.42 * (row - 1)
        set xlabel x_label(row) offset 0, 0.4
        set xrange [x_low(row) : x_high(row)]
        set yrange [y_low(row) : y_high(row)]
        do for [panel = 1 : panels] {
            scene = word(scenes, panel)
            set lmargin at screen (280 * (panel - 1) + 95) / width
            set rmargin at screen (280 * panel + 75) / width
            set title (row == 1 ? scene : "") offset 0, -0.6 noenhanced
            set ylabel (panel == 1 ? y_label(row) : "") offset 0.5, 0
            set format y (panel == 1 ? "10^{%T}" : "")
            plot for [curve in curves] rows_of(scene, curve) using (x_of(row)):(y_of(row, curve)) \
                with linespoints linetype style(curve), \
                for [curve in curves] rows_of(scene, curve) \
                using (x_of(row)):(y_of(row, curve) * emphasised(curve)) \
                with points linecolor rgb "black" pointtype 6 pointsize 1.6
        }
    }
    # The legend, as wide as the picture.
    set lmargin at screen 0.03; set rmargin at screen 0.97
    set bmargin at screen 0; set tmargin at screen 0.09
    unset border; unset tics; unset xlabel; unset ylabel; unset title; unset grid; unset logscale
    set xrange [0 : 1]; set yrange [0 : 1]
    set key center center horizontal maxrows 2 samplen 2.5 width -1 noenhanced
    plot for [curve in curves] NaN with linespoints linetype style(curve) title title_of(curve)
    unset multiplot
    set border; set tics
}
