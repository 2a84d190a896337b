# SPDX-License-Identifier: MIT
# Draws frames_paths.csv as PNG and SVG, a panel a scene and number of lights: times along cameras' paths (as Tiled Shading,
# Figure 2) to frames_times, and light evaluations (Figure 3) to frames_evaluations.
set datafile separator ","
colours = "#999999 #d95f02 #e6a23c #1b6ca8 #49a0d8 #2a9d4e #8cc63f #111111 #7b3fa0 #c9529c"
curves = "'Forward with every light' 'TiledForward' 'TiledForward-PreZ' 'TiledForward-PreZ both' 'TiledForward-PreZ box' 'ClusteredForward' 'ZBinnedForward' 'MaskedForward z-bins' 'Deferred 16 bit' 'DeferredStencil 16 bit'"
count_of_curves = words(colours)
panels = system("tail -n +2 frames_paths.csv | cut -d'\"' -f2 | uniq | tr ' ' '_'")
rows_of(panel, curve) = sprintf("< tr ' ' '_' < frames_paths.csv | grep -F '\"%s\",' | grep -F ',%s,'", panel, system("echo '".curve."' | tr ' ' '_'"))
do for [i = 1 : count_of_curves] { set linetype i linecolor rgb word(colours, i) linewidth 2.2 pointtype 7 pointsize 0.6 }
title_of(curve, what) = curve.(curve eq "TiledForward-PreZ both" && what == 4 ? " = TiledDeferred" : "")
count = words(panels)
columns = count > 1 ? 2 : 1
rows = (count + columns - 1) / columns
width = 620.0 * columns
height = 330.0 * rows + 130
do for [what = 4 : 5] {
    # The reference is not timed on a CPU.
    first = what == 5 ? 2 : 1
    if (system(sprintf("awk -F, 'NR > 1 && $%d > 0' frames_paths.csv | wc -l", what)) == 0) { continue }
    do for [kind in "png svg"] {
        if (kind eq "png") { set terminal pngcairo enhanced size width, height font "sans,13" }
        if (kind eq "svg") { set terminal svg enhanced size width, height font "sans,15" background "white" }
        set output (what == 5 ? "frames_times." : "frames_evaluations.").kind
        set multiplot
        set logscale y
        set format y what == 5 ? "%g" : "10^{%T}"
        set grid linetype -1 linecolor rgb "#dddddd" linewidth 1
        unset key
        do for [i = 1 : count] {
            row = (i - 1) / columns
            column_ = (i - 1) % columns
            set lmargin at screen (620.0 * column_ + 90) / width
            set rmargin at screen (620.0 * column_ + 600) / width
            set tmargin at screen 1 - (330.0 * row + 40) / height
            set bmargin at screen 1 - (330.0 * row + 275) / height
            set title system("echo '".word(panels, i)."' | tr '_' ' '") noenhanced offset 0, -0.6
            set ylabel column_ > 0 ? "" : what == 5 ? "ms a frame" : "million evaluations"
            set xlabel "frame of the camera's path" offset 0, 0.5
            plot for [k = first : count_of_curves] rows_of(word(panels, i), word(curves, k)) using 2:what with linespoints linetype k
        }
        set lmargin at screen 0.02; set rmargin at screen 0.98
        set bmargin at screen 0; set tmargin at screen 115 / height
        unset border; unset tics; unset xlabel; unset ylabel; unset title; unset grid; unset logscale
        set xrange [0 : 1]; set yrange [0 : 1]
        set key center center horizontal maxrows 4 samplen 2 width -2 noenhanced
        plot for [k = first : count_of_curves] NaN with linespoints linetype k title title_of(word(curves, k), what)
        unset multiplot
        set border; set tics; set autoscale
    }
}
