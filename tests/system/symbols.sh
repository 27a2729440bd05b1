#!/bin/bash
# No part of crescent calls a transcendental function of the C library, whose last bit depends on the machine. math/ has
# them.
. "$(dirname "$0")/common.sh"
command -v nm >/dev/null || skip "no nm here"

one='a?(sin|cos|tan)h?|sincos|atan2|exp|exp2|exp10|expm1|log|log2|log10|log1p|pow|cbrt|hypot|[lt]gamma|erfc?'
one+='|c(abs|arg|exp|log|pow|sqrt)'
calls() { nm -A -u "$@" 2>/dev/null | grep -E " U ($one)[fl]?(@.*)?$"; }

# It finds one that exists.
printf '#include <math.h>\ndouble twice(double x) { return 2 * cos(x); }\n' >planted.c
if "${CXX:-g++}" -x c -c planted.c -o planted.o 2>/dev/null; then
    calls planted.o >/dev/null || die "a call of cos is not found"
fi

# The known samplers in single precision compute as a user's do: with the C library.
mapfile -t parts < <(
    # Deeper ones are other builds.
    find "${CRESCENT_BUILD:?the build folder}" -maxdepth 2 -name 'libcrescent_*.a' ! -name 'libcrescent_known_samplers.a'
    find "$CRESCENT_BUILD/apps" "$CRESCENT_BUILD/src/gl" -name '*.cpp.o' 2>/dev/null |
        grep -v _test
)
[ "${#parts[@]}" -gt 8 ] || die "too few parts: ${parts[*]}"
calls "${parts[@]}" >found
[ -s found ] && die "calls of the C library's functions:
$(cat found)"
exit 0
