#!/bin/bash
# Outputs of `check`: JSON that obeys docs/check.schema.json and that equal calls repeat byte for byte, JUnit that
# states the failures, a summary that comes first and states each finding once.
. "$(dirname "$0")/common.sh"
/usr/bin/python3 -c 'import jsonschema' 2>said || die "python3-jsonschema is missing: $(cat said)"

fits() {
    /usr/bin/python3 - "$CRESCENT_SOURCE/docs/check.schema.json" "$@" <<'PY' || die "$1 does not fit the schema"
import json, sys, jsonschema
schema = json.load(open(sys.argv[1]))
jsonschema.Draft202012Validator.check_schema(schema)
for path in sys.argv[2:]: jsonschema.Draft202012Validator(schema).validate(json.load(open(path)))
PY
}
verdicts() { "$CRESCENT" list verdicts | awk '{ print $1 }'; }
check() { "$CRESCENT" check --quiet "$@"; }

expect 1 check phong --set s=32 --json a.json --junit a.xml --html a.html
expect 1 check phong --set s=32 --json b.json
cmp a.json b.json || die "equal calls differ: $(diff a.json b.json | head -n 5)"
fits a.json
expect 0 "$CRESCENT" report a.json --out again.html
[ "$(grep -c '<canvas' again.html)" = "$(grep -c '<canvas' a.html)" ] || die "crescent report: other pictures"
expect 0 "$CRESCENT" run "$tiny" --quiet --only metrics --out one
printf 'Pf\n2 1\n-1\n\0\0\200\77\0\0\200\77' >one.pfm
printf 'Pf\n2 1\n-1\n\0\0\200\77\0\0\100\77' >two.pfm
expect 0 "$CRESCENT" compare --arm a='one.pfm' --arm b='two.pfm' --allow-inconclusive --quiet --out pair
expect 0 python3 "$here/damaged_results.py" "$CRESCENT" a.json one/metrics.json pair/metrics.json
verdicts >names
sed -n 's/^   "name": "\(.*\)",$/\1/p' a.json | head -n "$(wc -l <names)" | cmp -s - names ||
    die "the verdicts of a case are not those of the list: $(cat names)"
python3 - <<'PY' || die "JUnit or HTML: $(head -c 600 a.xml)"
import re, xml.etree.ElementTree as x
root = x.parse("a.xml").getroot()
assert root.tag == "testsuites" and float(root.get("time")) > 0
cases = list(root.iter("testcase"))
assert len(cases) == int(root.get("tests")) and all(float(c.get("time")) >= 0 for c in cases)
html = open("a.html", encoding="utf-8").read()
assert "<title>phong: wrong" in html and 'class="matrix"' in html
PY

# One line per finding: the same fault at 8 w_o is reported in one line, before the table.
expect 0 "${CC:-cc}" -O2 -o slow "$here/slow.c" -lm
expect 1 check --exec './slow 100000000 0.3' --json bad.json --junit bad.xml
fits bad.json
head -n 1 printed | grep -q "identity: wrong at 8 of 8 w_o, worst at w_o" ||
    die "the summary is not first: $(head -n 3 printed)"
[ "$(grep -c "identity: wrong" printed)" -le 2 ] || die "said more than once: $(cat printed)"
grep -q '<failure message="wrong: The pdf ' bad.xml ||
    die "JUnit does not say what is wrong: $(head -c 900 bad.xml)"
