#!/bin/sh
# Writes the library as one header: `sh packaging/single_header.sh [FILE [all | core | c]]`. FILE is seen from the top
# folder; if it is not named, it is build/single/lightbin.hpp. `all`, the default, is the whole library in C++, `core`
# is lightbin.hpp alone, and `c` is lightbin.h with its implementation. The same sources give the same bytes.
set -eu
export LC_ALL=C
me=packaging/single_header.sh
cd "$(dirname "$0")/.."
. tests/packages.sh
takes "a file" "[^-].*" "$@"
file=${1:-build/single/lightbin.hpp} what=${2:-all}
case $what in
all)
    first=lightbin.hpp
    about='A header that a comment names is in here, too. With LIGHTBIN_CORE_ONLY defined all but lightbin.hpp is
// left out, which takes less time to compile.'
    ;;
core) first=lightbin.hpp about='It has lightbin.hpp alone, with all that it includes.' ;;
c) first=lightbin.h about='It has lightbin.h, and its implementation in C++20.' ;;
*) fail "cannot make '$what': it makes all, core or c" ;;
esac
mkdir -p "$(dirname "$file")"

{
    cat <<EOF
// lightbin $(library_version) in one file, made of the headers in include/lightbin by packaging/single_header.sh:
// change those. $about
//
EOF
    sed 's|^|// |; s| *$||' LICENSE
    [ "$what" = c ] || echo '#pragma once'
    echo
    awk -v first="lightbin/$first" -v what="$what" '
        function fail(what) {
            print what | "cat >&2"
            exit failed = 1
        }

        # Whether what was written under one condition is there under the one that holds now, too. A condition is the
        # numbers of the branches around a line.
        function is_there(earlier) {
            return substr(condition, 1, length(earlier)) == earlier
        }

        # Each header once. What ends in .inl is meant to be included often, each time under other macros; its comments
        # are kept the first time.
        function write(name, often, line, got, dropped, alone) {
            often = name ~ /\.inl$/
            if (!often && name in under) {
                if (!is_there(under[name])) fail(name " is included first under a condition, and again")
                return
            }
            if (!often) under[name] = condition  # before it is read: a header may include the one that includes it
            print "// ---- " name
            dropped = 1
            while ((got = (getline line < ("include/" name))) > 0) {
                if (line ~ /^#if !defined\(LIGHTBIN_KERNELS\)/) alone = 1  # what an editor reads
                if (alone) {
                    if (line == "#endif") alone = 0
                    continue
                }
                if (line ~ /^ *# *(el|endif)/) sub(/[0-9]+ $/, "", condition)
                if (line ~ /^ *# *(if|el)/) condition = condition (++branches) " "
                if (line == "#if defined(LIGHTBIN_IMPLEMENTATION)" && name == "lightbin/lightbin.h") {
                    print "#if defined(__GNUC__) && !defined(__cplusplus)"
                    print "#pragma GCC system_header  // C would warn of raw strings, even where it skips them"
                    print "#endif"
                    line = line " && !defined(LIGHTBIN_IMPLEMENTED)\n#define LIGHTBIN_IMPLEMENTED"
                }
                if (line ~ /^#include <lightbin\//) {
                    split(line, part, /[<>]/)
                    write(part[2])
                    dropped = 1
                } else if (is_known(line) || (often && name in under && line ~ /^ *\/\//)) {
                    dropped = 1
                } else if (line != "" || !dropped) {
                    print line
                    dropped = 0
                }
            }
            close("include/" name)
            if (got < 0) fail("cannot read include/" name)
            if (!(name in under)) under[name] = condition
            if (!dropped) print ""
        }

        # What the top of the file says, and includes of what was included by then.
        function is_known(line) {
            if (line == "#pragma once" || line == "// SPDX-License-Identifier: MIT") return 1
            if (line !~ /^#include </) return 0
            if (line in known && is_there(known[line])) return 1
            known[line] = condition
            return 0
        }

        BEGIN {
            write(first)
            if (what != "all") exit failed
            print "#if !defined(LIGHTBIN_CORE_ONLY)\n"
            for (i = 1; i < ARGC; ++i) write(substr(ARGV[i], length("include/") + 1))
            print "#endif"
            exit failed
        }' include/lightbin/*.hpp
} >"$file.part"
mv "$file.part" "$file"
echo "$file: $(wc -l <"$file") lines, $(wc -c <"$file") bytes"
