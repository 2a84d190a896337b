#!/bin/sh
# Measures: `sh bench/run.sh [PROGRAM] [options]` on Debian 12, as root or with sudo. Installs the packages that
# are missing, builds in build/bench and runs there. Leave the machine alone while it runs.
#
#   binning [--quick] [--filter=REGEX]
#       (the default) Whole builds as a ratio to the flat baseline; from world space and from structs as a ratio to
#       view-space vec4s (^sources), with clusters and z-bins (^slices), of spots as a ratio to spheres (^spots), of boxes
#       as a ratio to spheres and to spots (^boxes), and what threads gain where none waits for a core (threads): all, or
#       those whose names the expression matches, which it prints. Says how many goals are met and what is missed. Some
#       minutes, --quick half a one. Writes build/bench/binning_goals.csv, and what was timed, binning.csv: a row for each
#       case, instruction set and thing that it is a ratio to. The sets fieldN have a mean footprint of N tiles of 32
#       pixels; box is held against the baseline without Z; for no light ns_per_light is a whole build's.
#   report [--quick] [--evaluation-ns NUMBER] [SCENE.glb ...]
#       Error against run time: of every method and tile size what a frame pays (Z bounds, build, upload, light evaluations
#       of so many nanoseconds, .02 if none are given) and how many light evaluations it makes over those needed, on made scenes and those of bench/scenes, or on the named ones; and
#       what the picture loses by where lights end, and where they may for an RMSE of 1 %. A table with verdicts and a
#       sentence a scene, which also says what advise() chooses and what that costs over the best. Four minutes, --quick one. Writes build/bench/report.html and report.csv.
#   error [--quick] [SCENE.glb ...]
#       What each footprint and depth test and clusters list beyond the exact set, and what they miss, each pair of a cell and
#       a light decided in exact arithmetic; of single spots by half angle, listed as the spheres of their ranges, as their
#       least spheres and as spots; and of single boxes, listed as spheres and as boxes. Writes build/bench/error.csv,
#       spots_error.csv and boxes_error.csv.
#   c_side [SECONDS]
#       Whole builds through lightbin.h over the same in C++, in turns, on lights in structs of the caller's. Each line is
#       the median of five programs that differ in the order of their functions, with the least and the greatest; each
#       program takes half a second, or so many, for it. Three minutes.
#   stability [--quick]
#       How far off the screen bounds of lights are under stiff and extreme conditions, by decade, in pixels: ours and the
#       textbooks', in float and in double, against exact ones; what that misses, lists too much and takes. A miss by ours is
#       an error. A line a family; build/bench/stability.html is a page with plots. Writes stability.csv, too.
#       Some minutes, --quick half a one.
#   frames [--quick] [--counts] [--pictures] [--into=FOLDER] [SCENE.glb ...]
#       Whole frames in OpenGL by every technique of the papers, on the made scene and the named ones (or those of
#       bench/scenes): light evaluations, times of passes, memory, and the difference to every light in every fragment. Ten
#       minutes at most with a software renderer, --quick two; --counts leaves the times out, for a machine that is at work. A
#       scene of ten views or more is taken for a camera's path. Writes to build/bench, or to FOLDER, which it makes: its
#       tables, frames.txt; all rows, frames.csv; of the paths frames_paths.csv and the plots frames_times and
#       frames_evaluations, .svg and .png. --pictures: a PNG a view in build/bench, too. What the repository has of a
#       machine is made by `sh bench/run.sh frames --into=bench/results/llvmpipe-zen4`, or what its processor is.
#   gpu [--quick]
#       Builds on the GPU by shader_cull beside builds on the CPU with their upload, of 1,000 to 100,000 lights and of
#       Bevy's many_lights: milliseconds by the GPU's clock, bytes, tests of a light against a cell, and how many entries the
#       GPU lists beyond the Binner's; lists that lack one, or are out of order, are an error. In OpenGL. Some minutes
#       where that draws on the CPU, --quick one. Writes build/bench/gpu.csv.
set -eu
me=bench/run.sh
here=$(pwd)
cd "$(dirname "$0")/.."
. tests/packages.sh

program=binning
case ${1-} in
binning | report | error | frames | stability | gpu | c_side)
    program=$1
    shift
    ;;
esac
options="--quick" words="scenes (.glb)" pattern='.*\.glb'
case $program in
binning) options="--quick --filter=..." words="" pattern="" ;;
frames) options="--quick --counts --pictures --into=..." ;;
c_side) options="" words="a number" pattern='[0-9.]+' ;;
gpu) words="" pattern="" ;;
report) options="--quick --evaluation-ns" words="a number, scenes (.glb)" pattern='.*\.glb|[0-9.]+' ;;
esac
forms=$(echo "$options" | sed 's/ /|/g; s/\.\.\./.*/')
takes "$program, $options${options:+${words:+, }}$words" "$forms${forms:+${pattern:+|}}$pattern" "$@"

packages="g++ cmake ninja-build gnuplot-nox libglm-dev libboost-dev libgmp-dev libtinygltf-dev"
[ $program != c_side ] || packages="$packages lld"
case $program in
frames | gpu) packages="$packages libstb-dev libepoxy-dev libegl-dev libgl-dev libgl1-mesa-dri" ;;
esac
# shellcheck disable=SC2086  # one word a package
install_packages $packages

make_build_folder
echo "$me: building in build/bench"
{ cmake --preset bench && cmake --build build/bench --target $program; } >build/bench.log 2>&1 ||
    { cat build/bench.log; fail "the build failed"; }
echo "$me: $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1), $(nproc) cores; $(c++ --version | head -n 1)"

# Scenes and folders are named from where the caller stands.
into=
for word; do
    shift
    case $word in
    --into=/*) into=${word#--into=} ;;
    --into=*) into=$here/${word#--into=} ;;
    -* | /*) set -- "$@" "$word" ;;
    *.glb) set -- "$@" "$here/$word" ;;
    *) set -- "$@" "$word" ;;
    esac
done
cd build/bench
case $program in
report | stability)
    "./bench/$program" "$@"
    sh ../../bench/page.sh $program
    echo "$me: wrote build/bench/$program.html and $program.csv"
    ;;
frames)
    [ -z "$into" ] || mkdir -p "$into"
    failed=
    ./bench/frames/frames "$@" >frames.txt || failed=yes
    cat frames.txt
    rm -f frames_times.* frames_evaluations.*
    [ "$(wc -l <frames_paths.csv)" -lt 2 ] || gnuplot ../../bench/plot_frames.gp
    for file in frames.txt frames.csv frames_paths.csv frames_times.png frames_evaluations.png; do
        [ -z "$into" ] || [ ! -e $file ] || cp $file "$into"
    done
    echo "$me: wrote frames.txt, frames.csv, frames_paths.csv and the plots to ${into:-build/bench}"
    [ -z "$failed" ]
    exit
    ;;
gpu) ./bench/gpu/gpu "$@" ;;
c_side)
    for order in 1 2 3 4 5; do
        "./bench/c_side_$order" "$@" >c_side_$order.csv
        echo "$me: measured with the functions in order $order of 5"
    done
    awk -F, -f ../../bench/c_side.awk c_side_*.csv
    ;;
*) "./bench/$program" "$@" ;;
esac
