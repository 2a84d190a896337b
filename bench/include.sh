#!/bin/sh
# sh bench/include.sh: what it costs to include the library: processor seconds to compile a file that includes
# one header and uses nothing of it, the best of nine rounds over all headers, and beside them what that is beyond
# <immintrin.h>, which the kernels can't do without. With g++ -O0, or $CXX and $CXXFLAGS. A minute at most.
set -eu
me=bench/include.sh
cd "$(dirname "$0")/.."
. tests/packages.sh

takes "" "" "$@"
rounds=9
[ -n "${CXX-}" ] || install_packages g++ bash
compiler=${CXX:-g++}
flags=${CXXFLAGS:--O0}
headers="view.hpp light_grid.hpp lights.hpp lightbin.hpp list_format.hpp encode.hpp budget.hpp grid_union.hpp shader.hpp
    shader_reduce.hpp shader_cull.hpp advise.hpp"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# seconds NAME: a line of NAME and the seconds of user and system that a file takes which includes it.
seconds() {
    echo "#include <$1>" >"$work/file.cpp"
    # shellcheck disable=SC2016,SC2086  # the inner shell's own; several flags
    took=$(LC_ALL=C bash -c 'TIMEFORMAT="%3U %3S"; { time "$@" >&3 2>&3; } 2>&1' - \
        "$compiler" -std=c++20 $flags -Iinclude -c "$work/file.cpp" -o "$work/file.o" 3>"$work/said") ||
        { cat "$work/said"; fail "$compiler does not compile <$1>"; }
    echo "$1 $took"
}

echo "$me: $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1); $("$compiler" --version | head -n 1), $flags"
round=0
while [ $round -lt "$rounds" ]; do
    round=$((round + 1))
    seconds cstddef
    seconds immintrin.h
    for header in $headers; do
        seconds "lightbin/$header"
    done
done >"$work/times"
awk '
    !($1 in best) { order[++count] = $1; best[$1] = $2 + $3 }
    $2 + $3 < best[$1] { best[$1] = $2 + $3 }
    END {
        print "| header | s | beyond <immintrin.h> |\n| --- | --- | --- |"
        for (i = 1; i <= count; ++i) {
            beyond = best[order[i]] - best["immintrin.h"]
            printf "| %s | %.2f | %s |\n", order[i], best[order[i]], (beyond > 0 ? sprintf("%.2f", beyond) : "-")
        }
    }' "$work/times"
