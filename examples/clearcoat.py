"""The clearcoat of Disney's BRDF (Burley 2012): GTR1 with Schlick's Fresnel term and Smith's G. Local frame, n = +z.

Its pdf has the fault that pbrt-v3 had until pull request 172; that of `fixed` has not.
"""

import numpy as np

GLOSS = 0.25
A2 = GLOSS**2


def half(wo, wi):
    h = wo + wi
    return h / np.maximum(np.linalg.norm(h, axis=-1, keepdims=True), 1e-30)


def gtr1(cos):
    return (A2 - 1) / (np.pi * np.log(A2) * (1 + (A2 - 1) * cos**2))


def smith(cos):
    return 2 * cos / (cos + np.sqrt(A2 + cos**2 - A2 * cos**2))


def sample(wo, u):
    cos = np.sqrt((1 - A2 ** (1 - u[:, 0])) / (1 - A2))
    sin, phi = np.sqrt(np.maximum(1 - cos**2, 0)), 2 * np.pi * u[:, 1]
    h = np.stack([sin * np.cos(phi), sin * np.sin(phi), cos], -1)
    wi = 2 * np.sum(wo * h, -1, keepdims=True) * h - wo
    return wi, pdf(wo, wi)


def pdf(wo, wi):
    h = half(wo, wi)
    return np.where(wi[:, 2] > 0, gtr1(h[:, 2]) * h[:, 2], 0)


def f(wo, wi):
    h, cos_o, cos_i = half(wo, wi), np.maximum(wo[:, 2], 1e-9), np.maximum(wi[:, 2], 1e-9)
    fresnel = 0.04 + 0.96 * (1 - np.sum(wo * h, -1)) ** 5
    return np.where(wi[:, 2] > 0, gtr1(h[:, 2]) * fresnel * smith(cos_o) * smith(cos_i) / (4 * cos_o * cos_i), 0)


class fixed:
    """With the Jacobian of the reflection, 1 / (4 w_o.h)."""

    f = staticmethod(f)

    @staticmethod
    def pdf(wo, wi):
        return pdf(wo, wi) / (4 * np.maximum(np.sum(wo * half(wo, wi), -1), 1e-30))

    @staticmethod
    def sample(wo, u):
        wi, _ = sample(wo, u)
        return wi, fixed.pdf(wo, wi)
