#!/bin/sh
# sh bench/web.sh [--quick]: how fast the library is as WebAssembly. bench/web.cpp under node, with simd128 and without,
# beside the same on this machine by the same compiler, clang 14: whole builds as a ratio to the flat loop that is timed
# in turns with them, in brackets the spread. A minute, --quick a quarter of one, and building. On Debian 12, as root or
# with sudo. Leave the machine alone while it runs.
set -eu
me=bench/web.sh
cd "$(dirname "$0")/.."
. tests/packages.sh

takes --quick --quick "$@"
quick=${1-}

install_packages clang-14 libglm-dev emscripten node-acorn nodejs
make_build_folder
out=build/web-bench
mkdir -p $out/headers
ln -sfn /usr/include/glm $out/headers/glm  # em++ does not look where header-only libraries are
export NODE_PATH=/usr/share/nodejs         # where Debian's emscripten has a module that it needs

# build NAME COMPILER FLAGS...
build() {
    name=$1
    shift
    "$@" -std=c++20 -O3 -Iinclude -isystem $out/headers bench/web.cpp -o "$out/$name" >$out/build.log 2>&1 ||
        { cat $out/build.log; fail "$name does not build"; }
}
# measure COLUMN PROGRAM...: lines of a column's name and what the program says
measure() {
    column=$1
    shift
    # shellcheck disable=SC2086  # or none
    "$@" $quick >$out/said || fail "$column did not run"
    sed "s/^/$column /" $out/said
}
node="node --no-experimental-fetch"  # which its loader would take for a browser's
memory="-sINITIAL_MEMORY=512MB -sEXIT_RUNTIME=1"
simd="-msimd128"

# shellcheck disable=SC2086  # several words
{
    build native clang++-14
    build scalar.js em++ $memory
    build simd.js em++ $simd $memory
    echo "$me: $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1), $(nproc) cores; node $(node --version)"
    measure native $out/native >$out/results
    measure wasm $node $out/scalar.js >>$out/results
    measure simd128 $node $out/simd.js | awk '$3 == "simd128"' >>$out/results
}

# results: column, set, instruction set, ratio, spread, nanoseconds a light
awk '
    function cell(which) { return ratio[which] == "" ? "-" : sprintf("%.2f (%.2f)", ratio[which], spread[which]) }
    { which = $1 " " $2 " " $3; ratio[which] = $4; spread[which] = $5 }
    !seen[$2]++ { sets[++count] = $2 }
    END {
        print "| lights | simd128 | simd128, native | WebAssembly without | scalar, native |\n| --- | --- | --- | --- | --- |"
        for (i = 1; i <= count; ++i)
            print "| " sets[i] " | " cell("simd128 " sets[i] " simd128") " | " cell("native " sets[i] " simd128") " | " \
                cell("wasm " sets[i] " scalar") " | " cell("native " sets[i] " scalar") " |"
    }' $out/results
