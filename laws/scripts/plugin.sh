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

# The rose asks a library for its density, and a program, and shows both as cosine; of a library that exports none it
# says so: no colours then.
cat >colours.py <<'PY'
# The numbers of colours in the left and the right half of a PNG of 8-bit RGB.
import struct, sys, zlib
data, at, body = open(sys.argv[1], "rb").read(), 8, b""
while at < len(data):
    size, kind = struct.unpack(">I4s", data[at : at + 8])
    if kind == b"IHDR": width, height, depth, colour = struct.unpack(">IIBB", data[at + 8 : at + 18])
    if kind == b"IDAT": body += data[at + 8 : at + 8 + size]
    at += size + 12
assert (depth, colour) == (8, 2)
raw, row, halves = zlib.decompress(body), bytearray(3 * width), (set(), set())
for j in range(height):
    begin = j * (3 * width + 1)
    kind, line = raw[begin], bytearray(raw[begin + 1 : begin + 1 + 3 * width])
    for i in range(3 * width):
        a, b, c = (line[i - 3] if i > 2 else 0), row[i], (row[i - 3] if i > 2 else 0)
        near = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
        line[i] = (line[i] + (0, a, b, (a + b) // 2, near)[kind]) & 255
    row = line
    for i in range(width): halves[2 * i >= width].add(bytes(row[3 * i : 3 * i + 3]))
print(*map(len, halves))
PY
# rose FOLDER: the colours of its rose, of mine and of the built-in.
rose() { read -r mine built_in < <(python3 colours.py "$1/plates/rose.png") || die "no rose in $1"; }
for folder in out program; do
    rose $folder
    [ "$mine" -gt $((built_in * 4 / 5)) ] || die "the rose in $folder: $mine colours, of the built-in $built_in"
done
sed 's/^int crescent_sampler_pdf/int unasked/' "$CRESCENT_SOURCE/examples/plugin/cosine.c" >unasked.c
cc_shared unasked
sed 's|^plugin = .*|plugin = "unasked.so"|' mine.toml >unasked.toml
expect 0 "$CRESCENT" run unasked.toml --out unasked --quiet --only plates
rose unasked
[ "$mine" -lt $((built_in * 4 / 5)) ] || die "a rose without a density: $mine colours, with one $built_in"

# A library that ends the process ends a child of crescent's: it is told what was called, at which arm. It is an error
# of the sampler, and the outputs of before stand, with nothing half-written beside them.
# broken NAME CODE HEADER: cosine whose samples begin with this.
broken() {
    printf '#include <%s>\n' "$3" >"$1.c"
    sed "0,/(void)wo, (void)surface;/s//$2 &/" "$CRESCENT_SOURCE/examples/plugin/cosine.c" >>"$1.c"
}
broken leaves 'exit(0);' stdlib.h && cc_shared leaves
broken slips '_exit(0);' unistd.h && cc_shared slips
broken crashes 'raise(SIGSEGV);' signal.h && cc_shared crashes
broken aborts 'abort();' stdlib.h && cc_shared aborts
broken throws 'if (wo) throw std::runtime_error("no such light");' stdexcept
expect 0 "${CXX:-c++}" -O2 -shared -fPIC -I"$CRESCENT_SOURCE/src" -x c++ -o throws.so throws.c
expect 0 "$CRESCENT" run "$tiny" --out kept --quiet
cp -a kept before
while IFS='|' read -r name how; do
    told "plugin = \"$name.so\"" 3 "the arm 'mine' broke off: .*$name.so.*$how"
    expect 3 "$CRESCENT" run odd.toml --out kept --quiet
    diff -r before kept >difference || die "after $name: $(head -n 5 difference)"
    expect 3 "$CRESCENT" check --quiet --plugin "./$name.so" --wo 45 --json error.json --junit error.xml
    tr -s ' \n' '  ' <printed | grep -q "$name.so.*$how" || die "check does not say '$how': $(head -c 600 printed)"
    grep -q '"state": "error"' error.json && grep -q '<error' error.xml || die "the files call $name no error"
done <<'END'
leaves|crescent_sampler_sample at w_o = (.*by a call of exit()
slips|exit code 0
crashes|crescent_sampler_sample at w_o = (.*signal 11
aborts|crescent_sampler_sample at w_o = (.*signal 6
throws|crescent_sampler_sample at w_o = (.*threw 'no such light'
END

# Ctrl-C that reaches crescent alone ends the child too.
broken waits 'sleep(60);' unistd.h && cc_shared waits
sed 's|^plugin = .*|plugin = "waits.so"|' mine.toml >waits.toml
set -m
"$CRESCENT" run waits.toml --out kept --quiet >printed 2>said &
run=$!
set +m
for _ in $(seq 200); do [ -e .kept.crescent/lock ] && break || sleep 0.05; done
children=$(cat /proc/$run/task/*/children 2>/dev/null)
kill -s INT "$run"
wait "$run"
code=$?
[ "$code" -eq 130 ] && grep -q 'not changed' said || die "SIGINT: exit $code: $(cat said)"
for child in $children; do [ ! -e "/proc/$child" ] || die "the child $child lives on"; done

expect 0 "$CRESCENT" check --plugin ./libcosine.so --json right.json
grep -Eq '; [1-9][0-9]+ questions were answered' printed || die "nothing is told of questions: $(tail -n 1 printed)"
sed 's|pdf\[i\] = wi|pdf[i] = 1.01 * wi|; s|pdf\[i\] = cos_theta|pdf[i] = 1.01 * cos_theta|' \
    "$CRESCENT_SOURCE/examples/plugin/cosine.c" >bright.c && cc_shared bright
expect 1 "$CRESCENT" check --quiet --plugin ./bright.so
expect 3 "$CRESCENT" check --quiet --plugin ./nowhere.so
expect 2 "$CRESCENT" check --quiet --plugin ./libcosine.so --exec ./cosine
