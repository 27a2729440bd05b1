#!/bin/bash
# Parts of one experiment's seeds, run separately, equal one run: `crescent join` makes the bytes of the whole from
# them. What needs missing seeds is skipped; parts that do not belong together are rejected.
. "$(dirname "$0")/common.sh"

cat "$tiny" - >all.toml <<'END'

[furnaces.white]
arm = "cosine"
shape = "ball"
n = 4096

[exponent]
arm = "mixture"
shape = "ball"
n = 16
s = [8, 32]

[reference]
monte_carlo = true
disk_spp = 16
lobe_spp = 16

[assertions.median]
check = "rmse.ball(mixture) < rmse.ball(uniform)"
over = "median"

[assertions.wrong]
check = "rmse.ball(mixture) > rmse.ball(uniform)"
over = "median"

[assertions.own]
check = "fireflies(cosine) < 1000"

[assertions.white]
check = "furnace_error(white) < 0.05"

[assertions.plate]
check = "plate_bytes(hero) > 0"
END
run() { # CODE SEEDS OUT [OPTION...]
    expect "$1" "$CRESCENT" run all.toml --quiet --set 'ball.s=32' --seeds 7 --seed-range "$2" --out "$3" "${@:4}"
}
run 1 1:7 whole --only metrics
run 0 1:2 a --only metrics
run 0 3:5 b # with films, plates and report
run 0 5:7 c --only metrics
# Without the provenance.
bare() {
    /usr/bin/python3 -c 'import json, sys; m = json.load(sys.stdin); m.pop("provenance"); print(json.dumps(m))' \
        <"$1/metrics.json"
}
same() {
    cmp "$1/metrics.csv" "$2/metrics.csv" || die "metrics.csv of $1 and $2 differ"
    diff <(bare "$1") <(bare "$2") >difference || die "metrics.json of $1 and $2 differ: $(head -c 2000 difference)"
    diff <(grep -v '"command"' "$1/junit.xml") <(grep -v '"command"' "$2/junit.xml") >difference ||
        die "junit.xml of $1 and $2 differ: $(cat difference)"
}
expect 1 "$CRESCENT" join a b c --out joined
same whole joined
grep -q wrong printed || die "the assertion that fails is not named: $(cat printed)"
expect 1 "$CRESCENT" join c/metrics.json whole b --out again
same whole again
expect 1 "$CRESCENT" join joined --out again
expect 2 "$CRESCENT" join a/metrics.json b --out a
grep -q 'expected another folder than that of the part a/metrics.json' said || die "a part is overwritten: $(cat said)"
same whole again

# Whole runs of fewer seeds are parts too: the number of seeds does not change the experiment.
expect 1 "$CRESCENT" run all.toml --quiet --set ball.s=32 --seeds 4 --only metrics --out four
expect 1 "$CRESCENT" join four c --out again
same whole again

# In every output, what needs missing seeds is skipped; the rest decides.
skipped() { /usr/bin/python3 - "$1" "$2" <<'END'
import json, sys, xml.etree.ElementTree as xml
want = dict(pair.split("=") for pair in sys.argv[2].split(","))
got = {a["name"]: a.get("skipped", "") for a in json.load(open(sys.argv[1] + "/metrics.json"))["assertions"]}
cases = {c.get("name"): c.find("skipped") for c in xml.parse(sys.argv[1] + "/junit.xml").iter("testcase")}
for name, why in want.items():
    assert got[name] == why, (name, got[name])
    assert (cases[name] is not None) == bool(why), name
END
}
expect 0 skipped a "median=needs seeds 1 to 7,wrong=needs seeds 1 to 7,own=,white=,plate=no plates were drawn"
expect 0 skipped b "median=needs seeds 1 to 7,own=needs seed 1,white=,plate=,no bad samples=needs seed 1"
expect 0 skipped joined "median=,wrong=,own=,white="
expect 0 "$CRESCENT" join a c --out gap
grep -q 'missing: 3 to 4' printed || die "the missing seeds are not listed: $(cat printed)"
expect 0 skipped gap "median=needs seeds 1 to 7,own="
expect 0 "$CRESCENT" join c b --out late
run 0 3:7 late-whole --only metrics
same late late-whole
expect 1 "$CRESCENT" join gap late --out again
same whole again

# The page of a stored run is the page that the run wrote; without its plates it says what is missing.
expect 0 "$CRESCENT" report b/metrics.json --out again.html
cmp b/report.html again.html || die "crescent report makes another page"
expect 0 "$CRESCENT" report a/metrics.json
grep -q 'a/plates/hero.png: missing' said || die "not said that a plate is missing: $(cat said)"
[ -s a/report.html ] || die "no page beside metrics.json"
for bad in '{}' '{"format": "crescent metrics 9"}' '{"format": "another"}' 'no json'; do
    echo "$bad" >bad.json
    expect 2 "$CRESCENT" report bad.json --out bad.html
    grep -q '^bad.json: expected ' said || die "$bad: $(cat said)"
done
[ ! -e bad.html ] || die "a page of a file that is no result"

# Parts that do not belong together.
expect 0 "$CRESCENT" run all.toml --quiet --set ball.s=31 --seeds 7 --seed-range 1:2 --only metrics --out other
expect 2 "$CRESCENT" join other b --out nowhere
grep -q 'ball.*s is 31 there and 32 here' said || die "the key that differs is not named: $(cat said)"
mkdir changed
change() {
    sed "$1" c/metrics.json >changed/metrics.json && ! cmp -s c/metrics.json changed/metrics.json || die "no $1"
}
change '0,/"rmse": 0/s//"rmse": 1/'
expect 2 "$CRESCENT" join b changed --out nowhere # seed 5 is in both
change 's/"version": "/"version": "9./'
expect 2 "$CRESCENT" join a changed --out nowhere
change 's/"instrument": "CPU/"instrument": "GL/'
expect 2 "$CRESCENT" join a changed --out nowhere
change '/"furnace": \[/,/"measured"/s/"measured": 0/"measured": 1/'
expect 2 "$CRESCENT" join a changed --out nowhere
change '0,/"k": /s//"k": 1/'
expect 2 "$CRESCENT" join a changed --out nowhere
change 's/radius = 0.65/radius = 0.66/'
expect 2 "$CRESCENT" join changed --out nowhere
head -c 1000 c/metrics.json >changed/metrics.json
expect 2 "$CRESCENT" join changed --out nowhere
expect 2 "$CRESCENT" join missing --out nowhere
expect 2 "$CRESCENT" join all.toml --out nowhere
expect 2 "$CRESCENT" join --out nowhere
expect 2 "$CRESCENT" join a
[ ! -e nowhere ] || die "a wrong call left an output folder"
exit 0
