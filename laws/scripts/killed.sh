#!/bin/bash
# kill -9 at any moment: whatever stands under a final name is whole, and the next run is none the worse.
. "$(dirname "$0")/common.sh"

expect 0 "$CRESCENT" run "$tiny" --quiet --out whole
start=$(date +%s%N)
expect 0 "$CRESCENT" run "$tiny" --quiet --out whole
length=$((($(date +%s%N) - start) / 1000000))
for part in 10 60 85 95 100; do
    "$CRESCENT" run "$tiny" --quiet --out killed >/dev/null 2>&1 &
    run=$!
    sleep "$(awk "BEGIN { print $length * $part / 100000 }")"
    kill -s KILL "$run" 2>/dev/null
    wait "$run" 2>/dev/null
    [ -d killed ] || continue
    (cd killed && find . -type f ! -path '*.partial*' ! -path './.*' ! -name timing.json) | while read -r name; do
        cmp -s "killed/$name" "whole/$name" || die "killed after $part % of a run: $name is not whole"
    done || exit 1
done
expect 0 "$CRESCENT" run "$tiny" --quiet --out killed
same_outputs whole killed
