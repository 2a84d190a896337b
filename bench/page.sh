#!/bin/sh
# Makes a page of HTML that stands alone, for screens of all widths, light and dark: `sh bench/page.sh NAME` reads NAME.page
# in the current folder, and below it that of this folder, if there is one, and writes NAME.html. Needs
# gnuplot. Lines of a .page, in Markdown's manner:
#   # TEXT, ## TEXT            headings; below the first stand the machine, the commit and the date
#   > TEXT                     a verdict
#   | CELL | CELL |            a row of a table; the first of several is its head; columns of numbers are set to the right
#   - TEXT                     an item of a list
#   ![TEXT](FILE.gp ARG ...)   a plot, TEXT below it: a script of this folder, by page.gp; plots of lines in a row stand
#                              beside each other where there is room
#   TEXT                       a paragraph. In all of them `CODE`; nothing else has a meaning
set -eu
me=bench/page.sh
here=$(pwd)
bench=$(cd "$(dirname "$0")" && pwd)
cd "$bench/.."
. tests/packages.sh
takes "the name of a page" '[^-].*' "$@"
cd "$here"
[ $# -eq 1 ] || fail "it takes the name of a page, see --help"
name=$1
below=$bench/$name.page
[ -e "$below" ] || below=
processor=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)
commit=$(git -C "$bench" describe --always --dirty 2>/dev/null || echo unknown)
machine="${processor:-$(uname -m)}, $(nproc) cores; $(c++ --version | head -n 1); commit $commit; $(date -u '+%Y-%m-%d %H:%M UTC')"
awk -v bench="$bench" -v machine="$machine" -v picture="$name.svg" '
function text(s) {
    gsub(/&/, "\\&amp;", s); gsub(/</, "\\&lt;", s); gsub(/>/, "\\&gt;", s)
    while (match(s, /`[^`]*`/))
        s = substr(s, 1, RSTART - 1) "<code>" substr(s, RSTART + 1, RLENGTH - 2) "</code>" substr(s, RSTART + RLENGTH)
    return s
}
# Ends what the line before was part of, unless this one is too.
function within(tag, opening, closing) {
    if (tag == open) return
    if (open != "") print close_with
    if (tag != "") print opening
    open = tag; close_with = closing
}
function plot(line,    end, label, command, svg, inside) {
    end = index(line, "](")
    label = text(substr(line, 3, end - 3))
    command = substr(line, end + 2); sub(/\)[ \t]*$/, "", command)
    if (system("gnuplot -c " bench "/page.gp " picture " " bench "/" command " >&2") != 0) { failed = 1; exit }
    print "<figure>"
    while ((getline svg < picture) > 0) {
        if (svg ~ /<svg/) inside = 1
        if (!inside || svg ~ /^<(title|desc)>/) continue
        sub(/<svg/, "<svg role=\"img\"", svg)
        gsub(/"black"/, "\"currentColor\"", svg); gsub(/\047black\047/, "\047currentColor\047", svg)
        print svg
    }
    close(picture)
    print "<figcaption>" label "</figcaption></figure>"
}
/^# / {
    title = text(substr($0, 3))
    print "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
    print "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><title>" title "</title>\n<style>"
    while ((getline style < (bench "/page.css")) > 0) print style
    print "</style></head><body>\n<h1>" title "</h1>\n<p class=\"machine\">" text(machine) "</p>"
    next
}
/^## / { within(""); print "<h2>" text(substr($0, 4)) "</h2>"; next }
/^> / { within(""); print "<p class=\"verdict\">" text(substr($0, 3)) "</p>"; next }
/^- / { within("ul", "<ul>", "</ul>"); print "<li>" text(substr($0, 3)) "</li>"; next }
/^\|/ {
    first = open != "table"  # the head waits for the row below it, which says where its words stand
    within("table", "<div class=\"wide\"><table>", "</table></div>")
    count = split($0, cells, /[ \t]*\|[ \t]*/)
    row = names = ""
    for (i = 2; i < count; ++i) {
        if (first) heads[i] = text(cells[i])
        kind = cells[i] ~ /^[-+.]?[0-9][^ ]*$/ ? " class=\"number\">" : ">"
        names = names "<th" kind heads[i] "</th>"
        row = row "<td" kind text(cells[i]) "</td>"
    }
    if (second) print "<tr>" names "</tr>"
    if (!first) print "<tr>" row "</tr>"
    second = first
    next
}
/^!\[/ { within("plots", "<div class=\"plots\">", "</div>"); plot($0); next }
{ within("") }
NF { print "<p>" text($0) "</p>" }
END { if (failed) exit 1; within(""); print "</body></html>" }' "$name.page" ${below:+"$below"} >"$name.html"
rm -f "$name.svg"
