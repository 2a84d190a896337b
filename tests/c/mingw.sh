#!/bin/sh
# mingw.sh COMPILER: MinGW's g++ makes a library and a program of the C side for Windows, with no warning. Nothing is
# run.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
compiler=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$compiler" -std=c++20 -O1 -Wall -Wextra -Werror -I "$here/../../include" -DLIGHTBIN_SHARED -DLIGHTBIN_BUILD_SHARED -DLIGHTBIN_NO_U16 \
    -DLIGHTBIN_NO_ADVICE -shared "$here/../../packaging/lightbin.cpp" -o "$work/lightbin.dll" -Wl,--out-implib,"$work/lightbin.dll.a"
"$compiler" -x c++ -std=c++11 -Wall -Wextra -Werror -I "$here/../../include" -DLIGHTBIN_SHARED "$here/contract.c" -x none \
    "$work/lightbin.dll.a" -o "$work/contract.exe"
objdump -p "$work/contract.exe" | grep -q lightbin.dll
