#!/bin/sh
# Makes a release that only has to be uploaded: `sh packaging/release.sh VERSION` on Debian 12, as root or with sudo.
# Installs the packages that are missing. Writes to build/release/VERSION the archive of the last commit, the single
# headers, the npm package, their checksums, and NOTES.md; then uses each of them in an empty folder, as a user would.
# packaging/url says where the files will be. Takes three minutes.
set -eu
export LC_ALL=C
me=packaging/release.sh
cd "$(dirname "$0")/.."
. tests/packages.sh
takes "a version" '[0-9]+\.[0-9]+\.[0-9]+' "$@"
[ $# -eq 1 ] || fail "takes a version, such as $(library_version)"

version=$1
[ "$version" = "$(library_version)" ] ||
    fail "include/lightbin/version.hpp has version $(library_version), not $version"
changes=$(awk -v version="$version" '/^## / { inside = $2 == version || $2 == version ","; next } inside' CHANGELOG.md)
[ -n "$changes" ] || fail "CHANGELOG.md has no section '## $version'"
install_packages git g++ cmake make
changed=$(git status --porcelain) || fail "the release is made of a commit, so it needs the git repository"
[ -z "$changed" ] || fail "what is released has to be committed, and these files are not:" "$changed"

out=build/release/$version archive=lightbin-$version.tar.gz npm_package=lightbin-$version.tgz
url=$(sed "s|VERSION|$version|" packaging/url)
rm -rf "$out"
mkdir -p "$out"
git archive --prefix="lightbin-$version/" -o "$out/$archive" HEAD
sh packaging/single_header.sh "$out/lightbin.hpp"
sh packaging/single_header.sh "$out/lightbin_core.hpp" core
sh packaging/single_header.sh "$out/lightbin.h" c
echo "$me: building the npm package, which takes two minutes"
build_npm_package
npm pack ./build/npm/lightbin --pack-destination "$out" --silent
(cd "$out" && sha256sum lightbin* >SHA256SUMS)
cat >"$out/NOTES.md" <<END
# lightbin $version

$changes

**Files**, which $url has; \`sha256sum -c SHA256SUMS\` checks them:

| file | what it is |
| --- | --- |
| $archive | all sources, and recipes for vcpkg, Conan and xmake: docs/install.md |
| lightbin.hpp | the library in one header, for C++20 |
| lightbin_core.hpp | of it the lists of spheres, without shader text, spots and boxes |
| lightbin.h | the library in one header for C99, and for C++ from C++11 on: docs/c.md |
| $npm_package | the package for JavaScript: \`npm install $url/$npm_package\` |

In CMake:

\`\`\`cmake
include(FetchContent)
FetchContent_Declare(lightbin URL $url/$archive
    URL_HASH SHA256=$(sed -n "s/  $archive$//p" "$out/SHA256SUMS"))
FetchContent_MakeAvailable(lightbin)
target_link_libraries(yours PRIVATE lightbin::lightbin)
\`\`\`
END

place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cp "$out"/* "$place"
sources=$place/lightbin-$version
released=$(pwd)/$out
cd "$place"
tar xzf "$archive"

# try WHAT COMMAND...: prints what the command says only if it fails
try() {
    what=$1
    shift
    echo "$me: trying $what"
    "$@" >"$place/log" 2>&1 || { cat "$place/log"; fail "$what does not work; what was tried is $released"; }
}
# cmake_project FOLDER PROGRAM [OPTION]
cmake_project() {
    cmake -S "$1" -B "$1.build" ${3+"$3"} && cmake --build "$1.build" && "$1.build/$2"
}
# header FILE NAME COMMAND...: with the file as <lightbin/NAME>, the command makes a program
header() {
    rm -rf lightbin && mkdir lightbin && cp "$1" "lightbin/$2" && shift 2 && "$@" -I . -o program && ./program
}
c_program() {
    printf '#define LIGHTBIN_IMPLEMENTATION\n#include <lightbin/lightbin.h>\n' >code.cpp
    gcc -std=c99 -pedantic -Wall -Wextra -Werror -I . -c "$sources/tests/c/contract.c" &&
        g++ -std=c++20 code.cpp contract.o "$@"
}
npm_project() {
    mkdir npm && cp "$sources/tests/consumer/main.mjs" npm &&
        npm install --prefix npm "./$npm_package" --offline --no-audit --no-fund && node npm/main.mjs
}
try "the checksums" sha256sum -c SHA256SUMS
try "$archive as a subfolder" \
    cmake_project "$sources/tests/consumer/subdirectory" consumer "-DLIGHTBIN_SOURCE=$sources"
mkdir fetched
cp "$sources/tests/consumer/main.cpp" fetched
{
    printf 'cmake_minimum_required(VERSION 3.18...4.1)\nproject(yours LANGUAGES CXX)\nadd_executable(yours main.cpp)\n'
    sed -n '/^```cmake$/,/^```$/p' NOTES.md | sed "/^\`/d; s|$url/|file://$place/|"
} >fetched/CMakeLists.txt
try "$archive by the lines for CMake in NOTES.md" cmake_project fetched yours
try "lightbin.hpp" header lightbin.hpp lightbin.hpp g++ -std=c++20 fetched/main.cpp
try "lightbin_core.hpp" header lightbin_core.hpp lightbin.hpp g++ -std=c++20 fetched/main.cpp
try "lightbin.h" header lightbin.h lightbin.h c_program
try "$npm_package" npm_project

cd "$released"
echo "$me: lightbin $version is in $out, and every file works (bytes, name):"
wc -c lightbin* SHA256SUMS NOTES.md | sed 's/^/    /'
echo "Upload all but NOTES.md, which is the text of the release, to $url; npm's way is: npm publish $npm_package"
cd ../../..
[ "$(git tag --points-at HEAD "v$version")" ] || echo "Before: git tag v$version $(git rev-parse --short HEAD)"
again="commit that, and run this again."
! grep -q '\.example/' packaging/url || echo "Before: write the address in place of packaging/url's placeholder, $again"
! grep -q "^## $version, not yet" CHANGELOG.md || echo "Before: date the section of CHANGELOG.md, $again"
