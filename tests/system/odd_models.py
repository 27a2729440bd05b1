"""odd_models.py CRESCENT TINY.toml: imports models that are unusual but right, and models that are not."""
import base64
import json
import os
import pathlib
import re
import struct
import subprocess
import sys
import time

crescent, tiny = sys.argv[1:]
corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
triangles = [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]


def imported(name, *flags):
    start = time.monotonic()
    words = [crescent, "import", name, "--out", "x.mesh", "--memory", "500", *flags]
    done = subprocess.run(words, capture_output=True, text=True, timeout=60)
    assert time.monotonic() - start < 20, f"{name} takes {time.monotonic() - start:.0f} s"
    return done


def reads(name, count, low=None, high=None, words=()):
    """The model has so many triangles in this box, and the printed tables make an experiment that runs."""
    done = imported(name)
    assert done.returncode == 0, f"{name}: exit {done.returncode}: {done.stderr}"
    assert f": {count} triangles," in done.stdout, f"{name}: expected {count} triangles:\n{done.stdout}"
    for word in words:
        assert word in done.stdout, f"{name}: no '{word}' in\n{done.stdout}"
    if low is not None:
        box = [[float(x) for x in part.split(",")] for part in re.findall(r"\[([^]]*)\]", done.stdout.splitlines()[1])]
        assert all(abs(a - b) < 1e-5 for got, right in zip(box, (low, high)) for a, b in zip(got, right)), f"{name}: {box}"
    tables = "\n".join(line for line in done.stdout.splitlines() if not line.startswith("#"))
    scene = pathlib.Path(tiny).read_text()
    scene = scene[scene.index("[fill]"):scene.index("[arms.uniform]")]
    pathlib.Path("x.toml").write_text(f"[image]\nwidth = 32\nheight = 24\n{tables}\n{scene}\n[arms.cosine]\nn = 4\n")
    run = subprocess.run([crescent, "run", "x.toml", "--quiet", "--out", "out"], capture_output=True, text=True)
    assert run.returncode == 0, f"{name}: the printed experiment: {run.stderr}"
    (mean,) = [one["y_mean"] for one in json.loads(pathlib.Path("out/metrics.json").read_text())["runs"]]
    assert mean > 0.01, f"{name} is not seen: mean {mean}"


def refuses(name, *words):
    pathlib.Path("x.mesh").unlink(missing_ok=True)
    done = imported(name)
    assert done.returncode == 2, f"{name}: exit {done.returncode}:\n{done.stdout}{done.stderr}"
    for word in (f"{name}: ", *words):
        assert word in done.stderr, f"{name}: no '{word}' in {done.stderr}"
    assert not os.path.exists("x.mesh"), f"{name}: a refused model is written"


# ---- PLY.


def ply(name, form, elements, types, rows):
    """Elements with their rows, lists of numbers; `types`: the lines of properties."""
    head = f"ply\nformat {form} 1.0\ncomment by hand\n"
    for element, properties in zip(elements, types):
        head += f"element {element} {len(rows[element])}\n" + "".join(f"property {p}\n" for p in properties)
    body = bytearray()
    codes = {"char": "b", "uchar": "B", "short": "h", "int": "i", "float": "f", "double": "d"}
    order = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}[form]
    for element, properties in zip(elements, types):
        for row in rows[element]:
            if form == "ascii":
                flat = [x for value in row for x in ([len(value), *value] if isinstance(value, (list, tuple)) else [value])]
                body += (" ".join(map(str, flat)) + "\n").encode()
                continue
            for value, kind in zip(row, properties):
                words = kind.split()
                if words[0] == "list":
                    body += struct.pack(order + codes[words[1]], len(value))
                    body += struct.pack(f"{order}{len(value)}{codes[words[2]]}", *value)
                else:
                    body += struct.pack(order + codes[words[0]], value)
    pathlib.Path(name).write_bytes((head + "end_header\n").encode() + body)


point, face, strip = ["float x", "float y", "float z"], ["list uchar int vertex_indices"], ["list int int vertex_indices"]
ribbon = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0), (0, 2, 0), (1, 2, 0)]
for form in ("ascii", "binary_little_endian", "binary_big_endian"):
    ply("strip.ply", form, ["vertex", "tristrips"], [point, strip], {"vertex": ribbon, "tristrips": [[[0, 1, 2, 3, 4, 5]]]})
    reads("strip.ply", 4, (0, 0, 0), (1, 2, 0))
    ply("two.ply", form, ["vertex", "tristrips"], [point, strip], {"vertex": ribbon, "tristrips": [[[0, 1, 2, -1, 2, 3, 4, 5]]]})
    reads("two.ply", 3)
    # The first byte of the data is that of the end of a line.
    shifted = [(struct.unpack("<f" if "little" in form else ">f", b"\x0a\x00\x00\x3f")[0] if k == 0 else x, y, z) for k, (x, y, z) in enumerate(corners)]
    ply("quads.ply", form, ["vertex", "face"], [point, face], {"vertex": shifted, "face": [[f] for f in faces]})
    reads("quads.ply", 12)
    colours = {"vertex": [(*p, 200) for p in corners], "face": [[f, 7] for f in faces], "edge": [(0, 1), (1, 2)]}
    ply("more.ply", form, ["vertex", "face", "edge"], [[*point, "uchar red"], [*face, "int flags"], ["int vertex1", "int vertex2"]], colours)
    reads("more.ply", 12, words=("left out: 2 elements 'edge'", "left out: of the vertices: red", "'face': flags"))
    ply("beyond.ply", form, ["vertex", "face"], [point, face], {"vertex": corners, "face": [[(0, 1, 2)], [(0, 1, 8)]]})
    refuses("beyond.ply", "face 1", "8")
concave = [(0, 0, 0), (4, 0, 0), (4, 4, 0), (2, 1, 0), (0, 4, 0)]
ply("concave.ply", "ascii", ["vertex", "face"], [point, face], {"vertex": concave, "face": [[(0, 1, 2, 3, 4)]]})
reads("concave.ply", 3)
# A square with a square hole, joined by a bridge: the hole stays open.
keyhole = [(0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0), (1, 1, 0), (1, 3, 0), (3, 3, 0), (3, 1, 0)]
ply("keyhole.ply", "ascii", ["vertex", "face"], [point, face], {"vertex": keyhole, "face": [[(0, 1, 2, 3, 0, 4, 5, 6, 7, 4)]]})
reads("keyhole.ply", 8)
data = pathlib.Path("x.mesh").read_bytes()
spots = [struct.unpack_from("<3f", data, 40 + 12 * k) for k in range(8)]
area = 0
for k in range(8):
    (ax, ay, _), (bx, by, _), (cx, cy, _) = (spots[i] for i in struct.unpack_from("<3I", data, 40 + 12 * 8 + 12 * k))
    area += ((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) / 2
assert area == 12, f"keyhole.ply: the area {area}, expected 12"
text = pathlib.Path("strip.ply").read_bytes()
pathlib.Path("more.ply").write_bytes(text + b"1 2 3")
reads("more.ply", 4, words=("bytes after the last element",))
pathlib.Path("twice.ply").write_bytes(text.replace(b"element tristrips", b"element vertex 1\nproperty float x\nproperty float y\nproperty float z\nelement tristrips"))
refuses("twice.ply", "second")
pathlib.Path("cut.ply").write_bytes(text[:-5])
refuses("cut.ply", "tristrips")
for old, new, words in ((b"vertex 6", b"vertex 600000000000", "vertex"), (b"int int", b"float int", "line 9"), (b"format", b"frmat", "line 2"), (b"property float z\n", b"", "x, y and z")):
    pathlib.Path("bad.ply").write_bytes(text.replace(old, new))
    refuses("bad.ply", words)
wheel = 100_000
ply("wheel.ply", "ascii", ["vertex", "face"], [point, strip], {"vertex": [(k, k * k % 7, 0) for k in range(wheel)], "face": [[list(range(wheel))]]})
refuses("wheel.ply", "face 0", "4096")

# ---- OBJ.

vertices = "".join(f"v {x} {y} {z}\n" for x, y, z in corners)
cube = vertices + "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in triangles)
below = vertices + "".join(f"f {a - 8} {b - 8} {c - 8}\n" for a, b, c in triangles)
continued = vertices + "".join(f"f {a + 1} \\\n{b + 1} \\\n{c + 1}\n" for a, b, c in triangles)
for name, text in {"bom": "\ufeff" + cube, "cr": cube.replace("\n", "\r"), "crlf": cube.replace("\n", "\r\n"), "below": below, "continued": continued}.items():
    pathlib.Path(f"{name}.obj").write_bytes(text.encode())
    reads(f"{name}.obj", 12, (0, 0, 0), (1, 1, 1))
for name, text, words in (("beyond", cube + "f 1 2 9\n", "line 21"), ("above", "f -1 -2 -3\n" + cube, "line 1"), ("zero", cube + "f 0 1 2\n", "line 21"),
                          ("few", cube.replace("v 0 0 1\n", "v 0 9\n"), "line 2"),
                          ("polygon", "".join(f"v {k} {k * k % 7} 0\n" for k in range(wheel)) + "f " + " ".join(map(str, range(1, wheel + 1))) + "\n", f"line {wheel + 1}")):
    pathlib.Path(f"{name}.obj").write_text(text)
    refuses(f"{name}.obj", words)
for size in (1e-30, 1e-12, 1e-4, 1e7, 1e30):
    pathlib.Path("sized.obj").write_text("".join(f"v {size * x} {size * y} {size * z}\n" for x, y, z in corners) + cube[len(vertices):])
    reads("sized.obj", 12, words=() if 1e-3 <= size <= 1e5 else ("moved by",))
for name, text in {"indented": cube.replace("f ", "  f "), "path": "# C:\\models\\\n" + cube, "remark": cube.replace("\n", " # 4\n")}.items():
    pathlib.Path(f"{name}.obj").write_text(text)
    reads(f"{name}.obj", 12, (0, 0, 0), (1, 1, 1))
pathlib.Path("nowhere.obj").write_text("mtllib nowhere.mtl\n" + cube + "l 1 2\n")
reads("nowhere.obj", 12, words=("left out: the materials of 'nowhere.mtl'", "left out: 1 point or line\n"))
pathlib.Path("infinite.mtl").write_text("newmtl a\nKd nan 1e39 0\n")
pathlib.Path("infinite.obj").write_text("mtllib infinite.mtl\nusemtl a\n" + cube)
reads("infinite.obj", 12)
os.mkfifo("pipe.obj")
refuses("pipe.obj")
os.mkfifo("pipe.mtl")
pathlib.Path("piped.obj").write_text("mtllib pipe.mtl\n" + cube)
reads("piped.obj", 12)

# ---- glTF.


def gltf(name, change=lambda root: None, positions=None, indices=None, mode=4, binary=False, uri=None):
    positions = struct.pack("<24f", *(x for p in corners for x in p)) if positions is None else positions
    indices = [k for t in triangles for k in t] if indices is None else indices
    data = positions + struct.pack(f"<{len(indices)}H", *indices)
    root = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": mode, "indices": 1}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3"},
                      {"bufferView": 1, "componentType": 5123, "count": len(indices), "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": len(positions)}, {"buffer": 0, "byteOffset": len(positions), "byteLength": 2 * len(indices)}],
        "buffers": [{"byteLength": len(data)}],
    }
    if uri is not None:
        root["buffers"][0]["uri"] = uri
        if not os.path.exists(uri.replace("%20", " ")):
            pathlib.Path(uri.replace("%20", " ")).write_bytes(data)
    elif not binary:
        root["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    change(root)
    text = json.dumps(root).encode()
    if binary:
        text += b" " * (-len(text) % 4)
        data += b"\0" * (-len(data) % 4)
        chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(data), 0x004E4942) + data
        text = b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks
    pathlib.Path(name).write_bytes(text)


def put(path, value):
    def change(root):
        *way, last = path
        for key in way:
            root = root[key]
        root[last] = value
    return change


gltf("cube.gltf")
reads("cube.gltf", 12, (0, 0, 0), (1, 1, 1))
gltf("cube.glb", binary=True)
reads("cube.glb", 12, (0, 0, 0), (1, 1, 1))
gltf("named.gltf", uri="my%20data.bin")
reads("named.gltf", 12, (0, 0, 0), (1, 1, 1))
gltf("turned.gltf", put(["nodes", 0], {"mesh": 0, "translation": [1, 2, 3], "rotation": [0, 0, 2**-0.5, 2**-0.5], "scale": [2, 1, 1]}))
reads("turned.gltf", 12, (0, 2, 3), (1, 4, 4))
gltf("nested.gltf", lambda root: root.update(nodes=[{"children": [1, 2], "scale": [2, 2, 2]}, {"mesh": 0}, {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 2, 0, 0, 1]}]))
reads("nested.gltf", 24, (0, 0, 0), (6, 2, 2))
gltf("strip.gltf", indices=[0, 1, 2, 3, 4, 5], mode=5)
reads("strip.gltf", 4)
gltf("fan.gltf", indices=[0, 1, 3, 2], mode=6)
reads("fan.gltf", 2)
shorts = b"".join(struct.pack("<3hh", *(8000 * x for x in p), 0) for p in corners)
quantised = {"accessors": {"bufferView": 0, "componentType": 5122, "normalized": True, "count": 8, "type": "VEC3"}}


def quantise(root):
    root["extensionsRequired"] = root["extensionsUsed"] = ["KHR_mesh_quantization"]
    root["accessors"][0] = quantised["accessors"]
    root["bufferViews"][0]["byteStride"] = 8


gltf("quantised.gltf", quantise, positions=shorts)
reads("quantised.gltf", 12, (0, 0, 0), (8000 / 32767,) * 3)
far = struct.pack("<24f", *(3.8e6 + x for p in corners for x in p))
gltf("earth.gltf", positions=far)
reads("earth.gltf", 12, words=("moved by",))
# A tenth of a metre, as doubles of the node place it, four million metres away.
gltf("fine.gltf", put(["nodes", 0], {"mesh": 0, "translation": [3.8e6, 0, 0], "scale": [0.1] * 3}))
reads("fine.gltf", 12, (-0.05,) * 3, (0.05,) * 3, words=("moved by",))
colour = {"baseColorFactor": [1e300, 0, 0, 1]}
gltf("material.gltf", lambda root: (root.update(materials=[{"name": "a\n[sky]", "pbrMetallicRoughness": colour}]), root["meshes"][0]["primitives"][0].update(material=0)))
reads("material.gltf", 12, words=("material 'a\\x0a[sky]'",))
gltf("lit.gltf", put(["extensionsUsed"], ["KHR_lights_punctual"]))
reads("lit.gltf", 12, words=("left out: the extension KHR_lights_punctual",))


def sparse(root):
    root["accessors"][0]["sparse"] = {"count": 1, "indices": {"bufferView": 1, "componentType": 5123}, "values": {"bufferView": 0}}


gltf("sparse.gltf", sparse)
reads("sparse.gltf", 12, (0, 0, 0), (1, 1, 1))

for name, change, words in (
    ("names", put(["extensionsRequired"], "ACME_magic"), ("extensionsRequired",)),
    ("unknown", put(["extensionsRequired"], ["ACME_magic"]), ("ACME_magic",)),
    ("meshopt", put(["extensionsRequired"], ["KHR_meshopt_compression"]), ("KHR_meshopt_compression",)),
    ("long", put(["accessors", 0, "count"], 9), ("accessors[0]", "9 elements")),
    ("huge", put(["accessors", 1, "count"], 2**62), ("accessors[1]",)),
    ("view", put(["bufferViews", 1, "byteLength"], 10**6), ("bufferViews[1]",)),
    ("stride", put(["bufferViews", 0, "byteStride"], 2**63), ("accessors[0]",)),
    ("offset", put(["bufferViews", 1, "byteOffset"], 2**64 - 8), ("bufferViews[1]",)),
    ("short", put(["buffers", 0, "byteLength"], 10**9), ("buffers[0]",)),
    ("absent", put(["accessors", 1, "bufferView"], 7), ("bufferView",)),
    ("loop", put(["nodes", 0], {"mesh": 0, "children": [0]}), ("nodes[0]",)),
    ("words", put(["meshes", 0, "primitives", 0, "attributes"], 3), ("primitives[0]",)),
    ("negative", put(["accessors", 1, "count"], -3), ("accessors[1].count",)),
    ("outside", put(["buffers", 0, "uri"], "../outside.bin"), ("folder",)),
    ("device", put(["buffers", 0, "uri"], "/dev/zero"), ("folder",)),
    ("piped", put(["buffers", 0, "uri"], "pipe.obj"), ("regular file",)),
):
    gltf(f"{name}.gltf", change)
    refuses(f"{name}.gltf", *words)
gltf("beyond.gltf", indices=[0, 1, 2, 0, 1, 99])
refuses("beyond.gltf", "meshes[0].primitives[0].indices", "99", "8 vertices")
gltf("deep.gltf")
pathlib.Path("deep.gltf").write_bytes(b'{"asset":' + b"[" * 10**6)
refuses("deep.gltf")
gltf("cut.glb", binary=True)
pathlib.Path("cut.glb").write_bytes(pathlib.Path("cut.glb").read_bytes()[:-40])
refuses("cut.glb", "beyond the end")
