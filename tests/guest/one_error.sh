# one_error KIND EXPECTED WHAT COMMAND...: the command, a compiler's, fails, and says one line of that KIND, and it matches
# EXPECTED; both are extended regular expressions of grep's. WHAT is told where it is not so. Read by scripts.
one_error() {
    kind=$1 expected=$2 what=$3
    shift 3
    if said=$(LC_ALL=C "$@" 2>&1); then
        echo "accepted: $what" >&2
        exit 1
    fi
    about=$(echo "$said" | grep -E "$kind" | grep -vE '^[0-9]+ errors? generated|^ ')
    [ "$(echo "$about" | wc -l)" -eq 1 ] && echo "$about" | grep -qE "$expected" && return
    printf '%s\nsaid of: %s\n' "$said" "$what" >&2
    exit 1
}
