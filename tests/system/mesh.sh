#!/bin/bash
# Meshes from files: imports of each format, the content as identity, films of the same bytes on every instruction set,
# bad files refused with the place, damaged models that do not end the program.
. "$(dirname "$0")/common.sh"
# The rest of this script has a build with assimp; without it, the command says what is missing.
"$CRESCENT" import nothing.obj --out nothing.mesh >printed 2>said
[ $? -eq 2 ] || die "a missing model: $(cat said)"
if [ ! -x "$(dirname "$CRESCENT")/crescent-import" ] && ! command -v crescent-import >/dev/null; then
    echo 'v 0 0 0' >empty.obj
    expect 3 "$CRESCENT" import empty.obj --out empty.mesh
    grep -q libassimp-dev said || die "no package named: $(cat said)"
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
refuses 'in the folder of the experiment' "$PWD/tent-obj.mesh"
refuses 'determinant' tent-obj.mesh 'scale = [1, 0, 1]'
refuses 'within 1000000 m' tent-obj.mesh 'translate = [1e6, 0, 0]'
refuses 'found both' tent-obj.mesh $'scale = 2\nmatrix = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]'
refuses 'paired' tent-obj.mesh $'[reference]\nkind = "quadrature"'

printf 'v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n' >nan.obj
echo 'no model' >text.ply
for model in nan.obj text.ply tent.toml; do
    expect 2 "$CRESCENT" import $model --out bad.mesh
    grep -q "^$model: " said || die "$model: $(cat said)"
done
[ ! -e bad.mesh ] || die "a refused model is written"
expect 2 "$CRESCENT" import tent.obj --out tent.txt
expect 3 "$CRESCENT" import tent.obj --out none/tent.mesh

# 100,000 by hand: tests/system/mesh_mutants.py build/crescent 100000
python3 "$here/mesh_mutants.py" "$CRESCENT" 1000 || die "a damaged model"
