#!/bin/bash
# All C++ and GLSL is formatted by clang-format 19 with .clang-format. Its other versions differ in details.
. "$(dirname "$0")/common.sh"
formatter=$(command -v clang-format-19) || skip "no clang-format-19 here"
cd "$CRESCENT_SOURCE" || exit 1

# formatted FILE: FILE taken as C++.
formatted() { "$formatter" --assume-filename="$CRESCENT_SOURCE/src/x.cpp" --dry-run -Werror <"$1" 2>/dev/null; }

# It finds a file that is not formatted.
printf 'int  twice(int x)\n{ return 2*x; }\n' >"$work/planted"
formatted "$work/planted" && die "an unformatted function is not found"

for folder in include src apps python tests bench examples tools; do
    [ -d "$folder" ] && find "$folder" \( -name '*.h' -o -name '*.cpp' \) -print0
done | xargs -0 -P 2 -n 40 "$formatter" --dry-run -Werror >"$work/found" 2>&1 ||
    die "$(grep -m 20 'error:' "$work/found")
format them: clang-format-19 -i FILE"
while read -r shader; do
    formatted "$shader" || die "$shader is not formatted: clang-format-19 --assume-filename=src/x.cpp <$shader"
done < <(find src/gl -name '*.glsl')
