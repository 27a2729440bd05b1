#!/bin/bash
# tests/planted/run.sh [NAME...]: breaks the sources by each patch of this folder (or by these) in a copy of the tree,
# builds the program of the test that the patch names, and expects that test to fail, and to pass without the patch. By
# hand: a build of its own, then about half a minute a patch.
#
# A patch is one changed line, after two lines of text: what a user would lose, and `test: CTEST_NAME [FILTER]`: of
# GoogleTest, or of pytest.
# PLANTED_BUILD: a folder for the copy and its build, which the next call uses again; else a temporary one.
set -u
root=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../.." && pwd)
here=$root/tests/planted
work=${PLANTED_BUILD:-$(mktemp -d)}
source=$work/source build=$work/build log=$work/log
planted=$work/planted                           # the patch that is applied, if any
python=$root/build/python-test/bin/python       # of `./test --all`; without it, tests of Python are skipped
. "$root/tools/targets.sh"
seen=0 missed=0 skipped=0

# change [-R]: applies the patch $planted to the copy, or reverts it.
change() { patch -d "$source" -p1 --no-backup-if-mismatch -s "$@" <"$planted"; }
clean_up() {
    [ -n "${PLANTED_BUILD:-}" ] || { rm -rf "$work" && return; }
    [ ! -f "$planted" ] || { change -R && rm "$planted"; }
}
trap clean_up EXIT
trap 'exit 130' INT TERM

# build TEST: what the test needs.
build() {
    local target
    target=$(target_of_test "$1")
    [ "$1" != python ] || { [ -x "$python" ] || return 0; target=crescent_python; }
    ninja -C "$build" "${target:-crescent_every_part}" >"$log" 2>&1
}

# passes TEST FILTER: 0 it passes, 1 it fails, 77 it was skipped or there is no such test.
passes() {
    local test=$1 filter=$2 program got=0
    program=$(find "$build/" -type f -name "$(target_of_test "$test")" -perm -u+x | head -n 1)
    case $test in
    unit-* | conformance)
        [ -n "$program" ] || return 77
        # What the test of ctest runs, without its shard.
        case $test in
        unit-gl-*) export CRESCENT_GL_CONTEXT=${test#unit-gl-} ;;
        unit-film) ;;
        unit-*) export CRESCENT_TEST_FOLDER=src/${test#unit-} ;;
        esac
        timeout 600 "$program" --gtest_brief=1 --gtest_filter="${filter:-*}" >>"$log" 2>&1 || got=$?
        unset CRESCENT_GL_CONTEXT CRESCENT_TEST_FOLDER
        grep -q '0 tests from 0 test suites ran' "$log" && return 77
        ;;
    python)  # links to the package's files: only the module is built
        [ -x "$python" ] || return 77
        PYTHONPATH=$build/python "$python" -m pytest -q -p crescent.pytest_plugin -p no:cacheprovider \
            "$source/python/tests" ${filter:+-k "$filter"} >>"$log" 2>&1 || got=$?
        ;;
    *)
        ctest --test-dir "$build" --output-on-failure -R "^$test\$" >>"$log" 2>&1 || got=$?
        grep -qE '\*\*\*Skipped|No tests were found' "$log" && return 77
        ;;
    esac
    case $got in
    0) return 0 ;;
    77) return 77 ;;
    *) return 1 ;;
    esac
}

declare -A without  # whether a test passes without any patch

# plant NAME: prints one line and counts it.
plant() {
    local name=$1 patch=$here/$1.patch test filter got=0
    miss() { echo "MISSED $name$1" && missed=$((missed + 1)); }
    [ -f "$patch" ] || { miss ": there is no $patch" && return; }
    read -r test filter < <(sed -n '2s/^test: //p' "$patch")
    if [ "$(sed -n '/^@@/,$p' "$patch" | grep -c '^[-+]')" -ne 2 ] || [ -z "$test" ]; then
        miss ": expected 'test: NAME' in its second line and one changed line" && return
    fi
    if ! patch -d "$source" -p1 --no-backup-if-mismatch --dry-run -s <"$patch" >"$log" 2>&1; then
        miss ": the patch does not apply: $(head -n 1 "$log")" && return
    fi
    if [ "${without[$test $filter]}" = 1 ]; then
        miss ": $test $filter fails without it" && return
    fi
    cp "$patch" "$planted" && change
    if ! build "$test"; then
        miss ": it does not compile: $(grep -m 1 'error:' "$log")"
    else
        passes "$test" "$filter" || got=$?
        case $got in
        0) miss " ($test${filter:+ $filter})" ;;
        77) echo "skipped $name ($test${filter:+ $filter}): it cannot run here" && skipped=$((skipped + 1)) ;;
        *) echo "seen $name ($test${filter:+ $filter})" && seen=$((seen + 1)) ;;
        esac
    fi
    change -R && rm "$planted"
}

mkdir -p "$source"
[ ! -f "$planted" ] || { change -R && rm "$planted"; }  # of a call that was killed
# The tree as it is, with what is not committed. Files that have not changed keep their times, and are not compiled again.
(cd "$root" && git ls-files -z --cached --others --exclude-standard | xargs -0 cp -pu --parents -t "$source") || exit 3
export CCACHE_BASEDIR=$work CCACHE_NOHASHDIR=1
if [ ! -f "$build/build.ninja" ]; then
    module=()
    [ ! -x "$python" ] || module=(-DCRESCENT_PYTHON=ON "-DPython_EXECUTABLE=$python")
    (cd "$source" && cmake --preset release -B "$build" -DCRESCENT_UNITY=OFF -DCRESCENT_ISAS=native "${module[@]}") \
        >"$log" 2>&1 ||
        { tail -n 20 "$log" && exit 3; }
fi
names=("$@")
[ $# -gt 0 ] || mapfile -t names < <(cd "$here" && ls -- *.patch | sed 's/\.patch$//')
for name in "${names[@]}"; do  # all tests of the unchanged tree first: its programs are built once
    read -r test filter < <(sed -n '2s/^test: //p' "$here/$name.patch" 2>"$log")
    [ -n "${test:-}" ] && [ -z "${without[$test $filter]:-}" ] || continue
    build "$test" || { tail -n 20 "$log" && exit 3; }
    got=0 && passes "$test" "$filter" || got=$?
    without[$test $filter]=$got
done
for name in "${names[@]}"; do plant "$name"; done
printf '%d passed, %d failed, %d skipped\n' "$seen" "$missed" "$skipped"
[ "$missed" -eq 0 ]
