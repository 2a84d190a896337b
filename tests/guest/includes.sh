#!/bin/sh
# The library includes nothing but itself and the C++ standard library, whose headers alone are lower-case words
# without an ending.
set -eu
cd "$(dirname "$0")/../../include"
includes=$(grep -rnE '^[[:space:]]*#[[:space:]]*(include|import)' lightbin)
foreign=$(echo "$includes" | grep -vE '#include <([a-z_]+|lightbin/[a-z_/]+\.hpp)>$') || true
[ -z "$foreign" ] || { echo "$foreign"; exit 1; }
echo "$(echo "$includes" | wc -l) includes, none foreign"
