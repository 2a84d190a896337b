#!/bin/sh
# Makes a site with search of the guide and the other pages: `sh docs/site.sh [--serve]` on Debian 12, as root or with
# sudo. Installs the packages that are missing and writes to build/site. --serve serves it to this machine alone: opened
# as files, the pages have no search, as browsers allow no worker there.
set -eu
me=docs/site.sh
cd "$(dirname "$0")/.."
. tests/packages.sh
takes "--serve" "--serve" "$@"
install_packages mkdocs mkdocs-material python3-pymdownx python3-pygments
make_build_folder

# Every file is where it is here, so that links work, to sources, too.
rm -rf build/site.pages
mkdir build/site.pages
find . \( -name .git -o -path ./build \) -prune -o -type f -print0 | tar -c --null -T - | tar -x -C build/site.pages
mkdocs build --quiet --strict --config-file docs/site.yml
echo "$me: build/site/index.html is the front page"
[ $# -eq 0 ] || exec python3 -m http.server --bind 127.0.0.1 --directory build/site 8080
