#!/bin/sh
# mingw.sh COMPILER: MinGW's g++ makes a library and a program of the C side for Windows, with no warning. The program
# is run where wine is installed.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
compiler=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$compiler" -std=c++20 -O1 -Wall -Wextra -Werror -I "$here/../../include" -DLIGHTBIN_SHARED -DLIGHTBIN_BUILD_SHARED -DLIGHTBIN_NO_U16 \
    -shared "$here/../../packaging/lightbin.cpp" -o "$work/lightbin.dll" -Wl,--out-implib,"$work/lightbin.dll.a"
"$compiler" -x c++ -std=c++11 -Wall -Wextra -Werror -I "$here/../../include" -DLIGHTBIN_SHARED "$here/contract.c" -x none \
    "$work/lightbin.dll.a" -o "$work/contract.exe"
objdump -p "$work/contract.exe" | grep -q lightbin.dll
if ! command -v wine >"$work/wine"; then
    echo "the program was not run: it needs wine"
    exit
fi
for library in libstdc++-6.dll libgcc_s_seh-1.dll libwinpthread-1.dll; do # beside the program, as it is installed
    file=$("$compiler" -print-file-name=$library)
    [ "$file" = $library ] || cp "$file" "$work"
done
export WINEPREFIX="$work/prefix" WINEDEBUG=-all
wine "$work/contract.exe"
wineserver -w # which writes to the folder that is removed now
