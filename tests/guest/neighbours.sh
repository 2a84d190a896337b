#!/bin/sh
# neighbours.sh COMPILER QT: all public headers, and the single one, behind Qt's, whose folder is QT, and behind X11's, which
# define many words as macros. (Windows' are microsoft.sh's.)
set -eu
compiler=$1 qt=$2
top=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
sh "$top/packaging/single_header.sh" "$work/single.hpp" >/dev/null
headers=$(cd "$top/include" && echo lightbin/*.hpp)

# behind MACRO HEADER...: where these are included, as they must be to define the macro
behind() {
    macro=$1
    shift
    for library in single.hpp "$headers"; do
        # shellcheck disable=SC2086  # a line a header
        {
            printf '#include <%s>\n' "$@"
            printf '#if !defined(%s)\n#error "%s is no macro"\n#endif\n' "$macro" "$macro"
            printf '#include <%s>\n' $library
            echo 'lightbin::Binner<> binner;'
        } >"$work/file.cpp"
        "$compiler" -std=c++20 -w -fPIC -isystem "$qt" -isystem "$qt/QtCore" -isystem "$qt/QtGui" -isystem "$qt/QtWidgets" \
            -I "$top/include" -I "$work" -fsyntax-only "$work/file.cpp"
    done
}
behind slots QtWidgets/QtWidgets
behind None X11/Xlib.h X11/Xutil.h X11/Xatom.h X11/Xresource.h
echo "$compiler: all headers behind those of Qt and X11"
