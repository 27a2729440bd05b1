#!/bin/bash
# Each command once, on small inputs: its outputs are there, and right and wrong end with their exit codes. The other
# scripts of this folder have the details.
. "$(dirname "$0")/common.sh"

expect 0 "$CRESCENT" --version
for topic in arms isas verdicts plates; do
    expect 0 "$CRESCENT" list $topic
    [ -s printed ] || die "list $topic prints nothing"
done
expect 0 "$CRESCENT" schema --json
head -c 1 printed | grep -q '{' || die "the schema is no JSON"

expect 0 "$CRESCENT" run "$tiny" --quiet --seeds 2 --out whole
for name in metrics.json metrics.csv junit.xml timing.json report.html; do [ -s "whole/$name" ] || die "no $name"; done
ls whole/films/*.exr whole/plates/*.png >/dev/null || die "no films or plates"
expect 1 "$CRESCENT" run "$tiny" --quiet --only metrics --set 'assertions.no bad samples.check="bad(mixture) > 0"' --out failed
expect 2 "$CRESCENT" run "$tiny" --set image.widht=3 --out nowhere
grep -q "did you mean 'width'" said || die "no hint: $(cat said)"

# The same bits from any number of threads and from every instruction set.
expect 0 "$CRESCENT" list isas
while read -r isa; do
    expect 0 "$CRESCENT" run "$tiny" --quiet --seeds 2 --threads 1 --isa "$isa" --out "on-$isa"
    same_outputs whole "on-$isa"
done <<<"$(cat printed)"

# Two parts joined are the whole.
for range in 1:1 2:2; do
    expect 0 "$CRESCENT" run "$tiny" --quiet --seeds 2 --seed-range $range --out "part-$range"
done
expect 0 "$CRESCENT" join part-1:1 part-2:2 --out joined
cmp joined/metrics.csv whole/metrics.csv || die "the parts of a series are not the whole"

expect 0 "$CRESCENT" check cosine --wo 30 --json right.json --html right.html --junit right.xml
grep -q '"state": *"right"' right.json && [ -s right.html ] && [ -s right.xml ] || die "cosine: $(cat printed)"
expect 1 "$CRESCENT" check phong --set s=128 --wo 60
grep -q support printed || die "phong loses no support: $(cat printed)"
expect 0 "$CRESCENT" check --exec "python3 '$CRESCENT_SOURCE/examples/pipe_samplers/cosine.py'" --wo 30
expect 3 "$CRESCENT" check --exec 'exit 5' --wo 30

# Renders of one arm differ in noise alone; brighter ones are found.
for seed in 1 2 3 4; do
    expect 0 "$CRESCENT" run "$tiny" --quiet --only films --set seed=$seed --out "seed-$seed"
    expect 0 "$CRESCENT" run "$tiny" --quiet --only films --set seed=$((seed + 10)) --out "other-$seed"
    expect 0 "$CRESCENT" run "$tiny" --quiet --only films --set seed=$((seed + 20)) --set fill.radiance=[3,3.4,4] \
        --out "bright-$seed"
done
film=films/$(cd seed-1/films && ls | grep cosine | head -n 1)
expect 0 "$CRESCENT" compare --arm a="seed-*/$film" --arm b="other-*/$film" --layer n=16 --out same
expect 1 "$CRESCENT" compare --arm a="seed-*/$film" --arm b="bright-*/$film" --layer n=16 --expect same --out different

if "$CRESCENT" import --help >/dev/null 2>&1 && [ -x "$(dirname "$CRESCENT")/crescent-import" ]; then
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >triangle.obj
    expect 0 "$CRESCENT" import triangle.obj --out triangle.mesh
    grep -q ' 1 triangle,' printed || die "one triangle: $(cat printed)"
fi
if command -v ffmpeg >/dev/null; then
    expect 0 "$CRESCENT" film "$here/film.toml" --size 360p --from 0:08 --to 0:09 --out film --quiet
    [ -s film/crescent.mp4 ] && [ -s film/frames.json ] || die "no film"
fi
exit 0
