#!/bin/bash
# One definition a name. A kernel that is compiled for an instruction set shares no function with other files: the
# linker would keep one of them for everybody, and processors without that set would stop there. No two headers define
# types of one name in one namespace.
. "$(dirname "$0")/common.sh"
cd "$CRESCENT_SOURCE" || exit 1

for isa in sse4 avx2 avx512; do
    for object in $(find "${CRESCENT_BUILD:?}" -name "kernel_$isa.cpp.o"); do
        shared=$(nm -C --defined-only "$object" | awk '$2 ~ /^[WVu]$/' | grep -v "crescent::[a-z]*::$isa::")
        [ -z "$shared" ] || die "$object shares functions with other files: $shared"
        checked=1
    done
done
[ -n "${checked:-}" ] || skip "no kernels for other instruction sets here"

awk '
    FNR == 1 { space = "" }
    /^namespace [a-z_:]+(inline [a-z_]+)? \{/ { space = $0; sub(/ \{.*/, "", space) }
    /^(struct|class|enum class) [A-Za-z_0-9]+( final)?( :[^;]*)? \{/ {
        name = $1 == "enum" ? $3 : $2
        full = space "::" name
        if (full in first && first[full] != FILENAME) {
            print FILENAME ":" FNR ": " full " is also defined in " first[full]
            bad = 1
        }
        first[full] = FILENAME
    }
    END { exit bad }
' $(find src gl explainer cli -name '*.h') || exit 1
