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
# Beyond the range of an integer: never another number instead.
for large in 2147483648 4294967300 9223372036854775807 99999999999999999999 -1; do
    for flag in --threads --seeds --gl-device; do expect 2 "$CRESCENT" run "$tiny" "$flag" "$large"; done
    for key in regions.ball.box=[0,0,$large,$large] image.width=$large image.height=$large seeds=$large n=$large \
        arms.cosine.n=[$large] reference.lobe_spp=$large; do
        expect 2 "$CRESCENT" run "$tiny" --set "$key"
        grep -q -- "--set ${key%%=*}" said || die "no place: $(cat said)"
    done
done
for large in 4294967296 9223372036854775807 -1; do
    expect 2 "$CRESCENT" run "$tiny" --set "seed=$large"
    expect 2 "$CRESCENT" check cosine --seed "$large"
done
# An output is neither a file that is read nor another output.
printf 'numbers = 2\n' >mine.py
cp mine.py before.py
expect 2 "$CRESCENT" check mine.py --wo 30 --json mine.py
grep -q -- '--json .*mine.py: expected another file than one that is read' said || die "no reason: $(cat said)"
cmp mine.py before.py || die "the sampler's file was written"
expect 2 "$CRESCENT" check cosine --wo 30 --json one --junit ./one
grep -q -- 'expected another file than that of --json' said || die "no reason: $(cat said)"
for _ in 1 2; do expect 0 "$CRESCENT" check cosine --wo 30 --quiet --json cosine; done  # a name is no file
# Nothing that the terminal would interpret.
for command in "run absent$(printf '\033[31m\007').toml" "run $tiny --set a$(printf '\033\302\233')=3" \
    "list $(printf 'a\033\302\2332J')" "rnu$(printf '\033')" "run $tiny --isa $(printf '\033x')"; do
    expect 2 "$CRESCENT" $command
    LC_ALL=C grep -q "$(printf '[\001-\010\013-\037\177]')" said && die "a control character is shown: $(cat -v said)"
    LC_ALL=C grep -q "$(printf '\302[\200-\237]')" said && die "a C1 control character is shown: $(cat -v said)"
done
# A file without a name, a folder instead of a file, a missing command: reported by the flag that named it.
for flag in --json --html --junit; do
    expect 2 "$CRESCENT" check cosine "$flag" ""
    grep -q -- "$flag" said || die "no flag: $(cat said)"
done
expect 2 "$CRESCENT" check cosine --expect .
expect 2 "$CRESCENT" check cosine --against ./absent
grep -q '^--against ./absent: ' said || die "another flag than --against: $(cat said)"
"$CRESCENT" check --help | tr '\n' ' ' >manual  # every verdict of the list, in its order
grep -qF "$("$CRESCENT" list verdicts | awk '{ printf "%s%s", NR == 1 ? "" : ", ", $1 }')." manual ||
    die "crescent check --help has other verdicts than the list: $(cat manual)"
expect 2 "$CRESCENT" run "$tiny" --instrument telescope
expect 2 "$CRESCENT" run "$tiny" --set n
expect 2 "$CRESCENT" run "$tiny" --set n=none --set shapes.ball.radius=-1 --out there
[ "$(wc -l <said)" -eq 2 ] || die "expected two complaints, a line each: $(cat said)"
expect 2 "$CRESCENT" run absent.toml
expect 2 "$CRESCENT" list platez
expect 2 "$CRESCENT" list arms shapes
grep -q 'takes one TOPIC' said || die "list does not say that it takes one topic: $(cat said)"
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
for kinds in shapes lights; do  # every kind that a file can name, with its description
    expect 0 "$CRESCENT" list $kinds
    awk 'NF < 3 { exit 1 }' printed || die "a kind of $kinds without a word of what it is: $(cat printed)"
    "$CRESCENT" schema --json | python3 -c "
import json, sys
[table] = json.load(sys.stdin)['properties']['$kinds']['patternProperties'].values()
print(*table['properties']['kind']['enum'], sep='\n')" >named
    awk '{ print $1 }' printed | diff named - || die "crescent list $kinds names other kinds than the schema"
done
expect 0 "$CRESCENT" schema
expect 0 "$CRESCENT" schema --json
