#!/bin/bash
# Programs on trial that are slow, break off or speak another language: what was not looked at is said and never passes,
# and a program that cannot be asked is an error, not a wrong sampler.
. "$(dirname "$0")/common.sh"

# fields FILE CODE: a line of Python over the judgement `j`.
fields() { python3 -c "import json; j = json.load(open('$1')); $2" || die "$1: not so: $2"; }
check() { "$CRESCENT" check --quiet "$@"; }

expect 0 "${CC:-cc}" -O2 -o slow "$here/slow.c" -lm
some="any(v['name'] != 'valid' and v['state'] == 'inconclusive' for v in j['verdicts'])"
everywhere="sum(v['name'] == 'valid' and v['state'] == 'right' for v in j['verdicts']) == 8"
expect 4 check --exec './slow 150000' --patience 6 --json few.json --junit few.xml --html few.html
fields few.json "assert $everywhere and $some and 0 < len(j['left_out']) <= 8 and j['state'] == 'inconclusive'"
for file in printed few.xml few.html; do grep -q "Not looked at" $file || die "$file does not say what was not looked at"; done
expect 0 check --exec './slow 150000' --patience 6 --accept-few --json few.json
fields few.json "assert $everywhere and len(j['left_out']) > 0 and j['state'] == 'right'"
expect 1 check --exec './slow 20000 nan' --patience 3  # the normal is among the w_o that there is no time for

# broken WORDS PROGRAM: an error, told with these words.
broken() {
    expect 3 check --exec "$2" --json broken.json --junit broken.xml
    grep -q -- "$1" printed || die "nobody says '$1': $(cat printed)"
    grep -q "<error" broken.xml && ! grep -q "<failure" broken.xml || die "no error in $(cat broken.xml)"
    fields broken.json "assert j['state'] == 'error' and all(v['state'] in ('right', 'skipped', 'error') for v in j['verdicts'])"
}
broken "exit code 3" 'read hello; echo hello 1 x; exit 3'
broken "loading weights" 'echo loading weights...; cat'
broken "exit code 2" 'python3 nowhere.py'
broken "signal 11" 'read hello; echo hello 1 x; read f; echo -; kill -SEGV $$'
broken "got 'oops'" 'read hello; echo hello 1 x; read f; echo -; read sample; while echo 0 0 1 0.3; do read verb || exit 0; [ "${verb%% *}" = sample ] || { echo oops; break; }; done'
