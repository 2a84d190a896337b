#!/bin/sh
# What the library's files include:
# - nothing but each other, the compiler's own instruction headers, and the C++ standard library, whose headers alone are
#   lower-case words without an ending. (lightbin.h includes two of C. The file that abi_tag.hpp names for older
#   standards is none.)
# - folders of detail/ form an order, and a file includes, also by way of others, only files of its own folder and of
#   folders before it;
# - no file of the core includes one of a wing, and no wing includes another, but c, which offers all of them to C.
# - each public header says on its second line whether it is settled or may change.
set -eu
cd "$(dirname "$0")/../../include"
includes=$(grep -rnE '^[[:space:]]*#[[:space:]]*(include|import)' lightbin)
foreign=$(echo "$includes" | grep -vE '#include <([a-z_]+|([eisx]mm)?intrin\.h|arm_neon\.h|wasm_simd128\.h|lightbin/[a-z_/0-9]+\.(hpp|inl|h)|std(def|int)\.h)>$|"lightbin wants C') || true
[ -z "$foreign" ] || { echo "$foreign"; exit 1; }

for header in lightbin/*.h*; do
    sed -n 2p "$header" | grep -qE '^(//|/\*) Stability: (settled|may change)[.,]' || { echo "$header: no stability on line 2"; exit 1; }
done

# What a file reaches in a core folder is found through all files between, so a public header stands nowhere in the order.
echo "$includes" | sed -nE 's|^lightbin/([^:]+):.*#include <lightbin/(.*)>$|\1 \2|p' | awk '
    BEGIN {
        count = split("base vectors view project depth engine dispatch stages", core)
        for (i = 1; i <= count; ++i) level[core[i]] = i
        wing["spot.hpp"] = wing["box.hpp"] = "kinds"
        wing["shader.hpp"] = wing["shader_text.hpp"] = wing["shader_cull.hpp"] = wing["shader_reduce.hpp"] = "shaders"
        wing["cull_options.hpp"] = "shaders"
        wing["advise.hpp"] = wing["budget.hpp"] = wing["coverage.hpp"] = "tools"
        wing["dump.hpp"] = wing["encode.hpp"] = "tools"
        wing["lightbin.h"] = "c"
        for (file in wing) is_wing[wing[file]] = 1
    }
    function folder_of(file, part) {
        if (split(file, part, "/") == 1) return wing[file]
        if (!(part[2] in level) && !(part[2] in is_wing)) fail(file " lies in a folder that this test does not know")
        return part[2]
    }
    function fail(what) {
        print what
        failed = 1
    }
    function visit(from, file, i, to, folder) {
        for (i = 1; i <= counts[file]; ++i) {
            to = included[file, i]
            folder = folder_of(to)
            if (folder in level && level[folder] > level[folder_of(from)]) fail(from ": reaches up to " to ", by way of " file)
            if (!(to in seen)) {
                seen[to] = 1
                visit(from, to)
            }
        }
    }
    { included[$1, ++counts[$1]] = $2 }
    END {
        for (file in counts) {
            here = folder_of(file)
            for (i = 1; i <= counts[file]; ++i) {
                there = folder_of(included[file, i])
                if (there in is_wing && there != here && here != "c") fail(file ": includes " included[file, i] " of the wing " there)
                ++arrows
            }
            if (here in level) {
                split("", seen)
                visit(file, file)
                ++checked
            }
        }
        if (checked < 40 || arrows < 200) fail("only " checked " files and " arrows " includes were found")
        if (!failed) print arrows " includes, none foreign, none of a wing by the core, none that runs back up"
        exit failed
    }'
