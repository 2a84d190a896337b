#!/bin/sh
# sh tests/platforms.sh [NAME...]: the same tests on every platform that a user may have, on Debian 12, as root or with
# sudo. Builds them with each compiler, runs them - in an emulator, Wine or node where the machine is another - and sees
# that all platforms give the same light lists, byte for byte, as those that tests/oracle proves. Installs what the
# platforms asked for lack. What was built is kept in build/platforms: the first run takes much longer than the next.
#   NAME...  of these platforms only
#   --list   names them
#   --quick  of each platform the lists alone
# The tests of a platform, or a script's of this folder:
#   lists    tests/platforms/lists.cpp: every option and instruction set, hashes of the lists; Binners in several threads
#   unit     tests/unit, as far as they need doctest and GLM alone
#   c        tests/c/contract.c: what lightbin.h promises
#   guest    tests/guest: allocation and exceptions
set -eu
me=tests/platforms.sh
cd "$(dirname "$0")/.."
. tests/packages.sh

listing=
wanted=
all="lists unit"
for word in "$@"; do
    case $word in
    --list) listing=yes ;;
    --quick) all=lists ;;
    -h | --help) help ;;
    -*) fail "cannot do '$word': it takes names of platforms, --quick, --list or --help" ;;
    *) wanted="$wanted $word" ;;
    esac
done

out=$(pwd)/build/platforms
wine_prefix=
trap '[ -z "$wine_prefix" ] || wineserver -k || true' EXIT
failed=
found=

# is_wanted NAME WORDS: whether this platform's turn has come
is_wanted() {
    if [ -n "$listing" ]; then
        printf '  %-14s %s\n' "$1" "$2"
        return 1
    fi
    case "$wanted " in
    " " | *" $1 "*) found="$found $1" ;;
    *) return 1 ;;
    esac
    echo "$me: $1: $2"
    began=$(date +%s)
    folder=$out/${3:-$1}
    mkdir -p "$folder"
}

# result NAME WORDS TIERS RESULT: its line of the table
result() {
    case $4 in
    *FAILED*) failed="$failed $1" ;;
    esac
    echo "$me: $1: $4 ($(($(date +%s) - began)) s)"
    echo "| $2 | $3 | $4 |" >>"$out/table.md"
}

# build EXE PROGRAM...: with $compiler, $flags and $link, in $folder
build() {
    exe=$1
    shift
    targets=
    for program in "$@"; do
        targets="$targets $folder/$program$exe"
    done
    # shellcheck disable=SC2086  # one word a target
    make -j "$jobs" -f tests/platforms/programs.mk OUT="$folder" CXX="$compiler" FLAGS="$flags" LINK="$link" EXE="$exe" \
        THREADS="$threads" $targets >"$folder/build.log" 2>&1 && return
    grep -m 5 -E 'error|Error' "$folder/build.log" || true
    return 1
}

# try PROGRAM ARGUMENT...: runs it with $run; what it says in $folder/PROGRAM.txt, and what it and $run complain of in
# $folder/PROGRAM.err
try() {
    program=$1
    shift
    # shellcheck disable=SC2086  # several words
    timeout 1200 $run "$folder/$program$exe" "$@" >"$folder/$program.log" 2>"$folder/$program.err" && code=0 || code=$?
    tr -d '\r' <"$folder/$program.log" >"$folder/$program.txt"
    [ "$code" -eq 0 ] && return
    tail -n 15 "$folder/$program.txt" "$folder/$program.err" | cut -c 1-200
    return 1
}

# judged PROGRAM: what the table says of a program that ran
judged() {
    case $1 in
    lists)
        grep -v '^tiers' "$folder/lists.txt" >"$folder/lists.same"
        cmp -s "$out/reference" "$folder/lists.same" && echo "same lists" && return
        diff "$out/reference" "$folder/lists.same" >&2
        return 1
        ;;
    unit | guest) sed -n 's/.* assertions: *\([0-9]*\) .*/\1 assertions/p' "$folder/$1.txt" ;;
    c) cat "$folder/c.txt" ;;
    esac
}

# platform NAME WORDS PACKAGES TIERS [RUN [EXE [PROGRAMS [FOLDER]]]]: with $compiler, $flags and $link
#   TIERS  the instruction sets that must be there, or `any`
#   RUN    what runs a program that this machine doesn't
platform() {
    name=$1 words=$2 packages=$3 tiers=$4 run=${5-} exe=${6-} programs=${7:-$all}
    is_wanted "$name" "$words" "${8-}" || return 0
    # shellcheck disable=SC2086  # one word a package
    get "$name" $packages || { result "$name" "$words" - "FAILED: what it needs is not to be had"; return 0; }
    # shellcheck disable=SC2086  # one word a program
    build "$exe" $programs || { result "$name" "$words" - "FAILED to build, see $folder/build.log"; return 0; }
    said=
    for program in $programs; do
        case $name:$program in
        # A request of more memory than there is ends the program there.
        address:unit) argument="--no-colors=true --source-file-exclude=*/memory.cpp" ;;
        *:unit) argument=--no-colors=true ;;
        wasm:lists | wasm-simd:lists) argument=60 ;;
        *:lists) argument="60 threads" ;;
        *) argument= ;;
        esac
        # shellcheck disable=SC2086  # or none
        try "$program" $argument && verdict=$(judged "$program") && [ -n "$verdict" ] ||
            verdict="FAILED: $program, see $folder/$program.txt"
        said="$said${said:+, }$verdict"
    done
    has=$(sed -n 's/^tiers: //p' "$folder/lists.txt")
    [ "$tiers" = any ] || [ "$tiers" = "$has" ] || said="FAILED: tiers are $has, not $tiers; $said"
    result "$name" "$words" "$has" "$said"
}

# On this machine. Its lists are what all others are held against.
host="g++-12 make doctest-dev libglm-dev"
# Debian's libc++ 14 and 19 cannot be installed side by side: the older one is unpacked here.
libcxx=$out/libc++-14.files/usr/lib/llvm-14
start_wine() {
    wine_prefix=$out/wine
    export WINEPREFIX="$wine_prefix" WINEDEBUG=-all WINEDLLOVERRIDES="mscoree=;mshtml=;winemenubuilder.exe="
    timeout 300 wine wineboot -i >"$out/wine.log" 2>&1
}
# get NAME PACKAGE...: what a platform needs
get() {
    name=$1
    shift
    (install_packages "$@") || return 1
    case $name in
    neighbours) unpack_packages "$out/qt" qtbase5-dev ;; # of Qt the headers alone are read
    libc++-14) unpack_packages "$out/libc++-14.files" libc++-14-dev libc++abi-14-dev ;;
    windows) start_wine ;;
    esac
}

# with COMPILER FLAGS [LINK [THREADS]]: for the platforms that follow; THREADS is the flag for them, -pthread if not told
with() {
    compiler=$1 flags=$2 link=${3-} threads=${4--pthread}
}
prepare() {
    # shellcheck disable=SC2086  # one word a package
    install_packages $host
    make_build_folder
    jobs=$(nproc)
    # A cross compiler does not look where header-only libraries are.
    mkdir -p "$out/headers" "$out/gcc"
    for library in doctest glm; do
        ln -sfn /usr/include/$library "$out/headers/$library"
    done
    : >"$out/table.md"
    echo "$me: building the lists that all others are held against"
    folder=$out/gcc run='' exe=''
    with g++-12 "-std=c++20"
    build "" lists || fail "the lists do not compile"
    try lists || fail "the lists differ by the instruction set"
    grep -v '^tiers' "$folder/lists.txt" >"$out/reference"
}
[ -n "$listing" ] || prepare

with g++-12 "-std=c++20"
platform gcc "g++ 12, C++20" "" any
platform no-avx "the same on an x86-64 without AVX (qemu, Nehalem)" qemu-user-static "scalar simd128" "qemu-x86_64-static -cpu Nehalem" "" "$all" gcc
platform no-sse4 "the same on an x86-64 without SSE4.1 (qemu, Conroe)" qemu-user-static "scalar" "qemu-x86_64-static -cpu Conroe" "" "$all" gcc
platform no-avx512 "the same without AVX-512 (qemu, Haswell)" qemu-user-static "scalar simd128 avx2" "qemu-x86_64-static -cpu Haswell" "" "$all" gcc
with g++-12 "-std=c++23"
platform gcc-23 "g++ 12, C++23" "" any
with g++-12 "-m32 -msse2 -mfpmath=sse -std=c++20 -idirafter/usr/include/x86_64-linux-gnu"
platform x86-32 "32-bit x86, g++ 12" g++-12-multilib scalar

with clang++-14 "-std=c++20"
platform clang-14 "clang 14, libstdc++, C++20" clang-14 any
with clang++-14 "-std=c++2b"
platform clang-14-23 "clang 14, libstdc++, C++23" clang-14 any
with clang++-19 "-std=c++20"
platform clang-19 "clang 19, libstdc++, C++20" clang-19 any
with clang++-19 "-std=c++23"
platform clang-19-23 "clang 19, libstdc++, C++23" clang-19 any
with clang++-19 "-std=c++20 -stdlib=libc++"
platform libc++-19 "clang 19, libc++, C++20" "clang-19 libc++-19-dev libc++abi-19-dev" any
with clang++-19 "-std=c++23 -stdlib=libc++"
platform libc++-19-23 "clang 19, libc++, C++23" "clang-19 libc++-19-dev libc++abi-19-dev" any

with clang++-14 "-std=c++20 -nostdinc++ -isystem $libcxx/include/c++/v1" \
    "-nostdlib++ -L$libcxx/lib -Wl,-Bstatic -lc++ -lc++abi -Wl,-Bdynamic -ldl"
platform libc++-14 "clang 14, libc++, C++20" clang-14 any
with x86_64-w64-mingw32-g++-posix "-std=c++20" "-static"
platform windows "Windows (Wine), MinGW g++ 12" "g++-mingw-w64-x86-64-posix wine wine64" "scalar simd128" wine .exe

with aarch64-linux-gnu-g++ "-std=c++20" "-static"
platform aarch64 "64-bit ARM (qemu), g++ 12" "g++-aarch64-linux-gnu qemu-user-static" "scalar simd128" qemu-aarch64-static
with clang++-19 "--target=aarch64-linux-gnu -std=c++20" "-static"
platform aarch64-clang "64-bit ARM (qemu), clang 19" "clang-19 g++-aarch64-linux-gnu qemu-user-static" "scalar simd128" qemu-aarch64-static
with arm-linux-gnueabihf-g++ "-std=c++20 -mfpu=neon-vfpv4 -Wno-psabi" "-static"
platform arm-32 "32-bit ARM (qemu), g++ 12" "g++-arm-linux-gnueabihf qemu-user-static" scalar qemu-arm-static
with s390x-linux-gnu-g++ "-std=c++20" "-static"
platform s390x "big-endian: IBM Z (qemu), g++ 12" "g++-s390x-linux-gnu qemu-user-static" scalar qemu-s390x-static

# Debian's emscripten asks for a module that lies where its node does not look; and its loader takes node's fetch() for
# a browser's.
export NODE_PATH=/usr/share/nodejs
emscripten_link="-fexceptions -sINITIAL_MEMORY=1GB -sEXIT_RUNTIME=1"
node="node --no-experimental-fetch"
simd="-std=c++20 -fexceptions -msimd128"
with em++ "-std=c++20 -fexceptions" "$emscripten_link" ""
platform wasm "WebAssembly (node), emscripten 3.1.6" "emscripten node-acorn nodejs" scalar "$node" .js
with em++ "$simd" "$emscripten_link" ""
platform wasm-simd "the same with simd128" "emscripten node-acorn nodejs" "scalar simd128" "$node" .js
with em++ "$simd" "$emscripten_link -sPTHREAD_POOL_SIZE=32"
platform wasm-threads "the same with threads" "emscripten node-acorn nodejs" "scalar simd128" "$node" .js lists

with g++-12 "-std=c++20 -O1 -g -fsanitize=address,undefined -fno-sanitize-recover=all"
platform address "address and undefined behaviour sanitizer, g++ 12" "" any "" "" "$all c guest"
with clang++-19 "-std=c++20 -O1 -g -fsanitize=thread"
platform thread "thread sanitizer, clang 19" "clang-19 libclang-rt-19-dev" any "" "" lists
# Only what is compiled here says what it has written: no test library, no compiled part of the standard one.
with clang++-19 "-std=c++20 -O1 -g -fsanitize=memory -D_GLIBCXX_EXTERN_TEMPLATE=0"
platform memory "memory sanitizer, clang 19" "clang-19 libclang-rt-19-dev" scalar "" "" lists

# script NAME WORDS PACKAGES PATH ARGUMENT...: a script of the tests', whose last line goes into the table
script() {
    name=$1 words=$2 packages=$3 path=$4
    shift 4
    is_wanted "$name" "$words" || return 0
    said="FAILED, see $folder/log.txt"
    # shellcheck disable=SC2086  # one word a package
    get "$name" $packages && sh "tests/$path" "$@" >"$folder/log.txt" 2>&1 && said=$(tail -n 1 "$folder/log.txt")
    result "$name" "$words" - "$said"
}
for version in 14 19; do
    script compile-$version "no warning, clang $version" "clang-$version g++-aarch64-linux-gnu" guest/compile.sh clang++-$version
    script standards-$version "C++17 is refused in a sentence, clang $version" clang-$version guest/standards.sh clang++-$version
    script c-$version "lightbin.h in each language, clang $version" clang-$version \
        c/languages.sh clang-$version clang++-$version
done
script refused-19 "mistakes are refused in a sentence, clang 19" clang-19 guest/refused.sh clang++-19
script two-units "differently compiled units in one program, g++ 12" qemu-user-static \
    guest/two_units.sh g++-12 qemu-x86_64-static "$out/headers"
script open-alone "each file alone, g++ 12" "" guest/open_alone.sh g++-12
script flavours "each flag for instructions in the namespace's name, g++ 12, clang 19" clang-19 guest/flavours.sh g++-12 clang++-19
script neighbours "behind the headers of Qt and X11, g++ 12" libx11-dev guest/neighbours.sh g++-12 "$out/qt/usr/include/x86_64-linux-gnu/qt5"
script c-size "lightbin.h: size, and without exceptions, g++ 12" "" c/size.sh --check
script c-windows "lightbin.h: a DLL, MinGW g++ 12" "g++-mingw-w64-x86-64-posix wine wine64" c/mingw.sh x86_64-w64-mingw32-g++-posix
# Microsoft's compiler, as far as clang keeps its rules: code is made of all, and each header is read alone. Not run.
script microsoft "Microsoft's rules, clang 19, C++20 and C++23" "clang-19 libc++-19-dev mingw-w64-x86-64-dev binutils" \
    guest/microsoft.sh "$out/headers"

[ -z "$listing" ] || exit 0
for name in $wanted; do
    case "$found " in
    *" $name "*) ;;
    *) fail "there is no platform '$name'; --list names them" ;;
    esac
done
echo "$me: on $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)"
echo "| platform | instruction sets | what ran |"
echo "| --- | --- | --- |"
cat "$out/table.md"
[ -z "$failed" ] || fail "not every platform passed:$failed"
