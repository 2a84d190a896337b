#!/bin/sh
# Runs the tests for this machine: `sh tests/run.sh` on Debian 12, as root or with sudo. Installs the packages that are missing,
# configures and builds in build/dev, runs the tests, and says how far it is. docs/tour.md lists the tests that have commands
# of their own, such as those of other compilers and machines.
set -eu
me=tests/run.sh
cd "$(dirname "$0")/.."
. tests/packages.sh

takes "" "" "$@"

tools="git g++ cmake ninja-build pkgconf python3 gdb"
libraries="doctest-dev libglm-dev libeigen3-dev nlohmann-json3-dev"
oracle="libboost-dev libgmp-dev"
examples="libcli11-dev libtinygltf-dev libstb-dev libepoxy-dev libegl-dev libglfw3-dev"
renderers="libopenscenegraph-dev python3-moderngl xvfb" # somebody else's, and a display that nobody sees, for a window
opengl="libgl1-mesa-dri libgles2" # Mesa draws where there is no GPU
javascript="emscripten node-acorn binaryen esbuild nodejs node-typescript"
command -v npm >/dev/null || javascript="$javascript npm" # other distributions of node have it in them
shaders="glslang-dev glslang-tools spirv-tools" # the first names files of the second
# shellcheck disable=SC2086  # one word a package
install_packages $tools $libraries $oracle $examples $renderers $opengl $javascript $shaders
make_build_folder

# follow COMMAND...: waits for the last process in the background. Until then says what COMMAND prints: every 20 seconds,
# or on a terminal every second on the same line.
follow() {
    process=$!
    seconds=0
    while kill -0 "$process" 2>/dev/null; do
        sleep 1
        seconds=$((seconds + 1))
        if [ -t 1 ]; then
            printf '\r\033[K%s' "$("$@" | cut -c 1-100)"
        elif [ $((seconds % 20)) -eq 0 ]; then
            "$@"
        fi
    done
    [ ! -t 1 ] || printf '\r\033[K'
    wait "$process"
}

say_built() {
    sed -n 's/^\[\([0-9]*\)\/\([0-9]*\)\].*/\1 of \2 built/p' build/dev-build.log | tail -n 1
}

say_tested() {
    awk '/^ +Start +[0-9]+: / { sub(":", "", $2); running[$2] = $3 }
        /^ *[0-9]+\/[0-9]+ Test +#/ { sub(/^ */, ""); split($0, at, /[\/ ]/); total = at[2]; ++ended
            match($0, /#[0-9]+/); delete running[substr($0, RSTART + 1, RLENGTH - 1)] }
        END { for (i in running) names = names (names ? ", " : "; running: ") running[i]
            print ended + 0 (total ? " of " total : "") " tests done" names }' build/dev-tests.log
}

jobs=$(nproc)
echo "$me: configuring and building in build/dev"
cmake --preset dev -DLIGHTBIN_ALL_TESTS=ON >build/dev.log 2>&1 || { cat build/dev.log; fail "the configuration failed"; }
cmake --build --preset dev -j "$jobs" >build/dev-build.log 2>&1 &
follow say_built || {
    sed -n '/^FAILED/,$p' build/dev-build.log | grep -v '^\[[0-9]*/[0-9]*\]' | head -n 100
    fail "the build failed; the full log is build/dev-build.log"
}

echo "$me: running the tests"
ctest --preset dev -j "$jobs" >build/dev-tests.log 2>&1 &
failed=
follow say_tested || failed=yes
# What each failed test said, and the summary; no line for those that passed.
grep -vE '^ *(Start +[0-9]+: |[0-9]+/[0-9]+ Test +#.* Passed )' build/dev-tests.log
echo "$me: the longest tests: $(sed -n 's/.*Test *#[0-9]*: \([^ ]*\).* \([0-9.]*\) sec.*/\2 s \1/p' build/dev-tests.log |
    sort -rn | head -n 5 | paste -s -d , | sed 's/,/, /g')"
[ -z "$failed" ] || fail "not every test passed; the full log is build/dev-tests.log"

tiers=$(build/dev/tests/platforms/platforms.lists 1 | sed -n 's/^tiers: //p')
echo "$me: kernels that ran on this machine: $tiers"
case $tiers in
*avx512*) ;;
*) echo "$me: LEFT OUT for want of a machine: AVX-512 (Ice Lake, Zen 4 and later have all that it takes)" ;;
esac
echo "$me: processor time, user and system, of this script and of all that it ran:"
times
echo "$me: every test passed"
