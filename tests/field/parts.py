"""Building blocks of the faults in this folder: warps, GGX, frames, the selection of a lobe. Local frame, n = +z."""

import numpy as np


def unit(v):
    return v / np.linalg.norm(v, axis=1, keepdims=True)


def polar(cos_theta, phi):
    """The direction with this cosine to n and this azimuth."""
    s = np.sqrt(np.maximum(0, 1 - cos_theta**2))
    return np.stack([s * np.cos(phi), s * np.sin(phi), cos_theta], -1)


def dot(a, b):
    return np.sum(a * b, axis=1)


def reflect(w, m):
    return 2 * dot(w, m)[:, None] * m - w


def cosine(u):
    """(wi, cos / pi)."""
    wi = polar(np.sqrt(1 - u[:, 0]), 2 * np.pi * u[:, 1])
    return wi, wi[:, 2] / np.pi


def cosine_pdf(wi):
    return np.maximum(wi[:, 2], 0) / np.pi


def lambert(rho=0.5):
    return lambda wo, wi: np.where((wo[:, 2] > 0) & (wi[:, 2] > 0), rho / np.pi, 0.0)


def ggx_d(m, alpha):
    """Walter et al. 2007, (33)."""
    return np.where(m[:, 2] > 0, alpha**2 / (np.pi * (m[:, 2] ** 2 * (alpha**2 - 1) + 1) ** 2), 0.0)


def ggx_g1(w, alpha):
    """Walter et al. 2007, (34)."""
    tan2 = (1 - w[:, 2] ** 2) / np.maximum(w[:, 2] ** 2, 1e-300)
    return 2 / (1 + np.sqrt(1 + alpha**2 * tan2))


def sample_ggx_m(u, alpha):
    """m with density D (m.n). Walter et al. 2007, (35) and (36)."""
    tan2 = alpha**2 * u[:, 0] / (1 - u[:, 0])
    return polar(1 / np.sqrt(1 + tan2), 2 * np.pi * u[:, 1])


def sample_ggx_visible(wo, u, alpha):
    """m with the density of visible normals. Heitz 2018, listing 3."""
    v = unit(wo * [alpha, alpha, 1])
    long = np.hypot(v[:, 0], v[:, 1])
    flat = long < 1e-12
    t1 = np.stack([np.where(flat, 1, -v[:, 1]), np.where(flat, 0, v[:, 0]), np.zeros(len(v))], -1)
    t1 /= np.where(flat, 1, long)[:, None]
    t2 = np.cross(v, t1)
    r, phi = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1]
    x, y = r * np.cos(phi), r * np.sin(phi)
    s = 0.5 * (1 + v[:, 2])
    y = (1 - s) * np.sqrt(np.maximum(0, 1 - x * x)) + s * y
    z = np.sqrt(np.maximum(0, 1 - x * x - y * y))
    m = x[:, None] * t1 + y[:, None] * t2 + z[:, None] * v
    return unit(np.stack([alpha * m[:, 0], alpha * m[:, 1], np.maximum(m[:, 2], 1e-12)], -1))


def half(wo, wi):
    """The half vector; n if wi is opposite to wo."""
    h = wo + wi
    size = np.linalg.norm(h, axis=1, keepdims=True)
    return np.where(size > 1e-12, h / np.where(size > 1e-12, size, 1), [0.0, 0.0, 1.0])


def ggx_f(alpha, rho=1.0):
    """rho D G1 G1 / (4 cos cos), without Fresnel."""

    def f(wo, wi):
        up = (wo[:, 2] > 0) & (wi[:, 2] > 0)
        safe = np.where(up[:, None], wi, [0.0, 0.0, 1.0])
        m = half(wo, safe)
        value = rho * ggx_d(m, alpha) * ggx_g1(wo, alpha) * ggx_g1(safe, alpha) / (4 * wo[:, 2] * safe[:, 2])
        return np.where(up, value, 0.0)

    return f


def above(wi, p):
    """No sample is returned below the horizon: p is 0 there."""
    return np.where(wi[:, 2] > 0, p, 0.0)


def ggx_pdf(alpha):
    """D (m.n) / (4 (wo.m)) over the upper hemisphere; directions reflected below it return no sample."""

    def pdf(wo, wi):
        m = half(wo, wi)
        return above(wi, ggx_d(m, alpha) * m[:, 2] / (4 * np.maximum(dot(wo, m), 1e-12)))

    return pdf


def visible_pdf(alpha):
    """D G1 / (4 cos theta_o) over the upper hemisphere."""

    def pdf(wo, wi):
        return above(wi, ggx_d(half(wo, wi), alpha) * ggx_g1(wo, alpha) / (4 * wo[:, 2]))

    return pdf


def drawn_with(sample, pdf):
    """sample(wo, u) -> wi, with the pdf of a function."""

    def both(wo, u):
        wi = sample(wo, u)
        return wi, pdf(wo, wi)

    return both
