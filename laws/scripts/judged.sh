#!/bin/bash
# Samplers of one's own: a struct built against an installed crescent, programs behind a pipe, draws in a file; what is
# wrong with a call is told with exit 2, before anything is judged.
. "$(dirname "$0")/common.sh"

build_example my_sampler
expect 0 my_sampler/build/my_sampler
[ ! -e my_sampler/build/my_sampler_test ] || expect 0 my_sampler/build/my_sampler_test

printf '%s\n' '#include "verdicts/user.h"' 'struct V { double x, y, z; };' \
    'struct S { struct D { V wi; double pdf; }; D sample(V, V) const; double pdf(V, V) const; };' 'auto j = crescent::judge_sampler("s", S{});' >three.cpp
! "${CXX:-g++}" -std=c++20 -fsyntax-only -I"$CRESCENT_SOURCE/src" three.cpp >said 2>&1 || die "a u of three members compiles"
grep -q "the u of sample(wo, u) has three members" said && [ "$(grep -c 'error:' said)" -eq 1 ] || die "no sentence: $(grep error: said)"

pipes=$CRESCENT_SOURCE/examples/pipe_samplers
expect 0 "${CC:-cc}" -O2 -o cosine "$pipes/cosine.c" -lm
expect 0 "$CRESCENT" check --quiet --exec ./cosine --json c.json --junit c.xml --html c.html
grep -q '"state": "right"' c.json || die "cosine.c is not right: $(head -c 300 c.json)"
expect 0 "$CRESCENT" check --quiet --exec "python3 $pipes/cosine.py"
sed 's/0\.5 \/ pi/1.01 \/ pi/' "$pipes/cosine.c" >bright.c
expect 0 "${CC:-cc}" -O2 -o bright bright.c -lm
expect 1 "$CRESCENT" check --quiet --exec ./bright
grep -q "creates energy" printed || die "it does not say that energy is created: $(cat printed)"
expect 2 "$CRESCENT" check --quiet --exec ./nowhere
expect 3 "$CRESCENT" check --quiet --exec 'read hello; echo hello 1 x; exit 3'
grep -q "exit code 3" printed || die "it does not say how the program ended: $(cat printed)"

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
sed '7s/,[^,]*$/,oops/' right.csv >torn.csv
expect 2 "$CRESCENT" check --quiet --samples torn.csv --wo 0,0,1 --pdf-table table.csv
grep -q "^torn.csv:7:.*oops" said || die "no file, line and column: $(cat said)"
for call in "phng" "--set q=1" "phong --set alpha=0.2" "--alpha 0" "--alpha 2" "--seed x" "--exec" "--samples right.csv" "cosine --exec ./cosine" "cosine --wo 0,0,1"; do
    expect 2 "$CRESCENT" check $call
done
expect 2 "$CRESCENT" check --exec ''
expect 3 "$CRESCENT" check cosine --json /nowhere/x.json
