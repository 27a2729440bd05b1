"""Faults of shaders, in GLSL, HLSL and WGSL. A sampler is compiled when it is first checked."""

from pathlib import Path

import crescent
from crescent.field import Fault

HERE = Path(__file__).resolve().parent / "shaders"


def compiled(file, define=None, **words):
    """A callable that returns the sampler in a file of this folder."""
    return lambda: crescent.shader(HERE / file, define=define, **words)


def both(file, **words):
    """The faulty sampler and the fixed one, by the macro FIXED."""
    return compiled(file, **words), compiled(file, {"FIXED": 1}, **words)


VISIBLE = {
    "sample": "wi = sample_visible(wo, u, alpha)",
    "pdf": "pdf_visible(wo, wi, alpha)",
    "set": {"alpha": 0.4},
}
SKY = {
    "domain": "sphere",
    "sides": "none",
    "sample": "wi = sample_sky(u)",
    "pdf": "pdf_sky(wi)",
}

FAULTS = [
    Fault(
        "HLSL: the density of visible normals without G1",
        "NVIDIA Donut",
        "https://github.com/NVIDIA-RTX/Donut/issues/23",
        "p is D / (4 (w_o.m)) for draws of visible normals: G1 is missing and (w_o.m) does not cancel.",
        ("normalised",),
        *both("visible_normals.hlsl", **VISIBLE),
    ),
    Fault(
        "HLSL: lobes chosen by thresholds that are not cumulative",
        "Unity SS Path Tracing",
        "https://github.com/jiaozi158/UnitySSPathTracingURP/pull/8",
        "The probability of each lobe is compared with the same random number without adding the previous ones.",
        ("normalised",),
        *both(
            "visible_normals.hlsl",
            sample="wi = sample_lobes(wo, float3(u1, u2, u3), alpha, pdf)",
            pdf="pdf_lobes(wo, wi, alpha)",
            numbers=3,
            set={"alpha": 0.4},
        ),
    ),
    Fault(
        "GLSL: G1 of w_i in the density of visible normals",
        "IrrlichtBAW (Nabla)",
        "https://github.com/buildaworldnet/IrrlichtBAW/pull/524",
        "Normals visible from w_o are drawn, and the density has the masking of w_i.",
        ("normalised",),
        *both("lobes.glsl", **VISIBLE),
    ),
    Fault(
        "GLSL: lobe weight computed from different directions in pdf and sample",
        "three-gpu-pathtracer",
        "https://github.com/gkjohnson/three-gpu-pathtracer/issues/847",
        "The Fresnel share is computed at n when a lobe is chosen and at the half vector when the density is "
        "evaluated.",
        ("normalised", "density"),
        *both(
            "lobes.glsl",
            sample="wi = sample_lobes(wo, vec3(u1, u2, u3), alpha)",
            pdf="pdf_lobes(wo, wi, alpha)",
            numbers=3,
            set={"alpha": 0.4},
        ),
    ),
    Fault(
        "GLSL: a lens without the square root of the radius",
        "THREE.js-PathTracing-Renderer",
        "https://github.com/erichlof/THREE.js-PathTracing-Renderer/issues/36",
        "The radius on the aperture is u instead of its square root: points cluster in the middle.",
        ("density",),
        *both(
            "lens_and_sky.glsl",
            domain="disk",
            sample="x = sample_lens(u)",
            pdf="1.0 / Pi",
        ),
    ),
    Fault(
        "GLSL: the sky's pdf without sin theta",
        "Tauray",
        "https://github.com/vga-group/tauray/pull/5",
        "The density over the picture is not divided by sin theta: the poles are too dark.",
        ("normalised", "density"),
        compiled("lens_and_sky.glsl", {"WITHOUT_SINE": 1}, **SKY),
        compiled("lens_and_sky.glsl", **SKY),
    ),
    Fault(
        "GLSL: texels at the border that are never drawn",
        "three-gpu-pathtracer",
        "https://github.com/gkjohnson/three-gpu-pathtracer/issues/541",
        "The first and last texels are never sampled, but p is positive there.",
        ("density",),
        compiled("lens_and_sky.glsl", {"BORDERS_LEFT_OUT": 1}, **SKY),
        compiled("lens_and_sky.glsl", **SKY),
    ),
    Fault(
        "WGSL: area measure on one side of MIS",
        "Bevy (Solari)",
        "https://github.com/bevyengine/bevy/pull/24671",
        "The density of a point on the light is returned per area instead of per solid angle: cos / distance^2 is "
        "missing.",
        ("normalised", "density"),
        *both(
            "disk_light.wgsl",
            domain="sphere",
            sides="none",
            sample="wi = sample_disk(u);",
            pdf="pdf_disk(wi)",
        ),
    ),
]
