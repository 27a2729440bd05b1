#!/bin/bash
# A run in parts: --only writes what was requested, --seed-range splits the series so that its parts equal the whole,
# and metrics.csv has a column for each key that --set gave, with unique names.
. "$(dirname "$0")/common.sh"

expect 0 "$CRESCENT" run "$tiny" --quiet --seeds 5 --out whole
names() { (cd "$1" && find . -type f ! -name '.*' | sort | tr '\n' ' '); }

expect 0 "$CRESCENT" run "$tiny" --quiet --seeds 5 --out metrics --only metrics
[ "$(names metrics)" = "./junit.xml ./metrics.csv ./metrics.json ./timing.json " ] ||
    die "--only metrics: $(names metrics)"
cmp whole/metrics.csv metrics/metrics.csv || die "--only changes metrics.csv"
expect 0 "$CRESCENT" run "$tiny" --quiet --out films --only films
case "$(names films)" in *json*metrics* | *plates* | *report*) die "--only films: $(names films)" ;; esac
expect 0 "$CRESCENT" run "$tiny" --quiet --seeds 5 --out metrics --only plates,report
[ -e metrics/report.html ] && [ ! -e metrics/metrics.json ] || die "--only plates,report: $(names metrics)"

# Without tails, furnaces and article checks every other number is the same, and the assertions on them are skipped.
grep -q ',tail_' whole/metrics.csv || die "the run has no tails that could be left out"
furnace=(--set 'furnaces.white={arm = "uniform", shape = "ball", part = "combined", n = 64}')
skipped=(--set 'assertions.white.check="furnace(white) > 9"' --set 'assertions.tail.check="tail.ball(uniform) > 9"')
expect 1 "$CRESCENT" run "$tiny" --quiet --seeds 2 --only metrics "${furnace[@]}" "${skipped[@]}" --out studied
expect 0 "$CRESCENT" run "$tiny" --quiet --seeds 2 --only metrics "${furnace[@]}" "${skipped[@]}" --no-studies --out unstudied
grep -q '^2 assertions skipped: tails and furnaces were left out$' printed || die "not skipped: $(cat printed)"
grep -q 'warning: tails were left out' printed || die "no warning: $(cat printed)"
grep -v ',tail_' studied/metrics.csv | cmp - unstudied/metrics.csv || die "--no-studies changes other numbers"
grep -q '"studies": false' unstudied/metrics.json || die "metrics.json does not say that studies were left out"
grep -q -- '--no-studies' unstudied/metrics.json || die "the command does not have --no-studies"
expect 0 "$CRESCENT" report unstudied/metrics.json
expect 0 "$CRESCENT" run "$tiny" --quiet --no-studies --out page
[ -e page/report.html ] || die "no report without studies: $(names page)"

# Without references there are the films of the first seed, and no metrics.
expect 0 "$CRESCENT" run "$tiny" --quiet --seeds 5 --no-references --out bare
(cd whole && ls films | grep -v reference) | diff - <(ls bare/films) || die "--no-references: $(names bare)"
hashes() { grep -o '"[^"]* n=[0-9]* s=[^"]*": "[0-9a-f]*"' "$1/metrics.json"; }
[ "$(hashes bare | wc -l)" -eq 6 ] && diff <(hashes whole) <(hashes bare) || die "--no-references changes films"
[ "$(wc -l <bare/metrics.csv)" -eq 1 ] || die "metrics without a reference: $(head -n 3 bare/metrics.csv)"
grep -q '^1 assertion skipped: no reference was computed$' printed || die "not skipped: $(cat printed)"
expect 0 "$CRESCENT" run "$tiny" --quiet --no-references --only metrics --out bare
[ "$(names bare)" = "./junit.xml ./metrics.csv ./metrics.json ./timing.json " ] || die "--only metrics: $(names bare)"
for only in plates report films,report; do
    expect 2 "$CRESCENT" run "$tiny" --no-references --only "$only" --out nowhere
    grep -q '^--no-references: expected together with --only metrics, films or both' said || die "why: $(cat said)"
done
expect 2 "$CRESCENT" run "$tiny" --only metrix --out nowhere
grep -q "did you mean 'metrics'" said || die "no hint: $(cat said)"
expect 2 "$CRESCENT" run "$tiny" --only '' --out nowhere

expect 0 "$CRESCENT" run "$tiny" --quiet --seeds 5 --seed-range 1:2 --only metrics --out first
expect 0 "$CRESCENT" run "$tiny" --quiet --seeds 5 --seed-range 3:5 --only metrics --out second
tail -n +2 first/metrics.csv | grep -v ',tail_' | sort >parts
tail -n +2 second/metrics.csv | grep -v ',tail_' | sort >>parts
tail -n +2 whole/metrics.csv | grep -v ',tail_' | sort >all
sort parts | cmp - <(sort all) || die "the parts of a series are not the whole"
grep -A3 '"series"' second/metrics.json | tr -d ' \n' | grep -q '"first":3,"last":5,"of":5' ||
    die "metrics.json does not say which seeds"
for wrong in 0:2 2:1 1:6 1 1: a:b 1:2x; do
    expect 2 "$CRESCENT" run "$tiny" --seeds 5 --seed-range "$wrong" --out nowhere
done
[ ! -e nowhere ] || die "a wrong call left an output folder"

expect 0 "$CRESCENT" run "$tiny" --quiet --only metrics --set ball.s=9 --set exposure=2 --set ball.s=12 --out set
head -n 1 set/metrics.csv | grep -q ',value,ball.s,exposure' || die "no columns for --set: $(head -n 1 set/metrics.csv)"
sed -n 2p set/metrics.csv | tr -d '\r' | grep -q ',12,2$' || die "no values for --set: $(sed -n 2p set/metrics.csv)"
expect 0 "$CRESCENT" run "$tiny" --quiet --only metrics --set seed=9 --set n=4 --out twice
head -n 1 twice/metrics.csv | grep -q ',value,set.seed,set.n' ||
    die "two columns of one name: $(head -n 1 twice/metrics.csv)"

# A preview is one picture, written next to the files of an earlier run, and its boxes follow --set.
expect 0 "$CRESCENT" run "$tiny" --preview --quiet --out metrics
head -c 8 metrics/preview.png | cmp -s - <(printf '\211PNG\r\n\032\n') || die "no PNG: $(names metrics)"
[ -e metrics/report.html ] || die "a preview took what a run had left"
expect 0 "$CRESCENT" run "$tiny" --preview --quiet --out moved --set 'regions.ball.box=[1,2,9,9]'
[ "$(names moved)" = "./preview.png " ] || die "a preview wrote more: $(names moved)"
cmp -s metrics/preview.png moved/preview.png && die "the preview does not follow --set"
expect 2 "$CRESCENT" run "$tiny" --preview --only plates --out nowhere
expect 2 "$CRESCENT" run "$tiny" --preview --set 'regions.ball.box=[1,2,9999,9]' --out nowhere
expect 2 "$CRESCENT" run "$tiny" --preview --set 'camera.target=[0,90,9]' --out nowhere  # nothing is in view
[ ! -e nowhere ] || die "a wrong call left an output folder"
