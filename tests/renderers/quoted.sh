#!/bin/sh
# Sees that each block of code in a page stands, line after line, in the files that it quotes, whatever the indent:
#   quoted.sh PAGE FILE...
set -eu
page=$1
shift
awk '
    function stripped(line) { sub(/^ +/, "", line); return line "\n" }
    FILENAME != page { text = text stripped($0); next }
    /^```/ && inside {
        inside = 0
        ++blocks
        if (index(text, "\n" block)) next
        print "not in the files that the page quotes:\n" block
        wrong = 1
        next
    }
    /^```/ { inside = 1; block = ""; next }
    inside { block = block stripped($0) }
    END {
        print blocks + 0 " blocks"
        exit wrong || !blocks || inside
    }' page="$page" "$@" "$page"
