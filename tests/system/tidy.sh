#!/bin/bash
# clang-tidy finds nothing in the headers that crescent/crescent.h includes, with the checks of .clang-tidy.
. "$(dirname "$0")/common.sh"
tidy=$(command -v clang-tidy-19) || skip "no clang-tidy-19 here"
cp "$CRESCENT_SOURCE/.clang-tidy" .

# tidy FILE: the findings in it and in the headers of the tree that it includes.
tidy() { "$tidy" --quiet "$1" -- -std=c++20 -I"$CRESCENT_SOURCE/src" -I"$CRESCENT_SOURCE/include" -I"$CRESCENT_SOURCE" -I"$work" 2>/dev/null; }

# It finds planted errors: a string copied instead of referenced, a fault in a header of src/.
mkdir src
printf '#include <string>\ninline bool planted(std::string text) { return text.size() == 0; }\n' >src/planted.h
printf '#include "src/planted.h"\n' >planted.cpp
tidy planted.cpp >found
grep -q "readability-container-size-empty" found || die "a planted fault is not found: $(cat found)"
grep -q "performance-unnecessary-value-param" found || die "a string that is copied is not found: $(cat found)"

printf '#include "crescent/crescent.h"\n' >face.cpp
tidy face.cpp >found || true
grep -qE "(warning|error):" found && die "$(grep -E "(warning|error):" found | head -n 20)"
exit 0
