#!/bin/bash
# Every output but timing.json is the same bytes for any number of threads and any instruction set.
. "$(dirname "$0")/common.sh"

expect 0 "$CRESCENT" list isas
mapfile -t isas <printed
expect 0 "$CRESCENT" run "$tiny" --quiet --out first
turn=0
for threads in 1 2 3 16; do
    isa=${isas[turn % ${#isas[@]}]}
    expect 0 "$CRESCENT" run "$tiny" --quiet --out "out-$threads-$isa" --threads "$threads" --isa "$isa"
    same_outputs first "out-$threads-$isa"
    turn=$((turn + 1))
done

# And the evidence on the tail of an arm that is Phong alone.
{
    cat "$tiny"
    printf '[arms.phong]\nn = [4, 16]\n'
} >evidence.toml
expect 0 "$CRESCENT" run evidence.toml --quiet --out evidence --threads 1 --isa scalar
expect 0 "$CRESCENT" run evidence.toml --quiet --out evidence-16 --threads 16
same_outputs evidence evidence-16
