"""Makes five scenes of triangle meshes, with their experiments, in a folder, with NumPy and crescent.scenes.

    make.py FOLDER [SCENE...] [--side N] [--size WIDTHxHEIGHT]

knot: a torus knot under a sunset sky; gear: a gear of brushed metal; terrain: 2 million triangles (2 N^2, N = 1000);
field: 1,000 instances of one plant; room: a room lit by emitting triangles. `crescent run FOLDER/knot.toml` runs one.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from crescent.scenes import write_mesh, write_sky

SUNSET = 256  # rows of the sky


def sunset() -> np.ndarray:
    """A gradient with a glow about a sun of 4 degrees, 12 degrees above the horizon towards (1, 0, 1)."""
    theta = np.pi * (np.arange(SUNSET) + 0.5)[:, None] / SUNSET
    phi = np.pi * (np.arange(2 * SUNSET) + 0.5)[None, :] / SUNSET
    w = np.stack(np.broadcast_arrays(np.sin(theta) * np.sin(phi), np.cos(theta), -np.sin(theta) * np.cos(phi)), -1)
    up = w[..., 1:2]
    sky = np.where(up > 0, 0.25 + 0.35 * (1 - np.abs(up)), 0.06) * np.array([0.9, 0.75, 0.8])
    height = np.radians(12)
    sun = np.array([np.cos(height) / np.sqrt(2), np.sin(height), np.cos(height) / np.sqrt(2)])
    angle = np.arccos(np.clip(w @ sun, -1, 1))[..., None]
    return sky + np.array([9, 5, 2.5]) * np.exp(-((angle / 0.25) ** 2)) + np.array([600, 380, 180]) * (angle < np.radians(2))


def grid(columns: int, rows: int, around: bool = True, closed: bool = True) -> np.ndarray:
    """Triangles of a grid of columns x rows points; joined around in columns, and closed in rows."""
    i, j = np.meshgrid(np.arange(columns if around else columns - 1), np.arange(rows if closed else rows - 1), indexing="ij")
    at = lambda i, j: (i % columns) * rows + j % rows  # noqa: E731
    a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
    return np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])


def knot(columns: int, rows: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A (2, 3) torus knot, a tube of radius 0.3, with smooth normals."""
    t = 2 * np.pi * np.arange(columns) / columns
    curve = lambda t: np.stack(  # noqa: E731
        [(1.1 + 0.45 * np.cos(3 * t)) * np.cos(2 * t), 0.45 * np.sin(3 * t), (1.1 + 0.45 * np.cos(3 * t)) * np.sin(2 * t)], -1
    )
    unit = lambda v: v / np.linalg.norm(v, axis=-1, keepdims=True)  # noqa: E731
    along = unit(curve(t + 1e-4) - curve(t - 1e-4))
    side = unit(np.cross(along, [0, 1, 0]))
    up = np.cross(side, along)
    phi = 2 * np.pi * np.arange(rows) / rows
    normals = side[:, None] * np.cos(phi)[None, :, None] + up[:, None] * np.sin(phi)[None, :, None]
    positions = curve(t)[:, None] + 0.24 * normals
    return positions.reshape(-1, 3), grid(columns, rows)[:, ::-1], normals.reshape(-1, 3)


def gear(teeth: int = 24, steps: int = 8) -> tuple[np.ndarray, np.ndarray]:
    """A toothed ring with flat faces: points of its profile joined around."""
    angle = 2 * np.pi * np.arange(teeth * steps) / (teeth * steps)
    phase = (np.arange(teeth * steps) % steps) / steps
    outer = 1 + 0.16 * np.clip(1.6 - np.abs(phase - 0.5) * 6, 0, 1)
    rings = [(0.45, -0.12), (0.45, 0.12), (0.75, 0.12), (0.78, 0.2), (None, 0.2), (None, -0.2), (0.78, -0.2), (0.75, -0.12)]
    points = [
        np.stack([(outer if r is None else r) * np.cos(angle), np.full_like(angle, y), (outer if r is None else r) * np.sin(angle)], -1)
        for r, y in rings
    ]
    return np.stack(points, 1).reshape(-1, 3), grid(len(angle), len(rings))


def terrain(side: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A field of hills of 2 km: sines of eight octaves in directions of their own, with smooth normals."""
    x, z = np.meshgrid(np.linspace(-1000, 1000, side + 1), np.linspace(-1000, 1000, side + 1), indexing="ij")
    y, dx, dz = np.zeros_like(x), np.zeros_like(x), np.zeros_like(x)
    for k in range(8):
        f, turn = 2**k * 0.0035, 2.4 * k
        phase = f * (np.cos(turn) * x + np.sin(turn) * z) + k
        height = 60 / 1.9**k
        y += height * np.sin(phase)
        dx += height * f * np.cos(turn) * np.cos(phase)
        dz += height * f * np.sin(turn) * np.cos(phase)
    normals = np.stack([-dx, np.ones_like(dx), -dz], -1)
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    return np.stack([x, y, z], -1).reshape(-1, 3), grid(side + 1, side + 1, False, False)[:, ::-1], normals.reshape(-1, 3)


def plant(blades: int = 40) -> tuple[np.ndarray, np.ndarray]:
    """A tuft of bent blades, 0.5 m high."""
    random = np.random.default_rng(7)
    positions, triangles = [], []
    for _ in range(blades):
        turn, lean, height = random.uniform(0, 2 * np.pi), random.uniform(0.1, 0.5), random.uniform(0.3, 0.5)
        out, across = np.array([np.cos(turn), 0, np.sin(turn)]), np.array([-np.sin(turn), 0, np.cos(turn)])
        foot = random.uniform(0, 0.12) * out
        begin = len(positions)
        for k, width in enumerate((0.02, 0.016, 0.01)):
            at = foot + lean * height * (k / 3) ** 2 * out + np.array([0, height * k / 3, 0])
            positions += [at - width * across, at + width * across]
        positions.append(foot + lean * height * out + np.array([0, height, 0]))
        triangles += [[begin + a, begin + b, begin + c] for a, b, c in ((0, 1, 3), (0, 3, 2), (2, 3, 5), (2, 5, 4), (4, 5, 6))]
    return np.array(positions), np.array(triangles)


def box(low: tuple, high: tuple, inside: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """The 12 triangles of a box, their fronts outside or inside."""
    corner = np.array([[(low, high)[k >> a & 1][a] for a in range(3)] for k in range(8)], float)
    faces = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
    triangles = np.array([t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))])
    return corner, triangles[:, ::-1] if inside else triangles


def joined(*parts: tuple[np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    starts = np.cumsum([0] + [len(p) for p, _ in parts])
    return np.concatenate([p for p, _ in parts]), np.concatenate([t + s for (_, t), s in zip(parts, starts)])


ARMS = """
[arms.cosine]
[arms.ggx-vndf]
[arms.renderer]
"""
SKY_ARMS = """
[arms.sky]
"""


Regions = dict[str, tuple[float, float, float, float]]  # left, bottom, right, top, as shares of the image


def experiment(
    title: str, size: tuple[int, int], eye: list, target: list, vfov: float, regions: Regions, body: str
) -> str:
    width, height = size
    boxes = "".join(
        f"[regions.{name}]\nbox = {[int(a * width), int(b * height), int(c * width) - 1, int(d * height) - 1]}\n\n"
        for name, (a, b, c, d) in {"all": (0, 0, 1, 1), **regions}.items()
    )
    return f"""title = "{title}"
n = 16

[image]
width = {width}
height = {height}

[camera]
eye = {eye}
target = {target}
vfov_deg = {vfov}

{boxes}[plates.view]
kind = "gallery"

{body}"""


def make_knot(folder: Path, size: tuple[int, int], side: int) -> str:
    write_mesh(folder / "knot.mesh", *knot(6 * side // 5, side // 10))
    write_sky(folder / "sunset.exr", sunset())
    body = """[sky]
file = "sunset.exr"

[meshes.knot]
file = "knot.mesh"
translate = [0, 0.75, 0]
rho_d = [0.25, 0.08, 0.05]
rho_s = 0.5
brdf = "ggx"
alpha = 0.2

[shapes.ground]
kind = "plane"
point = [0, 0, 0]
normal = [0, 1, 0]
rho_d = [0.4, 0.38, 0.35]
occludes = true
"""
    regions: Regions = {"knot": (0.2, 0.2, 0.8, 0.72), "ground": (0, 0, 1, 0.15)}
    return experiment("A torus knot under a sunset sky", size, [2.4, 2.2, 4.2], [0, 0.65, 0], 40, regions, body + ARMS + SKY_ARMS)


def make_gear(folder: Path, size: tuple[int, int], side: int) -> str:
    write_mesh(folder / "gear.mesh", *gear())
    write_sky(folder / "haze.exr", np.full((4, 8, 3), [0.2, 0.22, 0.25]))
    body = """[sky]
file = "haze.exr"

[meshes.gear]
file = "gear.mesh"
rotate = [62, 0, 0]
rho_d = [0.02, 0.02, 0.02]
rho_s = [0.78, 0.77, 0.74]
brdf = "ggx"
alpha = 0.3

[disks.lamp]
center = [2, 3, 3]
normal = [-0.4264, -0.6396, -0.6396]
radius = 0.8
radiance = [12, 12, 11]

[arms.light-area]
"""
    regions: Regions = {"left": (0.2, 0.1, 0.5, 0.9), "right": (0.5, 0.1, 0.8, 0.9)}
    return experiment("A gear of brushed metal", size, [0, 0.8, 4.2], [0, 0, 0], 36, regions, body + ARMS)


def make_terrain(folder: Path, size: tuple[int, int], side: int) -> str:
    write_mesh(folder / "terrain.mesh", *terrain(side))
    write_sky(folder / "sunset.exr", sunset())
    body = """[sky]
file = "sunset.exr"

[meshes.terrain]
file = "terrain.mesh"
rho_d = [0.35, 0.32, 0.22]
"""
    regions: Regions = {"near": (0, 0, 1, 0.2), "far": (0, 0.35, 1, 0.55)}
    return experiment("A terrain", size, [-700, 320, -700], [100, -40, 200], 45, regions, body + ARMS + SKY_ARMS)


def make_field(folder: Path, size: tuple[int, int], side: int) -> str:
    write_mesh(folder / "plant.mesh", *plant())
    write_sky(folder / "sunset.exr", sunset())
    random = np.random.default_rng(3)
    places = "".join(
        f"[[meshes.plant.instances]]\ntranslate = [{x:.3f}, 0, {z:.3f}]\nrotate = [0, {turn:.1f}, 0]\nscale = {scale:.3f}\n"
        for x, z, turn, scale in zip(random.uniform(-6, 6, 1000), random.uniform(-6, 6, 1000), random.uniform(0, 360, 1000), random.uniform(0.7, 1.6, 1000))
    )
    body = f"""[sky]
file = "sunset.exr"

[shapes.ground]
kind = "plane"
point = [0, 0, 0]
normal = [0, 1, 0]
rho_d = [0.25, 0.2, 0.15]
occludes = true

[meshes.plant]
file = "plant.mesh"
rho_d = [0.12, 0.35, 0.08]

{places}"""
    regions: Regions = {"plants": (0.1, 0, 0.9, 0.5), "ground": (0, 0.72, 1, 0.8)}
    return experiment("A field of 1,000 plants", size, [0, 2.2, 8], [0, 0.2, 0], 40, regions, body + ARMS + SKY_ARMS)


def make_room(folder: Path, size: tuple[int, int], side: int) -> str:
    write_mesh(folder / "room.mesh", *box((-2, 0, -2), (2, 3, 6), inside=True))
    write_mesh(folder / "things.mesh", *joined(box((-1.3, 0, -1.2), (-0.4, 1.6, -0.3)), box((0.3, 0, -0.6), (1.2, 0.8, 0.3))))
    write_mesh(folder / "lamps.mesh", *joined(*(box((x - 0.25, 2.8, z - 0.25), (x + 0.25, 2.9, z + 0.25)) for x in (-1, 1) for z in (-1, 1))))
    body = """[meshes.room]
file = "room.mesh"
rho_d = [0.7, 0.68, 0.62]

[meshes.things]
file = "things.mesh"
rho_d = [0.3, 0.35, 0.5]
rho_s = 0.2
brdf = "ggx"
alpha = 0.25

[meshes.lamps]
file = "lamps.mesh"
rho_d = [0.5, 0.5, 0.5]
emission = [9, 8, 6.5]

[arms.light-triangle]
"""
    regions: Regions = {"things": (0.2, 0.3, 0.8, 0.7), "floor": (0, 0, 1, 0.2)}
    return experiment("A room lit by emitting triangles", size, [0, 1.5, 5.5], [0, 0.3, 0], 45, regions, body + ARMS)


SCENES = {"knot": make_knot, "gear": make_gear, "terrain": make_terrain, "field": make_field, "room": make_room}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("scene", nargs="*", default=list(SCENES), help=", ".join(SCENES))
    parser.add_argument("--side", type=int, default=1000, help="fineness: a terrain has 2 N^2 triangles")
    parser.add_argument("--size", default="640x400", help="pixels")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    size = tuple(int(side) for side in options.size.split("x"))
    for scene in options.scene:
        text = SCENES[scene](options.folder, size, options.side)
        (options.folder / f"{scene}.toml").write_text(text, encoding="utf-8")
        print(options.folder / f"{scene}.toml")


if __name__ == "__main__":
    main()
