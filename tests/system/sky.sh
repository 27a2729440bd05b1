#!/bin/bash
# Image skies from files: bad ones are refused with the texel, the content and not the path is the identity, films have
# the same bytes on every instruction set, parts of the seeds join, and other back ends and references are refused.
. "$(dirname "$0")/common.sh"
image() { /usr/bin/python3 "$here/sky_image.py" "$@" || die "cannot make $1"; }
sunset='(8, 6, 4) if 0.8 * right + 0.6 * up > 0.97 else (0.3 + 0.2 * up, 0.4 + 0.2 * up, 0.6 + 0.3 * up)'
image sunset.exr 64 "$sunset"

# The scene of tiny.toml under the sky in place of the fill.
sed -e '/^\[fill\]/,/^$/d' "$tiny" >body.toml
experiment() { # IMAGE [MORE]
    { cat body.toml && printf '\n[sky]\nfile = "%s"\n%s\n' "$1" "${2:-}" && cat arms; } >sky.toml
}
printf '\n[arms.sky]\nn = [4, 16]\n\n[arms.both]\nkind = "mis"\nof = ["sky", "mixture", "light-area"]\nn = [4, 16]\n' >arms
printf '\n[arms.renderer]\nn = [4, 16]\n' >>arms
run() { expect "$1" "$CRESCENT" run sky.toml --quiet "${@:2}"; }
refuses() { # WORDS [IMAGE [MORE]]
    experiment "${2:-sunset.exr}" "${3:-}"
    run 2 --out refused
    grep -q -- "$1" said || die "no '$1' in: $(cat said)"
    [ ! -e refused ] || die "a refused run writes"
}

image negative.exr 8 '(1, -1 if (x, y) == (5, 2) else 1, 1)'
image inf.exr 8 '(inf if (x, y) == (6, 1) else 1, 1, 1)'
image nan.exr 8 '(1, 1, nan if (x, y) == (7, 3) else 1)'
image zero.exr 8 '(0, 0, 0)'
image square.exr 8 '(1, 1, 1)' 8
head -c 300 sunset.exr >cut.exr
echo 'no image' >text.exr
refuses 'negative.exr.*texel (5, 2)' negative.exr
refuses 'inf.exr.*texel (6, 1)' inf.exr
refuses 'nan.exr.*texel (7, 3)' nan.exr
refuses 'zero.exr.*every texel is 0' zero.exr
refuses 'square.exr.*8 x 8' square.exr
refuses 'cut.exr.*OpenEXR' cut.exr
refuses 'text.exr.*OpenEXR' text.exr
refuses 'none.exr.*can be read' none.exr
refuses 'sky.toml:.*texel' sunset.exr 'scale = 1e9'
refuses 'content.*0123456789abcdef' sunset.exr 'content = "0123456789abcdef"'
refuses 'hexadecimal' sunset.exr 'content = "sunset"'
refuses 'paired' sunset.exr $'[reference]\nkind = "quadrature"'
refuses 'reference.n' sunset.exr $'[reference]\nn = 0'
experiment sunset.exr 'rotation = 30'
"$CRESCENT" run sky.toml --quiet --instrument gl --out refused >printed 2>said
code=$?
[ $code -eq 3 ] || { [ $code -eq 2 ] && grep -q '^sky.toml:[0-9]*:.* no image skies: expected --instrument cpu' said; } ||
    die "a sky by GL: exit $code: $(cat said)"

image cross.exr 8 '(1, 1, 1)' 6
refuses 'cross.exr.*8 x 6.*cube' cross.exr

# Numbers just below 0 count as 0 and are counted; more than a thousandth of the energy is refused with its share.
image little.exr 8 '(1, -0.04 if (x, y) == (5, 2) else 1, 1)'
experiment little.exr
run 0 --only metrics --out little
cat printed said | grep -q 'sky: 1 number below 0' || die "no count of numbers below 0: $(cat printed said)"
refuses 'negative.exr.*1 number below 0 is .* %' negative.exr

# Radiance HDR gives the numbers of the same texels in OpenEXR; its exposure divides.
radiance() { # FILE HEADER: 8 x 4 texels of 1
    { printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n%b\n-Y 4 +X 8\n' "$2" && printf '\x80\x80\x80\x81%.0s' {1..32}; } >"$1"
}
image one.exr 8 '(1, 1, 1)'
image half.exr 8 '(0.5, 0.5, 0.5)'
radiance one.hdr ''
radiance half.hdr 'EXPOSURE=2\n'
for name in one half; do
    for end in exr hdr; do
        experiment $name.$end
        run 0 --only metrics --out $name-$end
    done
    cmp $name-exr/metrics.csv $name-hdr/metrics.csv || die "$name.hdr gives other numbers than $name.exr"
done

# A layer of a file with several: the numbers and the identity of the same texels in a file of their own.
hash_of() { sed -n 's/.*"hash": "\([0-9a-f]*\)".*/\1/p' "$1/metrics.json" | head -n 1; }
image sun.exr 8 '(2, 1 + up, 1)'
image layers.exr 8 '(2, 1 + up, 1) if layer == "sun" else (0.5, 0.5, 0.5)' 4 sun ambient
experiment sun.exr
run 0 --only metrics --out sun
experiment layers.exr 'layer = "sun"'
run 0 --only metrics --out layer
expect 0 "$CRESCENT" import layers.exr --layer sun --out sun.image
experiment sun.image
run 0 --only metrics --out packed-layer
for out in layer packed-layer; do
    cmp sun/metrics.csv $out/metrics.csv || die "$out: other numbers than those of the texels"
    [ "$(hash_of sun)" = "$(hash_of $out)" ] || die "$out: another identity than that of the texels"
done
refuses "sky.toml:[0-9]*:[0-9]*: sky.layer: .*no layer 'son': expected one of 'ambient', 'sun'; did you mean 'sun'?" \
    layers.exr 'layer = "son"'
refuses "sky.file: .*no 'R' in the first part; a layer can be named: 'ambient', 'sun'" layers.exr
refuses 'sky.layer: .*OpenEXR' one.hdr 'layer = "sun"'
refuses 'sky.layer: .*empty' layers.exr 'layer = ""'
expect 2 "$CRESCENT" import layers.exr --layer son --out none.image
grep -q "^layers.exr: no layer 'son'" said || die "no list of layers: $(cat said)"

radiance wide.hdr 'PRIMARIES=0.71 0.29 0.17 0.8 0.13 0.05 0.31 0.33\n'
refuses 'wide.hdr.*PRIMARIES' wide.hdr
head -c 60 one.hdr >cut.hdr
refuses 'cut.hdr.*cut off' cut.hdr
experiment sunset.exr 'rotation = 30'

# The same bytes on every instruction set and any threads; the sampler of the sky is unbiased: its mean is the reference's.
run 0 --isa scalar --out scalar
run 0 --threads 1 --out best
same_outputs scalar best
cat >>sky.toml <<'END'
[assertions.mean]
check = "bias2.ball(sky) < 0.05"
[assertions.better]
check = "rmse.ball(both) < rmse.ball(uniform)"
[assertions.valid]
check = "bad(sky) == 0"
END
run 0 --out holds

# Another path, another folder: the same identity. Another content: another one.
mkdir elsewhere && cp sunset.exr elsewhere/image.exr && sed 's/sunset.exr/image.exr/' sky.toml >elsewhere/sky.toml
expect 0 "$CRESCENT" run elsewhere/sky.toml --quiet --only metrics --out moved
[ "$(hash_of holds)" = "$(hash_of moved)" ] || die "the path of a sky is part of the identity"
# A pack can replace its image; a damaged one is refused.
expect 0 "$CRESCENT" import sunset.exr --out sunset.image
expect 2 "$CRESCENT" import sunset.exr --out sunset.mesh
sed -i 's/sunset.exr/sunset.image/' sky.toml
run 0 --only metrics --out packed
[ "$(hash_of holds)" = "$(hash_of packed)" ] || die "a pack of an image has another identity"
cmp holds/metrics.csv packed/metrics.csv || die "a pack of an image gives other numbers"
head -c 3000 sunset.image >cut.image
printf '\x01' | dd of=sunset.image bs=1 seek=200 conv=notrunc status=none
run 2 --out refused
grep -q 'sky.file: sunset.image: byte 24' said || die "a damaged pack: $(cat said)"
sed -i 's/sunset.image/cut.image/' sky.toml
run 2 --out refused
grep -q truncated said || die "a truncated pack: $(cat said)"
sed -i 's/cut.image/sunset.exr/' sky.toml
image sunset.exr 64 '(1, 1, 1 + up)'
run 0 --only metrics --out other
[ "$(hash_of holds)" != "$(hash_of other)" ] || die "the content of a sky is no part of the identity"

# Parts join without the image.
run 0 --seeds 4 --only metrics --out whole
run 0 --seeds 4 --seed-range 1:2 --only metrics --out a
run 0 --seeds 4 --seed-range 3:4 --only metrics --out b
rm sunset.exr
expect 0 "$CRESCENT" join a b --out joined
cmp whole/metrics.csv joined/metrics.csv || die "parts under a sky do not join to the whole"
exit 0
