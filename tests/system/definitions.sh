#!/bin/bash
# One definition per name. A kernel that is compiled for an instruction set shares no function with other files: the
# linker would keep one of them for all, and processors without that set would crash there. No two files define types of
# one name in one namespace, read from all sources; for the code that makes films g++ checks this too when it links
# (preset gcc).
. "$(dirname "$0")/common.sh"
cd "$CRESCENT_SOURCE" || exit 1

for isa in sse4 avx2 avx512; do
    for object in $(find "${CRESCENT_BUILD:?}" -name "kernel_$isa.cpp.o"); do
        shared=$(nm -C --defined-only "$object" | awk '$2 ~ /^[WVu]$/' | grep -vE "crescent::([a-z]+::)?$isa::")
        [ -z "$shared" ] || die "$object shares functions with other files: $shared"
        checked=1
    done
done
[ -n "${checked:-}" ] || skip "no kernels for other instruction sets here"

# doubles FILE...: types of one name in one namespace in two files, unless they are local to the file.
doubles() {
    awk '
        FNR == 1 { space = ""; hidden = 0 }
        /^namespace \{/ { hidden = 1 }
        /^\}  \/\/ namespace$/ { hidden = 0 }
        /^namespace [a-z_:]+ \{/ { space = $0; sub(/ \{.*/, "", space) }
        !hidden && /^(struct|class|enum class) [A-Za-z_0-9]+( final)?( :[^;]*)? \{/ {
            name = $1 == "enum" ? $3 : $2
            full = space "::" name
            if (full in first && first[full] != FILENAME) {
                print FILENAME ":" FNR ": " full " is also defined in " first[full]
                bad = 1
            }
            first[full] = FILENAME
        }
        END { exit bad }
    ' "$@"
}

# It finds two that exist, and ignores a type that an unnamed namespace keeps local to its file.
for name in a b; do printf 'namespace crescent {\nstruct Twice {\n    int %s;\n};\n}\n' "$name" >"$work/$name.cpp"; done
for name in c d; do
    printf 'namespace crescent {\nnamespace {\nstruct Own {\n};\n}  // namespace\n}\n' >"$work/$name.cpp"
done
[ "$(doubles "$work"/[a-d].cpp | wc -l)" -eq 1 ] || die "not what was planted: $(doubles "$work"/[a-d].cpp)"
doubles $(find include src apps tests \( -name '*.h' -o -name '*.cpp' \) -not -path 'tests/fuzz/*') || exit 1
