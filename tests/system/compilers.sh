#!/bin/bash
# g++ and clang make the same films, bit for bit, on every instruction set; so does clang without optimisation, of
# smaller films. $FILM_HASHES, $FILM_HASHES_GCC and $FILM_HASHES_DEBUG are the program of tests/portability built by
# each.
. "$(dirname "$0")/common.sh"
[ -x "${FILM_HASHES_GCC:-}" ] || skip "nothing built by g++ (cmake --preset gcc && ninja -C build-gcc film_hashes)"

# Every built-in sampler over the small scene, and scenes with other shapes, lobes and lights.
{
    sed '/^\[arms/,/^n = /d' "$tiny"
    usable_arms | sed 's/.*/[arms.&]\nn = [4, 16]/'
    printf '[lights.bulb]\nkind = "sphere"\ncenter = [1.2, 1.8, 1.0]\nradius = 0.3\nradiance = [6, 5, 4]\n'
    printf '[lights.window]\nkind = "rectangle"\ncorner = [-1, 2.6, -0.4]\nedge_u = [1.2, 0, 0]\n'
    printf 'edge_v = [0, 0, 0.8]\nradiance = [2, 3, 4]\n'
} >every-arm.toml
cp "$CRESCENT_SOURCE"/experiments/*.toml "$CRESCENT_SOURCE"/experiments/published.json .
experiments=(every-arm.toml)
for name in three-glosses two-lamps empty-room; do [ -f "$name.toml" ] && experiments+=("$name.toml"); done

expect 0 "$FILM_HASHES" "${experiments[@]}"
mv printed clang
expect 0 "$FILM_HASHES_GCC" "${experiments[@]}"
[ "$(wc -l <clang)" -gt 20 ] || die "too few films: $(cat clang)"
diff clang printed >difference || die "films differ between compilers: $(cat difference)"
# And between instruction sets: without its name, each line appears once per set.
grep -v -e ' quadrature ' -e ' paired ' -e '^function ' clang | awk '{ $2 = ""; print }' | sort | uniq -c |
    awk -v sets="$("$CRESCENT" list isas | wc -l)" '$1 != sets { print; bad = 1 } END { exit bad }' ||
    die "films differ between instruction sets"

[ -x "${FILM_HASHES_DEBUG:-}" ] || skip "no Debug build (cmake --preset debug && ninja -C build-debug film_hashes)"
expect 0 "$FILM_HASHES" --fewer "${experiments[@]}"
mv printed release
expect 0 "$FILM_HASHES_DEBUG" --fewer "${experiments[@]}"
[ "$(wc -l <release)" -gt 20 ] || die "too few small films: $(cat release)"
diff release printed >difference || die "films differ without optimisation: $(cat difference)"
