#!/bin/bash
# `crescent compare` as its users call it: our own films give the metrics of their run; equal inputs give equal bytes;
# exit codes; bad input is named and nothing is written; its JSON obeys docs/compare.schema.json, its XML is
# well-formed.
. "$(dirname "$0")/common.sh"

for seed in 7 8 9; do expect 0 "$CRESCENT" run "$tiny" --set seed=$seed --out "s$seed" --quiet; done
arms=(--arm 'u=s[789]/films/uniform.exr' --layer u=n=16 --arm 'c=s[789]/films/cosine.exr' --layer c=n=16
    --reference s7/films/reference.exr --layer 'reference=quadrature s=32' --region ball=40,20,56,34)
expect 0 "$CRESCENT" compare "${arms[@]}" --seconds u=2 --seconds c=3 --out one --quiet
expect 0 "$CRESCENT" compare "${arms[@]}" --seconds u=2 --seconds c=3 --out two --quiet
same_outputs one two
expect 0 /usr/bin/python3 - "$CRESCENT_SOURCE" <<'END'
import json, sys
import jsonschema
run, compared = json.load(open("s7/metrics.json")), json.load(open("one/metrics.json"))
jsonschema.validate(compared, json.load(open(sys.argv[1] + "/docs/compare.schema.json")))
for arm, name in (("u", "uniform"), ("c", "cosine")):
    ours = next(r for r in run["runs"] if r["arm"] == name and r["n"] == 16)
    theirs = next(a for a in compared["arms"] if a["arm"] == arm)["files"][0]["regions"]
    for a, b in ((ours["regions"]["ball"]["rmse"], theirs["ball"]["rmse"]),
                 (ours["y_mean"], theirs["frame"]["y_mean"]), (ours["rmse_frame"], theirs["frame"]["rmse"])):
        assert abs(a - b) <= 1e-6 * abs(a), (arm, a, b)
END
for file in metrics.json metrics.csv junit.xml report.html plates/renders.png plates/errors.png plates/noise-c-u.png; do
    [ -s "one/$file" ] || die "no $file"
done
expect 0 /usr/bin/python3 -c 'import sys, xml.etree.ElementTree as e; [e.parse(f) for f in sys.argv[1:]]' one/junit.xml

expect 1 "$CRESCENT" compare "${arms[@]}" --assert 'rmse.ball(u) < 1e-9' --out failing --quiet --sarif failing.sarif
grep -q '"ruleId": *"rmse.ball(u) < 1e-9"' failing.sarif || die "not the assertion: $(cat failing.sarif)"
expect 1 "$CRESCENT" compare "${arms[@]}" --assert 'efficiency.ball(u) > 1' --out failing --quiet
grep -q 'a side of it was not measured' printed ||
    die "a claim that cannot be measured is not said to be: $(cat printed)"
grep -q '<failure' failing/junit.xml || die "the failing assertion is not in junit.xml"
expect 4 "$CRESCENT" compare "${arms[@]}" --expect same --out few --quiet
printf 'title = "From a file"\n[arms.u]\nfiles = "s[789]/films/uniform.exr"\nlayer = "n=16"\n' >plan.toml
expect 0 "$CRESCENT" compare plan.toml --out from-file --quiet
grep -q 'From a file' from-file/report.html || die "the title is not in the report"
expect 0 "$CRESCENT" report from-file/metrics.json --out again.html
cmp from-file/report.html again.html || die "crescent report makes another page of a comparison"
mkdir elsewhere  # paths of a file are relative to it, those of flags to the current folder
{
    printf 'reference = "../s7/films/reference.exr"\nreference_layer = "quadrature s=32"\n'
    printf '[arms.u]\nfiles = ["../s[789]/films/uniform.exr"]\nlayer = "n=16"\n'
} >elsewhere/plan.toml
expect 0 "$CRESCENT" compare elsewhere/plan.toml --arm 'c=s[789]/films/cosine.exr' --layer c=n=16 --out from-elsewhere \
    --quiet
expect 0 "$CRESCENT" compare --arm 'a=s%d/films/uniform.exr' --arm 'b=s%02d/films/cosine.exr' --layer a=n=16 \
    --layer b=n=16 \
    --pair --alpha 0.05 --exposure 2 --out paired --quiet
grep -q '"paired": true' paired/metrics.json || die "--pair did not pair"
expect 0 "$CRESCENT" compare --schema

# The sample counts of a ladder are known by their names; --spp without a name is for all arms, of the file too.
printf '[arms.u-%d]\nfiles = "s[789]/films/uniform.exr"\nlayer = "n=%d"\n' 16 16 4 4 >ladder.toml
expect 0 "$CRESCENT" compare ladder.toml --spp u-16=16 --spp u-4=4 --reference s7/films/reference.exr \
    --layer 'reference=quadrature s=32' --region ball=40,20,56,34 --out ladder --quiet
expect 0 /usr/bin/python3 -c 'import xml.etree.ElementTree as e; e.parse("ladder/plates/ladders.svg")'
[ -s ladder/plates/ladders.png ] || die "no plate of the ladders"
# Without a reference the page draws what its caption names: the standard deviation, read from the chart's own ticks.
expect 0 "$CRESCENT" compare ladder.toml --spp u-16=16 --spp u-4=4 --out bare --quiet
expect 0 /usr/bin/python3 - <<'END'
import json, math, re
bare = json.load(open("bare/metrics.json"))
figures = re.findall("<figure>.*?</figure>", open("bare/report.html").read(), re.S)
figure = next(f for f in figures if "The standard deviation of" in f)
assert ">standard deviation</text>" in figure and ">variance</text>" not in figure, figure
ticks = re.findall(r'M58.0 ([\d.]+) H.*?text-anchor="end">([\d.e-]+)</text>', figure)
(y0, v0), (y1, v1) = [(float(y), math.log(float(v))) for y, v in (ticks[0], ticks[-1])]
dots = re.findall(r'class="dot.*? cy="([\d.]+)"', figure)
drawn = [math.exp(v0 + (float(y) - y0) / (y1 - y0) * (v1 - v0)) for y in dots]
metric = {a["arm"]: a["regions"]["frame"]["metrics"]["var"]["value"] for a in bare["arms"]}
for name, value in zip(bare["ladders"][0]["arms"], drawn, strict=True):
    assert abs(value / math.sqrt(metric[name]) - 1) < 0.02, (name, value, metric[name])
END
expect 0 "$CRESCENT" compare ladder.toml --spp 16 --out alike --quiet
[ ! -e alike/plates/ladders.png ] || die "a plate of no ladder"
expect 0 /usr/bin/python3 - "$CRESCENT_SOURCE" <<'END'
import json, sys
import jsonschema
schema = json.load(open(sys.argv[1] + "/docs/compare.schema.json"))
ladder, alike = json.load(open("ladder/metrics.json")), json.load(open("alike/metrics.json"))
jsonschema.validate(ladder, schema), jsonschema.validate(alike, schema)
(rungs,) = ladder["ladders"]
assert rungs["name"] == "u" and rungs["arms"] == ["u-4", "u-16"], rungs
assert -0.7 < rungs["slopes"]["ball"]["value"] < -0.3, rungs
assert [a["spp"] for a in alike["arms"]] == [16, 16] and not alike["ladders"]
END
expect 0 "$CRESCENT" compare --schema --json
cp printed keys.json
expect 0 /usr/bin/python3 -c 'import json; json.load(open("keys.json"))'

# Differences other than mean Y: values that are not finite, hue at equal luminance, renders of equal seeds.
expect 0 /usr/bin/python3 - <<'END'
import random, struct
def write(name, pixels, side=32):
    with open(name + ".pfm", "wb") as out:
        out.write(b"PF\n%d %d\n-1.0\n" % (side, side) + struct.pack("<%df" % len(pixels), *pixels))
def render(seed):
    rng = random.Random(seed)
    return [mean * rng.gammavariate(25, 1 / 25) for _ in range(32 * 32) for mean in (1.0, 0.8, 0.6)]
for k in range(8):
    first, other = render(k), render(100 + k)
    write(f"first{k}", first), write(f"other{k}", other)
    write(f"nan{k}", [float("nan") if i == 3 * (5 * 32 + 7) + 1 else x for i, x in enumerate(other)])
    write(f"hue{k}", [x * (1.05, 1, 1 - 0.05 * 0.2126 / 0.0722 / 0.6)[i % 3] for i, x in enumerate(other)])
    write(f"corner{7 - k}", [x * (1.03 if i < 3 * 32 * 8 and i % 96 < 24 else 1) for i, x in enumerate(first)])
END
first=(--arm 'a=first?.pfm' --smallest 0.05 --quiet)
expect 0 "$CRESCENT" compare "${first[@]}" --arm 'b=other?.pfm' --expect same --out other
expect 1 "$CRESCENT" compare "${first[@]}" --arm 'b=nan?.pfm' --expect same --out nan
expect 1 "$CRESCENT" compare "${first[@]}" --arm b=nan0.pfm --expect same --out nan-single
expect 1 "$CRESCENT" compare "${first[@]}" --arm 'b=nan?.pfm' --region box=0,0,9,9 --assert 'y_mean.box(b) < 9' \
    --out nan
expect 0 "$CRESCENT" compare "${first[@]}" --arm 'b=nan?.pfm' --region box=9,9,19,19 --assert 'y_mean.box(b) < 9' \
    --out nan-elsewhere
expect 1 "$CRESCENT" compare "${first[@]}" --arm 'b=hue?.pfm' --expect same --out hue
expect 1 "$CRESCENT" compare "${first[@]}" --arm 'b=corner?.pfm' --expect same --out corner
expect 0 "$CRESCENT" compare --arm 'a=first?.pfm' --arm 'b=first?.pfm' --expect same --quiet --out alike
expect 0 "$CRESCENT" compare --arm a=first0.pfm --arm b=first0.pfm --expect same --quiet --out alike
expect 4 "$CRESCENT" compare --arm a=first0.pfm --arm b=first1.pfm --expect same --quiet --out single
expect 0 /usr/bin/python3 - "$CRESCENT_SOURCE" <<'END'
import json, sys
import jsonschema
schema = json.load(open(sys.argv[1] + "/docs/compare.schema.json"))
bias = {}
for name in ("other", "nan", "nan-single", "hue", "corner", "alike", "single"):
    result = json.load(open(name + "/metrics.json"))
    jsonschema.validate(result, schema)
    (bias[name],) = result["bias"]  # of b against a
assert not bias["other"]["differs"] and not bias["other"]["shared_seeds"]["renders"], bias["other"]
for name, renders in (("nan", 8), ("nan-single", 1)):
    found = bias[name]["non_finite"]["a"]
    assert found["pixels"] == 1 and found["first"] == [[7, 5]] and found["renders"] == [renders, renders], found
assert bias["hue"]["regions"]["frame"]["differs_in"] == ["R", "B"], bias["hue"]["regions"]
corner = bias["corner"]
assert corner["paired"] and corner["shared_seeds"]["all"], corner
assert [(r["a"] + r["b"]) for r in corner["shared_seeds"]["renders"]] == [7] * 8, corner["shared_seeds"]
assert [0, 0, 7, 7] in [tile["box"] for tile in corner["tiles"]["first"]], corner["tiles"]
assert bias["alike"]["identical"] and not bias["single"]["differs"] and bias["single"]["single"]["different"] == 1024
END

# bad WORDS MESSAGE: exit 2, the message, nothing written.
bad() {
    local message=$1
    shift
    expect 2 "$CRESCENT" compare "$@" --out nowhere
    grep -qF -- "$message" said || die "no '$message' in: $(cat said)"
    [ ! -e nowhere ] || die "a wrong call left a folder"
}
bad "--arm NAME=FILES"
bad "found none" --arm 'a=absent*.exr'
bad "named twice" --arm a=s7/films/uniform.exr --arm a=s7/films/uniform.exr --layer a=n=16
bad "choose one with --layer" --arm a=s7/films/uniform.exr
printf 'GIF89a.' >a.gif
printf 'P5\n4 4\n255\n0123456789abcdef' >four.pgm
bad "found a GIF" --arm a=a.gif
bad "expected 4 x 4 pixels" --arm a=four.pgm --arm b=one/plates/renders.png
bad "did you mean 'rmse'?" "${arms[@]}" --assert 'rsme.ball(u) < 1'
bad "'frame', the whole image" "${arms[@]}" --assert 'rmse(u) < 1'
bad "neither n nor s" "${arms[@]}" --assert 'rmse.frame(u, n=4) < 1'
bad "did you mean 'ball'?" "${arms[@]}" --assert 'rmse.bal(u) < 1'
bad "expected a box on the image" "${arms[@]}" --region big=0,0,4000,2
bad "expected a number above 0" "${arms[@]}" --spp many
bad "no arm 'x': expected one of u, c" "${arms[@]}" --seconds x=2
bad "expected a number above 0" "${arms[@]}" --brightest none
sed -i 's/^files/flies/' plan.toml
bad "plan.toml:3:1: " plan.toml
cp s7/films/uniform.exr copy.exr
bad "the same pixels" --arm a=s7/films/uniform.exr --arm a=copy.exr --layer a=n=16
bad "expected a render, found a folder" --arm a=s7/films
bad "an inverted box" --arm 'a=s[789]/films/uniform.exr' --layer a=n=16 --region r=56,20,40,34
head -c 3000 s7/films/uniform.exr >cut.exr
bad "cut.exr: " --arm a=cut.exr --layer a=n=16
printf 'PF\n2 2\n-1.0\n%048d' 0 >small.pfm
bad "expected 96 x 54 pixels as in" --arm 'a=s7/films/uniform.exr' --layer a=n=16 --arm b=small.pfm
bad "pixels as the renders have" --arm 'a=s[789]/films/uniform.exr' --layer a=n=16 --mask m=small.pfm
bad "--pair: expected" --arm 'a=s[78]/films/uniform.exr' --arm 'b=s[789]/films/cosine.exr' --layer a=n=16 \
    --layer b=n=16 --pair
bad "did you mean 'same'?" --arm 'a=s[78]/films/uniform.exr' --layer a=n=16 --expect sane

# Windows that differ are aligned or cropped, and --layer without an arm is for all files.
printf 'PF\n2 2\n-1.0\n%048d' 0 >two.pfm
printf 'PF\n2 2\n-1.0\n%048d' 7 >other.pfm
expect 0 "$CRESCENT" compare --arm a=two.pfm --arm b=other.pfm --align display --out aligned --quiet
printf 'PF\n2 1\n-1.0\n%024d' 3 >row.pfm
bad "expected 2 x 2 pixels as in two.pfm" --arm a=two.pfm --arm b=row.pfm
expect 0 "$CRESCENT" compare --arm a=two.pfm --arm b=row.pfm --crop --out cropped --quiet
grep -q '"height": 1,' cropped/metrics.json || die "not cropped: $(head -n 20 cropped/metrics.json)"
grep -q -- '--crop' cropped/report.html || die "the report's command lacks --crop"
bad "expected one of them" --arm a=two.pfm --arm b=row.pfm --crop --align display
bad "expected one of windows, display" --arm a=two.pfm --align left
expect 0 "$CRESCENT" compare --arm 'u=s[789]/films/uniform.exr' --arm 'c=s[789]/films/cosine.exr' --layer n=16 \
    --layer c=n=4 --out layered --quiet
grep -q '"layer": "n=16"' layered/metrics.json && grep -q '"layer": "n=4"' layered/metrics.json || die "not the layers"
mkfifo pipe
bad "found a pipe" --arm a=pipe
bad "found a device" --arm a=/dev/zero

# Headers of a few bytes that state gigabytes: rejected before memory is allocated.
printf 'PF\n60000 60000\n-1.0\n1234' >huge.pfm
printf 'P6\n60000 60000\n255\n1234' >huge.ppm
printf '\211PNG\r\n\032\n\0\0\0\rIHDR\0\0\352\140\0\0\352\140\10\2\0\0\0' >huge.png
printf '#?RADIANCE\n\n-Y 60000 +X 60000\n1234' >huge.hdr
printf '\223NUMPY\1\0\107\0%-70s\n1234' "{'descr': '<f8', 'fortran_order': False, 'shape': (60000, 60000, 4)}" \
    >huge.npy
/usr/bin/python3 - <<'END' || die "no huge.exr"
import struct
exr = open("s7/films/uniform.exr", "rb").read()
key, other = b"dataWindow\0box2i\0", b"DataWindow\0box2i\0"
while key in exr:  # its lower right corner is 4 + 8 bytes further
    at = exr.index(key)
    corner = at + len(key) + 12
    exr = exr[:at] + other + exr[at + len(key):corner] + struct.pack("<2i", 59999, 59999) + exr[corner + 8:]
open("huge.exr", "wb").write(exr.replace(b"DataWindow\0", b"dataWindow\0"))
END
expect 0 /usr/bin/python3 - "$CRESCENT" <<'END'
import os, resource, subprocess, sys
for name in ("huge.pfm", "huge.ppm", "huge.png", "huge.hdr", "huge.npy", "huge.exr"):
    for way in (["--arm", f"a={name}"], ["--arm", f"a={name}", "--layer", "n=16"],
                ["--arm", "a=s[789]/films/uniform.exr", "--layer", "a=n=16", "--reference", name]):
        call = subprocess.run([sys.argv[1], "compare", *way, "--out", "nowhere"], capture_output=True, text=True)
        assert call.returncode == 2 and name + ":" in call.stderr, (way, call)
        assert not os.path.exists("nowhere"), way
peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss  # KiB, of the largest of them
assert peak < 1 << 20, peak
END
