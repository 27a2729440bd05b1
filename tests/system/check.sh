#!/bin/bash
# Samplers of users: a struct built against an installed crescent, programs behind a pipe, draws in a file; a wrong call
# is reported with exit 2 before anything is checked.
. "$(dirname "$0")/common.sh"

without=
for package in OpenEXR PNG hwy Boost tomlplusplus; do without="$without -DCMAKE_DISABLE_FIND_PACKAGE_$package=ON"; done
build_example my_sampler $without
expect 0 my_sampler/build/my_sampler
[ ! -e my_sampler/build/my_sampler_test ] || expect 0 my_sampler/build/my_sampler_test

printf '%s\n' '#include "check/user.h"' 'struct V { double x, y, z; };' \
    'struct S { struct D { V wi; double pdf; }; D sample(V, int) const; double pdf(V, V) const; };' \
    'auto j = crescent::check_sampler("s", S{});' >odd.cpp
! "${CXX:-g++}" -std=c++20 -fsyntax-only -I"$CRESCENT_SOURCE/src" -I"$CRESCENT_SOURCE/include" odd.cpp >said 2>&1 || die "a u of int compiles"
grep -q "sample takes wo and then one to eight random numbers" said && [ "$(grep -c 'error:' said)" -eq 1 ] ||
    die "no sentence: $(grep error: said)"

# refused MEMBERS WORDS: a sampler with these members in addition to sample is rejected with one sentence that has these
# words.
refused() {
    printf '%s\n' '#include "check/user.h"' 'struct V { float x, y, z; };' 'struct U { float x, y; };' \
        "struct S { struct D { V wi; float pdf; }; D sample(V, U) const; $1 };" \
        'auto j = crescent::check_sampler("s", S{});' >odd.cpp
    ! "${CXX:-g++}" -std=c++20 -fsyntax-only -I"$CRESCENT_SOURCE/src" -I"$CRESCENT_SOURCE/include" odd.cpp >said 2>&1 || die "this compiles: $1"
    grep -q "$2" said && [ "$(grep -c 'error:' said)" -eq 1 ] || die "no sentence for $1: $(grep error: said)"
}
refused 'float pdf(V, V) const; std::array<float, 2> f(V, V) const;' "f takes (wo, wi).* and returns one number"
refused 'float pdf(V, V) const; int traits();' "traits() is const and returns crescent::Traits"
refused 'const char* pdf(V, V) const;' "pdf returns one number, 1/sr"

pipes=$CRESCENT_SOURCE/examples/pipe_samplers
expect 0 "${CC:-cc}" -O2 -o cosine "$pipes/cosine.c" -lm
# Every built-in sampler gets its expected verdicts: tests/conformance/.

expect 0 "$CRESCENT" check --quiet --exec ./cosine --json c.json --junit c.xml --html c.html
grep -q '"state": "right"' c.json || die "cosine.c is not right: $(head -c 300 c.json)"
expect 0 "$CRESCENT" check --quiet --exec "python3 $pipes/cosine.py" --wo 45
"$CRESCENT" check --quiet --wo 45 >list.txt  # all built-in samplers: none is accused, some may not be decided
case $? in 0 | 4) ;; *) die "a built-in sampler gets another verdict than expected: $(head -n 5 list.txt)" ;; esac
grep -q '^every ' list.txt || die "no line on the whole list: $(tail -n 1 list.txt)"
expect 0 "${CC:-cc}" -O2 -Wall -Wextra -Werror -o cosine_block "$pipes/cosine_block.c" -lm
expect 0 "$CRESCENT" check --quiet --exec ./cosine_block
sed 's/0\.5 \/ pi/1.01 \/ pi/' "$pipes/cosine.c" >bright.c
expect 0 "${CC:-cc}" -O2 -o bright bright.c -lm
expect 1 "$CRESCENT" check --quiet --exec ./bright --wo 45
grep -q "physics: wrong" printed || die "created energy is not reported: $(cat printed)"
expect 2 "$CRESCENT" check --quiet --exec ./nowhere
expect 0 "${CC:-cc}" -O2 -o coat "$pipes/coat.c" -lm
expect 0 "$CRESCENT" check --quiet --exec ./coat
sed 's/delta %a 1 1 1\\n", -ox, -oy, oz, mirrored/delta %a 1 1 1\\n", -ox, -oy, oz, 1.1 * mirrored/' "$pipes/coat.c" \
    >often.c
expect 0 "${CC:-cc}" -O2 -o often often.c -lm
expect 1 "$CRESCENT" check --quiet --exec ./often --wo 45
grep -q "density: wrong" printed || die "a delta part drawn less often than stated is not reported: $(cat printed)"
/usr/bin/python3 -c 'import numpy' || die "python3-numpy is missing"
expect 0 "$CRESCENT" check --quiet --exec "/usr/bin/python3 $pipes/glass.py"
expect 0 "$CRESCENT" check --quiet --exec "/usr/bin/python3 $pipes/glass.py" --wo 150 --json below.json
grep -q '"case": "w_o 150 deg' below.json || die "w_o under the surface is not judged"
sed 's/1 \/ eta\*\*2, 1\.0)  # of radiance/1.0, 1.0)/' "$pipes/glass.py" >unscaled.py
expect 1 "$CRESCENT" check --quiet --exec "/usr/bin/python3 unscaled.py" --wo 45 --sarif unscaled.sarif
grep -q "physics: wrong" printed || die "a missing eta^2 is not reported: $(cat printed)"
/usr/bin/python3 -c 'import json
run = json.load(open("unscaled.sarif"))["runs"][0]
places = {r["ruleId"]: r["locations"][0]["physicalLocation"] for r in run["results"]}
line = 1 + [each.startswith("def sample(") for each in open("unscaled.py")].index(True)
assert places["physics"] == {"artifactLocation": {"uri": "unscaled.py"}, "region": {"startLine": line}}, places' ||
    die "the SARIF file: $(cat unscaled.sarif)"
placed unscaled.sarif unscaled.py "$(grep -n '^def sample(' unscaled.py | cut -d: -f1)"
expect 1 "$CRESCENT" check --quiet --exec "/usr/bin/python3 $work/unscaled.py" --wo 45 --sarif unscaled.sarif
placed unscaled.sarif "file://$work/unscaled.py" "$(grep -n '^def sample(' unscaled.py | cut -d: -f1)"
# Arms of an experiment: at the sampler of a program, else at the arm, however its name is written.
sed 's/answer(\(words\|line\)/sample(\1/; s/{z \/ math.pi!r}/{2 * z \/ math.pi!r}/' "$pipes/cosine.py" >twice.py
sed '/^\[arms.uniform\]/,$d' "$tiny" >placed.toml
cat >>placed.toml <<'TOML'
[arms.uniform]
[arms]
mine = { exec = "/usr/bin/python3 twice.py" }
my-mix = { exec = "/usr/bin/python3 -c 'exec(open(\"twice.py\").read())'" }
TOML
for arm in mine my-mix; do
    expect 1 "$CRESCENT" check --quiet ./placed.toml --sampler "$arm" --wo 45 --sarif placed.sarif
    if [ "$arm" = mine ]; then placed placed.sarif twice.py "$(grep -n '^def sample(' twice.py | cut -d: -f1)"
    else placed placed.sarif placed.toml "$(grep -n '^my-mix' placed.toml | cut -d: -f1)"; fi
done
expect 0 "$CRESCENT" check --quiet --exec "/usr/bin/python3 $pipes/sky.py 512 1024"
sed 's/(j + np.clip(along/(j + 1 + np.clip(along/' "$pipes/sky.py" >next_texel.py
expect 1 "$CRESCENT" check --quiet --exec "/usr/bin/python3 next_texel.py 256 512"
expect 3 "$CRESCENT" check --quiet --exec 'read hello; echo hello 2 x weights=yes'
grep -q "expected one of u, domain, wo,.* got the unknown key 'weights'; did you mean 'weight'?" printed ||
    die "an unknown key is not named: $(cat printed)"
expect 3 "$CRESCENT" check --quiet --exec 'read hello; echo hello 2 x; exit 3'
grep -q "exit code 3" printed || die "it does not say how the program ended: $(cat printed)"

# Samplers without a pdf(w), with a branch of two intervals, with an f that fails at one pair, and one that never draws.
cat >small.py <<'PY'
import math
import sys

kind = sys.argv[1]
keys = {
    "no_pdf": "domain=hemisphere pdf=no weight=yes",
    "alias": "wo=none u=3",
    "mirror_nan": "domain=hemisphere",
    "never": "wo=none",
}
print("hello 2", kind, keys[kind], flush=True) if sys.stdin.readline() else sys.exit()
for line in sys.stdin:
    what, *given = line.split()
    wo, rest = [float(v) for v in given[:3]], [float(v) for v in given[3:]]
    if kind == "never":
        answer = {"sample": "0 0 1 0", "pdf": "0", "f": "-"}[what]
    elif what == "sample" and kind == "alias":  # light 1 from 1/2 to 3/4 of the third number, else light 0
        z = (1 - rest[0]) * (-1 if 0.5 <= rest[2] < 0.75 else 1)
        r, phi = math.sqrt(1 - z * z), 2 * math.pi * rest[1]
        answer = f"{r * math.cos(phi)!r} {r * math.sin(phi)!r} {z!r} {(3 if z > 0 else 1) / (8 * math.pi)!r}"
    elif what == "sample":
        r, z, phi = math.sqrt(rest[0]), math.sqrt(1 - rest[0]), 2 * math.pi * rest[1]
        answer = f"{r * math.cos(phi)!r} {r * math.sin(phi)!r} {z!r} {z / math.pi!r}"
        answer += " 0.5" if kind == "no_pdf" else ""
    elif what == "pdf":
        z = rest[2]
        answer = "-" if kind == "no_pdf" else repr((3 if z > 0 else 1) / (8 * math.pi) if kind == "alias" else z / math.pi)
    elif kind == "alias":
        answer = "-"
    else:
        mirrored = -wo[0] * rest[0] - wo[1] * rest[1] + wo[2] * rest[2]
        answer = "nan" if kind == "mirror_nan" and mirrored > 1 - 1e-9 else repr(0.5 / math.pi)
    print(answer, flush=True)
PY
expect 0 "$CRESCENT" check --quiet --exec "python3 small.py no_pdf" --wo 45
expect 0 "$CRESCENT" check --quiet --exec "python3 small.py alias"
expect 1 "$CRESCENT" check --quiet --exec "python3 small.py mirror_nan" --wo 45
grep -q "valid: wrong.*f(w) is not a number >= 0" printed || die "a NaN of f is not reported: $(cat printed)"
expect 4 "$CRESCENT" check --quiet --exec "python3 small.py never"

python3 - <<'PY'
import math, random
random.seed(5)
def row(lift):
    u, v = random.random(), random.random()
    z = math.sqrt(1 - u); r = math.sqrt(u); p = lift * z / math.pi
    return f"{u},{v},{r * math.cos(2 * math.pi * v)!r},{r * math.sin(2 * math.pi * v)!r},{z!r},{p!r},0.1\n"
for name, lift in (("right", 1), ("wrong", 1.02)):
    with open(name + ".csv", "w") as f: f.write("u1,u2,wix,wiy,wiz,pdf,f\n" + "".join(row(lift) for _ in range(40000)))
with open("table.csv", "w") as f:
    f.write("cos_theta,phi,pdf\n")
    for i in range(32):
        for j in range(64): f.write(f"{(i + 0.5) / 32},{(j + 0.5) * 2 * math.pi / 64},{(i + 0.5) / 32 / math.pi}\n")
PY
expect 0 "$CRESCENT" check --quiet --samples right.csv --wo 0,0,1 --pdf-table table.csv
expect 1 "$CRESCENT" check --quiet --samples wrong.csv --wo 0,0,1 --pdf-table table.csv
expect 0 "$CRESCENT" check --quiet --samples right.csv --wo 0,0,1 --pdf-table table.csv --against cosine --expect same
expect 1 "$CRESCENT" check --quiet --samples right.csv --wo 0,0,1 --pdf-table table.csv --against uniform --expect same
awk -F, -v OFS=, 'NR == 17 { $6 = -$6 } { print }' right.csv >negative.csv
expect 1 "$CRESCENT" check --samples negative.csv --wo 0,0,1 --pdf-table table.csv
grep -q "pdf is negative: 1 of 40000 rows, first at negative.csv:17: u = " printed ||
    die "a bad draw is not named by its line: $(cat printed)"
sed '7s/,[^,]*$/,oops/' right.csv >torn.csv
expect 2 "$CRESCENT" check --quiet --samples torn.csv --wo 0,0,1 --pdf-table table.csv
grep -q "^torn.csv:7:.*oops" said || die "no file, line and column: $(cat said)"

python3 - <<'PY'
import math, random
random.seed(6)
with open("disk.csv", "w") as right, open("no_root.csv", "w") as wrong:
    for f in right, wrong: f.write("x1,x2,pdf\n")
    for _ in range(40000):
        u, phi = random.random(), 2 * math.pi * random.random()
        for f, r in (right, math.sqrt(u)), (wrong, u):
            f.write(f"{r * math.cos(phi)!r},{r * math.sin(phi)!r},{1 / math.pi!r}\n")
with open("disk_table.csv", "w") as f: f.write(f"x1,x2,pdf\n0,0,{1 / math.pi!r}\n")
PY
expect 0 "$CRESCENT" check --quiet --samples disk.csv --domain disk --pdf-table disk_table.csv
expect 1 "$CRESCENT" check --quiet --samples no_root.csv --domain disk --pdf-table disk_table.csv
sed '7s/,[^,]*$/,oops/' disk.csv >torn.csv
expect 2 "$CRESCENT" check --quiet --samples torn.csv --domain disk --pdf-table disk_table.csv
grep -q "^torn.csv:7:.*oops" said || die "no file, line and column: $(cat said)"
expect 2 "$CRESCENT" check --quiet --samples disk.csv --domain square --pdf-table disk_table.csv --wo 30
for call in "phng" "--set q=1" "phong --set alpha=0.2" "--alpha 0" "--alpha 2" "--seed x" "--exec" \
    "--samples right.csv" "cosine --exec ./cosine" "cosine --wo 95" "cosine --wo 0,0,-1" "cosine --wo 1,2,3,4"; do
    expect 2 "$CRESCENT" check $call
done
expect 2 "$CRESCENT" check --exec ''
expect 0 "$CRESCENT" check --quiet cosine --wo 60,250 --wo 0,0,1 --json wo.json
grep -q '"command": "crescent check cosine --wo 60,250 --wo 0,0,1"' wo.json ||
    die "--wo is not in the command: $(grep '"command"' wo.json)"
[ "$(grep -c '"case": "w_o 60 deg az 250' wo.json)" -gt 0 ] && ! grep -q "w_o 45 deg" wo.json ||
    die "--wo is not what is judged: $(grep case wo.json | sort | uniq -c)"
expect 0 "$CRESCENT" check --quiet uniform --set alpha=0.5 --wo 45 --against cosine --json against.json
grep -q "B is better here" printed && grep -q '"name": "same_f"' against.json ||
    die "nothing is said of two samplers: $(cat printed)"
expect 1 "$CRESCENT" check --quiet uniform --set alpha=0.5 --wo 45 --against cosine --expect same
expect 0 "$CRESCENT" check --quiet --exec ./cosine --wo 45 --against ./cosine --expect same
expect 2 "$CRESCENT" check uniform --against cosin
expect 2 "$CRESCENT" check uniform --against ./nowhere
asked=$(sed -n 's/.*"questions": \([0-9]*\).*/\1/p' c.json)
[ "${asked:-0}" -gt 100000 ] && [ "$asked" -le 3600000 ] || die "cosine.c was asked '$asked' questions"
expect 3 "$CRESCENT" check cosine --json /nowhere/x.json

# Known failures are waived, with a reason; a waived verdict that passes is an error; inconclusive results may be
# allowed.
expect 1 "$CRESCENT" check phong --quiet --wo 60
waiver='phong support=wrong: it never reaches the horizon'
expect 0 "$CRESCENT" check phong --quiet --wo 60 --expect "$waiver" --allow-inconclusive --json waived.json
grep -q "support: wrong as waived at .*: it never reaches the horizon" printed || die "the waiver is not told: $(cat printed)"
grep -q '"waived": true' waived.json || die "the file does not say what was waived"
printf '# known\nphong support=wrong: the horizon\ncosine density=wrong: no more\n' >known.txt
expect 2 "$CRESCENT" check phong --quiet --wo 60 --expect known.txt
expect 1 "$CRESCENT" check cosine --quiet --wo 60 --expect 'density=wrong: no more'
grep -q "the expectation can go" printed || die "an expectation that nothing meets is not told: $(cat printed)"
expect 2 "$CRESCENT" check cosine --quiet --wo 60 --expect 'densty=wrong'
expect 4 "$CRESCENT" check phong --quiet --wo 0
expect 0 "$CRESCENT" check phong --quiet --wo 0 --allow-inconclusive
