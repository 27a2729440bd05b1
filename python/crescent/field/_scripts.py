"""Scripts of a few lines that show a finding with only Mitsuba and NumPy, and their output."""

from __future__ import annotations

import contextlib
import io

from ._shipped import Shipped

_HEAD = """import mitsuba as mi, numpy as np; mi.set_variant("llvm_ad_rgb")
b, si, n = mi.load_dict({code}), mi.SurfaceInteraction3f(), 1 << 22
c, rng, si.sh_frame = mi.BSDFContext(), np.random.default_rng(1), mi.Frame3f(mi.Vector3f(0, 0, 1))
si.wi = mi.Vector3f({wo})
"""

_MASS = """w = np.float32(rng.normal(size=(3, n))); w /= np.linalg.norm(w, axis=0); u = np.float32(rng.random((3, n)))
bs, weight = b.sample(c, si, mi.Float(u[2]), mi.Point2f(u[:2])); lost = np.mean(np.all(np.array(weight) == 0, axis=0))
print("pdf integrates to", 4 * np.pi * np.mean(b.pdf(c, si, mi.Vector3f(w))), "and draws of weight 0 are", lost)"""

_CORNER = """bs, weight = b.sample(c, si, mi.Float([{u2}]), mi.Point2f([{u0}], [{u1}]))
print("pdf", bs.pdf, "direction", bs.wo)"""

_ALBEDO = """u = np.float32(rng.random((3, n))); bs, weight = b.sample(c, si, mi.Float(u[2]), mi.Point2f(u[:2]))
print("reflects", np.mean(np.array(weight), axis=1))"""


def script_for(it: Shipped, verdict: str, wo: tuple[float, float, float], u: tuple[float, float, float] | None) -> str:
    """Returns the script for one verdict at one w_o; u: the corner that it concerns."""
    body = _ALBEDO if verdict == "physics" else _CORNER.format(u0=u[0], u1=u[1], u2=u[2]) if u else _MASS
    return _HEAD.format(code=it.code(), wo=", ".join(f"{v:.6g}" for v in wo)) + body


def output_of(script: str) -> str:
    """Returns the output of the script."""
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        exec(script, {})
    return out.getvalue().strip()
