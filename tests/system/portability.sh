#!/bin/bash
# Another compiler's and another machine's code gives the same bits: g++, clang without optimisation, ARM with its
# vectors under qemu, WebAssembly with its vectors in node. Small images and few samples, since most run slowly.
# $FILM_HASHES_ROOT-gxx, -unoptimised, -aarch64 and -wasm32 are tests/portability, built.
. "$(dirname "$0")/common.sh"
core=${FILM_HASHES_ROOT:?the build folder without its ending}
ls "$core"-*/film_hashes* >/dev/null 2>&1 || skip "no core built for another machine or compiler (./test builds them)"

# Every built-in sampler over the small scene, and scenes with other shapes, lobes and lights.
{
    sed '/^\[arms/,/^n = /d' "$tiny"
    usable_arms | sed 's/.*/[arms.&]\nn = [4, 16]/'
    printf '[lights.bulb]\nkind = "sphere"\ncenter = [1.2, 1.8, 1.0]\nradius = 0.3\nradiance = [6, 5, 4]\n'
    printf '[lights.window]\nkind = "rectangle"\ncorner = [-1, 2.6, -0.4]\nedge_u = [1.2, 0, 0]\n'
    printf 'edge_v = [0, 0, 0.8]\nradiance = [2, 3, 4]\n'
} >every-arm.toml
experiments=(every-arm.toml)
for name in three-glosses two-lamps empty-room; do
    file=$CRESCENT_SOURCE/experiments/$name.toml
    [ -f "$file" ] && experiments+=("$file")
done

expect 0 "$FILM_HASHES" --plain "${experiments[@]}"
mv printed plain
# A line names its instruction set second; without it, every set and machine prints the same.
hashes() { awk '/ quadrature | paired |^function /{ print; next } { $2 = ""; print }' "$1" | sort -u; }
expect 0 "$FILM_HASHES" <plain
hashes printed >here
grep -v -e ' quadrature ' -e ' paired ' -e '^function ' printed | awk '{ $2 = ""; print }' | sort | uniq -c |
    awk -v sets="$("$CRESCENT" list isas | wc -l)" '$1 != sets { print; bad = 1 } END { exit bad }' ||
    die "films differ between instruction sets"
[ "$(wc -l <here)" -gt 40 ] || die "too few films: $(cat here)"

# same NAME SET COMMAND...: the hashes of another machine, which has SET in addition to scalar code.
same() {
    local name=$1 set=$2
    shift 2
    expect 0 "$@" <plain
    grep -q " $set " printed || die "$name: no films of $set"
    hashes printed >there
    diff here there >difference || die "films differ on $name: $(head -n 12 difference)"
}
tried=0
if [ -x "$core-gxx/film_hashes" ]; then
    same "g++" avx2 "$core-gxx/film_hashes"
    tried=1
fi
if [ -x "$core-unoptimised/film_hashes" ]; then
    same "clang without optimisation" scalar "$core-unoptimised/film_hashes"
    tried=1
fi
if [ -x "$core-aarch64/film_hashes" ] && command -v qemu-aarch64-static >/dev/null; then
    same "ARM" neon qemu-aarch64-static "$core-aarch64/film_hashes"
    tried=1
fi
if [ -f "$core-wasm32/film_hashes.wasm" ] && command -v node >/dev/null; then
    same "WebAssembly" wasm128 node --no-warnings "$CRESCENT_SOURCE/tests/portability/run.mjs" "$core-wasm32/film_hashes.wasm"
    tried=1
fi
[ "$tried" -eq 1 ] || skip "neither qemu-aarch64-static nor node"
