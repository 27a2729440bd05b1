#!/usr/bin/env python3
"""The five scenes of examples/scenes/make.py in crescent and in Mitsuba 3: do they agree, and how fast is each?

    bench/mitsuba_scenes.py FOLDER [SCENE...] [--samples N] [--seeds K] [--rounds R] [--side N] [--size WIDTHxHEIGHT]

Needs mitsuba, numpy and the Python package of crescent. Makes the scenes in FOLDER, renders K seeds of each with both
programs, and lets `crescent compare --expect same --smallest 0.5%` decide: by regions, tiles and pixels. Exit 1: they
differ, or too few samples. Mitsuba reads the same meshes, placements, materials, lights and sky: integrator `direct`,
hidden emitters. Two differences are removed: its rays go through the centres of pixels too, and its sky is enlarged by
nearest texel, because it interpolates.

R rounds of speed (0: none): in each, both make one film of N samples of every technique that the arm `renderer`
combines, one of the material and one of each kind of light, and one of a single sample, on all processors. The difference of the two counts, in processor time (user), so neither
loading, nor compiling, nor what is done once for a film: crescent traces the primary rays once, Mitsuba for each pixel
sample (it is slower if one is split into N emitter and BSDF samples). Table: seconds, the median over rounds; ratios,
the median and the range of those of a round; and the ratio of variances. Mitsuba reads the instances of a mesh as one
mesh, which is faster for it.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import statistics
import subprocess
import sys
import time
import tomllib
from pathlib import Path

import mitsuba as mi
import numpy as np

ROOT = Path(__file__).resolve().parent.parent
LARGEST_SKY = 4096  # columns of the enlarged image
FAR = 1e5  # half the side of the square that a plane becomes, m
ARM = "renderer"  # MIS of the material and each kind of light


def set_variant() -> None:
    mi.set_variant("llvm_ad_rgb", "scalar_rgb")

    class Centred(mi.Sensor):
        """A sensor whose rays go through the centres of pixels, as crescent's."""

        def __init__(self, props: mi.Properties) -> None:
            super().__init__(props)
            self.inner = props["inner"]

        def centre(self, position: mi.Point2f) -> mi.Point2f:
            size = mi.Vector2f(self.film().size())
            return (mi.Point2f(mi.Vector2i(position * size)) + 0.5) / size

        def sample_ray(self, time, wavelengths, position, aperture, active=True):  # type: ignore[no-untyped-def]
            return self.inner.sample_ray(time, wavelengths, self.centre(position), aperture, active)

        def sample_ray_differential(self, time, wavelengths, position, aperture, active=True):  # type: ignore[no-untyped-def]
            return self.inner.sample_ray_differential(time, wavelengths, self.centre(position), aperture, active)

    mi.register_sensor("centred", lambda props: Centred(props))


def colour(value: float | list[float]) -> dict:
    return {"type": "rgb", "value": value if isinstance(value, list) else [value] * 3}


def material(table: dict) -> dict:
    diffuse, gloss = np.array(table["rho_d"], float), np.broadcast_to(table.get("rho_s", 0.0), 3)
    share = float(gloss.max() / (gloss.max() + diffuse.max()))
    lambert = {"type": "diffuse", "reflectance": colour((diffuse / (1 - share)).tolist())}
    if share == 0:
        return {"type": "twosided", "below": lambert}
    lobe = {"type": "roughconductor", "material": "none", "distribution": table["brdf"], "alpha": table["alpha"],
            "specular_reflectance": colour((gloss / share).tolist())}  # fmt: skip
    return {"type": "twosided", "below": {"type": "blendbsdf", "weight": share, "first": lambert, "second": lobe}}


def placement(table: dict) -> mi.ScalarTransform4f:
    at = mi.ScalarTransform4f
    out = at().translate(table.get("translate", [0, 0, 0]))
    for axis in (2, 1, 0):
        out = out @ at().rotate([float(k == axis) for k in range(3)], table.get("rotate", [0, 0, 0])[axis])
    return out @ at().scale(table.get("scale", 1.0))


def write_ply(mesh: Path, placements: list[np.ndarray], ply: Path) -> bool:
    """Writes copies of a .mesh file as one PLY; returns whether it has smooth normals."""
    head = np.fromfile(mesh, "<u4", 10)
    vertices, triangles, flags = int(head[4]), int(head[5]), int(head[6])
    smooth, textured = bool(flags & 1), flags >> 1 & 1
    data = np.fromfile(mesh, "<f4", vertices * (3 + 3 * smooth), offset=40).reshape(-1, 3).astype(float)
    corners = np.fromfile(mesh, "<u4", 3 * triangles, offset=40 + 4 * vertices * (3 + 3 * smooth + 2 * textured))
    columns = [np.concatenate([data[:vertices] @ to[:3, :3].T + to[:3, 3] for to in placements])]
    if smooth:
        normals = np.concatenate([data[vertices:] @ np.linalg.inv(to[:3, :3]) for to in placements])
        columns.append(normals / np.linalg.norm(normals, axis=1, keepdims=True))
    faces = np.empty(triangles * len(placements), [("n", "u1"), ("corners", "<u4", 3)])
    faces["n"] = 3
    faces["corners"] = np.concatenate([corners.reshape(-1, 3) + k * vertices for k in range(len(placements))])
    with open(ply, "wb") as file:
        file.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {len(columns[0])}\n".encode())
        names = ("x", "y", "z", "nx", "ny", "nz")[: 3 * len(columns)]
        file.write("".join(f"property float {name}\n" for name in names).encode())
        file.write(f"element face {len(faces)}\nproperty list uchar uint vertex_indices\nend_header\n".encode())
        file.write(np.concatenate(columns, 1).astype("<f4").tobytes() + faces.tobytes())
    return smooth


def loaded_mesh(name: str, table: dict, to_camera: mi.ScalarTransform4f, folder: Path) -> dict:
    ply = folder / f"{name}.ply"
    placements = [to_camera @ placement(one) @ placement(table) for one in table.get("instances", [{}])]
    smooth = write_ply(folder / table["file"], [np.array(to.matrix) for to in placements], ply)
    shape = {"type": "ply", "filename": str(ply), "face_normals": not smooth, "bsdf": material(table)}
    if "emission" in table:
        shape["emitter"] = {"type": "area", "radiance": colour(table["emission"])}
    return shape


def facing(center: list, normal: list, size: float) -> mi.ScalarTransform4f:
    at = mi.ScalarTransform4f
    up = [1, 0, 0] if abs(normal[1]) > 0.9 else [0, 1, 0]
    target = [c + n for c, n in zip(center, normal)]
    return at().look_at(origin=center, target=target, up=up) @ at().scale(size)


def loaded_sky(table: dict, folder: Path) -> dict:
    image = np.array(mi.Bitmap(str(folder / table["file"])).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32))
    times = max(1, LARGEST_SKY // image.shape[1])
    return {
        "type": "envmap",
        "bitmap": mi.Bitmap(np.repeat(np.repeat(image, times, 0), times, 1)),
        "scale": table.get("scale", 1.0),
        "to_world": mi.ScalarTransform4f().rotate([0, 1, 0], table.get("rotation", 0.0)),
    }


def loaded(experiment: dict, folder: Path) -> dict:
    """The dictionary of the scene, without its integrator. The camera is at the origin, because Mitsuba moves the origins
    of rays by a share of their distance from there: 9 cm at 1 km."""
    camera, image = experiment["camera"], experiment["image"]
    to_camera = mi.ScalarTransform4f().translate([-x for x in camera["eye"]])
    film = {"type": "hdrfilm", "width": image["width"], "height": image["height"], "rfilter": {"type": "box"},
            "pixel_format": "rgb", "component_format": "float32"}  # fmt: skip
    look = to_camera @ mi.ScalarTransform4f().look_at(origin=camera["eye"], target=camera["target"], up=[0, 1, 0])
    pinhole = {"type": "perspective", "fov": camera["vfov_deg"], "fov_axis": "y", "to_world": look, "film": film}
    scene = {"type": "scene", "sensor": {"type": "centred", "inner": pinhole, "film": film}}
    for name, table in experiment.get("meshes", {}).items():
        scene[name] = loaded_mesh(name, table, to_camera, folder)
    for name, plane in experiment.get("shapes", {}).items():
        square = to_camera @ facing(plane["point"], plane["normal"], FAR)
        scene[name] = {"type": "rectangle", "to_world": square, "bsdf": material(plane)}
    for name, disk in experiment.get("disks", {}).items():
        light = {"type": "area", "radiance": colour(disk["radiance"])}
        circle = to_camera @ facing(disk["center"], disk["normal"], disk["radius"])
        scene[name] = {"type": "disk", "to_world": circle, "emitter": light}
    if "sky" in experiment:
        scene["sky"] = loaded_sky(experiment["sky"], folder)
    return scene


class Mitsuba:
    """A scene, rendered with the techniques of the arm `renderer`, n samples of each."""

    def __init__(self, experiment: dict, folder: Path) -> None:
        emits = any("emission" in mesh for mesh in experiment.get("meshes", {}).values())
        lights = ("sky" in experiment) + bool(experiment.get("disks")) + emits
        self.integrator = mi.load_dict({"type": "direct", "hide_emitters": True, "emitter_samples": lights,
                                        "bsdf_samples": 1})  # fmt: skip
        self.scene = mi.load_dict(loaded(experiment, folder))

    def render(self, n: int, seed: int) -> tuple[np.ndarray, float]:
        """Returns the film and its processor time."""
        start = time.process_time()
        film = np.array(mi.render(self.scene, integrator=self.integrator, spp=n, seed=seed))
        return film, time.process_time() - start


def crescent_film(program: str, experiment: Path, n: int, seed: int, out: Path) -> float:
    """Makes the film of the arm at `out`; returns the processor time of the run, with everything that precedes
    the film."""
    before = os.times().children_user
    run = out.with_suffix("")
    keys = [f"arms.{ARM}.n={n}", f"seed={seed}", "reference.n=1"]
    if "sky" in tomllib.loads(experiment.read_text()):
        keys.append("sky.visible=false")  # as Mitsuba's hidden emitters
    changes = [f"--set={key}" for key in keys]
    words = [program, "run", str(experiment), "--only", "films", "--quiet", "--out", str(run), *changes]
    subprocess.run(words, check=True, stdout=subprocess.DEVNULL)
    (run / "films" / f"{ARM}.exr").replace(out)
    return os.times().children_user - before


def compared(mitsuba: Mitsuba, name: str, options: argparse.Namespace) -> tuple[int, str]:
    """Lets `crescent compare` decide; returns its exit code and columns: each region, with the smallest difference that
    would have been found, the tiles, and the ratio of variances, Mitsuba's / crescent's."""
    file, films, out = (options.folder / part for part in (f"{name}.toml", "films", f"compared/{name}"))
    experiment = tomllib.loads(file.read_text())
    for old in films.glob(f"{name}-*.exr"):
        old.unlink()
    for seed in range(1, options.seeds + 1):
        crescent_film(options.crescent, file, options.samples, seed, films / f"{name}-crescent-{seed}.exr")
        image, _ = mitsuba.render(options.samples, seed)
        mi.Bitmap(image).write(str(films / f"{name}-mitsuba-{seed}.exr"))
    words = [options.crescent, "compare", "--expect", "same", "--smallest", options.smallest, "--quiet", "--out", str(out)]
    for arm in ("crescent", "mitsuba"):
        words += ["--arm", f"{arm}={films}/{name}-{arm}-*.exr"]
    for region, table in experiment["regions"].items():
        words += ["--region", f"{region}={','.join(map(str, table['box']))}"]
    done = subprocess.run(words, text=True, capture_output=True)
    if done.returncode != 0:
        print(done.stdout + done.stderr, file=sys.stderr)
    if done.returncode not in (0, 1, 4):
        sys.exit(done.returncode)
    metrics = json.loads((out / "metrics.json").read_text())
    found = metrics["bias"][0]
    variance = {arm["arm"]: arm["regions"]["frame"]["metrics"]["var"]["value"] for arm in metrics["arms"]}
    regions = [
        f"{region} {one['a'] / one['b'] - 1:+.2%} ({one['smallest']:.2%})"
        for region, one in found["regions"].items()
        if region != "frame"
    ]
    tiles = f"{found['tiles']['different']} of {found['tiles']['tested']}"
    return done.returncode, f"{', '.join(regions)} | {tiles} | {variance['mitsuba'] / variance['crescent']:.2f}"


def timed(mitsuba: Mitsuba, file: Path, options: argparse.Namespace) -> str:
    """Returns the columns of speed: seconds of processor time of N samples less those of one."""
    film = file.parent / "films" / "timed.exr"
    crescent = lambda n, seed: crescent_film(options.crescent, file, n, seed, film)  # noqa: E731
    most = options.samples
    for n in (most, 1):
        mitsuba.render(n, 0)  # compiles
    own, theirs = [], []
    for seed in range(1, options.rounds + 1):
        own.append(crescent(most, seed) - crescent(1, seed))
        theirs.append(mitsuba.render(most, seed)[1] - mitsuba.render(1, seed)[1])
    ratios = sorted(b / a for a, b in zip(own, theirs))
    medians = [statistics.median(times) for times in (own, theirs)]
    return f"{medians[0]:.2f} | {medians[1]:.2f} | {statistics.median(ratios):.1f} ({ratios[0]:.1f} to {ratios[-1]:.1f})"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("scene", nargs="*", default=["knot", "gear", "terrain", "field", "room"])
    parser.add_argument("--side", type=int, default=1000)
    parser.add_argument("--size", default="640x400")
    parser.add_argument("--samples", type=int, default=4, help="of each technique")
    parser.add_argument("--seeds", type=int, default=12, help="0: no comparison")
    parser.add_argument("--smallest", default="0.5%")
    parser.add_argument("--rounds", type=int, default=0, help="of speed")
    parser.add_argument("--crescent", default=str(ROOT / "build" / "crescent"))
    options = parser.parse_args()
    set_variant()
    make = [sys.executable, str(ROOT / "examples" / "scenes" / "make.py"), str(options.folder), *options.scene]
    subprocess.run([*make, "--side", str(options.side), "--size", options.size], check=True, stdout=subprocess.DEVNULL)
    films = options.folder / "films"
    films.mkdir(exist_ok=True)
    columns = ["Mitsuba / crescent - 1 of the mean, by region (what would be found)", "tiles that differ"]
    columns = columns + ["variance, Mitsuba / crescent"] if options.seeds else []
    columns += ["crescent, s", "Mitsuba, s", "time, Mitsuba / crescent"] if options.rounds else []
    print("| " + " | ".join(["scene", *columns]) + " |\n" + "|---" * (1 + len(columns)) + "|", flush=True)
    worst = 0
    for name in options.scene:
        file = options.folder / f"{name}.toml"
        file.write_text(re.sub(rf"\[arms\.(?!{ARM}\b)[\w-]+\]\n", "", file.read_text()))  # the other arms
        mitsuba, cells = Mitsuba(tomllib.loads(file.read_text()), options.folder), [name]
        if options.seeds:
            code, cell = compared(mitsuba, name, options)
            worst = max(worst, code)
            cells.append(cell)
        if options.rounds:
            cells.append(timed(mitsuba, file, options))
        print("| " + " | ".join(cells) + " |", flush=True)
    return worst


if __name__ == "__main__":
    sys.exit(main())
