"""whole_scene.py CRESCENT: imports whole scenes into folders whose experiments run as they are."""
import json
import pathlib
import struct
import subprocess
import sys

import sky_image
from model_files import Glb, command, has, png

crescent = sys.argv[1]


square = [(-1, 0, -1), (1, 0, -1), (1, 0, 1), (-1, 0, 1)]
cube = [(x, y, z) for x in (-0.2, 0.2) for y in (0, 0.4) for z in (-0.2, 0.2)]
faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
cube_triangles = [k for a, b, c, d in faces for k in (a, b, c, a, c, d)]

# A textured floor, three copies of a metal cube, an emitter, a camera, and things that have no counterpart.
g = Glb()
floor = {"POSITION": g.array(square, "VEC3", "f", 5126), "TEXCOORD_0": g.array([(0, 0), (1, 0), (1, 1), (0, 1)], "VEC2", "f", 5126),
         "COLOR_0": g.array([(1, 1, 1)] * 4, "VEC3", "f", 5126)}
box = {"POSITION": g.array(cube, "VEC3", "f", 5126)}
floor_indices, box_indices = g.array([0, 2, 1, 0, 3, 2], "SCALAR", "H", 5123), g.array(cube_triangles, "SCALAR", "H", 5123)
colours = g.view(png(2, 2, lambda x, y: (188, 188, 188) if x == y else (0, 0, 0)))
surface = g.view(png(1, 1, lambda x, y: (0, 128, 0)))
scene = {
    "images": [{"bufferView": colours, "mimeType": "image/png", "name": "checks"}, {"bufferView": surface, "mimeType": "image/png"}],
    "textures": [{"source": 0, "sampler": 0}, {"source": 1}],
    "samplers": [{"wrapS": 33071}],
    "materials": [
        {"name": "tiles", "normalTexture": {"index": 0}, "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 1}}},
        {"name": "gold", "alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 0.8, 0.3, 1], "roughnessFactor": 0.5}},
        {"name": "lamp", "emissiveFactor": [1, 1, 1], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 5}}},
    ],
    "extensionsUsed": ["KHR_lights_punctual"],
    "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "aspectRatio": 2}}],
    "meshes": [
        {"name": "ground", "primitives": [{"attributes": floor, "indices": floor_indices, "material": 0}]},
        {"name": "cube", "primitives": [{"attributes": box, "indices": box_indices, "material": 1}]},
        {"name": "bulb", "primitives": [{"attributes": box, "indices": box_indices, "material": 2}]},
    ],
    "nodes": [
        {"mesh": 0}, {"name": "cubes", "children": [2, 3, 4]}, {"mesh": 1}, {"mesh": 1, "translation": [0.6, 0, 0], "name": "right"},
        {"mesh": 1, "translation": [-0.6, 0, 0], "scale": [-1, 2, 1]}, {"mesh": 2, "translation": [0, 1.2, 0], "scale": [0.5, 0.5, 0.5]},
        {"camera": 0, "translation": [0, 0.8, 4]}, {"extensions": {"KHR_lights_punctual": {"light": 0}}},
    ],
}
g.write("scene.glb", scene)
said = command("import", "scene.glb", "--out", "scene")
has(said, "3 meshes", "50 triangles", "2 images", "camera: that of the file", "3 copies", "1 mesh that emits", "left out: 1 normal map\n",
    "1 material with transparency", "1 light\n", "COLOR_0", "1 image that is clamped or mirrored at its ends, and repeats here")
text = pathlib.Path("scene/experiment.toml").read_text()
has(text, "[meshes.cube]", "[[meshes.cube.instances]]", "rho_s = [1, 0.8, 0.3]", "alpha = 0.25", "emission = [5, 5, 5]",
    "rho_d_texture = \"textures/", "alpha_texture = \"textures/", "eye = [0, 0.8, 4]", "height = 160")
command("run", "scene/experiment.toml", "--quiet", "--out", "out", "--set", "image.width=64", "--set", "image.height=32")
runs = json.loads(pathlib.Path("out/metrics.json").read_text())["runs"]
assert all(run["bad"] == 0 and run["y_mean"] > 0 for run in runs if "bad" in run), runs

# A layer of the sky is named in the experiment.
sky = sky_image.texels(8, 4, "(1, 1, 1)")
sky_image.write("layers.exr", 8, 4, {"sun": sky, "ambient": sky})
command("import", "scene.glb", "--out", "under-sky", "--sky", "layers.exr", "--layer", "sun")
has(pathlib.Path("under-sky/experiment.toml").read_text(), '[sky]\nfile = "sky.exr"\nlayer = "sun"\n')
has(command("import", "scene.glb", "--out", "none", "--sky", "layers.exr", "--layer", "son", code=2), "no layer 'son'", "did you mean 'sun'")
has(command("import", "scene.glb", "--out", "none", "--layer", "sun", code=2), "--layer: expected together with --sky")
assert not pathlib.Path("none").exists()

# One mesh and the folder have the same material.
for material in ("tiles", "gold", "lamp"):
    one = command("import", "scene.glb", "--out", "one.mesh", "--material", material).partition("[meshes.")[2]
    command("import", "scene.glb", "--out", "of-one", "--select", material)
    folder = pathlib.Path("of-one/experiment.toml").read_text().partition("[meshes.")[2].partition("\n\n")[0]
    for key in ("rho_d", "rho_s", "alpha", "emission"):
        values = [[line for line in text.splitlines() if line.startswith(key + " = ")] for text in (one, folder)]
        dark = values[1] in ([], ["rho_s = [0, 0, 0]"]) or (key == "alpha" and "rho_s = [0, 0, 0]" in folder)
        assert values[0] == values[1] or (dark and not values[0]), (material, values)

# A second import keeps what was edited since the first one, says so, and says nothing of what was not.
experiment = pathlib.Path("scene/experiment.toml")
written, meshes = experiment.read_text(), sorted(pathlib.Path("scene/meshes").iterdir())
again = command("import", "scene.glb", "--out", "scene")
assert "has changed" not in again and not list(pathlib.Path("scene").rglob("*.~1~")), again
for edited in (written + "# mine\n", written.replace("n = 64", "n = 65")):
    experiment.write_text(edited)
    own = meshes[0].read_bytes() + b"own"
    meshes[0].write_bytes(own)
    again = command("import", "scene.glb", "--out", "scene")
    number = len(list(pathlib.Path("scene").glob("experiment.toml.~*~")))
    has(again, f"experiment.toml has changed since crescent import wrote it: it is now experiment.toml.~{number}~",
        f"{meshes[0].name} has changed since")
    assert pathlib.Path(f"scene/experiment.toml.~{number}~").read_text() == edited
    assert pathlib.Path(f"{meshes[0]}.~{number}~").read_bytes() == own
    assert experiment.read_text() == written
assert "has changed" not in command("import", "scene.glb", "--out", "scene")
# One that the next import does not write is kept too, and so are files of the user.
meshes[0].write_bytes(own)
pathlib.Path("scene/notes.txt").write_text("mine")
rest = next(name for name in ("tiles", "gold", "lamp") if name not in meshes[0].name and (name, meshes[0].stem) != ("gold", "cube"))
other = command("import", "scene.glb", "--out", "scene", "--select", rest)
has(other, f"{meshes[0].name} has changed since")
assert pathlib.Path("scene/notes.txt").read_text() == "mine" and not meshes[0].exists()

# Copies that are kept, and the same triangles baked into one mesh, are the same scene.
said = command("import", "scene.glb", "--out", "baked.mesh")
has(said, "50 triangles", "box [-1, 0, -1] to [1, 1.4, 1]")
# Parts of it; names that are near.
has(command("import", "scene.glb", "--out", "cubes", "--select", "cubes"), "1 mesh,", "36 triangles")
has(command("import", "scene.glb", "--out", "gold", "--select", "gold"), "36 triangles")
has(command("import", "scene.glb", "--out", "right", "--select", "right"), "12 triangles", "box [0.4, 0,", "1 copy of meshes, as an instance")
has(command("import", "scene.glb", "--out", "none", "--select", "gild", code=2), "'gild'", "'gold'")
assert not pathlib.Path("none").exists()

# z up and a scale, also for .mesh files; smooth normals of a model that has none.
has(command("import", "scene.glb", "--out", "turned.mesh", "--up", "z", "--scale", "10"), "box [-10, -10, -14] to [10, 10, 0]")
cube_obj = "".join(f"v {x} {y} {z}\n" for x, y, z in cube) + "".join("f " + " ".join(str(k + 1) for k in f) + "\n" for f in faces)
pathlib.Path("cube.obj").write_text("\ufeffmtllib cube.mtl\nusemtl red\n" + cube_obj, encoding="utf-8", newline="\r")
pathlib.Path("cube.mtl").write_text("newmtl red\nKd 0.8 0.1 0.1\nKs 0.5 0.5 0.5\nNs 98\nmap_Kd nowhere.png\n")
has(command("import", "cube.obj", "--out", "flat.mesh"), "normals: of the triangles")
has(command("import", "cube.obj", "--out", "edges.mesh", "--smooth", "80"), "normals: of the triangles")
has(command("import", "cube.obj", "--out", "round.mesh", "--smooth", "100"), "normals: smooth", "8 vertices")
has(command("import", "cube.obj", "--out", "cube"), "1 mesh,", "12 triangles", "the whole model")
has(pathlib.Path("cube/experiment.toml").read_text(), "[meshes.red]", "rho_d = [0.8, 0.1, 0.1]", "rho_s = [0.2, 0.5, 0.5]", "alpha = 0.1414")
command("import", "cube.obj", "--out", "cube.text", code=2)

# Names with blanks are whole, of objects, groups and materials.
face = "f " + " ".join(str(k + 1) for k in faces[0]) + "\n"
pathlib.Path("names.obj").write_text(
    "mtllib names.mtl\n" + "".join(f"v {x} {y} {z}\n" for x, y, z in cube) +
    "o my car\nusemtl red paint\nf 1 2 4 3\no  two  blanks \nusemtl dull\nf 5 7 8 6\ng a wheel\nf 1 5 6 2\n")
pathlib.Path("names.mtl").write_text("newmtl red paint\nKd 1.5 0.1 0.1\nKs 0 0 0\nnewmtl dull\nKd 0.3 0.3 0.3\nKs 0.2 3 0.2\n")
has(command("import", "names.obj", "--out", "names", "--select", "my car"), "1 mesh,", "2 triangles")
has(command("import", "names.obj", "--out", "names", "--select", "my", code=2), "'my car'", "'two  blanks'", "'red paint'")
has(command("import", "names.obj", "--out", "names", "--select", "red paint"), "1 mesh,", "2 triangles")
# What an experiment does not take is cut to what it takes, and counted.
said = command("import", "names.obj", "--out", "names")
has(said, "cut: 1 material with colours (Kd) above 1, to 1", "cut: 1 material with colours of the lobe (Ks) above 1, to 1",
    "cut: 1 material with rho_s above 1 - rho_d")
has(pathlib.Path("names/experiment.toml").read_text(), "rho_d = [1, 0.1, 0.1]", "rho_s = [0.2, 0.7, 0.2]")
has(command("import", "names.obj", "--out", "names.mesh", "--material", "red paint"), "cut: 1 material with colours (Kd) above 1, to 1",
    "rho_d = [1, 0.1, 0.1]")
assert "cut:" not in command("import", "cube.obj", "--out", "kept", "--select", "red").replace("cut: 1 material with rho_s", "")

# A model of any aspect is seen by the camera that is made for it.
for x, y, z in ((1000, 1, 1), (1, 2000, 0.5), (1000, 0.001, 1000)):
    thin = "".join(f"v {a / 0.4 * x} {b / 0.4 * y} {c / 0.4 * z}\n" for a, b, c in cube)
    pathlib.Path("thin.obj").write_text(thin + "".join("f " + " ".join(str(k + 1) for k in f) + "\n" for f in faces))
    command("import", "thin.obj", "--out", "thin")
    command("run", "thin/experiment.toml", "--quiet", "--out", "out", "--only", "metrics", "--set", "n=1", "--set", "arms.cosine.n=[1]",
            "--set", "arms.material.n=[1]", "--set", "arms.renderer.n=[1]", "--set", "reference.n=2")
    seen = json.loads(pathlib.Path("out/metrics.json").read_text())["geometry_pixels"]
    assert seen > 320 * 240 / 100, (x, y, z, seen)

# EXT_meshopt_compression, as meshoptimizer's encoders write it: a rectangle of 1 by 2, plain and with the filter of
# exponents, its normals of one direction by octahedra, both modes of indices; and one of 0.5 by 0.25 as quaternions.
MESHOPT = {
    "positions": "a00000013f000000ffffff013f0000007e7d7e000000010c00000080000000000000000000000000000000000000000000000000000000000000000000000000",
    "exponents": "a000013f000000403f2000012800000000010c0000004000012800000000000001280000000000000000000000000000000000000000000000000000f2000000f2000000f2",
    "normals": "a00000000000000000000000000000000000000000000000000000000000000000db360000ff7f0000",
    "quaternions": "a0013f000000fbfcfb013f000000b4b3b4010c00000082010c0000005a0000000000000000000000000000000000000000000000000000000000000000825aff7f",
    "triangles": "e1fe000f06007687566778a9866589689801690000",
    "indices": "d10004080a0c0200000000"}


def meshopt_glb(name, positions="positions", indices="TRIANGLES", filter=None, component=5126, stride=12, change=None):
    """A rectangle in compressed views; `change` edits the extensions of the views of positions, normals, indices."""
    g, views = Glb(), []
    normals = {"mode": "ATTRIBUTES", "filter": "OCTAHEDRAL", "count": 4, "byteStride": 8}
    of_positions = {"mode": "ATTRIBUTES", "count": 4, "byteStride": stride, **({"filter": filter} if filter else {})}
    for data, more in ((positions, of_positions), ("normals", normals), (indices.lower(), {"mode": indices, "count": 6, "byteStride": 2})):
        packed = bytes.fromhex(MESHOPT[data])
        g.view(packed)
        size = more["count"] * more["byteStride"]
        views.append({"buffer": 1, "byteLength": size, "extensions": {"EXT_meshopt_compression": {"buffer": 0, "byteOffset": g.views[-1]["byteOffset"], "byteLength": len(packed), **more}}})
        if more["mode"] == "ATTRIBUTES":
            views[-1]["byteStride"] = more["byteStride"]
    if change:
        change(*(view["extensions"]["EXT_meshopt_compression"] for view in views))
    accessors = [{"bufferView": 0, "componentType": component, "normalized": component != 5126, "count": 4, "type": "VEC3"},
                 {"bufferView": 1, "componentType": 5122, "normalized": True, "count": 4, "type": "VEC3"},
                 {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"}]
    names = ["EXT_meshopt_compression", "KHR_mesh_quantization"]
    buffers = [{"byteLength": len(g.bytes)}, {"byteLength": 200, "extensions": {"EXT_meshopt_compression": {"fallback": True}}}]
    g.write(name, {"extensionsUsed": names, "extensionsRequired": names, "buffers": buffers, "bufferViews": views, "accessors": accessors,
                   "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2}]}], "nodes": [{"mesh": 0}]})



meshopt_glb("meshopt.glb")
tried = subprocess.run([crescent, "import", "meshopt.glb", "--out", "meshopt.mesh"], capture_output=True, text=True)
if "not supported" in tried.stderr:  # a build without meshoptimizer
    assert tried.returncode == 2
    has(tried.stderr, "meshopt.glb: extensionsRequired: the extension 'EXT_meshopt_compression' is not supported")
else:
    assert tried.returncode == 0, tried.stdout + tried.stderr
    for how in ({}, {"indices": "INDICES"}, {"positions": "exponents", "filter": "EXPONENTIAL"}):
        meshopt_glb("meshopt.glb", **how)
        has(command("import", "meshopt.glb", "--out", "meshopt.mesh"), "2 triangles, 4 vertices", "box [0, 0, 0] to [1, 2, 0]", "normals: smooth")
        plain = Glb()
        plain.array([(0, 0, 0), (1, 0, 0), (0, 2, 0), (1, 2, 0)], "VEC3", "f", 5126)
        plain.array([(19660, 0, 26214)] * 4, "VEC3", "h", 5122)
        plain.array([0, 1, 3, 0, 3, 2], "SCALAR", "H", 5123)
        plain.accessors[1]["normalized"] = True
        plain.write("plain.glb", {"extensionsUsed": ["KHR_mesh_quantization"], "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2}]}], "nodes": [{"mesh": 0}]})
        command("import", "plain.glb", "--out", "plain.mesh")
        ours, theirs = (pathlib.Path(name).read_bytes() for name in ("meshopt.mesh", "plain.mesh"))
        assert len(ours) == len(theirs)
        for k in range(0, len(ours) - 3, 4):  # to a step of 16 bits, which octahedra have
            a, b = struct.unpack_from("<f", ours, k)[0], struct.unpack_from("<f", theirs, k)[0]
            assert ours[k:k + 4] == theirs[k:k + 4] or abs(a - b) < 1e-4, (how, k, a, b)
    meshopt_glb("meshopt.glb", positions="quaternions", filter="QUATERNION", component=5122, stride=8)
    has(command("import", "meshopt.glb", "--out", "meshopt.mesh"), "box [0, 0, 0.500015] to [0.500015, 0.250008, 0.500015]")
    for change, words in (
        (lambda p, n, i: p.update(byteLength=p["byteLength"] - 9), ("bufferViews[0].extensions.EXT_meshopt_compression", "are not 4 elements of 12 bytes")),
        (lambda p, n, i: p.update(mode="POINTS"), ("expected a mode", "not 'POINTS'")),
        (lambda p, n, i: p.update(filter="WAVELET"), ("expected a filter", "not 'WAVELET'")),
        (lambda p, n, i: p.update(filter="OCTAHEDRAL"), ("elements of 4 or 8 bytes",)),
        (lambda p, n, i: n.update(count=3), ("3 elements of 8 bytes are not the 32 bytes",)),
        (lambda p, n, i: p.update(count=1 << 60), ("bufferViews[0]",)),
        (lambda p, n, i: i.update(filter="EXPONENTIAL"), ("expected no filter",)),
        (lambda p, n, i: i.update(byteOffset=10**6), ("bufferViews[2].extensions.EXT_meshopt_compression", "beyond")),
    ):
        meshopt_glb("meshopt.glb", change=change)
        has(command("import", "meshopt.glb", "--out", "meshopt.mesh", code=2), "meshopt.glb: ", *words)

# Draco, as its own encoder writes it: a rectangle of 1 by 2 with texture coordinates.
packed = bytes.fromhex(
    "445241434f02020101000000040201020000011fff0111ff011102ff0000000000010009030000000103090200010000000000000000000000"
    "00000000803f00000040000000000000000000000040000000000000803f000000000000000000000000000000000000803f0000803f000000"
    "000000803f0000803f00000000")
for data, code in ((packed, 0), (packed[:60], 2)):
    g = Glb()
    attributes = {"POSITION": 0, "TEXCOORD_0": 1}
    part = {"attributes": attributes, "indices": 2, "extensions": {"KHR_draco_mesh_compression": {"bufferView": g.view(data), "attributes": attributes}}}
    g.accessors = [{"componentType": 5126, "count": 4, "type": "VEC3"}, {"componentType": 5126, "count": 4, "type": "VEC2"},
                   {"componentType": 5123, "count": 6, "type": "SCALAR"}]
    names = ["KHR_draco_mesh_compression"]
    g.write("draco.glb", {"extensionsUsed": names, "extensionsRequired": names, "meshes": [{"primitives": [part]}], "nodes": [{"mesh": 0}]})
    done = subprocess.run([crescent, "import", "draco.glb", "--out", "draco.mesh"], capture_output=True, text=True)
    if "not supported" in done.stderr:
        break  # a build without Draco's library
    assert done.returncode == code, done.stdout + done.stderr
    has(done.stdout + done.stderr, *(("2 triangles, 4 vertices", "box [0, 0, 0] to [1, 2, 0]", "one set") if code == 0 else ("draco.glb: ", "Draco")))
