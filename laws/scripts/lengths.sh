#!/bin/bash
# Files that a person can read in one sitting: at most 300 lines.
. "$(dirname "$0")/common.sh"
cd "$CRESCENT_SOURCE" || exit 1

long=$(find src cli gl explainer python laws bench examples tools \( -name '*.cpp' -o -name '*.h' -o -name '*.sh' -o -name '*.py' -o -name '*.glsl' \) -exec awk 'END { if (FNR > 300) print FILENAME ": " FNR " lines" }' {} \; 2>/dev/null)
[ -z "$long" ] || die "$long"
