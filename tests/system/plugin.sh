#!/bin/bash
# External samplers: cosine as a shared library gives the built-in's numbers to 1e-6, on a scene with lights, lobes,
# furnaces and plates; a program works too; one that is missing, faulty or terminates is reported with its arm's name.
. "$(dirname "$0")/common.sh"

expect 0 "${CC:-cc}" -O2 -shared -fPIC -I"$CRESCENT_SOURCE/src" -I"$CRESCENT_SOURCE/include" -o libcosine.so \
    "$CRESCENT_SOURCE/examples/plugin/cosine.c" -lm
expect 0 "${CC:-cc}" -O2 -o cosine "$CRESCENT_SOURCE/examples/pipe_samplers/cosine.c" -lm
{
    sed 's/^\[arms.uniform\]/[arms.mine]\nplugin = "libcosine.so"/; s/^seeds = 1/seeds = 2/' "$tiny"
    printf '%s\n' '[plates.rose]' 'kind = "rose"' 'runs = [{arm = "mine", n = 16}, {arm = "cosine", n = 16}]' \
        '[furnaces.mine]' 'arm = "mine"' 'shape = "ball"' 'n = 4096' '[furnaces.built_in]' 'arm = "cosine"' \
        'shape = "ball"' 'n = 4096'
} >mine.toml
expect 0 "$CRESCENT" check --quiet cosine --wo 45 --against ./libcosine.so --expect same
expect 3 "$CRESCENT" check --quiet cosine --wo 45 --against ./libnowhere.so
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
    for key in a:  # a tail is a fit to the largest samples, whose order depends on their last bits
        tol = 1e-2 if "/tail/" in key else 1e-5 if key.endswith("/bias2") else 1e-6  # a difference of near numbers
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
mkfifo pipe.so
told 'plugin = "pipe.so"' 2 "arms.mine.plugin: expected a regular file"
expect 3 "$CRESCENT" check --plugin ./pipe.so --quiet
told 'exec = "./nowhere"' 2 "arms.mine.exec: the shell cannot start"
told 'exec = "read hello; echo hello 2 x; exit 3"' 3 "exit code 3"
told 'exec = ""' 2 "arms.mine.exec"
told 'sampler = "cosine"\nplugin = "libcosine.so"' 2 "one of sampler, kind, exec, plugin and python"
# A verdict on a library is at the library, and one on an arm at the line of the arm.
sed 's/pdf\[i\] = cos_theta/pdf[i] = 2 * cos_theta/' "$CRESCENT_SOURCE/examples/plugin/cosine.c" >double.c
expect 0 "${CC:-cc}" -O2 -shared -fPIC -I"$CRESCENT_SOURCE/include" -I"$CRESCENT_SOURCE/src" -o double.so double.c -lm
expect 1 "$CRESCENT" check --quiet --plugin ./double.so --wo 30 --sarif double.sarif
placed double.sarif double.so 1
sed 's|^plugin = .*|plugin = "double.so"|' mine.toml >double.toml
expect 1 "$CRESCENT" check --quiet double.toml --sampler mine --wo 30 --sarif double.sarif
placed double.sarif double.toml "$(grep -n '^\[arms.mine\]' double.toml | cut -d: -f1)"
cc_shared() { expect 0 "${CC:-cc}" -O2 -shared -fPIC -I"$CRESCENT_SOURCE/src" -I"$CRESCENT_SOURCE/include" -o "$1.so" "$1.c" -lm; }
sed 's/return 0;/return 7;/' "$CRESCENT_SOURCE/examples/plugin/cosine.c" >fails.c && cc_shared fails
told 'plugin = "fails.so"' 3 "gave 7, expected 0, in crescent_sampler_sample"
for version in 1 9; do
    sed "s/return CRESCENT_SAMPLER_ABI/return $version/" "$CRESCENT_SOURCE/examples/plugin/cosine.c" >other.c && cc_shared other
    told 'plugin = "other.so"' 3 "has version $version of the interface.*compile it with the sampler_plugin.h"
done
# A density of NaN, and a direction that is not unit, are bad samples: counted, and the assertion on them fails.
sed 's|pdf\[i\] = cos_theta / pi|pdf[i] = i == 3 ? NAN : cos_theta / pi|
    s|wi\[3 \* i\] = sin_theta|wi[3 * i] = (i == 5 ? 2 : 1) * sin_theta|' \
    "$CRESCENT_SOURCE/examples/plugin/cosine.c" >bad.c && cc_shared bad
sed 's|^plugin = .*|plugin = "bad.so"|; s|bad(mixture)|bad(mine)|' mine.toml >bad.toml
expect 1 "$CRESCENT" run bad.toml --out bad --quiet

# The rose evaluates the density of a library, and of a program, and shows both as cosine; a library that exports none
# is reported: it has no colours.
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

# Version 2 of the interface: the material by channel and the lights in the frame of each point. Version 1 still runs.
cp "$here/lights_plugin.c" lights.c && cc_shared lights
sed 's/^\[arms.cosine\]/[arms.light-area]/; s/^radiance = \[1.2.*/radiance = [0, 0, 0]/
    s/^\[arms.uniform\]/[arms.mine]\nplugin = "lights.so"/' "$tiny" >lights.toml
expect 0 "$CRESCENT" run lights.toml --out lights --only metrics --quiet
expect 0 python3 - <<'PY'
import json
m = json.load(open("lights/metrics.json"))
mean = {r["arm"]: r["y_mean"] for r in m["runs"] if r["n"] == 16}
assert mean["mine"] > 0 and abs(mean["mine"] / mean["light-area"] - 1) < 0.01, mean
PY
expect 0 "$CRESCENT" check --quiet --plugin ./lights.so --wo 30
sed 's/"rho_d,lights"/"rho_d,lamps"/' lights.c >lamps.c && cc_shared lamps
told 'plugin = "lamps.so"' 3 "crescent_sampler_uses gives 'rho_d,lamps': expected s, alpha, rho_d, rho_s, side, eta, lights"

# What a plugin may do to its process. odd NAME [-D HOOK]...: odd_plugin.c as NAME.so and an experiment NAME.toml.
odd() {
    local name=$1
    shift
    expect 0 "${CC:-cc}" -O2 -shared -fPIC -pthread -I"$CRESCENT_SOURCE/src" -I"$CRESCENT_SOURCE/include" -o "$name.so" "$@" "$here/odd_plugin.c" -lm
    sed "s|^plugin = .*|plugin = \"$name.so\"|; s|bad(mixture)|bad(mine)|" mine.toml >"$name.toml"
}
# films: the hashes of the films of the last run.
films() { grep -oE '[a-z]+ (n=[0-9]+ )?(s=[0-9]+)? +[0-9a-f]{16}' printed; }
numbers() { python3 -c "
import json
m = json.load(open('$1/metrics.json'))
del m['provenance']
print(json.dumps(m))"; }

# None of these changes a film, a number, the place of an output or the next run: threads of its own, another rounding
# mode, another folder, mask or environment, handlers, text on stdout, a child that survives or that returns here too.
odd plain
expect 0 "$CRESCENT" run plain.toml --out plain --quiet --only metrics
films >of_plain && [ "$(wc -l <of_plain)" = 7 ] || die "films: $(cat of_plain)"
numbers plain >numbers_of_plain
while IFS='|' read -r name load call; do
    odd "$name" -D "ON_LOAD=$load" -D "ON_CALL=$call"
    for threads in 1 2; do
        expect 0 timeout 60 "$CRESCENT" run "$name.toml" --out "$name" --quiet --only metrics --threads $threads
        films >of_this && numbers "$name" >numbers_of_this
        diff of_plain of_this >difference || [ "$name" = rounds ] && ! grep -q '^[<>] [^m]' difference ||
            die "$name: films differ: $(cat difference)"
        [ "$name" = rounds ] || cmp -s numbers_of_plain numbers_of_this || die "$name: numbers differ"
        [ $threads = 1 ] || cmp -s numbers_of_this numbers_of_one || die "$name: numbers depend on threads"
        cp numbers_of_this numbers_of_one
    done
done <<'END'
threads|start_thread()|start_thread()
rounds|flush_to_zero()|flush_to_zero()
moves|umask(0777)|if (chdir("/") + setenv("PWD", "/", 1)) return 1
handles|signal(SIGPIPE, SIG_DFL)|signal(SIGINT, SIG_IGN), signal(SIGTERM, SIG_IGN)
prints|write_junk("hello 2 x")|write_junk("0 0 1 1")
forks||leave_a_child()
forks_on||fork_and_go_on()
registers|atexit(abort)|
END
expect 0 timeout 60 "$CRESCENT" check --quiet --plugin ./moves.so --wo 45 --json moves.json
[ -s moves.json ] || die "the file is elsewhere"

# bad NAME [-D HOOK]...: its samples are bad, and the assertion on them fails.
bad() {
    odd "$@"
    expect 1 "$CRESCENT" run "$1.toml" --out "$1" --quiet --only metrics
    grep -q 'bad samples' printed && grep -q 'a pdf that cannot be used' printed ||
        die "$1: nothing of bad samples: $(cat printed)"
    python3 -c "
import json
m = json.load(open('$1/metrics.json'))
assert all((r['bad'] > 0) == (r['arm'] == 'mine') for r in m['runs']), m['runs']" || die "$1: the wrong arms are bad"
}
n=0
for pdf in INFINITY NAN -1.0 1e39 1e-46; do bad "pdf$((n += 1))" -D "PDF=$pdf"; done
bad long -D LENGTH=1.01
# Of the pdfs in single precision the largest is used, and the smallest if cos / p is finite too.
for pdf in 1e-30 3.4e38; do
    odd "used$((n += 1))" -D "PDF=$pdf"
    expect 0 "$CRESCENT" run "used$n.toml" --out "used$n" --quiet --only metrics
done

# A plugin that ends its process, throws or does not respond is an error, exit 3: the call and how it ended. It is an
# error of the sampler, and earlier outputs are kept, without half-written files.
odd exits -D 'ON_CALL=exit(0)'
odd slips -D 'ON_CALL=_exit(7)'
odd crashes -D 'ON_CALL=raise(SIGSEGV)'
odd aborts -D 'ON_CALL=abort()'
odd alarms -D 'ON_CALL=raise(SIGALRM)'
odd interrupts -D 'ON_CALL=raise(SIGINT)'
odd stops -D 'ON_CALL=raise(SIGSTOP)'
odd loops -D 'ON_CALL=for (;;) {}'
odd starts -D 'ON_LOAD=raise(SIGBUS)'
odd closes -D 'ON_CALL=for (int fd = 3; fd < 256; ++fd) close(fd)'
sed "0,/(void)wo, (void)surface;/s//if (wo) throw std::runtime_error(\"no such light\"); &/" \
    "$CRESCENT_SOURCE/examples/plugin/cosine.c" | sed '1i #include <stdexcept>' >throws.c
expect 0 "${CXX:-c++}" -O2 -shared -fPIC -I"$CRESCENT_SOURCE/src" -I"$CRESCENT_SOURCE/include" -x c++ -o throws.so throws.c
expect 0 "$CRESCENT" run "$tiny" --out kept --quiet
cp -a kept before
while IFS='|' read -r name how; do
    sed "s|^plugin = .*|plugin = \"$name.so\"|" mine.toml >odd.toml
    expect 3 timeout 60 "$CRESCENT" run odd.toml --out kept --quiet --timeout 1
    [ "$(grep -c "the arm 'mine' .*$name.so.*$how" said)" = 1 ] || die "$name: it does not say '$how': $(cat said)"
    diff -r before kept >difference || die "after $name: $(head -n 5 difference)"
    expect 3 timeout 60 "$CRESCENT" check --quiet --plugin "./$name.so" --wo 45 --json error.json --junit error.xml \
        --timeout 1
    tr -s ' \n' '  ' <printed | grep -q "$name.so.*$how" || die "check does not say '$how': $(head -c 600 printed)"
    grep -q '"state": "error"' error.json && grep -q '<error' error.xml || die "the files call $name no error"
done <<'END'
exits|exit code 0 in crescent_sampler_sample at w_o = (
slips|exit code 7 in crescent_sampler_sample at w_o = (
crashes|signal 11 (SIGSEGV) in crescent_sampler_sample at w_o = (
aborts|SIGABRT
alarms|SIGALRM
interrupts|SIGINT
stops|after 1 s in crescent_sampler_sample at w_o = (
loops|after 1 s in crescent_sampler_sample at w_o = (
starts|SIGBUS
closes|crescent_sampler_sample at w_o = (
throws|threw 'no such light'.* at w_o = (
END
{ cat "$here/film.toml" && printf '[arms.mine]\nplugin = "loops.so"\nn = [16]\n'; } >film.toml
expect 3 timeout 60 "$CRESCENT" film film.toml --out film --still 0:01 --timeout 1 --quiet
grep -q "the plugin .*loops.so.*after 1 s" said || die "film: $(cat said)"

# Output of a plugin or a program reaches the terminal line by line after its name, and moves no cursor there.
junk='\033[2J\033]0;title\007 caf\303\251 \302\233 \377'
printf "$junk" >junk && head -c 100000 /dev/zero | tr '\0' y >>junk && printf 'end\0of it' >>junk
odd noisy -D 'ON_LOAD=system("cat junk >&2; printf part; printf ial >&2")'
expect 0 "$CRESCENT" check --quiet --plugin ./noisy.so --wo 45
python3 - "noisy.so: " <<'PY' || die "what the plugin printed: $(cat -v said | cut -c 1-300 | head -n 5)"
import sys
raw = open("said", "rb").read()
text = raw.decode()
lines = text.splitlines()
assert raw.endswith(b"\n") and all(line.startswith(sys.argv[1]) for line in lines), lines[:3]
assert not any(ord(c) < 32 and c != "\n" or 127 <= ord(c) < 160 for c in text)
joined = "".join(line[len(sys.argv[1]):] for line in lines)
assert "café" in joined and "end\\x00of it" in joined and "partial" in joined and joined.count("y") == 100000
PY
expect 0 "$CRESCENT" check --quiet --wo 45 --exec "cat junk >&2; exec ./cosine"
grep -q '^cat junk >&2; exec ./cosine: .*x1b\[2J.* café' said || die "of a program: $(cat -v said | cut -c 1-300)"

# Ctrl-C that reaches only crescent ends a plugin too, and so does a kill that it cannot handle.
odd "waits$$" -D 'ON_CALL=start_thread(); if (fork() == 0) pause(); for (;;) {}'
hosts() { pgrep -f "^crescent-plugin-host waits$$.so" >pids || true; }
for signal in INT TERM KILL; do
    set -m
    "$CRESCENT" run "waits$$.toml" --out kept --quiet >printed 2>said &
    run=$!
    set +m
    for _ in $(seq 200); do hosts; [ ! -s pids ] || break; sleep 0.05; done
    [ -s pids ] || die "no host"
    sleep 0.3
    kill -s $signal "$run"
    wait "$run" 2>/dev/null
    code=$?
    [ $signal = KILL ] || { [ "$code" -eq 130 ] && grep -q 'not changed' said; } ||
        die "SIG$signal: exit $code: $(cat said)"
    for _ in $(seq 40); do hosts; [ -s pids ] || break; sleep 0.05; done
    [ ! -s pids ] || die "SIG$signal: the hosts $(cat pids) live on"
done

expect 0 "$CRESCENT" check --plugin ./libcosine.so --json right.json --verbose
grep -Eq '; [1-9][0-9]+ questions were answered' printed || die "nothing is told of questions: $(tail -n 1 printed)"
sed 's|pdf\[i\] = wi|pdf[i] = 1.01 * wi|; s|pdf\[i\] = cos_theta|pdf[i] = 1.01 * cos_theta|' \
    "$CRESCENT_SOURCE/examples/plugin/cosine.c" >bright.c && cc_shared bright
expect 1 "$CRESCENT" check --quiet --plugin ./bright.so
expect 3 "$CRESCENT" check --quiet --plugin ./nowhere.so
expect 2 "$CRESCENT" check --quiet --plugin ./libcosine.so --exec ./cosine
