# SPDX-License-Identifier: MIT
# Draws a table of the reports as PNG and SVG: gnuplot -e 'report="error_vs_time"' plot.gp, or "cutoff", where
# REPORT.csv lies. One column of panels a scene; a curve is the rows of one scene that have the curve's words.
set datafile separator ","

if (report eq "error_vs_time") {
    # Tiles of 64, 32, 16, 8 pixels from left to right. A colour a depth test, dashes for silhouettes.
    curves = system("tail -n +2 error_vs_time.csv | cut -d, -f4,5 | awk '!seen[$0]++'")
    rows_of(scene, curve) = "< grep '^".scene.",[0-9]*,[0-9]*,".curve.",' error_vs_time.csv"
    tests = "none interval box split_box"
    hue(curve) = sum [i = 1 : 4] (curve[strstrt(curve, ",") + 1:*] eq word(tests, i) ? i : 0)
    dash(curve) = curve[1:1] eq "s" ? 2 : 1
    title_of(curve) = curve[1:strstrt(curve, ",") - 1]." + ".curve[strstrt(curve, ",") + 1:*]
    x_column(panel) = 18
    y_column(panel, curve) = panel == 1 ? 11 : 16
    x_label(panel) = panel == 1 ? "" : "build of 64, 32, 16, 8 px tiles [us]"
    y_label(panel) = panel == 1 ? "excess: entries / exact set - 1" : "evaluations a pixel beyond the needed"
}
if (report eq "cutoff") {
    # Cutoffs from white / 2 to white / 4096 from left to right. A colour a window, a dash a measure.
    curves = "hard,7 hard,8 hard,10 smooth,7 smooth,8 smooth,10"
    rows_of(scene, curve) = "< grep '^".scene.",[0-9]*,".window_of(curve).",' cutoff.csv"
    window_of(curve) = curve[1:strstrt(curve, ",") - 1]
    measure_of(curve) = int(curve[strstrt(curve, ",") + 1:*])
    hue(curve) = window_of(curve) eq "hard" ? 2 : 3
    dash(curve) = measure_of(curve) == 7 ? 1 : measure_of(curve) == 8 ? 2 : 3
    measure_name(measure) = measure == 7 ? "RMSE" : measure == 8 ? "largest" : "RMSE, mean added back"
    title_of(curve) = window_of(curve).": ".measure_name(measure_of(curve))
    x_column(panel) = panel == 1 ? 11 : 6
    y_column(panel, curve) = measure_of(curve)
    x_label(panel) = panel == 1 ? "light evaluations a pixel" : "time of lists and shading [us]"
    y_label(panel) = "difference to unbounded lights, white = 1"
}

scenes = system("tail -n +2 ".report.".csv | cut -d, -f1 | uniq")
panels = words(scenes)
width = 300.0 * panels + 70
height = 800.0
colours = "#888888 #d95f02 #1b6ca8 #2a9d4e"
do for [i = 1 : 4] {
    set linetype i linecolor rgb word(colours, i) linewidth 1.7 pointtype 7 pointsize 0.6 dashtype 1
    set linetype i + 4 linecolor rgb word(colours, i) linewidth 1.4 pointtype 6 pointsize 0.6 dashtype 2
    set linetype i + 8 linecolor rgb word(colours, i) linewidth 1.4 pointtype 1 pointsize 0.5 dashtype 3
}
style(curve) = hue(curve) + 4 * (dash(curve) - 1)

do for [kind in "png svg"] {
    if (kind eq "png") { set terminal pngcairo noenhanced size width, height font "sans,11" }
    if (kind eq "svg") { set terminal svg noenhanced size width, height font "sans,13" background "white" }
    set output report.".".kind
    set multiplot
    set logscale xy
    set format xy "%g"
    set grid linecolor rgb "#cccccc"
    unset key
    do for [row = 1 : 2] {
        set tmargin at screen 0.96 - 0.43 * (row - 1)
        set bmargin at screen 0.60 - 0.43 * (row - 1)
        set xlabel x_label(row) offset 0, 0.4
        do for [panel = 1 : panels] {
            scene = word(scenes, panel)
            set lmargin at screen (300 * (panel - 1) + 85) / width
            set rmargin at screen (300 * panel + 22) / width
            set title (row == 1 ? scene : "") offset 0, -0.6
            set ylabel (panel == 1 ? y_label(row) : "")
            plot for [curve in curves] rows_of(scene, curve) using x_column(row):y_column(row, curve) \
                with linespoints linetype style(curve)
        }
    }
    # The legend, as wide as the picture.
    set lmargin at screen 0.03; set rmargin at screen 0.97
    set bmargin at screen 0.01; set tmargin at screen 0.08
    unset border; unset tics; unset xlabel; unset ylabel; unset title; unset grid; unset logscale
    set key center center horizontal maxrows 2 samplen 3 width 2
    plot [0 : 1] [0 : 1] for [curve in curves] NaN \
        with linespoints linetype style(curve) title title_of(curve)
    unset multiplot
    set border; set tics
}
