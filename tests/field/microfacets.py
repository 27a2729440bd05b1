"""Microfacets: Jacobians, shadowing, and the roles of directions."""

import numpy as np
from parts import (
    above,
    dot,
    drawn_with,
    ggx_d,
    ggx_f,
    ggx_g1,
    ggx_pdf,
    half,
    polar,
    reflect,
    sample_ggx_m,
    sample_ggx_visible,
    visible_pdf,
)

from crescent import Sampler
from crescent.field import Fault

ALPHA = 0.4


def visible(wo, u):
    return reflect(wo, sample_ggx_visible(wo, u, ALPHA))


def by_d(wo, u):
    return reflect(wo, sample_ggx_m(u, ALPHA))


def of(sample, pdf, f=ggx_f(ALPHA), name="ggx"):
    return Sampler(drawn_with(sample, pdf), pdf, f, name=name)


def without_g1(wo, wi):
    return above(wi, ggx_d(half(wo, wi), ALPHA) / (4 * wo[:, 2]))


def without_jacobian(wo, wi):
    m = half(wo, wi)
    return above(wi, ggx_d(m, ALPHA) * m[:, 2])


# GTR1, the clearcoat's: Burley 2012, "Physically Based Shading at Disney".
GLOSS = 0.25


def gtr1_d(m):
    a2 = GLOSS**2
    return np.where(m[:, 2] > 0, (a2 - 1) / (np.pi * np.log(a2) * (1 + (a2 - 1) * m[:, 2] ** 2)), 0.0)


def gtr1_cos2(u):
    a2 = GLOSS**2
    return (1 - a2 ** (1 - u[:, 0])) / (1 - a2)


def gtr1(wo, u):
    return reflect(wo, polar(np.sqrt(gtr1_cos2(u)), 2 * np.pi * u[:, 1]))


def gtr1_without_root(wo, u):
    """sin theta is 1 - cos^2 theta, and the vector is normalised afterwards."""
    cos2, phi = gtr1_cos2(u), 2 * np.pi * u[:, 1]
    sine = 1 - cos2
    m = np.stack([sine * np.cos(phi), sine * np.sin(phi), np.sqrt(cos2)], -1)
    return reflect(wo, m / np.linalg.norm(m, axis=1, keepdims=True))


def gtr1_pdf(wo, wi):
    m = half(wo, wi)
    return above(wi, gtr1_d(m) * m[:, 2] / (4 * np.maximum(dot(wo, m), 1e-12)))


def gtr1_f(wo, wi):
    up = (wo[:, 2] > 0) & (wi[:, 2] > 0)
    safe = np.where(up[:, None], wi, [0.0, 0.0, 1.0])
    shadow = ggx_g1(wo, 0.25) * ggx_g1(safe, 0.25)
    return np.where(up, 0.25 * gtr1_d(half(wo, safe)) * shadow / (4 * wo[:, 2] * safe[:, 2]), 0.0)


def exchanged(pdf):
    return lambda wo, wi: np.where(wi[:, 2] > 0, pdf(np.where(wi[:, 2:] > 0, wi, [0.0, 0.0, 1.0]), wo), 0.0)


def weight(divided):
    """sample() with its own weight: f cos / p, or f cos alone."""
    pdf, f = ggx_pdf(ALPHA), ggx_f(ALPHA)

    def sample(wo, u):
        wi = by_d(wo, u)
        p = pdf(wo, wi)
        value = f(wo, wi) * np.maximum(wi[:, 2], 0)
        return wi, p, value / np.where(p > 0, p, 1) if divided else value

    return Sampler(sample, pdf, f, name="ggx")


CLEARCOAT = of(gtr1, gtr1_pdf, gtr1_f, "clearcoat")

FAULTS = [
    Fault(
        "the density of visible normals without G1",
        "NVIDIA Donut",
        "https://github.com/NVIDIA-RTX/Donut/issues/23",
        "p lacks the factor G1 of the distribution of visible normals.",
        ("normalised",),
        of(visible, without_g1),
        of(visible, visible_pdf(ALPHA)),
    ),
    Fault(
        "no Jacobian from the half vector to w_i",
        "pbrt-v3 (DisneyClearcoat)",
        "https://github.com/mmp/pbrt-v3/pull/172",
        "The density of the half vector is returned instead of that of the direction: 1 / (4 (w_o.m)) is missing.",
        ("normalised", "density"),
        of(by_d, without_jacobian),
        of(by_d, ggx_pdf(ALPHA)),
    ),
    Fault(
        "missing square root in sin theta of the half vector",
        "NVISII",
        "https://github.com/owl-project/NVISII/issues/144",
        "sin theta is 1 - cos^2 theta instead of its square root; normalising the vector hides it.",
        ("density",),
        of(gtr1_without_root, gtr1_pdf, gtr1_f, "clearcoat"),
        CLEARCOAT,
    ),
    Fault(
        "w_o and w_i exchanged in pdf and f, not in sample",
        "pbrt-v4 (MeasuredBxDF)",
        "https://github.com/mmp/pbrt-v4/pull/215",
        "Visible normals are those seen from w_o in sample, but from w_i in pdf and f.",
        ("density",),
        Sampler(
            lambda wo, u: (visible(wo, u), visible_pdf(ALPHA)(wo, visible(wo, u))),
            exchanged(visible_pdf(ALPHA)),
            ggx_f(ALPHA),
            name="measured",
        ),
        of(visible, visible_pdf(ALPHA), name="measured"),
    ),
    Fault(
        "a weight that is not divided by the pdf",
        "Mitsuba 3, a user's plugin",
        "https://github.com/mitsuba-renderer/mitsuba3/issues/1011",
        "sample() returns f cos instead of f cos / p.",
        ("identity",),
        weight(False),
        weight(True),
    ),
]
