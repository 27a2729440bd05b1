#!/bin/bash
# The folders of src/ depend on each other as CMakeLists.txt states, which the build itself checks; this shows that a
# wrong include makes it fail. Programs, examples and benchmarks include only the public headers and their own files.
. "$(dirname "$0")/common.sh"
cd "$CRESCENT_SOURCE" || exit 1

mkdir -p "$work/src/base" "$work/src/scene"
printf '#include "scene/scene.h"\n' >"$work/src/base/wrong.h"
check() { cmake -DROOT="$1" -DNAME="$2" "-DALLOWED=$2" -DSTAMP="$work/stamp" -P cmake/check_includes.cmake; }
! check "$work/src" base >"$work/said" 2>&1 || die "a wrong include passes"
tr -s ' \n' ' ' <"$work/said" | grep -q 'src/base does not depend on scene' || die "the wrong include is not named: $(cat "$work/said")"
check "$work/src" scene >"$work/said" 2>&1 || die "no include at all fails: $(cat "$work/said")"

awk '
    !/^[ \t]*#[ \t]*include[ \t]*"/ { next }
    {
        split($0, quoted, "\"")
        target = quoted[2]
        # The program links the known samplers; bench/ compares kernels with its own headers.
        if (target ~ /^crescent\// || target ~ /^tests\/known_samplers\//) next
        dir = FILENAME; sub(/[^\/]*$/, "", dir)
        split(FILENAME, from, "/"); app = from[1] == "apps" ? from[1] "/" from[2] "/" : from[1] "/"
        if (system("test -f \"" dir target "\" -o -f \"" app target "\"") != 0) {
            print FILENAME ":" FNR ": " target ": neither a public header nor a file of the program"; bad = 1
        }
    }
    END { exit bad }
' $(find apps python bench examples \( -name '*.cpp' -o -name '*.h' \) ! -name '*_test.cpp') || exit 1
