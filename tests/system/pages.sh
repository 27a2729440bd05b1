#!/bin/bash
# What the pages for readers promise: a README of one screen, at most 30,000 words written by hand, and in AGENTS.md the
# names of options and of the JSON of check as they are.
. "$(dirname "$0")/common.sh"
command -v python3 >/dev/null || skip "no python3 here"
words() { python3 "$CRESCENT_SOURCE/tests/system/docs/words.py" "$@"; }

[ "$(wc -l <"$CRESCENT_SOURCE/README.md")" -le 80 ] || die "README.md has more than 80 lines"
expect 0 words --most 30000

# Parts that programs write: none is empty, each program is there, and writing one leaves the rest of the page.
# empty_parts PAGE...: those that a program should have written and did not.
empty_parts() { awk '/^<!-- measured by /{ at = FNR } /^<!-- end of /{ if (FNR == at + 1) print $4 }' "$@"; }
printf '<!-- measured by %s -->\n%s<!-- end of %s -->\nBy hand.\n' x.py 'old
' x.py y.py '' y.py >parts.md
[ "$(empty_parts parts.md)" = y.py ] || die "a part that nothing wrote is not found: $(empty_parts parts.md)"
missing=$(empty_parts "$CRESCENT_SOURCE"/docs/*.md)
[ -z "$missing" ] || die "never measured: $missing"
PYTHONPATH=$CRESCENT_SOURCE/bench python3 -B -c 'import measured_part; measured_part.write_between("parts.md", "x.py", "new")'
printf '<!-- measured by %s -->\n%s<!-- end of %s -->\nBy hand.\n' x.py 'new
' x.py y.py '' y.py | diff parts.md - || die "more than the part is written"
for program in $(sed -n 's/^<!-- measured by \(.*\) -->$/\1/p' "$CRESCENT_SOURCE"/docs/*.md | sort -u); do
    [ -n "$(find "$CRESCENT_SOURCE"/{bench,examples} -name "$program")" ] || die "no program is $program"
done

# Code, docs/field.md and what a program measured do not count; all else does, and too much is refused.
mkdir -p tree/docs tree/examples
for page in README.md AGENTS.md llms.txt CONTRIBUTING.md SECURITY.md docs/field.md docs/error-rates.md; do
    echo "One - 2." >"tree/$page"
done
cat >tree/docs/page.md <<'PAGE'
| a | b |
|---|---|
<!-- measured by x.py -->
not these
<!-- end of x.py -->
```sh
nor these
```
1. An item

   ```sh
   nor these
   ```
PAGE
expect 0 words --root tree --most 17
expect 1 words --root tree --most 16
grep -q "have 17 words. Expected at most 16" said || die "too many words: $(cat said)"

# Each key that AGENTS.md names is one of the schema or of the evidence, and each option one of check or compare.
expect 0 "$CRESCENT" check cosine --wo 30 --quiet --json check.json
python3 - "$CRESCENT_SOURCE" <<'PY' || die "AGENTS.md names what is not there"
import re, sys
from pathlib import Path
root = Path(sys.argv[1])
page = (root / "AGENTS.md").read_text()
known = (root / "docs/check.schema.json").read_text() + Path("check.json").read_text()
json = page[page.index("In the JSON:") : page.index("Work on the first")]
keys = {key for words in re.findall(r"`([a-z_.]+)`", json) for key in words.split(".")} - {"density", "normalised"}
missing = [key for key in sorted(keys) if f'"{key}"' not in known]
assert len(keys) >= 8 and not missing, (keys, missing)
PY
"$CRESCENT" check --help >options && "$CRESCENT" compare --help >>options
for option in $(grep -o -- '`[^`]*`' "$CRESCENT_SOURCE/AGENTS.md" | grep -o -- '--[a-z]\+' | sort -u); do
    grep -q -- "$option\b" options || die "AGENTS.md names $option, which check and compare do not have"
done

# The search field of the site finds each word of a heading, bold terms, first cells of tables, variables and options,
# with their dashes and without.
mkdir -p site/search
printf 'var indexSectionsWithContent =\n{\n  0: "abr",\n  1: "b"\n};\n' >site/search/searchdata.js
for at in 0 1 2; do printf "var searchData=\n[\n  ['b_0',['b',['../b.html',1,'']]]\n];\n" >site/search/all_$at.js; done
printf '<script src="all_0.js"></script>' >site/search/all_0.html
{
    printf '<div class="title">Other things</div>'
    printf '<h1><a class="anchor" id="x1"></a>\nA <code>b</code> &amp; a Reservoir</h1>'
} >site/md_a.html
{
    printf '<div class="title">x</div><div class="textblock"><p >In RGB.</p><b>Bad tail.</b> <code>A_B</code>\n'
    printf '<tr class="r">\n<td><code>--repro FILE</code></td><td>beside</td></tr><div>compare --until it</div>'
} >site/index.html
expect 0 python3 "$CRESCENT_SOURCE/tools/site_search.py" site
found() { # KEY LABEL LINK: the search field has it.
    local letters letter=${1:0:1}
    letters=$(sed -n 's/^  0: "\(.*\)",$/\1/p' site/search/searchdata.js)
    [ "$letter" != _ ] || letter=-
    grep -q "\"$1_s[0-9]*\", \[\"$2\", \[\"../$3\"" \
        "site/search/all_$(printf %x "$(printf %s "${letters%%"$letter"*}" | wc -c)").js" ||
        die "'$1' is not found: $(cat printed site/search/*.js)"
}
found reservoir "A b & a Reservoir" md_a.html#x1
found bad_20tail "Bad tail" index.html#
found tail "Bad tail" index.html#
found a_5fb A_B index.html#
found rgb x index.html#
found repro --repro index.html#
found _2d_2drepro --repro index.html#
found _2d_2duntil --until index.html#
! grep -q beside site/search/*.js || die "other cells than the first are found"
grep -q "all_3.js" site/search/all_3.html && grep -q "^  \['b_0'" site/search/all_2.js || die "an entry is lost"
