"""Imports damaged models: crescent-import may die of one, and `crescent import` must not.

    mesh_mutants.py CRESCENT COUNT [SEED]

Each of COUNT files is a small OBJ, PLY, STL, glTF or GLB with some bytes changed, removed, doubled or replaced by large
numbers. Exit 1: an exit code other than 0 (a mesh) and 2 (an error of the input that names the file)."""

import json
import os
import random
import struct
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

CORNERS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
FACES = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]


def obj() -> bytes:
    lines = ["mtllib none.mtl", "usemtl red", *("v %g %g %g" % p for p in CORNERS), "vt 0.5 0.5", "vn 0 0 1"]
    return "\n".join([*lines, *("f " + " ".join(f"{k + 1}/1/1" for k in face) for face in FACES), ""]).encode()


def ply(binary: bool) -> bytes:
    head = f"ply\nformat {'binary_little_endian' if binary else 'ascii'} 1.0\nelement vertex 4\nproperty float x\n"
    head += "property float y\nproperty float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
    if not binary:
        return (head + "".join("%g %g %g\n" % p for p in CORNERS) + "".join("3 %d %d %d\n" % f for f in FACES)).encode()
    body = b"".join(struct.pack("<3f", *p) for p in CORNERS) + b"".join(struct.pack("<B3i", 3, *f) for f in FACES)
    return head.encode() + body


def stl(binary: bool) -> bytes:
    if binary:
        triangles = (struct.pack("<3f", 0, 0, 1) + b"".join(struct.pack("<3f", *CORNERS[k]) for k in f) + b"\0\0" for f in FACES)
        return b"\0" * 80 + struct.pack("<I", len(FACES)) + b"".join(triangles)
    facets = (
        "facet normal 0 0 1\nouter loop\n" + "".join("vertex %g %g %g\n" % CORNERS[k] for k in f) + "endloop\nendfacet\n"
        for f in FACES
    )
    return ("solid x\n" + "".join(facets) + "endsolid x\n").encode()


def gltf(inside: bool) -> bytes:
    body = b"".join(struct.pack("<3f", *p) for p in CORNERS) + b"".join(struct.pack("<3H", *f) for f in FACES)
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "scale": [2, 2, 2]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
            {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"},
        ],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
        "buffers": [{"byteLength": 72} if inside else {"byteLength": 72, "uri": "../../../../etc/passwd"}],
    }
    text = json.dumps(document).encode()
    if not inside:
        return text
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(body), b"BIN\0") + body
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


MODELS = {
    "a.obj": obj(),
    "a.ply": ply(False),
    "b.ply": ply(True),
    "a.stl": stl(False),
    "b.stl": stl(True),
    "a.glb": gltf(True),
    "a.gltf": gltf(False),
}
NUMBERS = [b"\xff\xff\xff\xff", b"\xff\xff\xff\x7f", b"\0\0\0\0", b"\0\0\xc0\x7f", b"4294967295", b"-1", b"nan", b"1e39", b"inf"]


def mutant(model: bytes, draw: random.Random) -> bytes:
    out = bytearray(model)
    for _ in range(draw.choice((1, 1, 2, 4, 16))):
        at, kind = draw.randrange(len(out) + 1), draw.randrange(5)
        if kind == 0 and at < len(out):
            out[at] = draw.randrange(256)
        elif kind == 1:
            del out[at : at + draw.choice((1, 4, 50))]
        elif kind == 2:
            out[at:at] = out[at : at + draw.choice((1, 12, 100))]
        elif kind == 3:
            number = draw.choice(NUMBERS)
            out[at : at + len(number)] = number
        else:
            del out[at:]
        out = out or bytearray(b"\0")
    return bytes(out)


def imported(program: str, seed: int, k: int) -> tuple[int, bool]:
    """Returns the exit code for mutant k, and whether the importer died."""
    draw = random.Random(seed * 1000003 + k)
    name = draw.choice(list(MODELS))
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, name), "wb") as file:
            file.write(mutant(MODELS[name], draw))
        # Some claim 4294967295 vertices, and assimp believes them.
        words = [program, "import", name, "--out", "a.mesh", "--timeout", "1", "--memory", "256"]
        ended = subprocess.run(words, capture_output=True, text=True, errors="replace", cwd=folder)
    if ended.returncode not in (0, 2) or (ended.returncode == 2 and name not in ended.stderr):
        raise RuntimeError(f"mutant {k} of seed {seed} ({name}): exit {ended.returncode}\n{ended.stderr}")
    return ended.returncode, "the importer ended with" in ended.stderr


def main() -> None:
    program, count, seed = os.path.abspath(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3]) if len(sys.argv) > 3 else 1
    with ThreadPoolExecutor(2 * (os.cpu_count() or 1)) as pool:
        try:
            ends = list(pool.map(lambda k: imported(program, seed, k), range(count)))
        except RuntimeError as error:
            pool.shutdown(cancel_futures=True)
            sys.exit(str(error))
    good, dead = sum(code == 0 for code, _ in ends), sum(died for _, died in ends)
    print(f"{count} models: {good} imported, {count - good} refused, the importer died of {dead}")


if __name__ == "__main__":
    main()
