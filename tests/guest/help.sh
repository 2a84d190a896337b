#!/bin/sh
# help.sh: each script that a person runs prints the comment at its head on --help and -h, and refuses an option that it does
# not know in one line. Before it says so it starts nothing and writes nothing: it is run in a copy of the sources, where the
# programs that install, fetch and build are not those.
# Which scripts: all but those of the tests' own folders, which ctest runs; of these the ones that tell how to run them.
set -eu
export LC_ALL=C
top=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/copy" "$work/bin"
cd "$top"
tar -c --exclude=./build --exclude=./.git --exclude='*.glb' --exclude='*.png' . | tar -x -C "$work/copy"
for program in apt-get dpkg-query sudo cmake ctest make g++ g++-12 c++ clang++-14 clang++-19 em++ python3 node npm git; do
    printf '#!/bin/sh\necho "%s $*" >>"%s/started"\nexit 1\n' $program "$work" >"$work/bin/$program"
    chmod +x "$work/bin/$program"
done
export PATH="$work/bin:$PATH"

complain() {
    echo "$script $arguments: $*" >&2
    cat "$work/out" "$work/err" >&2
    exit 1
}
# try WORD...: in $code, and the files out and err, what comes of it
try() {
    arguments=$*
    find . | sort >"$work/before"
    timeout 20 sh "$script" "$@" >"$work/out" 2>"$work/err" </dev/null && code=0 || code=$?
    [ ! -e "$work/started" ] || complain "starts $(cat "$work/started")"
    find . | sort | cmp -s - "$work/before" || complain "writes files"
}

cd "$work/copy"
count=0
for script in $(find . -name '*.sh' | sed 's,^\./,,' | sort); do
    case $script in
    tests/packages.sh) continue ;; # read by the others
    tests/*/*) sed '/^[^#]/,$d' "$script" | grep -q "sh $script" || continue ;;
    esac
    for word in --help -h; do
        try $word
        [ "$code" -eq 0 ] && [ ! -s "$work/err" ] || complain "fails"
        awk 'NR > 1 && !/^#/ { exit } NR > 1 { sub(/^# ?/, ""); print }' "$script" >"$work/head"
        head -n "$(wc -l <"$work/head")" "$work/out" | cmp -s - "$work/head" && [ -s "$work/head" ] || complain "is no help"
        grep -q "sh $script" "$work/head" || complain "does not tell how to run it"
    done
    for option in --no-such-option -x --quickly; do
        try $option
        [ "$code" -ne 0 ] && [ "$code" -ne 124 ] || complain "is not refused"
        [ ! -s "$work/out" ] && [ "$(wc -l <"$work/err")" -eq 1 ] && grep -q -e "'$option'" "$work/err" || complain "is not told why"
    done
    count=$((count + 1))
done
[ "$count" -ge 15 ]
echo "$count scripts help, and refuse what they don't know"
