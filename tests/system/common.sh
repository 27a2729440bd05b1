# Shared by the scripts of this folder. They get the program as $CRESCENT and the repository as $CRESCENT_SOURCE; each
# works in a folder of its own, and ends at the first failure.
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

# expect CODE COMMAND...: runs it, storing stderr in `said` and stdout in `printed`; another exit code ends the script.
expect() {
    local code=$1 got=0
    shift
    "$@" >printed 2>said || got=$?
    [ "$got" -eq "$code" ] || die "exit $got, expected $code: $*
$(tail -n 40 printed said)"
}

# build_example NAME [OPTION...]: installs the build into prefix/, then builds examples/NAME against it, outside the
# tree, in NAME/build.
build_example() {
    expect 0 cmake --install "${CRESCENT_BUILD:?the build folder}" --prefix "$work/prefix"
    cp -r "$CRESCENT_SOURCE/examples/$1" "$1"
    expect 0 cmake -S "$1" -B "$1/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="${CXX:-g++}" \
        -DCMAKE_PREFIX_PATH="$work/prefix" "${@:2}"
    expect 0 cmake --build "$1/build"
}

# same_outputs A B: equal except for what varies from run to run.
same_outputs() { diff -r -x timing.json "$1" "$2" >difference || die "$1 and $2 differ: $(head -n 5 difference)"; }
