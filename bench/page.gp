# SPDX-License-Identifier: MIT
# One plot of a page: gnuplot -c page.gp PICTURE.svg SCRIPT.gp [ARGUMENT ...] (page.sh calls it). The script plots, and has
# its own arguments as ARG1 and so on. What is black takes the colour of the page's text; the line types 1 to 9 are to be
# told apart on white and on black.
set terminal svg size 520, 460 enhanced font "sans-serif,15"
set output ARG1
set datafile separator ","
colours = "#2f7fd1 #d1651b #2b9348 #b5479d #7a7a7a #1a8f9c #8a7a1e #7d5fd3 #c4393f"
do for [i = 1 : words(colours)] {
    set linetype i linecolor rgb word(colours, i) linewidth 1.6 pointtype 7 pointsize 0.7 dashtype 1
}
set grid linetype -1 linecolor rgb "#808080" linewidth 0.3 dashtype 1
set border 3
set tics nomirror
set key outside bottom center horizontal noenhanced samplen 1 width 1
call ARG2 ARG3 ARG4 ARG5 ARG6
