"""Diffuse lobes whose draws do not follow their density."""

import numpy as np
from parts import above, cosine, cosine_pdf, drawn_with, lambert, polar, unit

from crescent import Sampler
from crescent.field import Fault

COSINE = Sampler(lambda wo, u: cosine(u), lambda wo, wi: cosine_pdf(wi), lambert(), name="cosine")


def of(sample, pdf, u=2):
    return Sampler(drawn_with(sample, pdf), pdf, lambert(), name="cosine", u=u)


def twice_as_long(wo, u):
    r, phi = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1]
    return unit(np.stack([2 * r * np.cos(phi), 2 * r * np.sin(phi), np.sqrt(1 - u[:, 0])], -1))


def from_a_ball(wo, u):
    """n + a point in the unit ball, rather than on it."""
    point = np.cbrt(u[:, 2])[:, None] * polar(1 - 2 * u[:, 0], 2 * np.pi * u[:, 1])
    return unit(point + [0, 0, 1 + 1e-12])


def from_a_sphere(wo, u):
    return unit(polar(1 - 2 * u[:, 0], 2 * np.pi * u[:, 1]) + [0, 0, 1 + 1e-12])


def even_pdf(wo, wi):
    return above(wi, np.full(len(wi), 0.5 / np.pi))


def even(wo, u):
    return polar(u[:, 0], 2 * np.pi * u[:, 1])


FAULTS = [
    Fault(
        "x and y of the cosine warp doubled",
        "Ray Tracing: The Rest of Your Life",
        "https://github.com/RayTracing/TheRestOfYourLife/pull/8",
        "The coordinates on the disk are multiplied by 2 before they are projected to the hemisphere: directions "
        "cluster near the horizon, but p is cos / pi.",
        ("density",),
        of(twice_as_long, lambda wo, wi: cosine_pdf(wi)),
        COSINE,
    ),
    Fault(
        "a point in the ball instead of on the sphere",
        "Ray Tracing in One Weekend",
        "https://github.com/RayTracing/raytracing.github.io/issues/145",
        "n plus a random point in the unit ball is drawn, which is narrower than the cosine distribution; the point "
        "must be on the sphere.",
        ("density",),
        of(from_a_ball, lambda wo, wi: cosine_pdf(wi), u=3),
        of(from_a_sphere, lambda wo, wi: cosine_pdf(wi)),
    ),
    Fault(
        "a uniform pdf for cosine draws",
        "Ray Tracing: The Rest of Your Life",
        "https://github.com/RayTracing/raytracing.github.io/issues/933",
        "p was changed to 1 / (2 pi), but the draws remained proportional to the cosine.",
        ("density",),
        of(from_a_sphere, even_pdf),
        of(even, even_pdf),
    ),
]
