#!/bin/sh
# Runs a program on a display that nobody sees: on_xvfb.sh XVFB PROGRAM [ARGUMENT...]
set -eu
xvfb=$1
shift
number=$(mktemp)
"$xvfb" -displayfd 3 -screen 0 1280x720x24 3>"$number" 2>/dev/null &
server=$!
trap 'kill $server; rm -f "$number"' EXIT
while [ ! -s "$number" ]; do
    kill -0 $server
    sleep 0.1
done
DISPLAY=:$(cat "$number") "$@"
