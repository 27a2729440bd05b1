#!/bin/bash
# A wrong command line or experiment: exit 2, the nearest word, nothing written.
. "$(dirname "$0")/common.sh"

expect 2 "$CRESCENT"
expect 2 "$CRESCENT" rnu
grep -q "did you mean 'run'" said || die "no hint at 'run': $(cat said)"
expect 2 "$CRESCENT" run
expect 2 "$CRESCENT" run "$tiny" --tread 2
grep -q "did you mean '--threads'" said || die "no hint at '--threads': $(cat said)"
expect 2 "$CRESCENT" run "$tiny" --threads none
expect 2 "$CRESCENT" run "$tiny" --seeds 0
expect 2 "$CRESCENT" run "$tiny" --isa sse5
expect 2 "$CRESCENT" run "$tiny" --instrument telescope
expect 2 "$CRESCENT" run "$tiny" --set n
expect 2 "$CRESCENT" run "$tiny" --set n=none --set shapes.ball.radius=-1 --out there
[ "$(wc -l <said)" -eq 2 ] || die "expected two complaints, a line each: $(cat said)"
expect 2 "$CRESCENT" run absent.toml
expect 2 "$CRESCENT" list platez
printf 'title = "a"\nimage = 3\n[camera]\neye = [0, 0\n' >broken.toml
expect 2 "$CRESCENT" run broken.toml
grep -q '^broken.toml:[0-9]*:[0-9]*: ' said || die "no file:line:column: $(cat said)"
[ ! -e out ] && [ ! -e there ] || die "a wrong call left an output folder"

expect 0 "$CRESCENT" --help
expect 0 "$CRESCENT" run --help
awk 'length > 80 { exit 1 }' printed || die "the help is wider than 80 columns: $(awk 'length > 80' printed)"
expect 0 "$CRESCENT" --version
grep -q "^crescent $(cat "$CRESCENT_SOURCE/VERSION") " printed || die "version: $(cat printed)"
expect 0 "$CRESCENT" list
expect 0 "$CRESCENT" schema
expect 0 "$CRESCENT" schema --json
