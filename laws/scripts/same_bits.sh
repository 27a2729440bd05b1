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

# And the evidence on Phong's tail, which only a Phong lobe brings.
expect 0 "$CRESCENT" run "$tiny" --quiet --out evidence --threads 1 --isa scalar --set shapes.ball.brdf=phong
expect 0 "$CRESCENT" run "$tiny" --quiet --out evidence-16 --threads 16 --set shapes.ball.brdf=phong
same_outputs evidence evidence-16
