# SPDX-License-Identifier: MIT
# Draws what frames.csv has of cameras' paths, a panel a scene and number of lights: times (as Tiled Shading, Figure 2) to
# frames_times.png, and light evaluations (Figure 3) to frames_evaluations.png. run.sh makes frames_paths of frames.csv,
# lines of PANEL,FRAME,TECHNIQUE,MILLION_EVALUATIONS,MS, with _ for spaces.
set datafile separator ","
colours = "#999999 #d95f02 #e6a23c #1b6ca8 #49a0d8 #2a9d4e #8cc63f #111111 #7b3fa0 #c9529c"
curves = "Forward_with_every_light TiledForward TiledForward-PreZ TiledForward-PreZ_both TiledForward-PreZ_box \
          ClusteredForward ZBinnedForward MaskedForward_z-bins Deferred_16_bit DeferredStencil_16_bit"
count_of_curves = words(colours)
panels = system("cut -d, -f1 frames_paths | uniq")
rows_of(panel, curve) = sprintf("< grep -F '%s,' frames_paths | grep -F ',%s,'", panel, curve)
spaced(name) = system("echo '".name."' | tr '_' ' '")
do for [i = 1 : count_of_curves] { set linetype i linecolor rgb word(colours, i) linewidth 2.2 pointtype 7 pointsize 0.6 }
title_of(curve, what) = spaced(curve).(curve eq "TiledForward-PreZ_both" && what == 4 ? " = TiledDeferred" : "")
count = words(panels)
columns = count > 1 ? 2 : 1
rows = (count + columns - 1) / columns
width = 620.0 * columns
height = 330.0 * rows + 130
do for [what = 4 : 5] {
    # The reference is not timed on a CPU.
    first = what == 5 ? 2 : 1
    if (system(sprintf("awk -F, '$%d > 0' frames_paths | wc -l", what)) == 0) { continue }
    set terminal pngcairo enhanced size width, height font "sans,13"
    set output what == 5 ? "frames_times.png" : "frames_evaluations.png"
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
        set title spaced(word(panels, i)) noenhanced offset 0, -0.6
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
