"""Why a verdict on a shipped plugin is not right, if it is understood. Sizes are the verdict's own, or printed by a
script; nothing here is a measurement."""

from __future__ import annotations

import re
from dataclasses import dataclass

from .._result import Verdict


@dataclass(frozen=True)
class Note:
    """An explanation of verdicts on some plugins."""

    plugins: str  #: a regular expression over the plugin and its parameters
    verdicts: str  #: over the verdict's name
    states: tuple[str, ...]  #: what its sentences state, one of these; (): anything
    kind: str  #: "bug", "no picture changes", "corner", "approximation", "single precision", "the model"
    because: str
    script: str = ""  #: that shows it, instead of one made for the verdict
    report: str = ""  #: draft of a report to the project

    def covers(self, title: str, verdict: Verdict) -> bool:
        """Returns whether it explains this verdict of this plugin."""
        return (
            re.search(self.plugins, title) is not None
            and re.search(self.verdicts, verdict.name) is not None
            and (not self.states or any(verdict.states(what) for what in self.states))
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
        ("f(a, b) differs from f(b, a)",),
        "the model",
        "The map turns the frame in which the nested BSDF is evaluated, and with it the cosine at w_i. So f divided "
        "by the cosine at the surface's own normal is not reciprocal, and it is 0 for one of two exchanged "
        "directions if the other is below one of the horizons. Every shading normal has this effect (Veach 1996); "
        "sample and pdf agree.",
        _TURNED,
    ),
    Note(
        "sunsky",
        "normalised|density|identity",
        (),
        "single precision",
        "The sun's disc has a depth of 1 - cos(0.268 deg) = 1.09e-5, 183 steps of single precision. The cosine of "
        "its edge, by which the density is divided, and the product that decides whether w is in the disc may each "
        "be off by half a step or more. So p over the disc is up to 0.6 % off, and a draw at its edge may be "
        "outside. A disc of 5 degrees is right, and so is the sky without the sun.",
        _SUN,
    ),
    Note(
        "hair",
        "normalised|density|physics|mean|identity",
        (),
        "bug",
        "The longitudinal density needs log I0(x). For x above 12, `log_i0` of include/mitsuba/core/warp.h computes "
        "it as x + (log(1 / (2 pi x)) + 1 / (8 x)) / 2. The expansion is x + log(1 / (2 pi x)) / 2 + 1 / (8 x) + "
        "...: its last term is halved by mistake. Below 12 the series ends too early. So the density is too small, "
        "by 1 / (16 x) for large x, and so is f, which loses that much energy. Weights are not affected, since both "
        "have the same error. Moving the term out of the parentheses fixes it; `LogI0` of pbrt-v4 has the same "
        "fault. The script integrates the density of one fibre lobe; the expected result is 1.",
        _FIBER,
        "Symptom: the pdf of the hair BSDF with its default parameters integrates to 0.998, not to 1, and so does "
        "`square_to_rough_fiber_pdf`: 0.9966 at kappa 20, 0.9986 at 47. f has the same error, so hair loses that much "
        "light. Cause: for x above 12, `log_i0` of include/mitsuba/core/warp.h halves the term 1 / (8 x) of the expansion "
        "of log I0(x); below 12 its series ends too early. Fix: x + log(1 / (2 pi x)) / 2 + 1 / (8 x), and more terms.",
    ),
    Note(
        "",
        "valid",
        ("pdf is NaN", "The direction is NaN"),
        "corner",
        "If a random number is exactly 0 or next to 1, the distribution of normals divides by zero, and pdf or "
        "direction is NaN. A generator of 24 bits produces such numbers as rarely as the verdict states.",
    ),
    Note(
        "roughplastic",
        "normalised|density",
        (),
        "no picture changes",
        "pdf() is positive below the surface too, with the lobe's density there, and sample() draws less than that. "
        "eval() is 0 there, so no picture changes. Above the surface p is right.",
    ),
    Note(
        "^principled:(?!.*spec_trans)",
        "normalised|density|support|identity",
        ("no draw of p",),
        "no picture changes",
        "For w_o below an opaque surface pdf() returns the density of lobes that sample() does not draw from. "
        "eval() is 0 there, so no picture changes.",
    ),
    Note(
        "beckmann",
        "normalised|density|identity|physics|mean",
        (),
        "approximation",
        "G1 of Beckmann's distribution is the rational fit of Walter et al. 2007 with a stated relative error of "
        "0.35 %. Visible normals are drawn with the exact G1, so p is off by the error of the fit.",
    ),
    Note(
        "roughdielectric|principled.*spec_trans",
        "identity",
        ("The pdf with a draw is not pdf(w)",),
        "single precision",
        "The half vector of a refraction is recomputed from two directions in single precision. Near the critical "
        "angle and the horizon most of its digits cancel.",
    ),
    Note(
        "cylinder",
        "identity|normalised|density",
        (),
        "single precision",
        "pdf(w) is found by tracing a ray back. If the ray grazes the cylinder, rounding of the direction and of "
        "the intersection dominates the cosine, and p is divided by it. In the middle of the light the ratio of "
        "both is 1.",
    ),
    Note(
        "principled.*sheen",
        "physics",
        ("albedo",),
        "the model",
        "Disney's sheen is added to the other lobes without reducing them: at grazing w_o more light leaves the "
        "surface than arrives. The model defines it so.",
    ),
]


def note_on(title: str, verdict: Verdict) -> Note | None:
    """Returns the first note that explains the verdict; None: a bug, or not understood."""
    return next((note for note in NOTES if note.covers(title, verdict)), None)
