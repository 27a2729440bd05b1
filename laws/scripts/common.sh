# What the scripts of this folder share. They get the program as $CRESCENT and the repository as $CRESCENT_SOURCE; each
# works in a folder of its own, and ends with the first thing that is not so.
set -u
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
tiny="$here/tiny.toml"
: "${CRESCENT:?the program}" "${CRESCENT_SOURCE:?the repository}"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1

die() {
    printf '%s\n' "$*" >&2
    exit 1
}

skip() {
    printf 'skipped: %s\n' "$*"
    exit 77
}

# expect CODE COMMAND...: runs it, keeping what it says in `said` and `printed`; another exit code ends the script.
expect() {
    local code=$1 got=0
    shift
    "$@" >printed 2>said || got=$?
    [ "$got" -eq "$code" ] || die "exit $got, expected $code: $*
$(tail -n 40 printed said)"
}

# same_outputs A B: equal but for what varies from run to run.
same_outputs() { diff -r -x timing.json "$1" "$2" >difference || die "$1 and $2 differ: $(head -n 5 difference)"; }
