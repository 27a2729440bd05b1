"""Twelve more families of samplers of directions in NumPy, as those of fresh_pipe.py, which says how to use this file:
lights by area and by solid angle, skies, transformed cosines, both sides of a surface, resampling.

    python lights_and_lobes.py right --crescent build/crescent --seed 41 --cases 0:60 --out right.jsonl
"""

from __future__ import annotations

import numpy as np
from fresh_pipe import (
    PI,
    Array,
    Family,
    Rng,
    Sampler,
    alias_table,
    below_one,
    by_cosine,
    dot,
    frame,
    log_uniform,
    main,
    polar,
    random_direction,
    unit,
)

SPHERE = "domain=sphere wo=none"


def balls_by_area(rng: Rng, real: type, fault: str) -> Sampler:
    """One to four spheres by area; points that face away are no samples."""
    n = int(rng.integers(1, 5))
    radius = np.exp(rng.uniform(np.log(0.05), 0, n))
    distance = radius * np.exp(rng.uniform(np.log(1.15), np.log(8), n))
    centre = np.array([random_direction(rng) for _ in range(n)]) * distance[:, None]
    p = rng.dirichlet(np.full(n, 2.0))
    cdf = np.cumsum(p).astype(real)
    area = 4 * PI * radius**2

    def pdf(wo: Array, w: Array) -> Array:
        total, d = np.zeros(len(w)), w.astype(float)
        for k in range(n):
            along = d @ centre[k]
            across = centre[k] - along[:, None] * d
            half2 = radius[k] ** 2 - dot(across, across)
            half = np.sqrt(np.maximum(half2, 1e-300))
            t = along - half
            cos = 1 if fault == "missing cosine" else half / radius[k]
            jacobian = (t if fault == "missing square" else t * t) / cos
            total += np.where((half2 > 0) & (along > 0), p[k] / area[k] * jacobian, 0)
        return total.astype(real)

    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        k = np.minimum(np.searchsorted(cdf, u[:, 0], side="right"), n - 1)
        normal = polar(1 - 2 * u[:, 1], u[:, 2])
        x = centre.astype(real)[k] + radius.astype(real)[k, None] * normal
        w = unit(x)
        return w, np.where(dot(x, normal) < 0, pdf(wo, w), 0)

    return Sampler(SPHERE, 3, sample, pdf, None, f"n={n} radius={radius.round(3)}")


def tube(rng: Rng, real: type, fault: str) -> Sampler:
    """A cylinder without caps by area, from outside."""
    length, radius = log_uniform(rng, 0.2, 3), log_uniform(rng, 0.02, 0.5)
    turn = frame(random_direction(rng))
    centre = random_direction(rng) * (radius + length / 2 + log_uniform(rng, 0.3, 3))
    origin = -turn @ centre
    area = 2 * PI * radius * length

    def pdf(wo: Array, w: Array) -> Array:
        d = w.astype(float) @ turn.T
        a = d[:, 0] ** 2 + d[:, 1] ** 2
        b = origin[0] * d[:, 0] + origin[1] * d[:, 1]
        root2 = b * b - a * (origin[0] ** 2 + origin[1] ** 2 - radius**2)
        root = np.sqrt(np.maximum(root2, 1e-300))
        t = (-b - root) / np.maximum(a, 1e-300)
        hit = (root2 > 0) & (t > 0) & (np.abs(origin[2] + t * d[:, 2]) <= length / 2)
        jacobian = 1 if fault == "missing Jacobian" else t * t * radius / root
        return np.where(hit, jacobian / area, 0).astype(real)

    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        phi = 2 * PI * u[:, 0].astype(float)
        z = length * (u[:, 1].astype(float) - 0.5) * (0.9 if fault == "ends not reached" else 1)
        normal = np.stack([np.cos(phi), np.sin(phi), np.zeros_like(phi)], -1)
        x = (radius * normal + z[:, None] * np.array([0, 0, 1.0])) @ turn + centre
        w = unit(x).astype(real)
        return w, np.where(dot(x, normal @ turn) < 0, pdf(wo, w), 0)

    return Sampler(SPHERE, 2, sample, pdf, None, f"length={length:.3g} radius={radius:.3g}")


def transformed_cosine(rng: Rng, real: type, fault: str) -> Sampler:
    """A linear transform of the cosine (Heitz et al. 2016)."""
    m = np.diag(np.exp(rng.uniform(np.log(0.05), np.log(1.5), 3))) + np.triu(rng.normal(size=(3, 3)) * 0.3, 1)
    m[2, 0] = rng.normal() * 0.3
    if np.linalg.det(m) < 0:
        m[:, 0] *= -1
    inverse, det = np.linalg.inv(m), np.linalg.det(m)

    def pdf(wo: Array, w: Array) -> Array:
        v = w.astype(float) @ inverse.T
        length2 = dot(v, v)
        power = 1.5 if fault == "wrong power" else 2
        return (np.maximum(v[:, 2], 0) / (PI * det * length2**power)).astype(real)

    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        w = by_cosine(u[:, 0], u[:, 1]).astype(float) @ (m if fault == "transposed" else m.T)
        w = unit(w).astype(real)
        return w, pdf(wo, w)

    return Sampler(SPHERE, 2, sample, pdf, None, f"m={m.round(3).tolist()}")


def bilinear(rng: Rng, real: type, fault: str) -> Sampler:
    """Bilinear over the cosine and the azimuth (Pharr et al. 2023, A.5.4)."""
    corner = rng.gamma(1.0, size=4) + 0.01
    a, b, c, d = corner / corner.mean()

    def value(x: Array, y: Array) -> Array:
        return (1 - x) * (1 - y) * a + x * (1 - y) * b + (1 - x) * y * c + x * y * d

    def linear(u: Array, low: Array, high: Array) -> Array:
        return u * (low + high) / (low + np.sqrt((1 - u) * low * low + u * high * high))

    def pdf(wo: Array, w: Array) -> Array:
        x, y = np.arctan2(w[:, 1], w[:, 0]).astype(float) / (2 * PI) % 1, w[:, 2].astype(float)
        if fault == "axes exchanged":
            x, y = y, x
        return np.where(w[:, 2] > 0, value(x, y) / (2 * PI), 0).astype(real)

    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        v = u.astype(float)
        y = linear(v[:, 1], a + b, c + d)
        x = v[:, 0] if fault == "even rows" else linear(v[:, 0], (1 - y) * a + y * c, (1 - y) * b + y * d)
        w = polar(np.clip(y, 1e-9, 1), np.clip(x, 1e-6, 1 - 1e-6)).astype(real)
        return w, pdf(wo, w)

    return Sampler("wo=none", 2, sample, pdf, None, f"corners={corner.round(3)}")


def alias_sky(rng: Rng, real: type, fault: str) -> Sampler:
    """A whole sky in latitude and longitude with up to three suns, by one alias table of its texels."""
    rows = int(rng.integers(4, 33))
    columns, texels = 2 * rows, 2 * rows * rows
    z = np.cos(PI * np.arange(rows + 1) / rows)
    size = (z[:-1] - z[1:]) * 2 * PI / columns  # sr
    radiance = rng.gamma(log_uniform(rng, 0.3, 3), size=(rows, columns)) + 1e-3
    for _ in range(int(rng.integers(0, 4))):
        radiance[rng.integers(rows), rng.integers(columns)] *= log_uniform(rng, 10, 3000)
    mass = radiance * size[:, None]
    value = (radiance / mass.sum()).astype(real)
    chosen = radiance if fault == "sine left out" else mass
    keep, other = alias_table((chosen / chosen.sum()).ravel())
    if fault == "wrong alias entry":
        other[np.argmin(keep)] = np.argmin(keep)
    z = z.astype(real)

    def pdf(wo: Array, w: Array) -> Array:
        j = np.clip(np.searchsorted(-z, -w[:, 2], side="right") - 1, 0, rows - 1)
        i = np.minimum((np.arctan2(w[:, 1], w[:, 0]) / real(2 * PI) % 1 * columns).astype(int), columns - 1)
        return value[j, i]

    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        x = u[:, 0].astype(float) * texels
        k = np.minimum(x.astype(int), texels - 1)
        k = np.where(x - k < keep[k], k, other[k])
        j, i = k // columns, k % columns
        y, v = (np.clip(u[:, axis], 1e-4, 1 - 1e-4) for axis in (1, 2))
        w = polar(z[j] + (z[j + 1] - z[j]) * y, (i + v) / real(columns)).astype(real)
        return w, value[j, i]

    return Sampler(SPHERE, 3, sample, pdf, None, f"{rows} x {columns}")


def wrapped_azimuth(rng: Rng, real: type, fault: str) -> Sampler:
    """The cosine by Kumaraswamy's distribution, the azimuth by a wrapped Cauchy about that of w_o."""
    a, b = log_uniform(rng, 0.6, 6), log_uniform(rng, 0.6, 6)
    rho = rng.uniform(0, 0.9)

    def azimuth(w: Array) -> Array:
        return np.arctan2(w[:, 1], w[:, 0]).astype(float)

    def pdf(wo: Array, w: Array) -> Array:
        z = np.maximum(w[:, 2].astype(float), 1e-12)
        across2 = w[:, 0].astype(float) ** 2 + w[:, 1].astype(float) ** 2
        # Next to n, z rounds to 1, and with b < 1 p has a pole there.
        log_z = np.where(z > 0.7, 0.5 * np.log1p(-np.clip(across2, 1e-300, 0.6)), np.log(z))
        r = rho * rho if fault == "concentration squared" else rho
        about = (1 - r * r) / (2 * PI * (1 + r * r - 2 * r * np.cos(azimuth(w) - azimuth(wo))))
        cosine = a * b * np.exp((a - 1) * log_z) * (-np.expm1(a * log_z)) ** (b - 1)
        return np.where(w[:, 2] > 0, cosine * about, 0).astype(real)

    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        v = u.astype(float)
        z = (1 - (1 - v[:, 0]) ** (1 / b)) ** (1 / a)
        phi = 2 * np.arctan((1 - rho) / (1 + rho) * np.tan(PI * (v[:, 1] - 0.5)))
        if fault != "azimuth of w_o left out":
            phi = phi + azimuth(wo)
        w = polar(z, phi / (2 * PI)).astype(real)
        return w, pdf(wo, w)

    return Sampler("", 2, sample, pdf, None, f"a={a:.3g} b={b:.3g} rho={rho:.3g}")


def translucent(rng: Rng, real: type, fault: str) -> Sampler:
    """Lambert to both sides, chosen by the number that is used again."""
    reflected, transmitted = rng.dirichlet([2, 2, 1])[:2] * 0.95 + 0.02
    share = reflected / (reflected + transmitted)
    stated = 1 - share if fault == "exchanged sides" else share

    def pdf(wo: Array, w: Array) -> Array:
        return (np.where(w[:, 2] * wo[:, 2] > 0, stated, 1 - stated) * np.abs(w[:, 2]) / PI).astype(real)

    def f(wo: Array, w: Array) -> Array:
        return np.where(w[:, 2] * wo[:, 2] > 0, reflected, transmitted) / PI

    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        up = u[:, 0] < real(share)
        v = np.where(up, u[:, 0] / real(share), (u[:, 0] - real(share)) / real(1 - share))
        w = by_cosine(u[:, 0] if fault == "number not rescaled" else below_one(v), u[:, 1])
        w[:, 2] *= np.where(up, 1, -1) * np.sign(wo[:, 2])
        return w.astype(real), pdf(wo, w)

    return Sampler("domain=sphere wo=both", 2, sample, pdf, f, f"{reflected:.3g} {transmitted:.3g}")


def rough_glass(rng: Rng, real: type, fault: str) -> Sampler:
    """Walter et al. 2007, by normals of D cos; Fresnel's reflectance chooses."""
    alpha, index = log_uniform(rng, 0.05, 0.7), rng.uniform(1.2, 2.2)

    def index_at(o: Array) -> Array:
        return np.where(o[:, 2] > 0, index, 1 / index)

    def fresnel(cos: Array, eta: Array) -> Array:
        sin2 = np.maximum(1 - cos * cos, 0) / (eta * eta)
        inner = np.sqrt(np.maximum(1 - sin2, 0))
        across, along = (cos - eta * inner) / (cos + eta * inner), (eta * cos - inner) / (eta * cos + inner)
        return np.where(sin2 >= 1, 1.0, (across**2 + along**2) / 2)

    def pdf(wo: Array, w: Array) -> Array:
        o, i = wo.astype(float), w.astype(float)
        eta, mirrored = index_at(o), o[:, 2] * i[:, 2] > 0
        h = np.where(mirrored[:, None], o + i, o + i * eta[:, None])
        h = h / np.sqrt(np.maximum(dot(h, h), 1e-300))[:, None] * np.sign(h[:, 2:])
        oh, ih = dot(o, h), dot(i, h)
        facing = np.where(mirrored, ih * i[:, 2] > 0, oh * ih < 0) & (oh * o[:, 2] > 0)
        reflectance = fresnel(np.abs(oh), eta)
        if fault == "Fresnel's term left out":
            reflectance = np.where(reflectance < 1, 0.5, 1)
        z = np.maximum(h[:, 2], 1e-9)
        normals = alpha**2 / (PI * z**3 * (alpha**2 + 1 / (z * z) - 1) ** 2)
        scale = 1 if fault == "squared index left out" else eta**2
        refracted = scale * np.abs(ih) / np.maximum((oh + eta * ih) ** 2, 1e-300)
        reflected = 1 / (4 * np.maximum(np.abs(oh), 1e-300))
        density = normals * np.where(mirrored, reflectance * reflected, (1 - reflectance) * refracted)
        return np.where(facing, density, 0).astype(real)

    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        o, v = wo.astype(float), u.astype(float)
        m = polar(1 / np.sqrt(1 + alpha**2 * v[:, 0] / (1 - v[:, 0])), v[:, 1]) * np.sign(o[:, 2:])
        oh, eta = dot(o, m), index_at(o)
        mirrored = v[:, 2] < fresnel(np.abs(oh), eta)
        inner = np.sqrt(np.maximum(1 - (1 - oh * oh) / eta**2, 0))
        refracted = -o / eta[:, None] + (oh / eta - inner)[:, None] * m
        w = unit(np.where(mirrored[:, None], 2 * oh[:, None] * m - o, refracted))
        passes = (oh > 0) & (mirrored == (w[:, 2] * o[:, 2] > 0))
        w = w.astype(real)
        return w, np.where(passes, pdf(wo, w), 0)

    return Sampler("domain=sphere wo=both", 3, sample, pdf, None, f"alpha={alpha:.3g} index={index:.3g}")


def resampled(rng: Rng, real: type, fault: str) -> Sampler:
    """One of two or three cosine draws by f cos: a weight without a pdf (Talbot et al. 2005)."""
    count = int(rng.integers(2, 4))
    axis, sharpness = random_direction(rng, 0.2), log_uniform(rng, 2, 40)
    albedo = rng.uniform(0.2, 0.9)

    def f(wo: Array, w: Array) -> Array:
        value = albedo / PI * (0.05 + np.exp(sharpness * (w.astype(float) @ axis - 1)))
        return np.where((w[:, 2] > 0) & (wo[:, 2] > 0), value, 0)

    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        v, rows = u.astype(float), np.arange(len(u))
        drawn = np.stack([by_cosine(v[:, 2 * m], v[:, 2 * m + 1]) for m in range(count)], 1)
        sums = np.cumsum(np.stack([f(wo, drawn[:, m]) * PI for m in range(count)], 1), 1)
        taken = np.minimum((v[:, -1:] * sums[:, -1:] >= sums).sum(1), count - 1)
        weight = sums[:, -1] / (count + (0.1 if fault == "wrong count" else 0))
        if fault == "mean for the weight":
            weight = np.full(len(u), weight.mean())
        return drawn[rows, taken].astype(real), np.ones(len(u)), weight

    return Sampler("pdf=no weight=yes reciprocal=no", 2 * count + 1, sample, lambda wo, w: w[:, 2], f, f"{count} draws")


def many_cones(rng: Rng, real: type, fault: str) -> Sampler:
    """Up to 512 cones by binary search; what is left of the number is used again."""
    n = 2 ** int(rng.integers(1, 10))
    p = rng.gamma(0.7, size=n) + 0.02
    p /= p.sum()
    cdf = np.cumsum(p)
    axis = np.array([random_direction(rng) for _ in range(n)])
    height = 1 - np.cos(np.exp(rng.uniform(np.log(0.05), np.log(0.5), n)))
    frames = np.array([frame(a) for a in axis])
    value = p / (2 * PI * height)
    if fault == "exchanged probabilities":
        least, most = np.argsort(p)[[0, -1]]
        value[[least, most]] = value[[most, least]]

    def pdf(wo: Array, w: Array) -> Array:
        return ((w.astype(float) @ axis.T >= 1 - height - 1e-7) @ value).astype(real)

    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        v = u.astype(float)
        k = np.minimum(np.searchsorted(cdf, v[:, 0], side="right"), n - 1)
        rest = np.clip((v[:, 0] - cdf[k] + p[k]) / p[k], 0, 1 - 1e-7)
        if fault == "number not rescaled":
            rest = v[:, 0]
        z = 1 - height[k] * rest * (1 - 1e-5)
        w = np.einsum("nij,ni->nj", frames[k], polar(z, v[:, 1])).astype(real)
        return w, pdf(wo, w)

    return Sampler(SPHERE, 2, sample, pdf, None, f"n={n}")


def phase_function(rng: Rng, real: type, fault: str) -> Sampler:
    """Henyey-Greenstein forward and back, and Rayleigh's by the root of its cubic (Frisvad 2011)."""
    forward, back = rng.uniform(0.2, 0.95), -rng.uniform(0.05, 0.8)
    share = rng.dirichlet([2, 2, 2])
    cdf = np.cumsum(share)

    def value(cos: Array, g: float) -> Array:
        return (1 - g * g) / (4 * PI * np.maximum(1 + g * g - 2 * g * cos, 1e-12) ** 1.5)

    def inverse(u: Array, g: float) -> Array:
        q = (1 - g * g) / (1 - g + 2 * g * u)
        return (1 + g * g - q * q) / (2 * g)

    def pdf(wo: Array, w: Array) -> Array:
        cos = dot(wo.astype(float), w.astype(float)) * (1 if fault == "sign of g" else -1)
        rayleigh = 3 / (16 * PI) * (1 + cos * cos)
        return (share[0] * value(cos, forward) + share[1] * value(cos, back) + share[2] * rayleigh).astype(real)

    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        v, d = u.astype(float), -wo.astype(float)
        b = 2 * (1 - 2 * v[:, 0])
        root = np.cbrt(-b + np.sqrt(b * b + 1))
        rayleigh = 1 - 2 * v[:, 0] if fault == "even for Rayleigh" else root - 1 / root
        k = np.minimum(np.searchsorted(cdf, v[:, 2], side="right"), 2)
        cos = np.choose(k, [inverse(v[:, 0], forward), inverse(v[:, 0], back), rayleigh])
        turns = np.moveaxis(frame(d.T) if d.ndim == 1 else frame(d), 2, 0)
        w = np.einsum("nij,ni->nj", turns, polar(np.clip(cos, -1, 1), v[:, 1])).astype(real)
        return w, pdf(wo, w)

    return Sampler("domain=sphere wo=both f=cos reciprocal=no", 3, sample, pdf, None, f"g={forward:.3g} {back:.3g}")


def spherical_triangle(rng: Rng, real: type, fault: str) -> Sampler:
    """Arvo 1995, evenly in solid angle."""
    a, b, c = np.zeros((3, 3))
    while np.linalg.det([a, b, c]) < 0.02:
        a, b, c = (random_direction(rng) for _ in range(3))

    def angle(at: Array, p: Array, q: Array) -> float:
        m, n = np.cross(at, p), np.cross(at, q)
        return float(np.arccos(np.clip(m @ n / np.linalg.norm(m) / np.linalg.norm(n), -1, 1)))

    alpha = angle(a, b, c)
    area = alpha + angle(b, c, a) + angle(c, a, b) - PI
    edges = np.array([np.cross(a, b), np.cross(b, c), np.cross(c, a)])
    to_c = unit((c - (c @ a) * a)[None])

    def pdf(wo: Array, w: Array) -> Array:
        return np.where((w.astype(float) @ edges.T >= -1e-6).all(1), 1 / area, 0).astype(real)

    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        v = u.astype(float)
        part = area * (v[:, 0] ** 2 if fault == "missing root" else v[:, 0])
        s, t = np.sin(part - alpha), np.cos(part - alpha)
        x, y = t - np.cos(alpha), s + np.sin(alpha) * (a @ b)
        q = ((y * t - x * s) * np.cos(alpha) - y) / ((y * s + x * t) * np.sin(alpha) + 1e-300)
        q = np.clip(q, -1, 1)[:, None]
        end = q * a + np.sqrt(1 - q * q) * to_c
        cos = end @ b
        z = np.cos(v[:, 1] * np.arccos(np.clip(cos, -1, 1))) if fault == "even angle" else 1 - v[:, 1] * (1 - cos)
        tangent = end - cos[:, None] * b
        tangent /= np.maximum(np.sqrt(dot(tangent, tangent)), 1e-300)[:, None]
        w = unit(z[:, None] * b + np.sqrt(np.maximum(1 - z * z, 0))[:, None] * tangent).astype(real)
        return w, pdf(wo, w)

    return Sampler(SPHERE, 2, sample, pdf, None, f"area={area:.3g}")


FAMILIES: dict[Family, tuple[str, ...]] = {
    balls_by_area: ("missing square", "missing cosine"),
    tube: ("missing Jacobian", "ends not reached"),
    transformed_cosine: ("wrong power", "transposed"),
    bilinear: ("axes exchanged", "even rows"),
    alias_sky: ("sine left out", "wrong alias entry"),
    wrapped_azimuth: ("concentration squared", "azimuth of w_o left out"),
    translucent: ("exchanged sides", "number not rescaled"),
    rough_glass: ("squared index left out", "Fresnel's term left out"),
    resampled: ("wrong count", "mean for the weight"),
    many_cones: ("exchanged probabilities", "number not rescaled"),
    phase_function: ("sign of g", "even for Rayleigh"),
    spherical_triangle: ("missing root", "even angle"),
}

if __name__ == "__main__":
    main(FAMILIES)
