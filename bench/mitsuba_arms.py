"""The gallery in Mitsuba 3, its arms as a BSDF: mitsuba_arms.py FILE.toml N runs one round and prints one JSON line per
arm with seconds per film, the best of three.

Integrator `direct` without emitter sampling, N BSDF samples, one primary ray per pixel, emitters hidden from the
camera, variant llvm_ad_rgb: only the estimator of the arms. Compiling is not counted: the first film of each arm is
rendered before the clock starts.
"""
import json
import sys
import time
import tomllib

import drjit as dr
import mitsuba as mi

mi.set_variant("llvm_ad_rgb")
T = mi.ScalarTransform4f


class Arm(mi.BSDF):
    """f = rho_d/pi + rho_s (s+2)/(2 pi) (w.R)^s, sampled by one arm; weight 0 below the horizon."""

    def __init__(self, props):
        mi.BSDF.__init__(self, props)
        self.rho_d = mi.Color3f(props["rho_d"])
        self.rho_s = mi.Float(props["rho_s"])
        self.s = mi.Float(props["s"])
        self.arm = props["arm"]
        self.m_flags = mi.BSDFFlags.GlossyReflection | mi.BSDFFlags.FrontSide | mi.BSDFFlags.BackSide
        self.m_components = [self.m_flags]

    def f_cos(self, wo, wi):
        along = dr.maximum(dr.dot(mi.reflect(wo), wi), 0)
        lobe = self.rho_s * (self.s + 2) * dr.inv_two_pi * along**self.s
        return (self.rho_d * dr.inv_pi + lobe) * mi.Frame3f.cos_theta(wi)

    def density(self, wo, wi):
        if self.arm == "uniform":
            return mi.Float(dr.inv_two_pi)
        if self.arm == "cosine":
            return mi.Frame3f.cos_theta(wi) * dr.inv_pi
        along = dr.maximum(dr.dot(mi.reflect(wo), wi), 0)
        return (self.s + 1) * dr.inv_two_pi * along**self.s

    def draw(self, wo, u):
        if self.arm == "phong":
            cos = u.x ** (1 / (self.s + 1))
        else:
            cos = u.x if self.arm == "uniform" else dr.sqrt(u.x)
        sin = dr.safe_sqrt(1 - cos * cos)
        sin_phi, cos_phi = dr.sincos(2 * dr.pi * u.y)
        local = mi.Vector3f(sin * cos_phi, sin * sin_phi, cos)
        return mi.Frame3f(mi.reflect(wo)).to_world(local) if self.arm == "phong" else local

    def sample(self, ctx, si, sample1, sample2, active=True):
        bs = mi.BSDFSample3f()
        bs.wo = self.draw(si.wi, sample2)
        bs.pdf = self.density(si.wi, bs.wo)
        bs.eta = 1.0
        bs.sampled_type = mi.UInt32(+mi.BSDFFlags.GlossyReflection)
        bs.sampled_component = mi.UInt32(0)
        up = active & (mi.Frame3f.cos_theta(bs.wo) > 0) & (bs.pdf > 0)
        return bs, dr.select(up, self.f_cos(si.wi, bs.wo) / bs.pdf, 0)

    def eval(self, ctx, si, wo, active=True):
        return dr.select(active & (mi.Frame3f.cos_theta(wo) > 0), self.f_cos(si.wi, wo), 0)

    def pdf(self, ctx, si, wo, active=True):
        return dr.select(active & (mi.Frame3f.cos_theta(wo) > 0), self.density(si.wi, wo), 0)

    def eval_pdf(self, ctx, si, wo, active=True):
        return self.eval(ctx, si, wo, active), self.pdf(ctx, si, wo, active)

    def to_string(self):
        return f"Arm[{self.arm}]"


mi.register_bsdf("arm", lambda props: Arm(props))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def parallelogram(corner, u, v):
    """Returns a rectangle with a given corner and edges; its normal is u x v."""
    n = cross(u, v)
    size = sum(c * c for c in n) ** 0.5
    center = [c + (a + b) / 2 for c, a, b in zip(corner, u, v)]
    columns = [[a / 2 for a in u], [b / 2 for b in v], [c / size for c in n], center]
    rows = [[column[i] for column in columns] for i in range(3)] + [[0, 0, 0, 1]]
    return {"type": "rectangle", "to_world": T(rows)}


def facing(center, normal, radius):
    target = [c + n for c, n in zip(center, normal)]
    up = [1, 0, 0] if abs(normal[1]) > 0.9 else [0, 1, 0]
    return T().look_at(origin=center, target=target, up=up) @ T().scale(radius)


def geometry(shape):
    kind = shape["kind"]
    if kind == "sphere":
        return {"type": "sphere", "center": shape["center"], "radius": shape["radius"]}
    if kind == "box":
        half = [(b - a) / 2 for a, b in zip(shape["min"], shape["max"])]
        middle = [(a + b) / 2 for a, b in zip(shape["min"], shape["max"])]
        return {"type": "cube", "to_world": T().translate(middle) @ T().scale(half)}
    if kind == "plane":
        return {"type": "rectangle", "to_world": facing(shape["point"], shape["normal"], 100)}
    if kind == "disk":
        return {"type": "disk", "to_world": facing(shape["center"], shape["normal"], shape["radius"])}
    # A panel's recess is cut into the wall; here its back is directly before the wall, which costs the same rays.
    corner = shape["corner"] if kind == "quad" else [c + o for c, o in zip(shape["corner"], [0, 0, 1e-3])]
    return parallelogram(corner, shape["edge_u"], shape["edge_v"])


def load(experiment, arm, n):
    camera, image = experiment["camera"], experiment["image"]
    s = next(shape["s"] for shape in experiment["shapes"].values() if "s" in shape)
    scene = {
        "type": "scene",
        "integrator": {"type": "direct", "emitter_samples": 0, "bsdf_samples": n, "hide_emitters": True},
        "sensor": {
            "type": "perspective",
            "fov": camera["vfov_deg"],
            "fov_axis": "y",
            "to_world": T().look_at(origin=camera["eye"], target=camera["target"], up=camera["up"]),
            "film": {"type": "hdrfilm", "width": image["width"], "height": image["height"], "rfilter": {"type": "box"}},
            "sampler": {"type": "independent", "sample_count": 1},
        },
        "fill": {"type": "constant", "radiance": {"type": "rgb", "value": experiment["fill"]["radiance"]}},
    }
    for name, disk in experiment["disks"].items():
        emitter = {"type": "area", "radiance": {"type": "rgb", "value": disk["radiance"]}}
        to_world = facing(disk["center"], disk["normal"], disk["radius"])
        scene["disk_" + name] = {"type": "disk", "to_world": to_world, "emitter": emitter}
    for name, shape in experiment["shapes"].items():
        bsdf = {"type": "arm", "arm": arm, "rho_d": mi.ScalarColor3f(shape["rho_d"]), "rho_s": shape.get("rho_s", 0.0),
                "s": float(shape.get("s", s))}
        scene[name] = geometry(shape) | {"bsdf": bsdf}
    return mi.load_dict(scene)


def seconds_a_film(scene, repetitions=3):
    best = float("inf")
    for k in range(repetitions + 1):
        start = time.perf_counter()
        film = mi.render(scene, spp=1, seed=k)
        dr.eval(film)
        dr.sync_thread()
        if k > 0:
            best = min(best, time.perf_counter() - start)
    rgb = film.numpy().mean(axis=(0, 1))
    return best, float(0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2])


def main():
    with open(sys.argv[1], "rb") as file:
        experiment = tomllib.load(file)
    n = int(sys.argv[2])
    for name, plan in experiment["arms"].items():
        seconds, mean = seconds_a_film(load(experiment, plan.get("sampler", name), n))
        print(json.dumps({"arm": name, "seconds": seconds, "mean": mean, "version": mi.__version__}), flush=True)


if __name__ == "__main__":
    main()
