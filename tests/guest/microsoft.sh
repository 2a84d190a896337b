#!/bin/sh
# microsoft.sh HEADERS: clang 19, as a compiler for Windows by Microsoft's rules, makes code of the whole library,
# the wide kernels included. The C++ library is LLVM's, the C library MinGW's, so nothing is linked or run. HEADERS is a
# folder with header-only libraries that the source needs. Each public header is read by itself, too, as C++20 and as C++23.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# compile FLAG...: with warnings for errors; what it says only if there are any
compile() {
    clang++-19 --target=x86_64-pc-windows-msvc -fms-compatibility-version=19.38 -fgnuc-version=4.2.1 \
        -D_LIBCPP_NO_VCRUNTIME -nostdinc++ -isystem /usr/lib/llvm-19/include/c++/v1 \
        -isystem /usr/x86_64-w64-mingw32/include -isystem "$headers" -include "$here/microsoft.hpp" \
        -I "$here/../../include" -Wall -Wextra -Werror -Wno-error=#warnings "$@" 2>"$work/said" ||
        { cat "$work/said"; exit 1; }
}
headers=$1
compile -std=c++20 -O1 -DUNIT=unit -c "$here/use_everything.cpp" -o "$work/object.obj"

for registers in xmm ymm zmm; do
    used=$(objdump -d "$work/object.obj" | grep -c "%$registers") || true
    echo "$used instructions with $registers registers"
    [ "$used" -gt 500 ]
done

# Behind Windows' own header, which defines many words as macros.
sh "$here/../../packaging/single_header.sh" "$work/single.hpp" >/dev/null
for library in single.hpp "$(cd "$here/../../include" && echo lightbin/*.hpp)"; do
    # shellcheck disable=SC2086  # a line a header
    {
        echo '#include <windows.h>'
        printf '#if !defined(near)\n#error "near is no macro"\n#endif\n'
        printf '#include <%s>\n' $library
        echo 'lightbin::Binner<> binner;'
    } >"$work/behind.cpp"
    compile -std=c++20 -I "$work" -fsyntax-only "$work/behind.cpp"
done

count=0
for header in $(cd "$here/../../include" && echo lightbin/*.hpp); do
    echo "#include <$header>" >"$work/header.cpp"
    for standard in c++20 c++23; do
        compile -std=$standard -fsyntax-only "$work/header.cpp"
    done
    count=$((count + 1))
done
echo "$count headers alone"
