#!/bin/bash
# Outputs do not depend on the variant of sin or exp that the machine's C library selects. glibc has variants for
# processors with and without fused multiply-add, which differ in the last bit: a run with either writes the same bytes.
. "$(dirname "$0")/common.sh"
without=glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX2_Usable,-FMA_Usable

experiments=("$tiny")
for name in gallery cousins three-glosses two-lamps; do
    file=$CRESCENT_SOURCE/experiments/$name.toml
    [ -f "$file" ] && experiments+=("$file")
done
for experiment in "${experiments[@]}"; do
    expect 0 "$CRESCENT" run "$experiment" --quiet --seeds 1 --out with
    expect 0 env GLIBC_TUNABLES="$without" "$CRESCENT" run "$experiment" --quiet --seeds 1 --out without
    same_outputs with without
    rm -rf with without
done
