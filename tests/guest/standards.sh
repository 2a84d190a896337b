#!/bin/sh
# standards.sh COMPILER: each public header, and the single one, tells a compiler of an older C++ one thing, which flag it
# lacks, in whatever file and under all warnings; and takes those that say C++20 or later, each in its way.
set -eu
compiler=$1
here=$(cd "$(dirname "$0")" && pwd)
top=$here/../..
. "$here/one_error.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

case $compiler in
clang*) warnings="-Weverything -Wno-c++98-compat -Wno-c++98-compat-pedantic -Wno-unknown-warning-option" ;;
*) warnings="-Wall -Wextra -Wpedantic -Wundef" ;;
esac
# said FLAG...: what the compiler says of file.cpp
said() {
    # shellcheck disable=SC2086  # several flags
    "$compiler" $warnings -I "$work/single" -I "$top/include" "$@" -fsyntax-only "$work/file.cpp" 2>&1
}

mkdir "$work/single"
sh "$top/packaging/single_header.sh" "$work/single/single.hpp" >/dev/null
count=0
for header in single.hpp $(cd "$top/include" && echo lightbin/*.hpp); do
    cat >"$work/file.cpp" <<EOF
#include <$header>
int main() {
    lightbin::Binner<lightbin::Options{.tests = 1}> binner;
    return nobody.knows(this) + lightbin::View::from_projection(binner);
}
EOF
    case $header in
    single.hpp | lightbin/lightbin.hpp) standards="c++11 c++14 c++17 gnu++17" ;;
    *) standards=c++17 ;;
    esac
    for standard in $standards; do
        one_error '(error|warning):' 'lightbin wants C\+\+20, .* -std=c\+\+20 .*/std:c\+\+20' \
            "<$header> by $compiler -std=$standard" said -std=$standard
        count=$((count + 1))
    done
done
[ "$count" -gt 25 ]

# Numbers that compilers gave C++20 before it had one, and Microsoft's, whose own macro says which it is.
echo '#include <lightbin/version.hpp>' >"$work/file.cpp"
for flags in -std=c++2a -std=gnu++2a -std=c++20 -std=c++2b "-U__cplusplus -D__cplusplus=201709L" \
    "-U__cplusplus -D__cplusplus=199711L -D_MSVC_LANG=202002L"; do
    # shellcheck disable=SC2086  # several flags
    said $flags -w >"$work/said" || { cat "$work/said"; echo "$compiler $flags does not do" >&2; exit 1; }
done
if said -std=c++20 -D_MSVC_LANG=201703L -w >/dev/null; then
    echo "$compiler accepts Microsoft's C++17" >&2
    exit 1
fi
echo "$compiler: $count refusals in one sentence"
