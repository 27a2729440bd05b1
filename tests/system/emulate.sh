#!/bin/bash
# Another machine's code makes the same bits: ARM with its vectors under qemu, WebAssembly with its vectors in node.
# Small images and few samples, since both run slowly. $FILM_HASHES_AARCH64 and $FILM_HASHES_WASM are tests/portability, built.
. "$(dirname "$0")/common.sh"
[ -x "${FILM_HASHES_AARCH64:-}" ] || [ -f "${FILM_HASHES_WASM:-}" ] ||
    skip "no core built for another machine (./test builds them)"

# Every built-in sampler over the small scene, and scenes with other shapes, lobes and lights.
{
    sed '/^\[arms/,/^n = /d' "$tiny"
    "$CRESCENT" list arms | sed 's/ .*//; s/.*/[arms.&]\nn = [4, 16]/'
    printf '[lights.bulb]\nkind = "sphere"\ncenter = [1.2, 1.8, 1.0]\nradius = 0.3\nradiance = [6, 5, 4]\n'
    printf '[lights.window]\nkind = "rectangle"\ncorner = [-1, 2.6, -0.4]\nedge_u = [1.2, 0, 0]\n'
    printf 'edge_v = [0, 0, 0.8]\nradiance = [2, 3, 4]\n'
} >every-arm.toml
experiments=(every-arm.toml)
for name in three-glosses two-lamps; do
    file=$CRESCENT_SOURCE/experiments/$name.toml
    [ -f "$file" ] && experiments+=("$file")
done

expect 0 "$FILM_HASHES" --plain "${experiments[@]}"
mv printed plain
# A line names its instruction set second; without it, every set and machine says the same.
hashes() { awk '/ quadrature |^function /{ print; next } { $2 = ""; print }' "$1" | sort -u; }
expect 0 "$FILM_HASHES" <plain
hashes printed >here
[ "$(wc -l <here)" -gt 40 ] || die "too few films: $(cat here)"

# same NAME SET COMMAND...: the hashes of another machine, which has SET beside scalar code.
same() {
    local name=$1 set=$2
    shift 2
    expect 0 "$@" <plain
    grep -q " $set " printed || die "$name: no films of $set"
    hashes printed >there
    diff here there >difference || die "films differ on $name: $(head -n 12 difference)"
}
tried=0
if [ -x "${FILM_HASHES_AARCH64:-}" ] && command -v qemu-aarch64-static >/dev/null; then
    same "ARM" neon qemu-aarch64-static "$FILM_HASHES_AARCH64"
    tried=1
fi
if [ -f "${FILM_HASHES_WASM:-}" ] && command -v node >/dev/null; then
    same "WebAssembly" wasm128 node --no-warnings "$CRESCENT_SOURCE/tests/portability/run.mjs" "$FILM_HASHES_WASM"
    tried=1
fi
[ "$tried" -eq 1 ] || skip "neither qemu-aarch64-static nor node"
