#!/bin/bash
# Every relative link of README.md, AGENTS.md, llms.txt, CONTRIBUTING.md, SECURITY.md and docs/*.md leads to a file and a
# heading that exist.
. "$(dirname "$0")/common.sh"
command -v python3 >/dev/null || skip "no python3 here"
links=$CRESCENT_SOURCE/tests/system/docs/links.py
pages() { (cd "$CRESCENT_SOURCE" && ls README.md AGENTS.md llms.txt CONTRIBUTING.md SECURITY.md docs/*.md); }
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
expect 1 python3 "$links" linked.md
diff printed - <<'FOUND' || die "these links are not found as planted"
linked.md:2: none.md: no such file
linked.md:3: other.md#nowhere: no such heading
FOUND
(cd "$CRESCENT_SOURCE" && python3 "$links" "${pages[@]}") >found || die "$(cat found)"
