#!/bin/bash
# `crescent compare SUITE.toml` as a build server calls it: states, exit codes, outputs, --accept, --plan; bad input is
# named with its place and nothing is written; a killed --accept leaves the old baseline or the new one.
. "$(dirname "$0")/common.sh"

expect 0 /usr/bin/python3 - <<'END'
import os, random, struct
def write(path, seed, scale=1.0, shape=25, side=24):
    rng = random.Random(seed)
    pixels = [scale * mean * rng.gammavariate(shape, 1 / shape) for _ in range(side * side) for mean in (1.0, 0.8, 0.6)]
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb") as out:
        out.write(b"PF\n%d %d\n-1.0\n" % (side, side) + struct.pack("<%df" % len(pixels), *pixels))
for k in range(8):
    for view, base, out in (("same", {}, {}), ("changed", {}, {"scale": 1.05}), ("noisier", {}, {"shape": 12}),
                            ("improved", {"shape": 12}, {})):
        write(f"base/{view}-{k}.pfm", f"{view} base {k}", **base)
        write(f"out/{view}-{k}.pfm", f"{view} out {k}", **out)
    write(f"base/gone-{k}.pfm", f"gone {k}")
    write(f"out/added-{k}.pfm", f"added {k}")
    if k < 3:
        write(f"base/few-{k}.pfm", f"few base {k}", shape=1)
        write(f"out/few-{k}.pfm", f"few out {k}", shape=1)
        write(f"base/fixed-{k}.pfm", "fixed")
        write(f"out/fixed-{k}.pfm", "fixed")
END
cat >suite.toml <<'END'
[suite]
alpha = 0.01
baseline = "base/{view}-*.pfm"
candidate = "out/{view}-*.pfm"
smallest = "4 %"
[view.same]
smallest = "6 %"
regions.corner = [0, 0, 11, 11]
END
expect 1 "$CRESCENT" compare suite.toml --json all.json --junit all.xml --markdown all.md --out one --quiet
expect 1 "$CRESCENT" compare suite.toml --json two.json --out two --quiet
cmp all.json two.json || die "equal inputs give other numbers"
same_outputs one two
expect 0 /usr/bin/python3 - "$CRESCENT_SOURCE" <<'END'
import json, os, sys, xml.etree.ElementTree as tree
import jsonschema
result = json.load(open("all.json"))
jsonschema.validate(result, json.load(open(sys.argv[1] + "/docs/suite.schema.json")))
states = {v["view"]: v["state"] for v in result["views"]}
assert states == {"same": "same", "changed": "changed", "noisier": "noisier", "improved": "improved", "gone": "missing",
                  "added": "new", "few": "too few renders", "fixed": "same"}, states
views = {v["view"]: v for v in result["views"]}
assert set(views["same"]["means"]) == {"corner", "frame"} and views["same"]["smallest"] == 0.06
assert views["fixed"]["deterministic"] and views["few"]["renders_needed"] > 3
assert result["exit_code"] == 1 and result["views_tested"] == 5
cases = {c.get("name"): [e.tag for e in c] for c in tree.parse("all.xml").getroot().iter("testcase")}
assert cases == {"same": [], "improved": [], "fixed": [], "changed": ["failure"], "noisier": ["failure"],
                 "gone": ["failure"], "few": ["error"], "added": ["failure"]}, cases
text = open("all.md").read()
assert "| ❌ changed | changed |" in text and "fixed" not in text and len(text.encode()) < 60000, text
page = open("one/report.html").read()
assert page.count("<details") == 8 and "http" not in page.replace("http://www.w3.org", ""), "not one offline page"
END

# Exit codes of parts of it; new views fail unless --new-baseline allows them.
part() {
    rm -rf part
    mkdir -p part/base part/out
    for view; do cp base/"$view"-* part/base/ 2>/dev/null; cp out/"$view"-* part/out/ 2>/dev/null; done
    sed '/^\[view/,$d' suite.toml >part/suite.toml
}
part same improved added
expect 1 "$CRESCENT" compare part/suite.toml --out nothing --quiet
expect 0 "$CRESCENT" compare part/suite.toml --out nothing --new-baseline --quiet
part same few
expect 4 "$CRESCENT" compare part/suite.toml --out nothing --quiet
grep -q 'renders of each side would do' printed || die "no number of renders: $(cat printed)"
part few gone
cp out/same-0.pfm part/out/
expect 1 "$CRESCENT" compare part/suite.toml --out nothing --quiet

# --plan, also before anything is rendered.
part same
rm part/out/*
expect 0 "$CRESCENT" compare part/suite.toml --plan --json plan.json --quiet
grep -q '4 % of mean Y in frame' printed || die "no plan: $(cat printed)"
expect 0 /usr/bin/python3 -c 'import json; v = json.load(open("plan.json"))["views"][0]
assert v["needed"][0]["renders"] > v["needed"][2]["renders"] > 1, v'

# --accept: as renders and as moments; the suite is then unchanged.
part same changed added
expect 0 "$CRESCENT" compare part/suite.toml --accept changed --because 'new sampler' --quiet
cmp part/base/changed-3.pfm part/out/changed-3.pfm || die "the renders were not accepted"
grep -q '"because": "new sampler"' part/base/baseline.json || die "no reason in the manifest"
[ ! -e part/base/added-0.pfm ] || die "a view that was not named was accepted"
expect 0 "$CRESCENT" compare part/suite.toml --accept --quiet
expect 0 "$CRESCENT" compare part/suite.toml --out nothing --quiet
sed -i 's/{view}-\*.pfm"/{view}-*.*"/' part/suite.toml
sed 's/base\/{view}-\*\.\*/base\/{view}-*.exr/' part/suite.toml >part/moments.toml
expect 2 "$CRESCENT" compare part/moments.toml --accept same --store moments --quiet
grep -q 'the patterns of the baseline do not match this file' said || die "not named: $(cat said)"
expect 0 "$CRESCENT" compare part/moments.toml --accept --store moments --quiet
[ "$(ls part/base)" = "$(printf '%s\n' added-moments.exr baseline.json changed-moments.exr same-moments.exr)" ] ||
    die "no moments, or old renders: $(ls part/base)"
expect 0 "$CRESCENT" compare part/moments.toml --json moments.json --out nothing --quiet
grep -q '"moments": true' moments.json || die "the baseline was not read from its moments"

# A baseline in a folder elsewhere, of the images that the suite compares; what is accepted keeps their format.
part same changed
mkdir part/bucket && cp part/base/* part/bucket/
expect 1 "$CRESCENT" compare part/suite.toml --baseline part/bucket --out nothing --quiet
expect 0 "$CRESCENT" compare part/suite.toml --baseline part/bucket --accept changed --because 'new sampler' --quiet
[ -e part/bucket/changed/0.pfm ] && [ ! -e part/bucket/changed-0.pfm ] || die "accepted otherwise: $(ls part/bucket)"
expect 0 "$CRESCENT" compare part/suite.toml --baseline part/bucket --out nothing --quiet
expect 1 "$CRESCENT" compare part/suite.toml --out nothing --quiet

# Pictures of the views that failed, for a comment; none of those that did not.
ls one/plates | grep -q '^1-changed-significance.png$' || die "no pictures: $(ls one one/plates)"
! ls one/plates | grep -qE 'same|improved|fixed' || die "pictures of views that are the same: $(ls one/plates)"

# Folders without a file: one image for each view, whose names may have a '-', besides several of a view.
mkdir -p flat/a flat/b
for side in a b; do
    for view in lamp glass-ball glass-cup; do cp out/fixed-0.pfm "flat/$side/$view.pfm"; done
    for seed in 1 2; do cp "out/same-$seed.pfm" "flat/$side/wall-$seed.pfm"; done
done
expect 0 "$CRESCENT" compare --baseline flat/a --candidate flat/b --json flat.json --out nothing --quiet
expect 0 "$CRESCENT" compare --baseline flat/a --candidate flat/b --accept --because all --quiet
expect 0 "$CRESCENT" compare --baseline flat/a --candidate flat/b --out nothing --quiet
[ "$(ls flat/a)" = "$(printf '%s\n' baseline.json glass-ball.pfm glass-cup.pfm lamp.pfm wall-1.pfm wall-2.pfm)" ] ||
    die "accepted otherwise: $(ls flat/a)"
expect 0 /usr/bin/python3 -c 'import json
views = {v["view"]: v["renders"]["candidate"] for v in json.load(open("flat.json"))["views"]}
assert views == {"lamp": 1, "glass-ball": 1, "glass-cup": 1, "wall": 2}, views'

# Folders without a file.
mkdir -p folders/a/crown folders/b/crown
bad() {
    local message=$1
    shift
    expect 2 "$CRESCENT" compare "$@"
    grep -qF -- "$message" said || die "no '$message' in: $(cat said)"
}
bad "found no file that matches 'folders/b/{view}/*.exr'" --baseline folders/a --candidate folders/b --out nowhere
bad "expected a folder" --baseline folders/a --candidate absent --out nowhere
sed 's/^alpha/alhpa/' suite.toml >wrong.toml
cp wrong.toml wrong-key.toml
bad "wrong.toml:2:1: " wrong.toml --out nowhere
bad "did you mean 'alpha'?" wrong.toml --out nowhere
sed 's/view.same/view.sane/' suite.toml >wrong.toml
bad "did you mean 'same'?" wrong.toml --out nowhere
sed 's/11, 11/99, 11/' suite.toml >wrong.toml
expect 2 "$CRESCENT" compare wrong.toml --out wrong --quiet
grep -q 'unreadable .*same .*wrong.toml:8:' printed || die "the place of the box is not named: $(cat printed)"
sed 's/{view}-/view-/' suite.toml >wrong.toml
bad "expected {view} in the pattern" wrong.toml --out nowhere
bad "did you mean 'changed'?" suite.toml --accept chnaged
bad "expected --accept with it" suite.toml --because x
bad "expected a suite" --arm a=out/same-0.pfm --markdown x.md
bad "expected no such flag" suite.toml --arm a=out/same-0.pfm
head -c 100 out/same-0.pfm >out/same-9.pfm
head -c 100 out/few-0.pfm >out/few-9.pfm
[ ! -e nowhere ] && [ ! -e x.md ] || die "a wrong call left an output"
expect 2 "$CRESCENT" compare suite.toml --out unread --json unread.json --junit unread.xml --quiet
for file in out/few-9.pfm out/same-9.pfm; do grep -q "$file" printed || die "$file is not named: $(cat printed)"; done
expect 0 /usr/bin/python3 -c 'import json; states = {v["view"]: v["state"] for v in json.load(open("unread.json"))["views"]}
assert states["few"] == states["same"] == "unreadable" and states["changed"] == "changed", states'
rm out/same-9.pfm out/few-9.pfm
# A JUnit file of an earlier call does not stay.
cp all.xml stale.xml
bad "did you mean 'alpha'?" wrong-key.toml --junit stale.xml --out nowhere
grep -q '<error' stale.xml && ! grep -q 'name="same"' stale.xml || die "the JUnit file of an earlier call stayed"
printf '[suite\n' >broken.toml
for file in absent.toml broken.toml; do
    cp all.xml stale.xml
    bad "$file" "$file" --junit stale.xml --out nowhere
    grep -q '<error' stale.xml && grep -q "$file" stale.xml || die "$file: the JUnit file of an earlier call stayed"
done

# So does a SARIF file, which names the line; one of arms too.
bad "did you mean 'alpha'?" wrong-key.toml --sarif stale.sarif --out nowhere
expect 0 /usr/bin/python3 -c 'import json
place = json.load(open("stale.sarif"))["runs"][0]["results"][0]["locations"][0]["physicalLocation"]
assert place == {"artifactLocation": {"uri": "wrong-key.toml"}, "region": {"startLine": 2}}, place'
expect 2 "$CRESCENT" compare --arm 'a=absent*.pfm' --arm 'b=out/same-*.pfm' --sarif arms.sarif --out nowhere
grep -q 'absent\*.pfm' arms.sarif || die "the failure is not in the SARIF file"

# A pointer of Git LFS is named, also without a manifest.
part same
for file in part/base/*; do printf 'version https://git-lfs.github.com/spec/v1\noid sha256:1\nsize 1\n' >"$file"; done
expect 2 "$CRESCENT" compare part/suite.toml --out nothing --quiet
grep -q 'git lfs pull' printed || die "the pointer is not named: $(cat printed)"

# A baseline that differs from its manifest is named; so is a missing one.
part same changed
expect 0 "$CRESCENT" compare part/suite.toml --accept --quiet
expect 0 "$CRESCENT" compare part/suite.toml --out nothing --quiet
mv part/base/same-1.pfm moved.pfm
expect 2 "$CRESCENT" compare part/suite.toml --out nothing --quiet
grep -q 'base/same-1.pfm: no such file of the baseline' printed || die "the missing file is not named: $(cat printed)"
mv moved.pfm part/base/same-1.pfm
sed -i 's/^{/<<<<<<< HEAD\n{/' part/base/baseline.json
bad "found a conflict of a merge" part/suite.toml --out nothing --quiet
rm -r part/base
expect 1 "$CRESCENT" compare part/suite.toml --out nothing --quiet
expect 2 "$CRESCENT" compare part/suite.toml --accept '' --quiet
expect 3 "$CRESCENT" compare suite.toml --json absent/folder/x.json --out nothing --quiet

# Killed at any time, --accept leaves one of the two baselines.
hash_of() { cat "$1"/same-*.pfm | sha256sum; }
new=$(hash_of out)
for delay in 0.005 0.01 0.02 0.03 0.05; do
    rm -rf part && mkdir -p part && cp -r base out part/
    sed '/^\[view/,$d' suite.toml >part/suite.toml
    old=$(hash_of part/base)
    "$CRESCENT" compare part/suite.toml --accept same --quiet >/dev/null 2>&1 &
    sleep "$delay"
    kill -9 $! 2>/dev/null
    wait $! 2>/dev/null
    now=$(hash_of part/base)
    [ "$now" = "$old" ] || [ "$now" = "$new" ] || die "a killed --accept left a mixed baseline"
done
expect 0 "$CRESCENT" compare --baseline "file://$PWD/flat/a" --candidate flat/b --out nothing --quiet
expect 2 "$CRESCENT" compare --baseline s3://bucket/base --candidate out
grep -q 'mount it' said || die "an address is not refused: $(cat said)"
