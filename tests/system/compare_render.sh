#!/bin/bash
# `crescent compare SUITE.toml --render CMD` and `--a CMD --b CMD`: a renderer that writes PNG, unchanged, changed, slow,
# crashing, writing half a file and ignoring its seed; views with hostile names; a second call uses what is there.
. "$(dirname "$0")/common.sh"
cat >pt.py <<'PY'
# pt.py VIEW SEED OUT [FACTOR [HOW]]: a noisy picture of 24 x 24 pixels as PNG, or as PFM by the end of its name.
import os, random, struct, sys, time, zlib
view, seed, out = sys.argv[1:4]
factor, how = float(sys.argv[4]) if len(sys.argv) > 4 else 1, sys.argv[5] if len(sys.argv) > 5 else ""
rng = random.Random(f"{view}{0 if how == 'ignore' else seed}")
side = 24
values = [min(1, factor * 0.2 * rng.gammavariate(16, 1 / 16)) for _ in range(side * side * 3)]
if how == "crash":
    print("no memory left", file=sys.stderr)
    os.abort()
if how == "slow":
    time.sleep(60)
if out.endswith(".png"):
    encoded = bytes(round(255 * (12.92 * v if v <= 0.0031308 else 1.055 * v ** (1 / 2.4) - 0.055)) for v in values)
    rows = b"".join(b"\0" + encoded[3 * side * r:3 * side * (r + 1)] for r in range(side))
    chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    data = (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", side, side, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
else:
    data = b"PF\n%d %d\n-1.0\n" % (side, side) + struct.pack("<%df" % len(values), *values)
open(out, "wb").write(data[:len(data) // 2] if how == "half" else data)
PY
hostile='$(touch ran);x'
for view in lamp "$hostile"; do
    for seed in 1 2 3 4 5 6 7 8 9 10 11 12; do
        mkdir -p base && python3 pt.py "$view" "$seed" "base/$view-$seed.png" || die "no baseline"
    done
done
cat >suite.toml <<'TOML'
[suite]
baseline = "base/{view}-*.png"
candidate = "out/{view}-*.png"
smallest = "8 %"
TOML
render="python3 pt.py {view} {seed} {out}"
rendered() { "$CRESCENT" compare suite.toml --until decided --budget 5min --jobs 2 --quiet --out report "${@:2}" --render "$1"; }

expect 0 rendered "$render" --json same.json
made=$(ls out | wc -l)
[ "$made" -ge 8 ] && ls out | grep -q -- '-13.png' || die "not rendered with new seeds: $(ls out)"
expect 0 rendered "$render"
[ "$(ls out | wc -l)" = "$made" ] || die "a second call rendered again"
[ ! -e ran ] || die "the name of a view was run"
expect 0 /usr/bin/python3 -c 'import json
views = json.load(open("same.json"))["views"]
assert [v["state"] for v in views] == ["same", "same"], views
assert any("pictures for display" in n for n in views[0]["notes"]) and any("made in" in n for n in views[0]["notes"]), views'

rm -r out
expect 1 rendered "$render 1.2"
grep -q 'changed *lamp' printed || die "the change is not found: $(cat printed)"
fails() { # HOW MESSAGE [FLAG...]
    rm -rf out
    expect 2 rendered "$render 1 $1" "${@:3}"
    grep -qF -- "$2" printed || die "no '$2' in: $(cat printed)"
}
fails crash "ended with signal 6 (SIGABRT): no memory left for seed 13"
fails half "wrote a file that cannot be read"
fails ignore "ignores the seed"
fails slow "did not end within 0.5 s" --timeout 0.5
rm -rf out && : >out
expect 3 rendered "$render"
grep -q 'cannot make the folder out: ' said || die "the folder is not named: $(cat said)"
rm out && mkdir -p out/lamp-13.png
expect 2 rendered "$render"
grep -q 'wrote a file that cannot become out/lamp-13.png' printed || die "the name is not named: $(cat printed)"
[ -z "$(find . -name '.crescent-partial*')" ] || die "partial files stayed"
rm -rf out
expect 4 "$CRESCENT" compare suite.toml --render "$render 1 slow" --until decided --budget 1s --out report
grep -q 'The program was stopped after 1' printed || die "the slow program is not named: $(cat printed)"
grep -q '^0 of 2 views decided; making 8 renders' said || die "no progress: $(cat said)"
expect 2 "$CRESCENT" compare suite.toml --render 'python3 pt.py {view}'
grep -q 'expected {out}' said || die "$(cat said)"
expect 2 "$CRESCENT" compare suite.toml --budget 5min
grep -q 'expected --render' said || die "$(cat said)"
expect 2 "$CRESCENT" compare suite.toml --render "$render" --views lamp
grep -q 'expected --a and --b with it' said || die "$(cat said)"
expect 2 "$CRESCENT" compare suite.toml --render "$render" --budget soon
grep -q 'expected a time above 0' said || die "$(cat said)"

# Two programs with one mean, and with two.
a="python3 pt.py {view} {seed} {out}"
expect 0 "$CRESCENT" compare --a "$a" --b "$a" --views lamp,wall --smallest 8% --budget 5min --jobs 2 --quiet --out two
[ -d two-renders/a ] && grep -q 'At equal time b has' printed || die "$(cat printed)"
# A region is tested in each view.
expect 1 "$CRESCENT" compare --a "$a" --b "$a 1.2" --views lamp,wall --region corner=0,0,7,7 --quiet --json region.json --out regions
expect 0 /usr/bin/python3 -c 'import json
views = json.load(open("region.json"))["views"]
assert [sorted(v["means"]) for v in views] == [["corner", "frame"]] * 2, views
assert views[0]["means"]["corner"]["smallest"] > views[0]["means"]["frame"]["smallest"], views'
for bad in frame=0,0,7,7 corner=0,0,7 corner; do
    expect 2 "$CRESCENT" compare --a "$a" --b "$a" --views lamp --region "$bad" --quiet --out regions
    grep -qF -- "--region $bad" said || die "the region is not named: $(cat said)"
done
expect 2 "$CRESCENT" compare suite.toml --render "$render" --region corner=0,0,7,7 --quiet --out report
# A command states the format, for a program that goes by the end of the name.
expect 0 "$CRESCENT" compare --a "python3 pt.py {view} {seed} {out}.png" --b "$a" --views lamp --smallest 8% --quiet --out png
ls png-renders/a | grep -q '^lamp-[0-9]*.png$' && ls png-renders/b | grep -q '^lamp-[0-9]*.exr$' || die "$(ls png-renders/*)"
expect 2 "$CRESCENT" compare suite.toml --render "python3 pt.py {view} {seed} {out}.exr" --quiet --out report
grep -q 'with the ending of the pattern' said || die "$(cat said)"
expect 1 "$CRESCENT" compare --a "$a" --b "$a 1.2" --views other --smallest 8% --budget 5min --quiet --out three
expect 2 "$CRESCENT" compare --a "$a" --b "$a" --quiet
grep -q 'expected the views' said || die "$(cat said)"

# Both programs ignore their seeds, or the seed is not in their commands: nothing is decided, unless they have no noise.
undecided() { # TEXT ARG...
    expect 4 "$CRESCENT" compare --smallest 8% --budget 5min --quiet --out "$work_of_call" "${@:2}"
    grep -qF -- "$1" printed || die "no '$1' in: $(cat printed)"
}
work_of_call=four
undecided "the programs ignore {seed}" --a "$a 1 ignore" --b "$a 1 ignore" --views lamp --json four.json
expect 0 /usr/bin/python3 -c 'import json
view = json.load(open("four.json"))["views"][0]
assert view["state"] == "too few renders" and "--tolerance" in view["sentence"], view'
[ "$(ls four-renders/a four-renders/b | grep -c lamp)" = 8 ] || die "it went on: $(ls four-renders/*)"
work_of_call=five
undecided "neither command has {seed}" --a 'python3 pt.py {view} 1 {out}' --b 'python3 pt.py {view} 2 {out}' --views lamp
expect 1 "$CRESCENT" compare --a 'python3 pt.py {view} 1 {out}' --b 'python3 pt.py {view} 2 {out}' --views lamp \
    --tolerance '0 ulp' --quiet --out six
expect 0 "$CRESCENT" compare --a 'python3 pt.py {view} 1 {out}' --b 'python3 pt.py {view} 1 {out}' --views lamp \
    --tolerance '0 ulp' --quiet --out seven
expect 2 "$CRESCENT" compare --a "$a" --b "$a" --views lamp --tolerance '2 nits' --quiet --out eight
grep -q 'expected a tolerance such as' said || die "$(cat said)"
# Only the last digits of the seed are used, so both sides have the same noise.
last='sh -c '"'"'seed=$1; python3 pt.py "$0" $((seed % 1000)) "$2"'"'"' {view} {seed} {out}'
work_of_call=nine
undecided "both sides have the same noise" --a "$last" --b "$last" --views lamp
expect 0 "$CRESCENT" compare --a "$last" --b "$last" --views lamp --pair --smallest 8% --quiet --out ten
