"""Compares crescent's direct light of an image sky with that of Mitsuba 3 (`direct`, hidden emitters) on one scene:
diffuse balls, a metal ball and a floor. Mitsuba interpolates between texels, so it gets each texel enlarged; it draws all
over a pixel and crescent at its centre, so regions keep off edges. Usage: sky_peer.py CRESCENT SKY_IMAGE"""

import math
import subprocess
import sys

try:
    import mitsuba as mi
    import numpy as np
except ImportError:
    print("no Mitsuba 3 here: pip install mitsuba numpy")
    sys.exit(77)

WIDTH, HEIGHT, ENLARGED, SPP = 160, 60, 16, 4096
BALLS = {
    "red": ((-1.2, 0.5, 0.0), {"rho_d": [0.6, 0.2, 0.1]}),
    "metal": ((0.0, 0.5, 0.0), {"rho_d": [0, 0, 0], "rho_s": 0.7, "brdf": '"ggx"', "alpha": 0.3}),
    "blue": ((1.2, 0.5, 0.0), {"rho_d": [0.1, 0.2, 0.6]}),
}
REGIONS = {"red": (35, 22, 51, 41), "metal": (72, 22, 88, 41), "blue": (109, 22, 125, 41), "floor": (10, 0, 150, 4)}
EYE, TARGET, VFOV, TURN = (0, 0.8, 5), (0, 0.45, 0), 22, 40


def experiment() -> str:
    out = f'[image]\nwidth = {WIDTH}\nheight = {HEIGHT}\n[camera]\neye = {list(EYE)}\ntarget = {list(TARGET)}\n'
    out += f'vfov_deg = {VFOV}\n[sky]\nfile = "sky.exr"\nrotation = {TURN}\nscale = 1.5\n'
    for name, (center, material) in BALLS.items():
        out += f'[shapes.{name}]\nkind = "sphere"\ncenter = {list(center)}\nradius = 0.5\noccludes = true\n'
        out += "".join(f"{key} = {value}\n" for key, value in material.items())
    out += '[shapes.floor]\nkind = "plane"\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\nrho_d = [0.4, 0.4, 0.4]\n'
    out += "occludes = true\n"
    out += "[arms.sky]\nn = 16\n[reference]\nn = 1024\n"
    return out + "".join(f"[regions.{n}]\nbox = {list(box)}\n" for n, box in REGIONS.items())


def ball(center: tuple[float, float, float], material: dict) -> dict:
    bsdf = {"type": "diffuse", "reflectance": {"type": "rgb", "value": material["rho_d"]}}
    if "alpha" in material:
        bsdf = {"type": "roughconductor", "material": "none", "distribution": "ggx", "alpha": material["alpha"],
                "specular_reflectance": {"type": "rgb", "value": [material["rho_s"]] * 3}}  # fmt: skip
    return {"type": "sphere", "center": center, "radius": 0.5, "bsdf": bsdf}


def by_mitsuba(image: "np.ndarray") -> "np.ndarray":
    transform = mi.ScalarTransform4f
    large = np.repeat(np.repeat(image, ENLARGED, 0), ENLARGED, 1).astype(np.float32)
    scene = {
        "type": "scene",
        "integrator": {"type": "direct", "emitter_samples": 1, "bsdf_samples": 1, "hide_emitters": True},
        "sensor": {
            "type": "perspective", "fov": VFOV, "fov_axis": "y",
            "to_world": transform().look_at(origin=EYE, target=TARGET, up=(0, 1, 0)),
            "film": {"type": "hdrfilm", "width": WIDTH, "height": HEIGHT, "rfilter": {"type": "box"}},
            "sampler": {"type": "independent", "sample_count": SPP},
        },  # fmt: skip
        "sky": {"type": "envmap", "bitmap": mi.Bitmap(large), "scale": 1.5,
                "to_world": transform().rotate([0, 1, 0], TURN)},  # fmt: skip
        "floor": {
            "type": "rectangle", "to_world": transform().rotate([1, 0, 0], -90).scale(1e4),
            "bsdf": {"type": "diffuse", "reflectance": {"type": "rgb", "value": [0.4] * 3}},
        },  # fmt: skip
    }
    for name, (center, material) in BALLS.items():
        scene[name] = ball(center, material)
    return np.array(mi.render(mi.load_dict(scene), seed=3))[:, :, :3]


def main() -> int:
    crescent, sky = sys.argv[1:3]
    variants = [v for v in ("llvm_ad_rgb", "scalar_rgb") if v in mi.variants()]
    mi.set_variant(variants[-1])
    image = np.array(mi.Bitmap(sky).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False))
    with open("peer.toml", "w") as file:
        file.write(experiment())
    subprocess.run([crescent, "run", "peer.toml", "--quiet", "--only", "films", "--out", "peer"], check=True)
    film = mi.Bitmap("peer/films/reference.exr").split()
    planes = dict(film)
    own = np.array(planes["<root>"].convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False))
    theirs = by_mitsuba(image)
    bad = 0
    for name, (x0, y0, x1, y1) in REGIONS.items():
        box = np.s_[HEIGHT - 1 - y1 : HEIGHT - y0, x0 : x1 + 1]
        a, b = own[box].mean((0, 1)), theirs[box].mean((0, 1))
        off = float(np.max(np.abs(a / b - 1)))
        print(f"{name}: crescent {a}, Mitsuba {b}, off by {100 * off:.3f} %")
        bad += not (off < 5e-3 and math.isfinite(off))
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
