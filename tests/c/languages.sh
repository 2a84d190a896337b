#!/bin/sh
# languages.sh C_COMPILER CXX_COMPILER [LIBRARY]: lightbin.h has no warning as C99, C11 and C++11 to 20. Given LIBRARY, a shared
# library of the C side, it keeps the promises to the program of each language, and the C of the documentation does what it
# says.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
c_compiler=$1 cxx_compiler=$2 library=${3-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# try COMPILER STANDARD LANGUAGE FLAG...: builds and runs the program of contract.c; a warning is an error
try() {
    compiler=$1
    standard=$2
    language=$3
    shift 3
    set -- -std="$standard" -pedantic -Wall -Wextra -Wconversion -Wshadow -Wundef -Werror "$@" -DLIGHTBIN_SHARED \
        -I "$here/../../include" -x "$language" "$here/contract.c"
    if [ -n "$library" ]; then
        "$compiler" "$@" -x none "$library" -Wl,-rpath,"$(dirname "$library")" -o "$work/program"
        "$work/program" >/dev/null
    else
        "$compiler" "$@" -fsyntax-only
    fi
    echo "$compiler -std=$standard"
}
for standard in c99 c11; do
    try "$c_compiler" $standard c -Wstrict-prototypes
done
for standard in c++11 c++14 c++17 c++20; do
    try "$cxx_compiler" $standard c++
done

# In C++20 it stands beside every header of the C++ side, before or behind them, and its values are those of abi.txt.
(cd "$here/../../include" && printf '#include <%s>\n' lightbin/*.hpp) >"$work/cpp.hpp"
echo '#include <lightbin/lightbin.h>' >"$work/c.hpp"
sed -n 's/^  \(LIGHTBIN_[A-Z0-9_]*\) = \([0-9]*\)$/static_assert(\1 == \2);/p' "$here/abi.txt" >"$work/values.hpp"
for order in 'c cpp' 'cpp c'; do
    printf '#include "%s.hpp"\n' $order values >"$work/both.cpp"
    g++ -std=c++20 -pedantic -Wall -Wextra -Wundef -Werror -fsyntax-only -I "$here/../../include" "$work/both.cpp"
done

# The file of the code, if it is compiled as C, is refused by one sentence.
if "$c_compiler" -std=c99 -DLIGHTBIN_IMPLEMENTATION -I "$here/../../include" -fsyntax-only -x c - 2>"$work/said" <<END
#include <lightbin/lightbin.h>
END
then
    exit 1
fi
[ "$(grep -c ' error: ' "$work/said")" -eq 1 ]
grep -q 'is C++20, not C' "$work/said"
[ -n "$library" ] || { echo "six languages, no warning"; exit; }

# blocks PAGE: its blocks of C
blocks() {
    awk '/^```c$/ { inside = 1; next } /^```/ { inside = 0 } inside' "$here/../../docs/$1.md"
}
# run_page FILE: compiles it as C99 and runs it
run_page() {
    "$c_compiler" -std=c99 -pedantic -Wall -Wextra -Werror -DLIGHTBIN_SHARED -I "$here/../../include" -o "$work/program" "$1" "$library" \
        -Wl,-rpath,"$(dirname "$library")"
    "$work/program"
}

# The page's program, which also calls the page's function that makes clusters.
blocks c | sed -e 's/^static void succeed/void bin_clusters(const lightbin_view*, const lightbin_lights*);\n&/' \
    -e 's/^    lightbin_view_destroy(view);$/    bin_clusters(view, \&lights);\n&/' >"$work/page.c"
run_page "$work/page.c" >"$work/said"
grep -q '^20 x 20 tiles, [1-9]' "$work/said"
grep -qx '20 x 20 x 24 clusters' "$work/said"

# The passes of docs/gpu.md are compiled and dispatched in their order.
cat >"$work/gpu.c" <<END
#include <lightbin/lightbin.h>
#include <string.h>
static int compiled, dispatched;
static uint64_t allocated;
static uint32_t tiles_x;
static void succeed(lightbin_result result) { compiled += result.error == LIGHTBIN_OK ? 0 : 100; }
static void compile_compute(const char* version, const char* text) {
    compiled += strstr(version, "430") != NULL && strstr(text, "void main()") != NULL;
}
static void upload(const uint32_t* words, size_t bytes) { tiles_x = bytes == 256 ? words[0] : 0; }
static void allocate(uint64_t scratch, uint64_t tiles, uint64_t lists) { allocated = scratch > 16 ? tiles + lists : 0; }
static void dispatch(uint32_t x, uint32_t y) { dispatched += x > 0 && y > 0; }
static void storage_barrier(void) {}
int main(void) {
    const float projection[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1.002f, -1, 0, 0, -0.2002f, 0};
    lightbin_view_options view_options = {
        .size = sizeof view_options, .width = 640, .height = 480, .projection = {.floats = projection}};
    lightbin_view* view = NULL;
    succeed(lightbin_view_create(&view_options, &view));
    {
        $(blocks gpu)
    }
    lightbin_view_destroy(view);
    return compiled == 5 && dispatched == 5 && tiles_x == 20 && allocated == 8 * 20 * 15 + 4 * 200000 ? 0 : 1;
}
END
run_page "$work/gpu.c"

# The lists of docs/cameras.md are made once a frame.
cat >"$work/cameras.c" <<END
#include <lightbin/lightbin.h>
typedef struct Camera {
    float projection[16], world_to_view[16];
    int width, height;
} Camera;
$(blocks cameras)
int main(void) {
    const Camera camera = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1.002f, -1, 0, 0, -0.2002f, 0},
                           {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, 640, 480};
    const float lamp[4] = {0, 0, -5, 2};
    lightbin_view_options options = {.size = sizeof options, .projection = {.floats = camera.projection}};
    lightbin_lights lights = {.size = sizeof lights,
                              .spheres = {.count = 1, .centre = {lamp, sizeof lamp}, .radius = {lamp + 3, sizeof lamp}}};
    CameraLists lists = {0};
    uint64_t made[3];
    for (int draw = 0; draw < 3; ++draw) {
        if (draw == 0 && (lightbin_view_create(&options, &lists.view).error != LIGHTBIN_OK ||
                          lightbin_binner_create(NULL, &lists.binner).error != LIGHTBIN_OK)) return 1;
        if (use_lists(&lists, &camera, draw < 2 ? 1 : 2, lights).error != LIGHTBIN_OK) return 2;
        made[draw] = lists.grid.id_count;
        lights.spheres.count = 0; /* from the second draw on, which is in the same frame */
    }
    lightbin_binner_destroy(lists.binner);
    lightbin_view_destroy(lists.view);
    return made[0] > 0 && made[1] == made[0] && made[2] == 0 && lists.grid.tiles_x == 20 ? 0 : 3;
}
END
run_page "$work/cameras.c"
