#!/bin/bash
# Ctrl-C and SIGTERM at any moment: exit 130 within a second, and the message about the outputs is true: not changed, or
# those of the new run. From the first milliseconds to the end of the run.
. "$(dirname "$0")/common.sh"

expect 0 "$CRESCENT" run "$tiny" --quiet --out good
cp -a good before
visible() { (cd "$1" && find -L . -type f ! -path './.*' ! -name timing.json -exec sha256sum {} + | sort -k 2); }
visible before >of_before
# Before main the handlers are not installed yet: the dynamic loader runs, and a sanitizer's start takes time.
case "$CRESCENT" in *sanitize*) silent="0 0.02 0.1" ;; *) silent="0" ;; esac
for signal in INT TERM; do
    for after in 0 0.02 0.1 0.6; do
        # A job in the background ignores SIGINT unless it has a process group of its own.
        set -m
        "$CRESCENT" run "$tiny" --out good --set 'arms.cosine.n=[16777216]' >printed 2>said &
        run=$!
        set +m
        # The shell's child is not crescent yet.
        until [ "$(readlink /proc/$run/exe)" = "$(readlink -f "$CRESCENT")" ]; do :; done
        sleep "$after"
        start=$(date +%s%N)
        kill -s "$signal" "$run"
        wait "$run"
        code=$?
        took=$((($(date +%s%N) - start) / 1000000))
        if [[ " $silent " != *" $after "* ]]; then
            [ "$code" -eq 130 ] || die "SIG$signal after $after s: exit $code: $(cat said)"
            grep -q 'not changed' said || die "SIG$signal after $after s: nothing is said of the outputs: $(cat said)"
        fi
        [ "$took" -le 1000 ] || die "SIG$signal after $after s: took $took ms"
        visible good >of_good
        cmp -s of_before of_good || die "SIG$signal after $after s touched earlier outputs: $(diff of_before of_good)"
    done
done

# Around the end of a run of another experiment.
start=$(date +%s%N)
expect 0 "$CRESCENT" run "$tiny" --quiet --out new --set seed=11
length=$((($(date +%s%N) - start) / 1000000))
visible new >of_new
for part in 60 80 90 95 100 105; do
    rm -rf good && cp -a before good
    set -m
    "$CRESCENT" run "$tiny" --quiet --out good --set seed=11 >printed 2>said &
    run=$!
    set +m
    sleep "$(awk "BEGIN { print $length * $part / 100000 }")"
    kill -s INT "$run" 2>/dev/null
    wait "$run"
    code=$?
    visible good >of_good
    if [ "$code" -eq 0 ] || grep -q 'of this run are complete' said; then
        cmp -s of_new of_good || die "exit $code, and the outputs are not the new ones"
    elif grep -q 'not changed' said; then cmp -s of_before of_good || die "'not changed' is said, and it is not so"
    else cmp -s of_new of_good || cmp -s of_before of_good || die "exit $code: a mixture: $(cat said)"
    fi
done
exit 0
