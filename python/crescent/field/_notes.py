"""Why a verdict on a shipped plugin is not right, where that is understood. Sizes are the verdict's own, or printed
by a script; nothing here is a measurement."""

from __future__ import annotations

import re
from dataclasses import dataclass

from .._judgement import Verdict


@dataclass(frozen=True)
class Note:
    """What explains verdicts of some plugins."""

    plugins: str  #: a regular expression over the plugin and its parameters
    verdicts: str  #: over the verdict's name
    says: str  #: over its sentence
    kind: str  #: "bug", "no picture changes", "corner", "approximation", "single precision", "the model"
    because: str
    script: str = ""  #: that shows it, in place of one made for the verdict

    def covers(self, title: str, verdict: Verdict) -> bool:
        """Whether it explains this verdict of this plugin."""
        return all(
            re.search(pattern, text, re.S) is not None
            for pattern, text in ((self.plugins, title), (self.verdicts, verdict.name), (self.says, verdict.say))
        )


_FIBER = """import mitsuba as mi, numpy as np; mi.set_variant("llvm_ad_rgb")
z, phi = np.meshgrid((np.arange(2000) + 0.5) / 1000 - 1, (np.arange(2000) + 0.5) * np.pi / 1000)
xyz, pdf = (np.sqrt(1 - z * z) * np.cos(phi), np.sqrt(1 - z * z) * np.sin(phi), z), mi.warp.square_to_rough_fiber_pdf
w, wi, tangent = mi.Vector3f(*(np.float32(v.ravel()) for v in xyz)), mi.Vector3f(1, 0, 0), mi.Vector3f(0, 0, 1)
for kappa in (11.8, 20.0, 47.0):
    print(kappa, np.mean(pdf(w, wi, tangent, kappa)) * 4 * np.pi)"""

_TURNED = """import mitsuba as mi; mi.set_variant("llvm_ad_rgb")
normals, c, si = {"type": "rgb", "value": [0.6, 0.5, 0.95]}, mi.BSDFContext(), mi.SurfaceInteraction3f()
b = mi.load_dict({"type": "normalmap", "normalmap": normals, "bsdf": {"type": "diffuse"}})
w, x, y = [mi.Vector3f(0.6, 0, 0.8), mi.Vector3f(-0.6, 0, 0.8)], mi.Vector3f(1, 0, 0), mi.Vector3f(0, 1, 0)
si.dp_du, si.dp_dv, si.sh_frame = x, y, mi.Frame3f(x, y, mi.Vector3f(0, 0, 1))
for o, i in ((0, 1), (1, 0)): si.wi = w[o]; print("f", b.eval(c, si, w[i]) / w[i].z)"""

_SUN = """import drjit as dr, mitsuba as mi, numpy as np; mi.set_variant("llvm_ad_rgb")
u, e = mi.Point2f(np.float32(np.random.default_rng(1).random((2, 1 << 22)))), mi.load_dict({"type": "sunsky"})
ds, _ = e.sample_direction(dr.zeros(mi.SurfaceInteraction3f), u); d = np.array(ds.d)[:, np.array(ds.pdf) > 1000]
sun, q = mi.Vector3f(d.mean(axis=1, dtype=float).tolist()), 0.006 * mi.warp.square_to_uniform_disk_concentric(u)
ds.d = dr.normalize(mi.Frame3f(dr.normalize(sun)).to_world(mi.Vector3f(q.x, q.y, 1)))
p = e.pdf_direction(dr.zeros(mi.SurfaceInteraction3f), ds)
print("drawn in the sun", d.shape[1] / (1 << 22), "p integrates there to", np.mean(p) * np.pi * 0.006**2)"""

NOTES = [
    Note(
        "normalmap|bumpmap",
        "physics",
        "reciprocal",
        "the model",
        "The map turns the frame that the BSDF below it is asked in, and the cosine at w_i with it: f divided by the "
        "cosine at the surface's own normal is then not reciprocal, and 0 for one of two directions that change "
        "places where the other stands under one of the horizons. Every shading normal does so (Veach 1996); sample "
        "and pdf agree.",
        _TURNED,
    ),
    Note(
        "sunsky",
        "normalised|density|identity",
        "",
        "single precision",
        "The sun's disc is 1 - cos(0.268 deg) = 1.09e-5 deep, 183 steps of single precision: the cosine of its edge, "
        "which the density divides by, and the product that says whether w is in the disc are each off by up to "
        "half a step or more. So p over the disc is up to 0.6 % off, and a draw at its edge may not be in it. A disc "
        "of 5 degrees is right, and so is the sky alone.",
        _SUN,
    ),
    Note(
        "hair",
        "normalised|physics|mean|identity",
        "",
        "bug",
        "The longitudinal density needs log I0(x), which `log_i0` of include/mitsuba/core/warp.h takes for x above 12 "
        "as "
        "x + (log(1 / (2 pi x)) + 1 / (8 x)) / 2. The expansion is x + log(1 / (2 pi x)) / 2 + 1 / (8 x) + ...: its "
        "last term "
        "stands inside the half. Below 12 the series ends too early. So the density is too small, by 1 / (16 x) where "
        "x is "
        "large, and f with it, which loses that much energy; weights are not touched, since both share the error. "
        "Moving the "
        "term out of the half mends it; `LogI0` of pbrt-v4 has the same. The script integrates the density of one "
        "fibre lobe, which should come to 1.",
        _FIBER,
    ),
    Note(
        "",
        "valid",
        "at u = .*corners of u",
        "corner",
        "Where a random number is exactly 0 or next to 1 the distribution of normals divides by zero: pdf or "
        "direction is "
        "no number. A generator of 24 bits comes upon such numbers as seldom as the verdict says.",
    ),
    Note(
        "roughplastic",
        "normalised|density",
        "",
        "no picture changes",
        "pdf() answers under the surface too, with the lobe's density there, of which sample() draws less than that; "
        "eval() "
        "is 0 there, so no picture changes. Beside it p is right above the surface.",
    ),
    Note(
        "^principled:(?!.*spec_trans)",
        "normalised|density|support|identity",
        "nothing|Fewer than two bins",
        "no picture changes",
        "For w_o under an opaque surface pdf() gives the density of lobes that sample() does not draw from; eval() is "
        "0 "
        "there, so no picture changes.",
    ),
    Note(
        "beckmann",
        "normalised|density|identity|physics|mean",
        "",
        "approximation",
        "G1 of Beckmann's distribution is the rational fit of Walter et al. 2007, whose stated relative error is 0.35 "
        "%; as "
        "visible normals are drawn with the exact one, p is off by the fit's error.",
    ),
    Note(
        "roughdielectric|principled.*spec_trans",
        "identity",
        "pdf that came with the draw and pdf\\(w\\) differ",
        "single precision",
        "The half vector of a refraction is computed anew from two directions of single precision, and near the "
        "critical "
        "angle and the horizon most of its digits cancel.",
    ),
    Note(
        "cylinder",
        "identity|normalised|density",
        "",
        "single precision",
        "pdf(w) is found by sending a ray back; where it grazes the cylinder the cosine there is lost to the rounding "
        "of the "
        "direction and of the intersection, and p divides by it. The ratio of both is 1 in the middle of the lamp.",
    ),
    Note(
        "principled.*sheen",
        "physics",
        "creates energy",
        "the model",
        "Disney's sheen is added on top of the other lobes and takes nothing from them: at grazing w_o more leaves the "
        "surface than arrives. The model is written so.",
    ),
]


def note_on(title: str, verdict: Verdict) -> Note | None:
    """The first note that explains the verdict; None: a bug, or not understood."""
    return next((note for note in NOTES if note.covers(title, verdict)), None)
