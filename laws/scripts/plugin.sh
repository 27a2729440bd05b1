#!/bin/bash
# Arms from outside: cosine as a shared library gives the built-in's figures to 1e-6, on a scene with lights, lobes,
# furnaces and plates; a program draws as well; one that is missing, odd or breaks off is told with its arm's name.
. "$(dirname "$0")/common.sh"

expect 0 "${CC:-cc}" -O2 -shared -fPIC -I"$CRESCENT_SOURCE/src" -o libcosine.so \
    "$CRESCENT_SOURCE/examples/plugin/cosine.c" -lm
expect 0 "${CC:-cc}" -O2 -o cosine "$CRESCENT_SOURCE/examples/pipe_samplers/cosine.c" -lm
{
    sed 's/^\[arms.uniform\]/[arms.mine]\nplugin = "libcosine.so"/; s/^seeds = 1/seeds = 2/' "$tiny"
    printf '%s\n' '[plates.rose]' 'kind = "rose"' 'runs = [{arm = "mine", n = 16}, {arm = "cosine", n = 16}]' \
        '[furnaces.mine]' 'arm = "mine"' 'shape = "ball"' 'n = 4096' '[furnaces.built_in]' 'arm = "cosine"' \
        'shape = "ball"' 'n = 4096'
} >mine.toml
expect 0 "$CRESCENT" run mine.toml --out out --quiet
expect 0 python3 - <<'PY'
import json, math
m = json.load(open("out/metrics.json"))
def numbers(x, path=""):
    if isinstance(x, dict): return {k: v for key, y in x.items() for k, v in numbers(y, path + "/" + key).items()}
    return {path: x} if isinstance(x, (int, float)) else {}
runs = {(r["arm"], r["n"], r["seed"]): numbers(r) for r in m["runs"]}
pairs = [(a, runs[("cosine",) + key[1:]]) for key, a in runs.items() if key[0] == "mine"]
assert len(pairs) == 4, runs.keys()
for a, b in pairs:
    assert a.keys() == b.keys() and len(a) > 8, a
    for key in a:  # a tail is a fit to the largest samples, whose order is that of their last bits
        tol = 1e-2 if "/tail/" in key else 1e-6
        assert math.isclose(a[key], b[key], rel_tol=tol, abs_tol=1e-9), (key, a[key], b[key])
f = {x["name"]: x for x in m["furnace"]}
assert math.isclose(f["mine"]["measured"], f["built_in"]["measured"], rel_tol=1e-6), f
PY
expect 0 "$CRESCENT" run mine.toml --out again --quiet --threads 1 --isa scalar
same_outputs out again

sed 's/^plugin = .*/exec = ".\/cosine"/' mine.toml >program.toml
expect 0 "$CRESCENT" run program.toml --out program --quiet
expect 0 python3 - <<'PY'
import json
m = json.load(open("program/metrics.json"))
mean = {r["arm"]: r["y_mean"] for r in m["runs"] if r["n"] == 16}
assert abs(mean["mine"] / mean["cosine"] - 1) < 0.05, mean
PY

told() {
    sed "s|^plugin = .*|$1|" mine.toml >odd.toml
    expect "$2" "$CRESCENT" run odd.toml --out odd --quiet
    grep -q -- "$3" said || die "it does not say '$3': $(cat said)"
    [ ! -e odd/metrics.json ] || die "something was written"
}
told 'plugin = "libnowhere.so"' 3 "the arm 'mine' does not start: cannot open the plugin"
told 'plugin = "mine.toml"' 3 "cannot open the plugin"
told 'exec = "./nowhere"' 2 "arms.mine.exec: the shell cannot start"
told 'exec = "read hello; echo hello 1 x; exit 3"' 3 "exit code 3"
told 'exec = ""' 2 "arms.mine.exec"
told 'sampler = "cosine"\nplugin = "libcosine.so"' 2 "one of sampler, exec and plugin"
cc_shared() { expect 0 "${CC:-cc}" -O2 -shared -fPIC -I"$CRESCENT_SOURCE/src" -o "$1.so" "$1.c" -lm; }
sed 's/return 0;/return 7;/' "$CRESCENT_SOURCE/examples/plugin/cosine.c" >fails.c && cc_shared fails
told 'plugin = "fails.so"' 3 "crescent_sampler_sample gave 7"
sed 's/return CRESCENT_SAMPLER_ABI/return 9/' "$CRESCENT_SOURCE/examples/plugin/cosine.c" >newer.c && cc_shared newer
told 'plugin = "newer.so"' 3 "has version 9 of the interface"
# A density of NaN, and a direction that is not unit, are bad samples: counted, and the assertion on them fails.
sed 's|pdf\[i\] = cos_theta / pi|pdf[i] = i == 3 ? NAN : cos_theta / pi|
    s|wi\[3 \* i\] = sin_theta|wi[3 * i] = (i == 5 ? 2 : 1) * sin_theta|' \
    "$CRESCENT_SOURCE/examples/plugin/cosine.c" >bad.c && cc_shared bad
sed 's|^plugin = .*|plugin = "bad.so"|; s|bad(mixture)|bad(mine)|' mine.toml >bad.toml
expect 1 "$CRESCENT" run bad.toml --out bad --quiet

expect 0 "$CRESCENT" check --plugin ./libcosine.so --json right.json
grep -Eq '; [1-9][0-9]+ questions were answered' printed || die "nothing is told of questions: $(tail -n 1 printed)"
sed 's|pdf\[i\] = wi|pdf[i] = 1.01 * wi|; s|pdf\[i\] = cos_theta|pdf[i] = 1.01 * cos_theta|' \
    "$CRESCENT_SOURCE/examples/plugin/cosine.c" >bright.c && cc_shared bright
expect 1 "$CRESCENT" check --quiet --plugin ./bright.so
expect 3 "$CRESCENT" check --quiet --plugin ./nowhere.so
expect 2 "$CRESCENT" check --quiet --plugin ./libcosine.so --exec ./cosine
