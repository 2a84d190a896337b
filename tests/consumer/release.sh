#!/bin/sh
# release.sh NPM_PACKAGE: packaging/release.sh in a small repository, in which building the npm package is copying the
# folder NPM_PACKAGE: it refuses by a sentence what is no release, and makes one of the rest.
set -eu
export LC_ALL=C
npm_package=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$(dirname "$0")/../.."
cp -r --parents .gitignore CHANGELOG.md CMakeLists.txt LICENSE include packaging tests/packages.sh tests/consumer \
    tests/c "$work"
cd "$work"
echo "mkdir -p build/npm && cp -r '$npm_package' build/npm" >packaging/npm/build.sh
mkdir build
git init -q
commit() {
    git add .
    git -c user.name=test -c user.email=test@example.com commit -qm "$1"
}
commit "The release"
version=$(. tests/packages.sh && library_version)

# refuse SENTENCE WORD...
refuse() {
    sentence=$1
    shift
    ! sh packaging/release.sh "$@" >build/said 2>&1 || { echo "not refused, but: $sentence"; exit 1; }
    grep -qF -- "$sentence" build/said || { cat build/said; echo "does not say: $sentence"; exit 1; }
}
refuse "takes a version, such as $version"
refuse "include/lightbin/version.hpp has version $version, not 9.9.9" 9.9.9
touch left_behind
refuse "has to be committed, and these files are not: ?? left_behind" "$version"
rm left_behind
sed -i "s/^## $version/## 9.9.9/" CHANGELOG.md
commit "Another section"
refuse "CHANGELOG.md has no section '## $version'" "$version"
sed -i "s/^## 9.9.9.*/## $version, 1 January 2000/" CHANGELOG.md
echo 'https://host/lightbin-VERSION' >packaging/url
commit "The date, and the address"

sh packaging/release.sh "$version" >build/log 2>&1 || { cat build/log; exit 1; }
tail -n 12 build/log
grep -q "^Before: git tag v$version" build/log
[ "$(grep -c '^Before: ' build/log)" -eq 1 ]
grep -q "npm install https://host/lightbin-$version/lightbin-$version.tgz" "build/release/$version/NOTES.md"
# The section of the CHANGELOG, and nothing of the next, is in the notes.
awk '/^## / { ++sections; next } sections == 1 && NF' CHANGELOG.md >wanted
sed '1d; /^\*\*Files\*\*/,$d' "build/release/$version/NOTES.md" | grep . | cmp - wanted
