#!/bin/bash
# Output on stdout and stderr, and the behaviour after its reader has closed the pipe.
. "$(dirname "$0")/common.sh"

expect 0 "$CRESCENT" run "$tiny" --quiet
[ ! -s said ] || die "--quiet said: $(cat said)"
[ -f out/tiny/metrics.json ] || die "the default folder is not out/ and the file's name"
awk 'length > 80 { exit 1 }' printed || die "the summary is wider than 80 columns"

expect 0 "$CRESCENT" run "$tiny" --out lines
[ -s said ] || die "no progress in a log"
grep -q $'[\r\e]' said && die "a log has terminal codes in it: $(cat -v said)"

"$CRESCENT" run "$tiny" --quiet --out piped | true
[ "${PIPESTATUS[0]}" -eq 0 ] || die "a reader who went away stopped the run"
"$CRESCENT" run "$tiny" --quiet --out closed >&- 2>&- || die "closed stdout and stderr stopped the run"
same_outputs out/tiny piped
same_outputs out/tiny closed
