#!/bin/sh
# Writes the whole library as one header: `sh packaging/single_header.sh [FILE]`. FILE, build/single/lightbin.hpp if not
# named, is seen from the top folder. The same sources give the same bytes.
set -eu
export LC_ALL=C
me=packaging/single_header.sh
cd "$(dirname "$0")/.."
. tests/packages.sh
takes "a file" "[^-].*" "$@"
file=${1:-build/single/lightbin.hpp}
version=$(sed -n 's/^#define LIGHTBIN_VERSION_[A-Z]* //p' include/lightbin/version.hpp | paste -s -d .)
mkdir -p "$(dirname "$file")"

{
    cat <<EOF
// lightbin $version in one file, made of the headers in include/lightbin by packaging/single_header.sh: change those.
// A header of the library that a comment names is in here, too. With LIGHTBIN_CORE_ONLY defined all but lightbin.hpp is
// left out, which takes less time to compile.
//
EOF
    sed 's|^|// |; s| *$||' LICENSE
    printf '#pragma once\n\n'
    awk '
        function fail(what) {
            print what | "cat >&2"
            exit failed = 1
        }

        # Each header once. What ends in .inl is meant to be included often, each time under other macros; its comments
        # are kept the first time.
        function write(name, often, line, got, dropped, alone) {
            often = name ~ /\.inl$/
            if (name in depth_of) {
                if (!often && depth_of[name] > 0) fail(name " is included first under a condition, and again")
                if (!often) return
            }
            if (!often) depth_of[name] = depth  # before it is read: a header of detail/ may include the one that includes it
            print "// ---- " name
            dropped = 1
            while ((got = (getline line < ("include/" name))) > 0) {
                if (line ~ /^#if !defined\(LIGHTBIN_KERNELS\)/) alone = 1  # what an editor reads
                if (alone) {
                    if (line == "#endif") alone = 0
                    continue
                }
                if (line ~ /^ *# *if/) ++depth
                if (line ~ /^ *# *endif/) --depth
                if (line ~ /^#include <lightbin\//) {
                    split(line, part, /[<>]/)
                    write(part[2])
                    dropped = 1
                } else if (is_known(line) || (often && name in depth_of && line ~ /^ *\/\//)) {
                    dropped = 1
                } else if (line != "" || !dropped) {
                    print line
                    dropped = 0
                }
            }
            close("include/" name)
            if (got < 0) fail("cannot read include/" name)
            if (!(name in depth_of)) depth_of[name] = depth
            if (!dropped) print ""
        }

        # What the top of the file says, and includes of what was included by then.
        function is_known(line) {
            if (line == "#pragma once" || line == "// SPDX-License-Identifier: MIT") return 1
            if (depth > 0 || line !~ /^#include /) return 0
            return known[line]++
        }

        BEGIN {
            write("lightbin/lightbin.hpp")
            print "#if !defined(LIGHTBIN_CORE_ONLY)\n"
            for (i = 1; i < ARGC; ++i) write(substr(ARGV[i], length("include/") + 1))
            print "#endif"
            exit failed
        }' include/lightbin/*.hpp
} >"$file.part"
mv "$file.part" "$file"
echo "$file: $(wc -l <"$file") lines, $(wc -c <"$file") bytes"
