#!/bin/sh
# Measures: `sh bench/run.sh [PROGRAM] [options]` on Debian 12, as root or with sudo. Installs the packages that
# are missing, builds in build/bench and runs there. Leave the machine alone while it runs.
#
#   binning [--quick] [--filter=REGEX]
#       (the default) Times of whole builds, over the flat loop or what else is named: all, or the cases whose names the
#       expression matches, which it prints: ^sources, ^slices, ^spots, ^boxes, threads. Writes build/bench/binning.csv, a
#       row for each case, instruction set and thing that it is a ratio to. The sets fieldN have a mean footprint of N
#       tiles of 32 pixels; for no light ns_per_light is a whole build's.
#   report [--quick] [--evaluation-ns NUMBER] [SCENE.glb ...]
#       Error against run time: of every method and tile size what a frame pays (Z bounds, build, upload, light evaluations
#       of so many nanoseconds, .02 if none are given) and how many light evaluations it makes over those needed, on made
#       scenes and those of bench/scenes, or on the named ones; what advise() chooses; and what the picture loses by where
#       lights end. Writes build/bench/report.html and report.csv.
#   error [--quick] [SCENE.glb ...]
#       What each depth test and clusters list beyond the exact set, and what they miss; of single spots by half angle and
#       of single boxes by shape, too. Writes build/bench/error.csv, spots_error.csv and boxes_error.csv.
#   stability [--quick]
#       How far off the screen bounds of lights are under stiff and extreme conditions: the library's and the textbooks', in
#       float and in double. A miss by the library is an error. Writes build/bench/stability.html and stability.csv.
#   frames [--quick] [--counts] [--into=FOLDER] [SCENE.glb ...]
#       Whole frames in OpenGL by every technique of the papers, on the made scene and the named ones (or those of
#       bench/scenes). --counts leaves the times out, for a machine that is at work. A scene of ten views or more is taken
#       for a camera's path. Writes to build/bench, or to FOLDER, which it makes: frames.txt, frames.csv and the plots
#       frames_times.png and frames_evaluations.png.
#   gpu [--quick]
#       Builds on the GPU by shader_cull beside builds on the CPU with their upload, in OpenGL. GPU's lists that lack an
#       entry of the CPU's, or are out of order, are an error. Writes build/bench/gpu.csv.
#   van_oosten [--quick]
#       The tables of a published thesis, up to 7,000,000 lights, beside builds of lights with the same statistics on the
#       CPU and, where there is one, the GPU. Lists that are not right are an error. Writes build/bench/van_oosten.csv.
set -eu
me=bench/run.sh
here=$(pwd)
cd "$(dirname "$0")/.."
. tests/packages.sh

program=binning
case ${1-} in
binning | report | error | frames | stability | gpu | van_oosten)
    program=$1
    shift
    ;;
esac
options="--quick" words="scenes (.glb)" pattern='.*\.glb'
case $program in
binning) options="--quick --filter=..." words="" pattern="" ;;
frames) options="--quick --counts --into=..." ;;
gpu | van_oosten) words="" pattern="" ;;
report) options="--quick --evaluation-ns" words="a number, scenes (.glb)" pattern='.*\.glb|[0-9.]+' ;;
esac
forms=$(echo "$options" | sed 's/ /|/g; s/\.\.\./.*/')
takes "$program, $options${options:+${words:+, }}$words" "$forms${forms:+${pattern:+|}}$pattern" "$@"

packages="g++ cmake ninja-build gnuplot-nox libglm-dev libboost-dev libgmp-dev libtinygltf-dev"
case $program in
frames | gpu | van_oosten) packages="$packages libstb-dev libepoxy-dev libegl-dev libgl-dev libgl1-mesa-dri" ;;
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
    rm -f frames_times.png frames_evaluations.png
    # A frame's number ends the name of its view; where none does, the views are numbered.
    awk -F'"' '/^path/ {
        split($5, row, ","); sub(/\.glb$/, "", $2); panel = $2 ": " row[2] " lights"
        if (panel != last_panel) frame = 0; else if ($4 != last_view) ++frame
        last_panel = panel; last_view = $4
        match($4, /[0-9]*$/)
        line = panel "," (RLENGTH > 0 ? substr($4, RSTART) : frame) "," row[3] "," row[4] / 1e6 "," row[5]
        gsub(/ /, "_", line)
        print line
    }' frames.csv >frames_paths
    [ ! -s frames_paths ] || gnuplot ../../bench/plot_frames.gp
    rm frames_paths
    for file in frames.txt frames.csv frames_times.png frames_evaluations.png; do
        [ -z "$into" ] || [ ! -e $file ] || cp $file "$into"
    done
    echo "$me: wrote frames.txt, frames.csv and the plots to ${into:-build/bench}"
    [ -z "$failed" ]
    exit
    ;;
gpu) ./bench/gpu/gpu "$@" ;;
*) "./bench/$program" "$@" ;;
esac
