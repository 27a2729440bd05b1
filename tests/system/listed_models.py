"""listed_models.py CRESCENT: what an import does not take along has a line with a count; what it takes, it takes right."""
import os
import pathlib
import struct

import sky_image
from model_files import Glb, command, has, png

square = "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
textured = "f 1/1 4/4 3/3 2/2\n"


def write(**files):
    """Files by their names, with '__' for a dot and '_in_' for a folder."""
    for name, content in files.items():
        path = pathlib.Path(name.replace("_in_", "/").replace("__", "."))
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())


def without(text, *words):
    for word in words:
        assert word not in text, f"'{word}' in:\n{text}"


def imported(name, *flags):
    """What is printed, and the experiment, which runs."""
    said = command("import", name, "--out", "folder", *flags)
    toml = pathlib.Path("folder/experiment.toml").read_text()
    arms = ["cosine", "material", "renderer"] + ["sky"] * ("[arms.sky]" in toml)
    small = ["image.width=64", "image.height=48", "n=1", "reference.n=2", *(f"arms.{arm}.n=[1]" for arm in arms)]
    command("run", "folder/experiment.toml", "--quiet", "--out", "out", "--only", "metrics", *(word for one in small for word in ("--set", one)))
    return said, toml


def uv_of(file):
    """The texture coordinates of a .mesh file without normals, by position (x, z)."""
    data = pathlib.Path(file).read_bytes()
    (count,) = struct.unpack_from("<I", data, 16)
    spots = [struct.unpack_from("<3f", data, 40 + 12 * k) for k in range(count)]
    uv = [struct.unpack_from("<2f", data, 40 + 12 * count + 8 * k) for k in range(count)]
    return {(x, z): tuple(round(v, 5) for v in pair) for (x, _, z), pair in zip(spots, uv)}


# ---- MTL: every statement is read or named; options of images place the texture coordinates.

wood = png(2, 2, lambda x, y: (200, 120, 40))
write(a__obj="mtllib a.mtl\n" + square + "usemtl a\n" + textured, wood__png=wood)
write(a__mtl="newmtl a\nKd 0.5 0.5 0.5\nmap_Kd wood.png\n")
said, toml = imported("a.obj")
has(said, "1 mesh, 2 triangles, 1 image\n", "taken: 1 image of colours", "taken: 1 material,")
without(said, "left out", "assumed")
assert uv_of("folder/meshes/a.mesh") == {(-1, -1): (0, 0), (1, -1): (1, 0), (1, 1): (1, 1), (-1, 1): (0, 1)}
write(a__mtl="newmtl a\nmap_Kd -s 2 3 1 -o 0.5 -0.25 -clamp on -mm 0.1 0.9 -blendu on -t 0 0 0 -imfchan r wood.png  \t\r\n")
said, toml = imported("a.obj")
has(said, "the option '-clamp' of 1 image", "the option '-mm' of 1 image", "the option '-imfchan' of 1 image", "1 image\n")
without(said, "-blendu", "'-t'", "'-s'", "'-o'")
has(toml, "rho_d = [1, 1, 1]", "rho_d_texture")
assert uv_of("folder/meshes/a.mesh") == {(-1, -1): (0.5, -0.25), (1, -1): (2.5, -0.25), (1, 1): (2.5, 2.75), (-1, 1): (0.5, 2.75)}
names = ("map_Ka", "map_Ks", "map_Ns", "map_d", "map_Pr", "map_Pm", "map_Ps", "map_bump", "bump", "disp", "decal", "norm", "refl", "map_aat", "unheard_of")
values = ("Ka 1 1 1", "Tf 0.5 1 1", "Ni 1.5", "illum 4", "d 0.5", "Tr 0.5", "Pc 0.5", "Pcr 0.5", "Ps 1", "aniso 1", "anisor 1", "sharpness 60")
write(a__mtl="newmtl a\n" + "".join(f"{name} -bm 2 wood.png\n" for name in names) + "".join(f"{line}\n" for line in values))
said, _ = imported("a.obj")
for name in (*names, *(line.split()[0] for line in values)):
    has(said, f"left out: '{name}' of 1 material\n")
write(a__mtl="newmtl a\nd 1\nTr 0.0\nTf 1 1 1\nillum 2\nKa 0 0 0\nKe 0 0 0 # none\nNs 98\nmap_kd wood.png\nnewmtl b\nmap_Ke wood.png\nKe 2 2 2\nd 0.5\nnewmtl a\n")
said, toml = imported("a.obj")
has(said, "'d' of 1 material\n", "'map_Ke' of 1 material\n", "'Ke' of 1 material\n", "1 material with a name that another one has", "1 material that no part has")
without(said, "'Tr'", "'Tf'", "illum", "'Ka'", "'Ns'", "map_kd")
has(toml, "alpha = 0.1414", "rho_d_texture")
for line, words in (("Kd -1 0 0", "'Kd -1' of 1 material"), ("Kd 1 2", "'Kd' of 1 material"), ("Ks spectral x.rfl", "'Ks spectral' of 1 material"),
                    ("Ns nan", "'Ns nan' of 1 material"), ("Pr 1e", "'Pr 1e' of 1 material")):
    write(a__mtl=f"Kd 1 1 1\nnewmtl a\n{line}\n{line}\n")
    has(imported("a.obj")[0], f"left out: {words}\n", "1 statement of libraries before their first material")

# Names of files: backslashes, several libraries, blanks, other folders, paths of other machines.
write(lib_in_a__mtl="newmtl a\nmap_Kd tex\\wood.png \r\n", b__mtl="newmtl b\nKd 0.1 0.2 0.3\n")
os.makedirs("lib/tex", exist_ok=True)
pathlib.Path("lib/tex/wood.png").write_bytes(wood)
two = "usemtl a\nf 1/1 3/3 2/2\nusemtl b\nf 1/1 4/4 3/3\n"
for names in ("lib\\a.mtl b.mtl", "b.mtl  lib/a.mtl # both", "lib/a.mtl\nmtllib .\\b.mtl \r"):
    write(c__obj=f"mtllib {names}\n" + square + two)
    said, toml = imported("c.obj")
    has(said, "2 meshes", "1 image\n")
    without(said, "left out", "assumed")
    has(toml, "[meshes.a]", "[meshes.b]", "rho_d = [0.1, 0.2, 0.3]")
pathlib.Path("my own lib.mtl").write_text('newmtl a\nmap_Kd "C:\\\\Users\\\\me\\\\wood.png"\n'.replace("\\\\", "\\"))
write(c__obj="mtllib my own lib.mtl b.mtl nothing.mtl\n" + square + two + "usemtl gone\nf 1 2 3\n")
said, toml = imported("c.obj")
has(said, "3 meshes", "1 image\n", "assumed: 'wood.png' is 'C:\\Users\\me\\wood.png' of another folder", "the materials of 'nothing.mtl'",
    "1 material, which no library has: grey in place of 'gone'")
write(a__mtl="newmtl a\nmap_Kd none.png\n")
has(imported("a.obj")[0], "left out: 1 image that is not in the model or its folder: none.png\n")
write(a__mtl="newmtl a\nmap_Kd a.mtl\n")
has(imported("a.obj")[0], "left out: 1 image, damaged or of a format that is not read: a.mtl\n")
os.makedirs("inner", exist_ok=True)
write(inner_in_a__obj="mtllib a.mtl\n" + square + "usemtl a\n" + textured, inner_in_a__mtl="newmtl a\nmap_Kd ..\\wood.png\n")
has(command("import", "inner/a.obj", "--out", "folder"), "left out: 1 image that is not in the model or its folder")

# ---- OBJ: statements that carry no triangles are named; those that are not read are no reason to refuse a model.

lines = "lod 3\nbevel on\nc_interp off\nusemap x\nmaplib y.map\nshadow_obj s\nl 1 2 # comment\np 1 2 3\nf 1 2\ncurv 0 1 1 2\nparm u 0 1\nend\nmg 1 0.5\ns 1\n"
write(d__obj="\ufeff# C:\\x\\\n" + square + lines + "  f 1 2 \\\n 3 # a face\ns off\nfo +1 3 4\nv 0 0 0 0.5\nv 0 0 0 1 0 0\nv 0 0 0 1 2\n")
said, _ = imported("d.obj")
has(said, "2 triangles", *(f"left out: 1 statement '{key}'\n" for key in ("lod", "bevel", "c_interp", "usemap", "maplib", "shadow_obj", "parm", "end", "mg")),
    "left out: 3 points or lines", "left out: 1 curve or surface", "left out: 1 weight of vertices", "left out: 1 colour of vertices",
    "1 vertex with more numbers than are read", "1 face of smoothing groups without normals: the smoothing (--smooth DEG)")
for face, words in (("f 1/1//4 2 3", "line 9: expected an index"), ("f /1 2 3", "line 9"), ("f 1 2 x", "line 9"), ("f 1/9 2/1 3/1", "line 9: the index 9 of 'vt', of which there are 4"),
                    ("v 1 2", "line 9: expected 3 numbers after 'v'"), ("vt", "line 9: expected 1 number after 'vt'"), ("f 1//1 2//1 3//1", "of which there are 0")):
    write(e__obj=square + face + "\n")
    has(command("import", "e.obj", "--out", "none", code=2), "e.obj: ", words)
write(f__obj=square + "f 1/1 2/2 3\nf 1/1 3/3 4/4\nf 1//1 2 3//1\nvn 0 1 0\nf 5 6 7\nv 0 1 0\nv 1 1 0\nv 0 1 1\n")
has(imported("f.obj")[0], "3 triangles", "1 face with texture coordinates at some corners alone", "1 triangle that occurs twice")
pathlib.Path("g.obj").write_bytes(bytes(range(256)) * 300)
has(command("import", "g.obj", "--out", "none", code=2), "g.obj: found no triangle")

# ---- STL: solids by name, in either form; what is behind is counted, what is missing is refused with its place.

facet = "facet normal 0 1 0\nouter loop\nvertex 0 0 0\nvertex 0 0 1\nvertex 1 0 0\nendloop\nendfacet\n"
write(a__stl=f"solid left part\n{facet}endsolid left part\nSOLID right C:\\\n{facet.upper().replace('1 0 0', '2 1E0 0')}ENDSOLID\n")
has(imported("a.stl")[0], "1 mesh, 2 triangles")
has(command("import", "a.stl", "--out", "folder", "--select", "left part"), "1 triangle,")
has(command("import", "a.stl", "--out", "none", "--select", "middle", code=2), "'left part'", "'right C:")
write(b__stl="solid\n" + facet.replace("\n", " ") + "endsolid\n")
has(imported("b.stl")[0], "1 triangle,")
write(b__stl="solid\r\n" + facet.replace("\n", "\r\n  ") + "\r\n")
has(imported("b.stl")[0], "1 triangle,")
for old, new, words in (("vertex 0 0 1", "vertex 0 0", "line 5: expected three numbers after 'vertex'"), ("vertex 1 0 0\n", "", "line 6: expected three corners"), ("outer loop\n", "", "line 3: expected 'outer loop'"),
                        ("endfacet", "endfact", "line 8: expected facet"), ("endloop\nendfacet\n", "", "line 3: expected 'endloop'")):
    write(c__stl="solid\n" + facet.replace(old, new))
    has(command("import", "c.stl", "--out", "none", code=2), "c.stl: ", words)
corners = struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0x8001)
write(d__stl=b"solid COLOR=red".ljust(80) + struct.pack("<I", 1) + corners + b"end")
has(imported("d.stl")[0], "1 triangle,", "1 attribute or colour of triangles", "left out: COLOR= of the header\n", "3 bytes after the last triangle")
write(e__stl=b"x".ljust(80) + struct.pack("<I", 3) + corners)
has(command("import", "e.stl", "--out", "none", code=2), "byte 80: expected 3 triangles, the file ends after 1")
write(e__stl=b"x")
has(command("import", "e.stl", "--out", "none", code=2), "e.stl: expected the word solid")

# ---- glTF: accessors, parts without texture coordinates, images that state their gamma, extensions.

corners = [(-1, 0, -1), (1, 0, -1), (1, 0, 1), (-1, 0, 1)]


def scene(name, change=lambda g, root: None, image=wood, uri=None):
    """Two textured squares; the second one has no texture coordinates."""
    g = Glb()
    one = {"POSITION": g.array(corners, "VEC3", "f", 5126), "TEXCOORD_0": g.array([(0, 0), (1, 0), (1, 1), (0, 1)], "VEC2", "f", 5126)}
    two = {"POSITION": g.array([(x, 1, z) for x, _, z in corners], "VEC3", "f", 5126)}
    indices = g.array([0, 3, 2, 0, 2, 1], "SCALAR", "B", 5121)
    source = {"bufferView": g.view(image), "mimeType": "image/png"} if uri is None else {"uri": uri}
    root = {"images": [source], "textures": [{"source": 0}], "materials": [{"name": "m", "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1, 1], "metallicFactor": 0, "baseColorTexture": {"index": 0}}}],
            "meshes": [{"primitives": [{"attributes": one, "indices": indices, "material": 0}, {"attributes": two, "indices": indices, "material": 0}]}], "nodes": [{"mesh": 0}]}
    change(g, root)
    g.write(name, root)


scene("a.glb")
said, toml = imported("a.glb")
has(said, "2 meshes, 4 triangles, 1 image\n", "1 part without texture coordinates, of a material with images: it has its colours alone")
assert toml.count("rho_d = [0.5, 0.25, 1]") == 2 and toml.count("rho_d_texture") == 1, toml
scene("a.glb", image=png(2, 2, lambda x, y: (90, 90, 90), gamma=1))
has(imported("a.glb")[0], "assumed: 1 image of colours is sRGB, although it states a gamma or a profile")
scene("a.glb", image=png(2, 2, lambda x, y: (90, 90, 90), gamma=0.45455))
without(imported("a.glb")[0], "assumed")
os.makedirs("a dir", exist_ok=True)
pathlib.Path("a dir/wöod.png").write_bytes(wood)
for uri in ("a%20dir/w%C3%B6od.png", "a dir/wöod.png"):
    scene("a.glb", uri=uri)
    has(imported("a.glb")[0], "1 image\n")


def zeros(g, root):
    """A third primitive whose positions are zeros but for those that are sparse, without a view of its own."""
    rows, values = g.view(struct.pack("<2H", 1, 2)), g.view(struct.pack("<6f", 0, 2, 0, 1, 2, 0))
    g.accessors.append({"componentType": 5126, "count": 3, "type": "VEC3", "sparse": {"count": 2, "indices": {"bufferView": rows, "componentType": 5123}, "values": {"bufferView": values}}})
    root["meshes"][0]["primitives"] = [{"attributes": {"POSITION": len(g.accessors) - 1}}]
    g.accessors.append({"componentType": 5126, "count": 3, "type": "VEC2"})
    root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = len(g.accessors) - 1


scene("b.glb", zeros)
has(imported("b.glb")[0], "1 triangle,", "box [0, 0, 0] to [1, 2, 0]")


def signed_indices(g, root):
    zeros(g, root)
    g.accessors[-2]["sparse"]["indices"]["componentType"] = 5126


scene("c.glb", signed_indices)
has(command("import", "c.glb", "--out", "none", code=2), "accessors[4].sparse.indices.componentType: expected 5121, 5123 or 5125, not 5126")
scene("c.glb", lambda g, root: g.accessors[3].update(componentType=5120))
has(command("import", "c.glb", "--out", "none", code=2), "accessors[3].componentType: expected 5121, 5123 or 5125, not 5120")


def coats(g, root):
    root["materials"][0]["extensions"] = {"KHR_materials_clearcoat": {}, "KHR_materials_sheen": {}}
    root["materials"].append({"extensions": {"KHR_materials_sheen": {}}})
    root["extensionsUsed"] = ["KHR_materials_sheen"]


scene("d.glb", coats)
has(imported("d.glb")[0], "the extension KHR_materials_clearcoat, in 1 place\n", "the extension KHR_materials_sheen, in 2 places\n")
data = pathlib.Path("d.glb").read_bytes()
pathlib.Path("d.glb").write_bytes(data + struct.pack("<II", 4, 0x12345678) + b"1234" + b"tail")
has(imported("d.glb")[0], "1 part of the file of an unknown kind", "4 bytes after the last part of the file")

for node, words in (({"rotation": [0, 0, 2, 2]}, "nodes[0].rotation: expected a quaternion of length 1, not 2.828"), ({"rotation": [0, 0, 0, 0]}, "nodes[0].rotation"),
                    ({"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], "scale": [1, 1, 1]}, "nodes[0]: expected 'matrix' or 'scale', found both"),
                    ({"matrix": [1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}, "nodes[0].matrix: expected 0, 0, 0 and 1 as the last row")):
    scene("c.glb", lambda g, root: root["nodes"][0].update(node))
    has(command("import", "c.glb", "--out", "none", code=2), words)
for key, value in (("roughnessFactor", "a"), ("baseColorFactor", ["a", 1, 1, 1])):
    scene("c.glb", lambda g, root: root["materials"][0]["pbrMetallicRoughness"].update({key: value}))
    has(command("import", "c.glb", "--out", "none", code=2), f"materials[0].pbrMetallicRoughness.{key}: expected")
scene("c.glb", lambda g, root: root["materials"][0].update(emissiveFactor=[-1, 1, 1], extensions={"KHR_materials_emissive_strength": {"emissiveStrength": 1e9}}))
has(imported("c.glb")[0], "1 material with numbers below 0: it has 0 in their place", "1 material with numbers above 1e6: it has 1e6 in their place")

# ---- A sky whose numbers below 0 count as 0.

texels = sky_image.texels(8, 4, "(1, -0.04 if (x, y) == (5, 2) else 1, 1)")
sky_image.write("sky.exr", 8, 4, {"": texels})
has(imported("a.glb", "--sky", "sky.exr")[0], "# sky: 1 number below 0, at most 0.1 % of its energy, counts as 0\n")
