#!/bin/bash
# Every output except timing.json has the same bytes for any number of threads and any instruction set.
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

# Also for optional parts: the measurements of a Phong arm's tail, the Monte Carlo reference.
{
    cat "$tiny"
    printf '[arms.phong]\nn = [4, 16]\n'
} >evidence.toml
beside=(--set note_evidence=true --set reference.monte_carlo=true)
expect 0 "$CRESCENT" run evidence.toml "${beside[@]}" --quiet --out evidence --threads 1 --isa scalar
expect 0 "$CRESCENT" run evidence.toml "${beside[@]}" --quiet --out evidence-16 --threads 16
grep -q '"rejected"' evidence/metrics.json && grep -q 'note reference' evidence/metrics.json ||
    die "they were not measured"
same_outputs evidence evidence-16
