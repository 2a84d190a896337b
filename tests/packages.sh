# What the scripts share that a person runs. They read it at the top folder, after naming themselves in $me.

fail() {
    echo "$me: $*" >&2
    exit 1
}

# Prints the version of the library.
library_version() {
    sed -n 's/^#define LIGHTBIN_VERSION_[A-Z]* //p' include/lightbin/version.hpp | paste -s -d .
}

# Prints the comment at the script's head and ends.
help() {
    sed -n '2,/^set/s/^# \{0,1\}//p' "$me"
    exit
}

# takes WHAT PATTERN WORD...: sees to a script's WORDs before anything is installed: prints the help where one asks for it, and
# refuses what does not fit the PATTERN, an extended one of grep's. WHAT names what does.
takes() {
    what=$1 pattern=$2
    shift 2
    for word; do
        case $word in
        -h | --help) help ;;
        esac
        printf '%s\n' "$word" | grep -qxE -e "$pattern" || fail "cannot do '$word': it takes ${what:+$what or }--help"
    done
}

# Installs those of the named Debian packages that are not there yet, and says so first. Where all are there,
# apt-get is not called, so that no network is needed.
install_packages() {
    for tool in apt-get dpkg-query; do
        command -v $tool >/dev/null || fail "there is no $tool here: this script sets up Debian 12." \
            "Elsewhere, install what matches these packages and use the CMake presets: $*"
    done

    missing=
    for package in "$@"; do
        [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] ||
            missing="$missing $package"
    done
    [ -n "$missing" ] || return 0

    [ -z "$root" ] || command -v sudo >/dev/null || fail "needs root, or sudo, to install these packages:$missing"
    echo "$me: installing these Debian packages${root:+ (with sudo)}:$missing"

    log=$(mktemp)
    # A package list that cannot be fetched is no matter as long as the packages can be.
    apt_get update >"$log" 2>&1 || true
    # shellcheck disable=SC2086  # one word a package
    apt_get install -y --no-install-recommends $missing >>"$log" 2>&1 ||
        fail "the packages could not be installed (is there a network?): $(last_error) (all of it: $log)"
    rm -f "$log"
}

# fetch_npm FOLDER PACKAGE@VERSION...: npm packages in FOLDER/node_modules, fetched unless these versions are there. The
# JavaScript of tests finds them by MODULES.
fetch_npm() {
    fetched=$1
    shift
    mkdir -p "$fetched"
    export MODULES="$PWD/$fetched/node_modules"
    for package; do
        # The prefix keeps it here: npm otherwise looks for a project in the folders above.
        grep -qs '"version": "'"${package##*@}"'"' "$fetched/node_modules/${package%@*}/package.json" ||
            npm install --prefix "$fetched" --cache "$fetched/npm.cache" --no-save --ignore-scripts --no-audit \
                --no-fund "$@" >"$fetched/npm.log" 2>&1 ||
            { cat "$fetched/npm.log"; fail "npm could not install $package"; }
    done
}

# unpack_packages FOLDER PACKAGE...: the files of Debian packages, but not what they depend on, unpacked in FOLDER.
unpack_packages() {
    unpacked=$1
    shift
    [ ! -e "$unpacked/unpacked" ] || return 0
    mkdir -p "$unpacked"
    (cd "$unpacked" && { apt-get -q download "$@" || { apt_get update && apt-get -q download "$@"; }; } >download.log 2>&1 &&
        for package in *.deb; do dpkg -x "$package" . || exit 1; done && touch unpacked)
}

root=
[ "$(id -u)" -eq 0 ] || root=sudo
apt_get() {
    $root env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300 "$@"
}

# What apt-get says, or where it did not even start, sudo.
last_error() {
    { grep '^E:' "$log" || cat "$log"; } | tail -n 1
}

# Both scripts build below build/; a run as root may have left it to root.
make_build_folder() {
    mkdir -p build && [ -w build ] || fail "cannot write to $(pwd)/build"
}

# build_npm_package [PACKAGE...]: makes build/npm/lightbin, which is LIGHTBIN to the JavaScript of tests, and installs
# what that takes and the packages.
build_npm_package() {
    install_packages nodejs emscripten node-acorn binaryen esbuild "$@"
    command -v npm >/dev/null || install_packages npm
    make_build_folder
    sh packaging/npm/build.sh
    export LIGHTBIN="$PWD/build/npm/lightbin"
}

# run_node_tests FILE LOG: runs tests of node, and says which passed. Where one fails, so does the script.
run_node_tests() {
    node_failed=
    node --test-reporter=spec "$1" >"$2" 2>&1 || node_failed=yes
    grep -E '^(✔|✖|    at |  [A-Z])' "$2" || true
    [ -z "$node_failed" ] || fail "not every test passed; the log is $2"
    echo "$me: every test passed"
}
