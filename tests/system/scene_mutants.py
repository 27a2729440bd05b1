"""Damaged files of a scene: models to import, .mesh files, skies and textures. crescent-import may die of one, and the
program must not, nor take memory that the file does not need.

    scene_mutants.py CRESCENT COUNT [SEED [IMAGE.exr...]]

Each of COUNT files is a small OBJ, PLY, STL, glTF, GLB, .mesh or OpenEXR file, or one of these IMAGEs, with some bytes
changed, removed, doubled or replaced by large numbers. Exit 1: an exit code other than 0 (it is good) and 2 (an error of
the input that names the file or its table), or more than 96 MB for an experiment of 16 pixels."""

import json
import os
import random
import struct
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import sky_image

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
EXPERIMENT = """n = 1
image = {width = 4, height = 4}
camera = {eye = [0, 2, 2], target = [0, 0, 0], vfov_deg = 30}
sky = {file = "sky.exr"}
reference = {n = 1}
[meshes.a]
file = "a.mesh"
rho_d = [0.5, 0.5, 0.5]
rho_s = 0.1
brdf = "ggx"
alpha = 1
rho_d_texture = "colour.exr"
alpha_texture = "rough.exr"
[arms.cosine]
[arms.sky]
"""
LARGEST = 96 << 10  # KiB in use


def mesh() -> bytes:
    corners = b"".join(struct.pack("<3f", *p) for p in CORNERS)
    normals, uv = struct.pack("<12f", *(4 * (0.0, 1.0, 0.0))), struct.pack("<8f", 0, 0, 1, 0, 0, 1, 1, 1)
    triangles = b"".join(struct.pack("<3I", *f) for f in FACES)
    head = struct.pack("<8s6IQ", b"crescent", 0x6873656D, 1, len(CORNERS), len(FACES), 3, 0, 0)
    return head + corners + normals + uv + triangles


def image(width: int, height: int, rule: str) -> bytes:
    with tempfile.NamedTemporaryFile(suffix=".exr") as file:
        sky_image.write(file.name, width, height, {"": sky_image.texels(width, height, rule)})
        return Path(file.name).read_bytes()


SCENE = {
    "a.mesh": mesh(),
    "sky.exr": image(8, 4, "(1, 1 + up, 2)"),
    "colour.exr": image(5, 3, "(0.1 * x, 0.5, 0.3 * y)"),
    "rough.exr": image(2, 2, "(0.5, 0.5, 0.5)"),
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


def ended(words: list[str], folder: str) -> tuple[int, str, int]:
    """Returns the exit code, what it said, and its largest memory in KiB."""
    with tempfile.TemporaryFile() as said:
        process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=said, cwd=folder)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        said.seek(0)
        return process.returncode, said.read().decode(errors="replace"), usage.ru_maxrss


def tried(program: str, seed: int, k: int, images: list[bytes]) -> tuple[int, bool]:
    """Returns the exit code for mutant k, and whether the importer died."""
    draw = random.Random(seed * 1000003 + k)
    name = draw.choice([*MODELS, *SCENE])
    with tempfile.TemporaryDirectory() as folder:
        files = {name: mutant(MODELS[name], draw)} if name in MODELS else dict(SCENE)
        if name in SCENE:
            own = [SCENE[name], *images] if name.endswith(".exr") else [SCENE[name]]
            files |= {name: mutant(draw.choice(own), draw), "a.toml": EXPERIMENT.encode()}
        for file, data in files.items():
            Path(folder, file).write_bytes(data)
        # Some claim 4294967295 vertices.
        words = ["import", name, "--out", "a.mesh", "--timeout", "1", "--memory", "256"]
        if name in SCENE:
            words = ["run", "a.toml", "--quiet", "--only", "metrics", "--threads", "1", "--out", "out"]
        code, said, memory = ended([program, *words], folder)
    located = name in said or "meshes.a:" in said
    if code not in (0, 2) or (code == 2 and not located) or (name in SCENE and memory > LARGEST):
        raise RuntimeError(f"mutant {k} of seed {seed} ({name}): exit {code}, {memory} KiB\n{said}")
    return code, "the importer ended with" in said


def main() -> None:
    program, count, seed = os.path.abspath(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3]) if len(sys.argv) > 3 else 1
    images = [Path(file).read_bytes() for file in sys.argv[4:]]
    with ThreadPoolExecutor(2 * (os.cpu_count() or 1)) as pool:
        try:
            ends = list(pool.map(lambda k: tried(program, seed, k, images), range(count)))
        except RuntimeError as error:
            pool.shutdown(cancel_futures=True)
            sys.exit(str(error))
    good, dead = sum(code == 0 for code, _ in ends), sum(died for _, died in ends)
    print(f"{count} files: {good} read, {count - good} refused, the importer died of {dead}")


if __name__ == "__main__":
    main()
