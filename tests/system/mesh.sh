#!/bin/bash
# Meshes from files: imports of each format, the content as identity, films of the same bytes on every instruction set,
# textures, parts that join without the files, bad files refused with the place, damaged files of all kinds that do not
# end the program.
. "$(dirname "$0")/common.sh"
# The rest of this script needs the importer; without it, the command says what is missing.
"$CRESCENT" import nothing.obj --out nothing.mesh >printed 2>said
[ $? -eq 2 ] || die "a missing model: $(cat said)"
if [ ! -x "$(dirname "$CRESCENT")/crescent-import" ] && ! command -v crescent-import >/dev/null; then
    echo 'v 0 0 0' >empty.obj
    expect 3 "$CRESCENT" import empty.obj --out empty.mesh
    grep -q build-all said || die "the command that builds it is not named: $(cat said)"
    skip "this build has no importer"
fi

# A tent over the scene of tiny.toml, as each format has it; one mesh from all.
cat >tent.obj <<'END'
v -2 0 -2
v 2 0 -2
v 2 0 2
v -2 0 2
v 0 1.5 0
f 1 5 2
f 2 5 3
f 3 5 4
f 4 5 1
END
cat >tent.ply <<'END'
ply
format ascii 1.0
element vertex 5
property float x
property float y
property float z
element face 4
property list uchar int vertex_indices
end_header
-2 0 -2
2 0 -2
2 0 2
-2 0 2
0 1.5 0
3 0 4 1
3 1 4 2
3 2 4 3
3 3 4 0
END
for model in tent.obj tent.ply; do
    expect 0 "$CRESCENT" import $model --out ${model/./-}.mesh
    grep -q '4 triangles, 5 vertices' printed || die "$model: $(cat printed)"
    grep -q '^\[meshes.tent-' printed && grep -q '^\[camera\]' printed || die "no tables: $(cat printed)"
done
cmp -s tent-obj.mesh tent-ply.mesh || die "the formats differ"

experiment() { { cat "$tiny" && printf '\n[meshes.tent]\nfile = "%s"\nrho_d = [0.5, 0.4, 0.3]\n%s\n' "$1" "${2:-}"; } >mesh.toml; }
run() { expect "$1" "$CRESCENT" run mesh.toml --quiet "${@:2}"; }
refuses() { # WORDS FILE [MORE]
    experiment "$2" "${3:-}"
    run 2 --out refused
    grep -q -- "$1" said || die "no '$1' in: $(cat said)"
    [ ! -e refused ] || die "a refused run writes"
}
hash_of() { sed -n 's/.*"hash": "\([0-9a-f]\{16\}\)".*/\1/p' "$1/metrics.json" | head -n 1; }

# The same bytes on every instruction set and any threads; the file's name is no part of the identity, its content is.
experiment tent-obj.mesh 'translate = [0, 0.3, 0]'
run 0 --isa scalar --out scalar
run 0 --threads 1 --out best
same_outputs scalar best
cp tent-obj.mesh other.mesh
experiment other.mesh 'translate = [0, 0.3, 0]'
run 0 --out other
[ -n "$(hash_of best)" ] && [ "$(hash_of other)" = "$(hash_of best)" ] || die "the name of a file is in the identity"
sed 's/0 1.5 0/0 1.6 0/' tent.obj >tall.obj
expect 0 "$CRESCENT" import tall.obj --out other.mesh
run 0 --out tall
[ "$(hash_of tall)" != "$(hash_of best)" ] || die "the content of a file is not in the identity"

# Textures: the same, and the mesh needs texture coordinates.
image() { /usr/bin/python3 "$here/sky_image.py" "$@" || die "cannot make $1"; }
{ grep '^v' tent.obj && printf 'vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 0.5 0.5\n' &&
    printf 'f 1/1 5/5 2/2\nf 2/2 5/5 3/3\nf 3/3 5/5 4/4\nf 4/4 5/5 1/1\n'; } >uv.obj
expect 0 "$CRESCENT" import uv.obj --out uv.mesh
image wood.exr 5 '(0.1 + 0.2 * x, 0.5, 0.9 if y else 0.1)' 3
image rough.exr 3 '(0.1 + 0.2 * x, 0.1 + 0.2 * x, 0.1 + 0.2 * x)' 2
textures=$'rho_d_texture = "wood.exr"\nalpha_texture = "rough.exr"'
gloss=$'rho_s = 0.3\nbrdf = "ggx"\nalpha = 0.9\n[reference]\nn = 4'
experiment uv.mesh "$gloss"
run 0 --only films --out bare
experiment uv.mesh "$textures"$'\n'"$gloss"
run 0 --isa scalar --out scalar
run 0 --threads 1 --out best
same_outputs scalar best
cmp -s bare/films/cosine.exr best/films/cosine.exr && die "a texture changes no film"
mv wood.exr oak.exr
experiment uv.mesh "${textures/wood/oak}"$'\n'"$gloss"
run 0 --only metrics --out other
[ "$(hash_of other)" = "$(hash_of best)" ] || die "the name of a texture is in the identity"
image wood.exr 5 '(0.1 + 0.2 * x, 0.6, 0.9 if y else 0.1)' 3
experiment uv.mesh "$textures"$'\n'"$gloss"
run 0 --only metrics --out other
[ "$(hash_of other)" != "$(hash_of best)" ] || die "the content of a texture is not in the identity"

# GL has no meshes: nothing is drawn. Exit code 3: no GL here.
"$CRESCENT" run mesh.toml --quiet --instrument gl --out gl >printed 2>said
code=$?
[ $code -eq 3 ] || { [ $code -eq 2 ] && grep -q '^mesh.toml:[0-9]*:.* no meshes: expected --instrument cpu' said; } ||
    die "a mesh by GL: exit $code: $(cat said)"
[ ! -e gl ] || die "GL draws a mesh"

# Parts join with the files and without them; another texture is another experiment.
mv best one && run 0 --seeds 4 --only metrics --out whole
run 0 --seeds 4 --seed-range 1:2 --only metrics --out a
run 0 --seeds 4 --seed-range 3:4 --only metrics --out b
expect 0 "$CRESCENT" join a b --out joined
cmp whole/metrics.csv joined/metrics.csv || die "parts with a mesh do not join to the whole"
mkdir away && mv uv.mesh wood.exr rough.exr mesh.toml away && mv away/mesh.toml .
expect 0 "$CRESCENT" join a b --out again
cmp whole/metrics.csv again/metrics.csv || die "parts do not join without the files of a mesh"
mv away/* .
mv oak.exr wood.exr
run 0 --seeds 4 --seed-range 3:4 --only metrics --out b
expect 2 "$CRESCENT" join a b --out nowhere
grep -q '"tent".content is' said || die "the content that differs is not named: $(cat said)"
refuses 'content 0123456789abcdef, found' uv.mesh 'content = "0123456789abcdef"'
refuses 'hexadecimal' uv.mesh 'content = "tent"'

image nan.exr 4 '(1, nan if (x, y) == (3, 1) else 1, 1)' 2
image dark.exr 4 '(0, -0.1 if (x, y) == (3, 1) else 1, 1)' 2
image inf.exr 4 '(inf if (x, y) == (3, 1) else 1, 1, 1)' 2
image bright.exr 4 '(1, 1, 1.1 if (x, y) == (3, 1) else 1)' 2
image wide.exr 8193 '(1, 1, 1)' 1
head -c 200 wood.exr >cut.exr
mkfifo pipe.exr
for bad in nan dark inf bright; do
    refuses "mesh.toml:[0-9]*:[0-9]*: meshes.tent.rho_d_texture: .*$bad.exr: texel (3, 1)" uv.mesh "rho_d_texture = \"$bad.exr\""
done
refuses 'alpha_texture: .*texel (0, 0).*grey' uv.mesh 'alpha_texture = "wood.exr"'
for part in combined lobe; do
    refuses 'mesh.toml:[0-9]*:[0-9]*: furnaces.tent-[a-z]*.shape: .*one material.*alpha_texture' uv.mesh \
        "$textures"$'\n'"$gloss"$'\n[furnaces.tent-'$part$']\narm = "cosine"\nshape = "tent"\nn = 16\npart = "'$part'"'
done
refuses 'wide.exr: .*8192 x 8192.*8193 x 1' uv.mesh 'rho_d_texture = "wide.exr"'
refuses 'cut.exr: .*OpenEXR' uv.mesh 'rho_d_texture = "cut.exr"'
refuses 'pipe.exr: .*regular file' uv.mesh 'rho_d_texture = "pipe.exr"'
refuses 'none.exr: .*can be read' uv.mesh 'rho_d_texture = "none.exr"'
refuses 'mesh.toml:[0-9]*:[0-9]*: .*with texture coordinates' tent-obj.mesh 'rho_d_texture = "wood.exr"'
for outside in ../wood.exr "$PWD/wood.exr" ''; do
    refuses 'mesh.toml:[0-9]*:[0-9]*: .*in the folder of the experiment' uv.mesh "alpha_texture = \"$outside\""
done

head -c 80 tent-obj.mesh >cut.mesh
{ head -c 16 tent-obj.mesh && printf '\x00\xe1\xf5\x05\x00\xe1\xf5\x05' && head -c 1000 /dev/zero; } >huge.mesh
{ head -c 44 tent-obj.mesh && printf '\x00\x00\xc0\x7f' && tail -c +49 tent-obj.mesh; } >nan.mesh
printf '\0\0\0\0\0\0\0\0' | dd of=nan.mesh bs=1 seek=32 conv=notrunc 2>/dev/null # the hash: not stated
echo text >text.mesh
mkdir folder.mesh
refuses 'mesh.toml:.*cut.mesh: .*truncated' cut.mesh
refuses 'huge.mesh: .*100000000 vertices and 100000000 triangles' huge.mesh
refuses 'nan.mesh: vertex 0: ' nan.mesh
refuses 'text.mesh: expected a .mesh file' text.mesh
refuses 'folder.mesh: expected a regular file' folder.mesh
refuses 'none.mesh: .*found none' none.mesh
refuses 'in the folder of the experiment' ../tent-obj.mesh
mkdir outside inside
cp tent-obj.mesh uv.mesh wood.exr outside
mv outside ..
ln -s ../outside/tent-obj.mesh linked.mesh
ln -s ../outside linked
ln -s ../outside/wood.exr linked.exr
ln -s ../uv.mesh inside/uv.mesh
refuses 'in the folder of the experiment.*link' linked.mesh
refuses 'in the folder of the experiment.*link' linked/tent-obj.mesh
refuses 'in the folder of the experiment.*link' uv.mesh 'rho_d_texture = "linked.exr"'
experiment inside/uv.mesh # a link that stays in the folder
expect 0 "$CRESCENT" run mesh.toml --only metrics --out linked-inside
rm -r ../outside
refuses 'in the folder of the experiment' "$PWD/tent-obj.mesh"
refuses 'determinant' tent-obj.mesh 'scale = [1, 0, 1]'
refuses 'within 1000000 m' tent-obj.mesh 'translate = [1e6, 0, 0]'
refuses 'found both' tent-obj.mesh $'scale = 2\nmatrix = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]'
refuses 'paired' tent-obj.mesh $'[reference]\nkind = "quadrature"'

# Numbers as other programs write them, and statements of MTL that are not read.
cat >dot.obj <<'O'
mtllib dot.mtl
v 0 0 0
v .5 0 -.25
v 0 +1 0 1 1 1 1
v 9 9 9
usemtl a
f 1 2 3
O
printf 'newmtl a\nKd .5 0.25 0\naniso 0.3\nKs spectral a.rfl 1\nd -halo 0.5\nanisor 1\n' >dot.mtl
expect 0 "$CRESCENT" import dot.obj --out dots
grep -qF "box [0, 0, -0.25] to [0.5, 1, 0]" printed said || die "its box: $(cat printed said)"
grep -qF "rho_d = [0.5, 0.25, 0]" dots/experiment.toml || die "its colour: $(cat dots/experiment.toml)"
for what in aniso anisor 'Ks spectral' 'd -halo'; do
    grep -qF "left out: '$what' of 1 material" printed said || die "$what is lost: $(cat printed said)"
done

# A square metre far away keeps its millimetres.
cat >survey.obj <<'O'
v 5200000.130 440000.210 100.07
v 5200001.130 440000.210 100.07
v 5200001.130 440001.210 100.07
v 5200000.230 440000.410 100.37
f 1 2 3
f 1 2 4
O
expect 0 "$CRESCENT" import survey.obj --out survey.mesh
grep -qF "box [-0.5, -0.5, -0.15] to [0.5, 0.5, 0.15]" printed said || die "its box: $(cat printed said)"

printf 'v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n' >nan.obj
printf 'v 0x10 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >hex.obj
echo 'no model' >text.ply
for model in nan.obj hex.obj text.ply tent.toml; do
    expect 2 "$CRESCENT" import $model --out bad.mesh
    grep -q "^$model: " said || die "$model: $(cat said)"
done
expect 2 timeout 20 "$CRESCENT" import nan.obj --out bad --smooth 30
[ ! -e bad.mesh ] || die "a refused model is written"
expect 2 "$CRESCENT" import tent.obj --out tent.txt
expect 3 "$CRESCENT" import tent.obj --out none/tent.mesh

# 100,000 by hand: tests/system/scene_mutants.py build/crescent 100000
python3 "$here/scene_mutants.py" "$CRESCENT" 1000 || die "a damaged file"
