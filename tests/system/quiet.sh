#!/bin/bash
# Output on stdout and stderr, on a terminal and in a pipe, and the behaviour after its reader has closed the pipe.
. "$(dirname "$0")/common.sh"

expect 0 "$CRESCENT" run "$tiny" --quiet
[ ! -s said ] || die "--quiet said: $(cat said)"
[ -f out/tiny/metrics.json ] || die "the default folder is not out/ and the file's name"
awk 'length > 80 { exit 1 }' printed || die "the summary is wider than 80 columns"

# What makes a film wrong is said all the same.
sed '/^\[arms.uniform\]/,$d' "$tiny" >lossy.toml
cat >>lossy.toml <<'TOML'
[arms.both]
kind = "mis"
of = ["phong", "light-area"]
weights = [0.5, 0.5]
n = 4
[regions.all]
box = [0, 0, 95, 53]
TOML
expect 0 "$CRESCENT" run lossy.toml --quiet --only metrics
[ "$(wc -l <said)" -eq 1 ] && grep -q "^warning: both: .*MIS weight where its density is 0" said || die "--quiet: $(cat said)"

expect 0 "$CRESCENT" run "$tiny" --out lines
[ -s said ] || die "no progress in a log"
grep -q $'[\r\e]' said && die "a log has terminal codes in it: $(cat -v said)"

"$CRESCENT" run "$tiny" --quiet --out piped | true
[ "${PIPESTATUS[0]}" -eq 0 ] || die "a reader who went away stopped the run"
"$CRESCENT" run "$tiny" --quiet --out closed >&- 2>&- || die "closed stdout and stderr stopped the run"
same_outputs out/tiny piped
same_outputs out/tiny closed

# Verdicts of one sampler: at most 12 lines, with marks; colours and rows that fit are for a terminal alone.
expect 1 "$CRESCENT" check --quiet phong --wo 60
[ "$(wc -l <printed)" -le 12 ] && head -n 1 printed | grep -q '^✗ support: wrong' || die "not the short form: $(cat printed)"
! grep -q $'\e' printed || die "colours in a pipe: $(cat -v printed)"
expect 1 env COLUMNS=80 "$CRESCENT" check --quiet phong --wo 60
sed 's/✓\|✗/x/' printed | awk 'length > 80 { exit 1 }' && [ "$(wc -l <printed)" -le 12 ] || die "rows that do not fit: $(cat printed)"
expect 1 "$CRESCENT" check --quiet phong --wo 60 --verbose
grep -q "statistical tests share" printed && grep -q "of CPU time" printed || die "no details: $(cat printed)"

# on_terminal [VARIABLE=VALUE...]: what a terminal of 80 columns gets, in `printed`.
on_terminal() {
    python3 - "$@" <<'PY' >printed
import fcntl, os, pty, struct, sys, termios
child, end = pty.fork()
if child == 0:
    fcntl.ioctl(0, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 80, 0, 0))
    os.execvp("env", ["env", "-u", "NO_COLOR", "TERM=xterm", *sys.argv[1:], os.environ["CRESCENT"], "check", "--quiet", "phong", "--wo", "60"])
while True:
    try:
        text = os.read(end, 65536)
    except OSError:
        break
    sys.stdout.buffer.write(text.replace(b"\r", b""))
os.waitpid(child, 0)
PY
}
on_terminal
grep -q $'^\e\[1;31m✗ support: wrong' printed && grep -q $'^\e\[32m✓' printed || die "no colours: $(cat -v printed)"
[ "$(wc -l <printed)" -le 12 ] && sed $'s/\e\[[0-9;]*m//g; s/✓\|✗/x/' printed | awk 'length > 80 { exit 1 }' ||
    die "more than 12 rows of 80 columns: $(cat -v printed)"
for plain in NO_COLOR=1 TERM=dumb; do
    on_terminal "$plain"
    grep -q "✗ support: wrong" printed && ! grep -q $'\e' printed || die "$plain: $(cat -v printed)"
done
