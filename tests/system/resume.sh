#!/bin/bash
# A killed run is resumed: the same bytes as an uninterrupted run, with less work.
. "$(dirname "$0")/common.sh"

long=(run "$tiny" --quiet --keep-after 0 --set image.width=256 --set image.height=144 --set seeds=4
    --set 'arms.cosine.n=[16,384]' --set 'arms.mixture.n=[16,384]' --set 'regions.ball.box=[100,60,130,90]')
expect 0 "$CRESCENT" "${long[@]}" --out alone
long+=(--out stopped)

# kill_after PASSES: kills a run once it has stored that many passes of the mixture.
passes() { cat stopped/.crescent-kept/* 2>/dev/null | grep -ao 'mixture' | wc -l; }
kill_after() {
    "$CRESCENT" "${long[@]}" >/dev/null 2>&1 &
    local run=$!
    until [ "$(passes)" -ge $((2 * $1)) ]; do # each has two sample counts
        kill -0 "$run" 2>/dev/null || die "the run ended before it kept $1 passes"
        sleep 0.01
    done
    kill -s KILL "$run"
    wait "$run" 2>/dev/null
}

kill_after 1
kill_after 2
truncate -s -100 stopped/.crescent-kept/*
expect 0 "$CRESCENT" "${long[@]}" --threads 1 --isa scalar
same_outputs alone stopped
[ -e stopped/.crescent-kept ] && die "what was kept is still there"
drawn() { grep -o '"samples": [0-9]*' "$1/timing.json" | awk '{ sum += $2 } END { print sum }'; }
[ "$(drawn stopped)" -lt "$(drawn alone)" ] || die "nothing of the killed run was used"

# Another experiment takes nothing from it, and does not remove it: the first one is resumed afterwards.
kill_after 1
expect 0 "$CRESCENT" run "$tiny" --out stopped
grep -q 'resuming from' said && die "another experiment went on from what was kept: $(cat said)"
grep -q 'another, unfinished run' said || die "nothing is said of what another run kept: $(cat said)"
expect 0 "$CRESCENT" run "$tiny" --out tiny
same_outputs_but_kept() {
    diff -r -x timing.json -x .crescent-kept "$1" "$2" >difference || die "$1 and $2 differ: $(cat difference)"
}
same_outputs_but_kept tiny stopped
expect 0 "$CRESCENT" "${long[@]}"
same_outputs alone stopped
[ -e stopped/.crescent-kept ] && die "what was kept outlived the outputs"

# Another part of the same experiment's seeds takes nothing from it either, and does not remove it.
kill_after 1
kept=(stopped/.crescent-kept/*)
expect 0 "$CRESCENT" "${long[@]}" --seed-range 2:2 --only metrics
grep -q 'resuming from' said && die "another part went on from what was kept: $(cat said)"
[ -e "${kept[0]}" ] || die "what one part kept went with another one's outputs"
expect 0 "$CRESCENT" "${long[@]}"
same_outputs alone stopped

# The same scene with another light, stopped and run into one folder: nothing of the first one is used.
sed 's/radiance = \[90, 80, 70\]/radiance = [900, 800, 700]/' "$tiny" >bright.toml
kill_after 1
bright=("${long[@]}")
bright[1]=bright.toml
expect 0 "$CRESCENT" "${bright[@]}"
bright[-1]=fresh
expect 0 "$CRESCENT" "${bright[@]}"
same_outputs_but_kept fresh stopped
exit 0
