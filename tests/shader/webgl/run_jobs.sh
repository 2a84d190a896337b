#!/bin/sh
# Runs a share of the jobs in a browser: run_jobs.sh FOLDER FIRST COUNT, where FOLDER holds write_webgl_jobs.
set -eu
folder=$1 page=$1/webgl.$2.html
cp "$(dirname "$0")/run_jobs.js" "$folder"
"$folder/write_webgl_jobs" "$2" "$3" >"$page"
chromium --headless --no-sandbox --user-data-dir="$folder/chromium.$2" --dump-dom "file://$page" >"$page.out" \
    2>"$page.log"
sed -n '/<body>/,$ { s/.*<body>//; s,</body>.*,,; /./p }' "$page.out"
grep -q '<title>passed</title>' "$page.out"
