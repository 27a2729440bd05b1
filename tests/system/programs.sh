#!/bin/bash
# Checked programs that are slow, terminate or break the protocol: skipped parts are reported and never pass, and a
# program that cannot be queried is an error, not a wrong sampler.
. "$(dirname "$0")/common.sh"

# fields FILE CODE: a line of Python over the result `j`.
fields() { python3 -c "import json; j = json.load(open('$1')); $2" || die "$1: not so: $2"; }
check() { "$CRESCENT" check --quiet "$@"; }

expect 0 "${CC:-cc}" -O2 -o slow "$here/slow.c" -lm
some="any(v['name'] != 'valid' and v['state'] == 'inconclusive' for v in j['verdicts'])"
everywhere="sum(v['name'] == 'valid' and v['state'] == 'right' for v in j['verdicts']) == 8"
expect 4 check --exec './slow 900000' --patience 20 --json few.json --junit few.xml --html few.html
fields few.json "assert $everywhere and $some and 0 < len(j['left_out']) <= 8 and j['state'] == 'inconclusive'"
for file in printed few.xml few.html; do
    grep -q "Not examined" $file || die "$file does not say what was not looked at"
done
expect 0 check --exec './slow 900000' --patience 20 --accept-few --json few.json
fields few.json "assert $everywhere and len(j['left_out']) > 0 and j['state'] == 'right'"
expect 1 check --exec './slow 20000 n:nan' --patience 3  # the normal is among the w_o that are skipped for lack of time

# broken WORDS PROGRAM: an error, reported with these words.
broken() {
    expect 3 check --exec "$2" --json broken.json --junit broken.xml
    grep -q -- "$1" printed || die "it does not say '$1': $(cat printed)"
    grep -q "<error" broken.xml && ! grep -q "<failure" broken.xml || die "no error in $(cat broken.xml)"
    fields broken.json "
assert j['state'] == 'error' and all(v['state'] in ('right', 'skipped', 'error') for v in j['verdicts'])"
}
broken "exit code 3" 'read hello; echo hello 2 x; exit 3'
broken "loading weights.*stdout is for answers alone" 'echo loading weights...; cat'
broken "exit code 2" 'python3 nowhere.py'
broken "signal 11" 'read hello; echo hello 2 x; read f; echo -; kill -SEGV $$'
broken "got 'oops'" 'read hello; echo hello 2 x; read f; echo -; read sample
    while echo 0 0 1 0.3; do read verb || exit 0; [ "${verb%% *}" = sample ] || { echo oops; break; }; done'

# A number too large for a double is infinite in every notation.
for huge in 1e999 0x1p+5000 inf 123456789e400; do
    expect 1 check --exec "./slow 10000000 $huge" --wo 45
    grep -q "pdf is infinite" printed || die "$huge is not infinite: $(cat printed)"
done

# For any name of a program or a file, XML is well-formed, HTML is UTF-8 and nothing moves a cursor.
well_formed() {
    python3 -c "
import sys, xml.parsers.expat as x
x.ParserCreate().ParseFile(open(sys.argv[1], 'rb'))
open(sys.argv[2], encoding='utf-8').read()" "$1" "$2" || die "$1 or $2"
}
for name in 'a\033[31m\302\233<&"' "$(printf 'x%.0s' {1..59})\303\251\303\251" 'na\357ve'; do
    expect 3 check --exec "read hello; printf 'hello 2 $name\n'; read f; echo -; exit 3" --junit name.xml \
        --html name.html
    well_formed name.xml name.html
    ! LC_ALL=C grep -q "$(printf '\033\\|\302\233')" printed || die "a control character of the name: $(cat -v printed)"
done

# Processes that a program started end with it, including those in a session of their own; the program ends with
# crescent.
gone() {
    for _ in $(seq 50); do
        kill -0 "$(cat "$1")" 2>/dev/null || return 0
        sleep 0.1
    done
    die "process $(cat "$1") lives on"
}
expect 3 check --exec 'setsid sh -c "echo \$\$ >session; exec sleep 300" & read hello; echo hello 2 x
    while [ ! -s session ]; do :; done; exit 3'
gone session
"$CRESCENT" check --quiet --exec 'echo $$ >orphan; exec sleep 300' >/dev/null 2>&1 &
while [ ! -s orphan ]; do sleep 0.1; done
kill -9 $!
gone orphan
# Ctrl-C: all processes end, and exit 130.
rm orphan
set -m
"$CRESCENT" check --quiet --exec 'trap "" INT TERM; sleep 300 &
    setsid sh -c "echo \$\$ >orphan; exec sleep 300" & wait' >/dev/null 2>&1 &
set +m
while [ ! -s orphan ]; do sleep 0.1; done
kill -s INT $!
wait $!
code=$?
[ $code -eq 130 ] || die "SIGINT: exit $code"
gone orphan

# Files appear whole; no other file is changed, and no link is followed.
echo mine >r.json.part && echo mine >victim && ln -s victim r.json
expect 1 check --exec "./slow 10000000 -1" --wo 45 --json r.json
[ "$(cat r.json.part victim)" = "mine
mine" ] || die "a file that is not ours was touched"
fields r.json "assert j['state'] == 'wrong'"
check --exec "./slow 10000000 -1" --wo 45 --json /dev/stdout 2>said | grep -q '"state": "wrong"' ||
    die "nothing on /dev/stdout: $(cat said)"

# A header of 60,000 blanks, for which a recursive matcher would run out of stack.
python3 - <<'PY'
header = b"{'descr':" + b" " * 60000 + b"'<f8', 'fortran_order': False, 'shape': (2, 6), }\n"
open("blanks.npy", "wb").write(b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header + b"\0" * 96)
PY
expect 2 check --samples blanks.npy --wo 0,0,1 --pdf-table blanks.npy
grep -q "2 samples are too few" said || die "$(cat said)"

# Two samplers are compared over one domain; another one is bad input, and so is a value for a sampler of points.
draws() { printf 'while read -r word rest; do case $word in hello) echo hello 2 %s domain=%s;; *) echo -;; esac; done' "$1" "$2"; }
expect 2 check --exec "$(draws lens disk)" --against "$(draws film square)"
grep -q "lens draws points of disk, and film points of square" said || die "$(cat said)"
expect 2 check --exec "$(draws lens disk)" --estimates 1
grep -q "needs a sampler whose draws are values" said || die "$(cat said)"
