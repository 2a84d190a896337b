# SPDX-License-Identifier: MIT
# Draws frames_paths.csv, light evaluations along cameras' paths (Tiled Shading, Figure 3), as PNG and SVG: a panel a scene.
set datafile separator ","
curves = "'Forward with every light' 'TiledForward' 'TiledForward-PreZ' 'TiledForward-PreZ both' 'TiledForward-PreZ box (GPU)' 'ClusteredForward' 'ZBinnedForward' 'Deferred 32 bit' 'DeferredStencil 32 bit'"
title_of(curve) = curve eq "TiledForward-PreZ both" ? "TiledForward-PreZ both = TiledDeferred" : curve
panels = system("tail -n +2 frames_paths.csv | cut -d'\"' -f2 | uniq | tr ' ' '_'")
rows_of(panel, curve) = sprintf("< tr ' ' '_' < frames_paths.csv | grep -F '\"%s\",' | grep -F ',%s,'", panel, system("echo '".curve."' | tr ' ' '_'"))
colours = "#999999 #d95f02 #e6a23c #1b6ca8 #49a0d8 #2a9d4e #8cc63f #7b3fa0 #c9529c"
do for [i = 1 : 9] { set linetype i linecolor rgb word(colours, i) linewidth 2.4 pointtype 7 pointsize 0.6 }
count = words(panels)
columns = count > 1 ? 2 : 1
rows = (count + columns - 1) / columns
width = 620.0 * columns
height = 330.0 * rows + 110
do for [kind in "png svg"] {
    if (kind eq "png") { set terminal pngcairo enhanced size width, height font "sans,13" }
    if (kind eq "svg") { set terminal svg enhanced size width, height font "sans,15" background "white" }
    set output "frames_paths.".kind
    set multiplot
    set logscale y
    set format y "10^{%T}"
    set grid linetype -1 linecolor rgb "#dddddd" linewidth 1
    unset key
    do for [i = 1 : count] {
        row = (i - 1) / columns
        column_ = (i - 1) % columns
        set lmargin at screen (620.0 * column_ + 80) / width
        set rmargin at screen (620.0 * column_ + 600) / width
        set tmargin at screen 1 - (330.0 * row + 40) / height
        set bmargin at screen 1 - (330.0 * row + 275) / height
        set title system("echo '".word(panels, i)."' | tr '_' ' '") noenhanced offset 0, -0.6
        set ylabel column_ == 0 ? "million evaluations" : ""
        set xlabel "view along the path" offset 0, 0.5
        plot for [k = 1 : 9] rows_of(word(panels, i), word(curves, k)) using 2:4 with linespoints linetype k
    }
    set lmargin at screen 0.02; set rmargin at screen 0.98
    set bmargin at screen 0; set tmargin at screen 100 / height
    unset border; unset tics; unset xlabel; unset ylabel; unset title; unset grid; unset logscale
    set xrange [0 : 1]; set yrange [0 : 1]
    set key center center horizontal maxrows 3 samplen 2 width -2 noenhanced
    plot for [k = 1 : 9] NaN with linespoints linetype k title title_of(word(curves, k))
    unset multiplot
    set border; set tics; set autoscale
}
