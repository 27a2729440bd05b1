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
