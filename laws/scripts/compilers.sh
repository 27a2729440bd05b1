#!/bin/bash
# g++ and clang make the same films, bit for bit. $CRESCENT_CLANG is the program built by clang.
. "$(dirname "$0")/common.sh"
[ -x "${CRESCENT_CLANG:-}" ] || skip "no program built by clang (cmake --preset clang && ninja -C build-clang crescent_cli)"

# films RUN: what a metrics.json says of its films, "NAME": "HASH".
films() { grep -E '"[^"]+ (n|s)=[^"]*": "[0-9a-f]{16}"' "$1/metrics.json" | tr -d ' ,'; }

for experiment in "$tiny" "$CRESCENT_SOURCE"/experiments/three-glosses.toml; do
    for program in "$CRESCENT" "$CRESCENT_CLANG"; do
        out=$([ "$program" = "$CRESCENT" ] && echo gcc || echo clang)
        expect 0 "$program" run "$experiment" --quiet --seeds 1 --out "$out"
    done
    films gcc >gcc.films
    films clang >clang.films
    [ -s gcc.films ] || die "no film hashes in metrics.json"
    diff gcc.films clang.films >difference || die "films of $experiment differ between compilers: $(cat difference)"
done
