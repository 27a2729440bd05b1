#!/bin/bash
# The documentation and the comments of code have no retired word of tools/retired-words.txt (codespell), and every
# relative link of README.md, CONTRIBUTING.md, SECURITY.md and docs/*.md leads to a file and a heading that exist.
. "$(dirname "$0")/common.sh"
command -v python3 >/dev/null || skip "no python3 here"
list=$CRESCENT_SOURCE/tools/retired-words.txt
prose=$CRESCENT_SOURCE/tests/system/docs/prose.py
pages() { (cd "$CRESCENT_SOURCE" && ls README.md CONTRIBUTING.md SECURITY.md docs/*.md); }
mapfile -t pages < <(pages)
[ "${#pages[@]}" -gt 10 ] || die "too few pages: ${pages[*]}"

# A link to a missing file and one to a missing heading are found; others, and code, are not.
cat >other.md <<'PAGE'
# A page: `code` & more
## Twice
## Twice
PAGE
cat >linked.md <<'PAGE'
[to it](other.md), [to its heading](other.md#a-page-code--more), [the second](other.md#twice-1), `[code](none.md)`
[missing](none.md)
and [a heading
over two lines](other.md#nowhere) [outside](https://example.org/none)
PAGE
expect 1 python3 "$prose" links linked.md
diff printed - <<'FOUND' || die "these links are not found as planted"
linked.md:2: none.md: no such file
linked.md:3: other.md#nowhere: no such heading
FOUND
(cd "$CRESCENT_SOURCE" && python3 "$prose" links "${pages[@]}") >found || die "$(cat found)"

command -v codespell >/dev/null || skip "no codespell here; the links are right"
# Phrases of the list are searched as such: codespell looks up what this pattern finds, by default single words.
phrases=$(sed -n 's/^\([^#>]* [^>]*\)->.*/\1/p' "$list" | paste -sd '|')
retired() { codespell -D "$list" --regex "(?i)\b(?:$phrases)\b|[\w'’-]+" "$@" >"$work/found" 2>&1; }

# A retired word is found, and a phrase over the end of a line; the same in code is not.
cat >planted.md <<'PAGE'
The program was told, and the
note says so.

`told`, `the note`
```text
told
```
PAGE
mkdir planted
python3 "$prose" text planted planted.md
! retired planted || die "retired words are not found"
[ "$(grep -c 'planted/planted.md:1: ' found)" -eq 2 ] && [ "$(wc -l <found)" -eq 2 ] ||
    die "not as planted: $(cat found)"

(cd "$CRESCENT_SOURCE" && python3 "$prose" text "$work/prose" "${pages[@]}") || die "no prose"
sed -i '/^|/d' prose/docs/error-rates.md  # its tables have the names of samplers and faults
(cd prose && retired .) || die "retired words (tools/retired-words.txt):
$(cat found)"

# Comments and docstrings of these folders.
folders="include src apps python tests bench examples tools cmake"
comments=$CRESCENT_SOURCE/tests/system/docs/comments.py

# They are found in each language, over the end of a line too; strings and words in backticks are not comments.
mkdir planted/code
printf '%s\n' 'auto a = "told // told";  // told' '' '/// the' '/// note, `told`' >planted/code/a.cpp
printf '%s\n' 'const a = `told // told`; // told' '' '/** It is the' ' *  note. */' >planted/code/a.ts
printf '%s\n' "'''The" "note.'''" 'a = "told # told"  # told' >planted/code/a.py
printf '%s\n' '#!/bin/told' 'echo "told # told"  # told' '' '# the' '# note' >planted/code/a.sh
(cd planted/code && python3 "$comments" "$work/commented" a.cpp a.ts a.py a.sh) || die "no comments"
(cd commented && retired .)
[ "$(sed -E 's/^\.\/(.*): .* ==.*/\1/' found | sort | uniq -c | awk '{ print $2, $1 }' | paste -sd ' ')" = \
    "a.cpp:1 1 a.cpp:3 1 a.py:1 2 a.sh:2 1 a.sh:4 1 a.ts:1 1 a.ts:3 1" ] || die "not as planted: $(cat found)"

mapfile -t sources < <(
    cd "$CRESCENT_SOURCE" || exit 1
    # shellcheck disable=SC2086  # lists of folders
    find $folders \( -name node_modules -o -name build \) -prune -o -type f \( -name '*.cpp' -o -name '*.h' -o \
        -name '*.py' -o -name '*.ts' -o -name '*.sh' -o -name '*.glsl' -o -name '*.cmake' -o -name CMakeLists.txt \) \
        -print | sort
)
[ "${#sources[@]}" -gt 300 ] || die "too few sources: ${sources[*]}"
(cd "$CRESCENT_SOURCE" && python3 "$comments" "$work/code" "${sources[@]}") || die "no comments"
(cd code && retired .) || die "retired words (tools/retired-words.txt) in comments:
$(cat found)"
