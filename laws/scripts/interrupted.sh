#!/bin/bash
# Ctrl-C and SIGTERM: exit 130 within a second, earlier outputs untouched, none half-made.
. "$(dirname "$0")/common.sh"

expect 0 "$CRESCENT" run "$tiny" --quiet --out good
cp -a good before
for signal in INT TERM; do
    for after in 0.1 0.6; do
        # A job in the background ignores SIGINT unless it has a process group of its own.
        set -m
        "$CRESCENT" run "$tiny" --out good --set 'arms.cosine.n=[16777216]' >printed 2>said &
        run=$!
        set +m
        sleep "$after"
        start=$(date +%s%N)
        kill -s "$signal" "$run"
        wait "$run"
        code=$?
        took=$((($(date +%s%N) - start) / 1000000))
        [ "$code" -eq 130 ] || die "SIG$signal after $after s: exit $code: $(cat said)"
        [ "$took" -le 1000 ] || die "SIG$signal after $after s: took $took ms"
        diff -r before good >difference || die "SIG$signal after $after s touched earlier outputs: $(cat difference)"
    done
done
