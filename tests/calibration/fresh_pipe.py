"""Samplers of directions in NumPy, in single and double precision, that `crescent check` queries by blocks over a pipe.

They were written after all rules and used for none: choices by alias tables, trees and tables whose number is used again,
lights over the whole sphere, microfacets, fibres, weights without a pdf, rejection. Each case has random parameters, a
function of the family, the seed and its number. Needs NumPy 2, SciPy and a built `crescent`.

    python fresh_pipe.py verify                                                        # without crescent
    python fresh_pipe.py right --crescent build/crescent --seed 41 --cases 0:60 --out right.jsonl
    python fresh_pipe.py faults --crescent build/crescent --seed 41 --cases 0:60 --out faults.jsonl
    crescent check --exec 'python fresh_pipe.py serve right 41 7'                      # one of them
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
import zlib
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from scipy import special, stats

Array = np.ndarray
Rng = np.random.Generator
PI = float(np.pi)


@dataclass(frozen=True)
class Sampler:
    """sample(w_o, u): w_i and p, and the weight if there is one; pdf and f: of w_o and w_i."""

    hello: str
    numbers: int
    sample: Callable[[Array, Array], tuple[Array, ...]]
    pdf: Callable[[Array, Array], Array]
    f: Callable[[Array, Array], Array] | None = None
    parameters: str = ""

    @property
    def over_sphere(self) -> bool:
        return "domain=sphere" in self.hello

    @property
    def without_wo(self) -> bool:
        return "wo=none" in self.hello


def log_uniform(rng: Rng, low: float, high: float) -> float:
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def random_direction(rng: Rng, least_z: float = -1) -> Array:
    z, phi = rng.uniform(least_z, 1), rng.uniform(0, 2 * PI)
    return np.array([np.sqrt(1 - z * z) * np.cos(phi), np.sqrt(1 - z * z) * np.sin(phi), z])


def dot(a: Array, b: Array) -> Array:
    return (a * b).sum(-1)


def unit(v: Array) -> Array:
    return v / np.sqrt(dot(v, v))[..., None]


def frame(axis: Array) -> Array:
    """Rows: two tangents and the axis (Duff et al. 2017), computed in double and rounded."""
    x, y, z = axis.astype(float).T
    s = np.copysign(1.0, z)
    a = -1 / (s + z)
    b = x * y * a
    return np.array([[1 + s * x * x * a, s * b, -s * x], [b, s + y * y * a, -y], [x, y, z]])


def polar(z: Array, turns: Array) -> Array:
    """A direction by the cosine with +z and its azimuth in turns."""
    r, phi = np.sqrt(np.maximum(1 - z * z, 0)), 2 * PI * turns
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], -1)


def by_cosine(u: Array, v: Array) -> Array:
    r, phi = np.sqrt(u), 2 * PI * v
    return np.stack([r * np.cos(phi), r * np.sin(phi), np.sqrt(1 - u)], -1)


def below_one(u: Array) -> Array:
    """The last number of the precision below 1."""
    return np.minimum(u, np.nextafter(u.dtype.type(1), u.dtype.type(0)))


# ---- Families. `real` is the type in which they compute; `fault` is "" or one of FAULTS of the family.

Family = Callable[[Rng, type, str], Sampler]


def alias_table(p: Array) -> tuple[Array, Array]:
    """By repeated exchange of the poorest and the richest entry."""
    n = len(p)
    level, keep, other = p * n, np.ones(n), np.arange(n)
    open_entries = set(range(n))
    while len(open_entries) > 1:
        poor = min(open_entries, key=lambda k: level[k])
        rich = max(open_entries, key=lambda k: level[k])
        keep[poor], other[poor] = min(level[poor], 1), rich
        level[rich] -= 1 - keep[poor]
        open_entries.remove(poor)
    return keep, other


def glossy_lobes(rng: Rng, real: type, fault: str) -> Sampler:
    """von Mises-Fisher lobes over the sphere, by an alias table; what remains of the number draws the cosine."""
    n = int(rng.integers(2, 13))
    p = rng.dirichlet(np.full(n, 1.5))
    sharpness = np.exp(rng.uniform(0, np.log(300), n))
    axes = np.array([random_direction(rng) for _ in range(n)])
    frames = np.array([frame(a) for a in axes]).astype(real)
    keep, other = alias_table(p)
    if fault == "wrong alias entry":
        other[np.argmin(keep)] = np.argmin(keep)
    if fault == "exchanged lobe weights":
        p = p.copy()
        p[[np.argmin(p), np.argmax(p)]] = p[[np.argmax(p), np.argmin(p)]]
    kappa, keep, axes, p = sharpness.astype(real), keep.astype(real), axes.astype(real), p.astype(real)
    scale = (sharpness / (2 * PI * -np.expm1(-2 * sharpness))).astype(real)

    def pdf(wo: Array, w: Array) -> Array:
        total = np.zeros(len(w), real)
        for k in range(n):
            d = w - axes[k]
            total += p[k] * scale[k] * np.exp(kappa[k] * (dot(d, d) * real(-0.5)))
        return total

    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        x = u[:, 0] * n
        k = np.minimum(x.astype(int), n - 1)
        rest = x - k.astype(real)
        kept = rest < keep[k]
        gone = np.maximum(1 - keep[k], real(1e-7))
        v = below_one(np.where(kept, rest / np.maximum(keep[k], real(1e-7)), (rest - keep[k]) / gone))
        if fault == "number not rescaled":
            v = rest
        k = np.where(kept, k, other[k])
        z = 1 + np.log1p(v * np.expm1(-2 * kappa[k])) / kappa[k]
        w = unit(np.einsum("nij,ni->nj", frames[k], polar(np.clip(z, -1, 1), u[:, 1])))
        return w, pdf(wo, w)

    return Sampler("domain=sphere wo=none", 2, sample, pdf, None, f"n={n} kappa={sharpness.round(1)}")


def portals(rng: Rng, real: type, fault: str) -> Sampler:
    """Two to five rectangular openings around the point, one of them by a number of its own, by area; they may overlap."""
    n = int(rng.integers(2, 6))
    centre = np.array([random_direction(rng) * log_uniform(rng, 0.8, 4) for _ in range(n)])
    rotation = np.array([frame(unit(-c / np.linalg.norm(c) + 0.4 * random_direction(rng))) for c in centre])
    half = np.exp(rng.uniform(np.log(0.1), np.log(0.8), (n, 2)))
    p = rng.dirichlet(np.full(n, 2.0))
    cdf = np.cumsum(p).astype(real)
    of_pdf = p[::-1].copy() if fault == "pdf of another light" else p
    c, s, t, m = (a.astype(real) for a in (centre, rotation[:, 0], rotation[:, 1], rotation[:, 2]))
    area, h, of_pdf = (4 * half[:, 0] * half[:, 1]).astype(real), half.astype(real), of_pdf.astype(real)

    def pdf(wo: Array, w: Array) -> Array:
        total = np.zeros(len(w), real)
        for k in range(n):
            cos = w @ m[k]
            front = np.abs(cos) > real(1e-6)
            distance = (c[k] @ m[k]) / np.where(front, cos, 1)
            q = w * distance[:, None] - c[k]
            hit = front & (distance > 0) & (np.abs(q @ s[k]) <= h[k, 0]) & (np.abs(q @ t[k]) <= h[k, 1])
            jacobian = 1 if fault == "missing Jacobian" else distance * distance / np.maximum(np.abs(cos), real(1e-6))
            total += np.where(hit, of_pdf[k] / area[k] * jacobian, 0).astype(real)
        return total

    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        k = np.minimum(np.searchsorted(cdf, u[:, 2], side="right"), n - 1)
        inner = real(1 - 3e-6)  # an edge belongs to the opening for either rounding
        a, b = ((2 * u[:, i] - 1) * h[k, i] * inner for i in (0, 1))
        w = unit(c[k] + a[:, None] * s[k] + b[:, None] * t[k])
        return w, pdf(wo, w)

    return Sampler("domain=sphere wo=none", 3, sample, pdf, None, f"n={n} p={p.round(3)}")


def octahedral_warp(rng: Rng, real: type, fault: str) -> Sampler:
    """A sky on the octahedral map of 4 to 64 cells a side, by halves of a hierarchy of sums (Clarberg et al. 2005)."""
    levels = int(rng.integers(2, 7))
    n = 2**levels
    cells = rng.gamma(log_uniform(rng, 0.5, 4), size=(n, n)) + 1e-3
    cells /= cells.sum()
    sums = [cells]
    while len(sums[-1]) > 1:
        sums.append(sums[-1].reshape(len(sums[-1]) // 2, 2, -1, 2).sum((1, 3)))
    rounded = [a.astype(real) for a in sums[::-1]]
    per_area = (cells * n * n / 4).astype(real)

    def fold(q: Array) -> Array:
        return (1 - np.abs(q[:, ::-1])) * np.copysign(real(1), q)

    def density(w: Array) -> Array:
        o = w / np.abs(w).sum(1)[:, None]
        q = np.where(o[:, 2:] < 0, fold(o[:, :2]), o[:, :2])
        i, j = np.clip(((q.T + 1) * real(n / 2)).astype(int), 0, n - 1)
        if fault == "missing Jacobian":
            return per_area[j, i] / real(PI)
        r2 = dot(o, o)
        return per_area[j, i] * r2 * np.sqrt(r2)

    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        x, y = u[:, 0].copy(), u[:, 1].copy()
        i, j = np.zeros(len(u), int), np.zeros(len(u), int)
        for a in rounded[1:]:
            i, j = 2 * i, 2 * j
            row = a[j, i] + a[j, i + 1]
            below = row / (row + a[j + 1, i] + a[j + 1, i + 1])
            up = y >= below
            y = below_one(np.where(up, (y - below) / (1 - below), y / below))
            j += up
            left = a[j, i] / (a[j, i] + a[j, i + 1])
            right = x >= left
            x = below_one(np.where(right, (x - left) / (1 - left), x / left))
            i += right
        q = np.stack([(i + x) * real(2 / n) - 1, (j + y) * real(2 / n) - 1], -1).astype(real)
        z = 1 - np.abs(q).sum(1)
        w = unit(np.concatenate([np.where(z[:, None] < 0, fold(q), q), z[:, None]], 1))
        if fault == "wrong half of the map":
            w[:, 2] = np.abs(w[:, 2])
        return w, density(w)

    return Sampler("domain=sphere wo=none", 2, sample, lambda wo, w: density(w), None, f"n={n}")


def reflect(o: Array, m: Array) -> Array:
    return unit(2 * dot(o, m)[:, None] * m - o)


def half_vector(o: Array, w: Array) -> Array:
    return unit(o + w)


def beckmann_visible(rng: Rng, real: type, fault: str) -> Sampler:
    """Beckmann's visible normals: the slope along w_o by a table of its closed form, and Newton steps (Heitz & d'Eon 2014)."""
    ax, ay = log_uniform(rng, 0.08, 0.9), log_uniform(rng, 0.08, 0.9)
    alpha = np.array([ax, ay, 1])
    albedo = rng.uniform(0.2, 0.9)

    def smith(w: Array) -> Array:
        """1 + Lambda."""
        v = w[:, 2] / np.maximum(np.hypot(w[:, 0] * ax, w[:, 1] * ay), 1e-12)
        return (1 + special.erf(v)) / 2 + np.exp(-v * v) / (2 * v * np.sqrt(PI))

    def distribution(m: Array) -> Array:
        x, y, z = m[:, 0] / ax, m[:, 1] / ay, np.maximum(m[:, 2], 1e-6)
        return np.exp(-(x * x + y * y) / (z * z)) / (PI * ax * ay * z**4)

    def pdf(wo: Array, w: Array) -> Array:
        o, i = wo.astype(float), w.astype(float)
        m = half_vector(o, i)
        seen = distribution(m) / np.maximum(o[:, 2] * smith(i if fault == "G1 of w_i" else o), 1e-30)
        p = seen * (dot(o, m) if fault == "missing Jacobian" else 0.25)
        return np.where((i[:, 2] > 0) & (dot(o, m) > 0), p, 0).astype(real)

    def f(wo: Array, w: Array) -> Array:
        o, i = wo.astype(float), w.astype(float)
        with np.errstate(over="ignore", invalid="ignore"):
            value = albedo * distribution(half_vector(o, i)) / (4 * o[:, 2] * i[:, 2] * (smith(o) + smith(i) - 1))
        return np.where((o[:, 2] > 0) & (i[:, 2] > 0), value, 0)

    def slopes(o: Array, u: Array) -> Array:
        """Of all rows with equal w_o."""
        v = o * alpha
        a = v[2] / max(np.hypot(v[0], v[1]), 1e-7)
        whole = a * (1 + special.erf(a)) / 2 + np.exp(-a * a) / (2 * np.sqrt(PI))
        part = lambda x: (a * (1 + special.erf(x)) / 2 + np.exp(-x * x) / (2 * np.sqrt(PI))) / whole
        x = np.linspace(-6, min(a, 6), 8193)
        s = np.interp(u[:, 0], part(x), x)
        for _ in range(3):
            slope = np.maximum((a - s) * np.exp(-s * s) / (np.sqrt(PI) * whole), 1e-12)
            s = np.clip(s + np.clip((u[:, 0] - part(s)) / slope, -1e-3, 1e-3), -6.2, min(a, 6.2))
        t = special.erfinv(2 * np.clip(u[:, 1], 1e-9, 1 - 1e-9) - 1)
        c, d = (v[:2] / np.hypot(v[0], v[1])) if np.hypot(v[0], v[1]) > 1e-9 else (1.0, 0.0)
        return np.stack([(c * s - d * t) * ax, (d * s + c * t) * ay], -1)

    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        m = np.ones((len(u), 3))
        begin = np.flatnonzero(np.any(np.diff(wo, axis=0, prepend=np.nan), 1))
        for a, b in zip(begin, [*begin[1:], len(u)], strict=True):
            m[a:b, :2] = -slopes(wo[a].astype(float), u[a:b].astype(float))
        w = reflect(wo.astype(float), unit(m))
        w = w.astype(real)
        return w, pdf(wo, w)

    return Sampler("", 2, sample, pdf, f, f"alpha={ax:.3g} {ay:.3g}")


def student_normals(rng: Rng, real: type, fault: str) -> Sampler:
    """Normals with slopes of Student's t (Ribardiere et al. 2017), mirrored; draws below the horizon are none."""
    a, g = log_uniform(rng, 0.08, 0.8), rng.uniform(1.6, 8)
    a2 = real(a * a * (g - 1))

    def pdf(wo: Array, w: Array) -> Array:
        m = half_vector(wo, w)
        z = np.maximum(m[:, 2], real(1e-6))
        tan2 = (m[:, 0] ** 2 + m[:, 1] ** 2) / (z * z)
        power = -(g + 1) if fault == "pdf of another exponent" else -g
        d = real(1 / (PI * a * a)) * (1 + tan2 / a2) ** real(power) / (z * z * z)
        jacobian = real(0.25) if fault == "missing Jacobian" else 1 / np.maximum(4 * dot(wo, m), real(1e-6))
        return np.where((w[:, 2] > 0) & (m[:, 2] > 0), d * jacobian, 0).astype(real)

    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        tan = np.sqrt(a2 * np.expm1(-np.log1p(-u[:, 0]) / real(g - 1)))
        phi = real(2 * PI) * u[:, 1]
        m = unit(np.stack([tan * np.cos(phi), tan * np.sin(phi), np.ones_like(tan)], -1))
        w = reflect(wo, m)
        return w, np.where(dot(wo, m) > 0, pdf(wo, w), 0)

    return Sampler("", 2, sample, pdf, None, f"alpha={a:.3g} gamma={g:.3g}")


def sheen(rng: Rng, real: type, fault: str) -> Sampler:
    """Inverted normals of cloth, p of the sine (Estevez and Kulla 2017), with a share of the cosine by the same number."""
    alpha, share = log_uniform(rng, 0.15, 1), rng.uniform(0.2, 0.8)
    inverse = 1 / alpha
    albedo = rng.uniform(0.2, 0.9)
    share_of_pdf = real(1 - share if fault == "exchanged lobe weights" else share)

    def pdf(wo: Array, w: Array) -> Array:
        m = half_vector(wo, w)
        sin = np.hypot(m[:, 0], m[:, 1])
        d = real((inverse + 2) / (2 * PI)) * sin ** real(inverse) * m[:, 2]
        if fault != "missing Jacobian":
            d = d / np.maximum(4 * dot(wo, m), real(1e-6))
        return np.where(w[:, 2] > 0, share_of_pdf * d + (1 - share_of_pdf) * w[:, 2] / real(PI), 0).astype(real)

    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        cloth = u[:, 0] < real(share)
        v = below_one(np.where(cloth, u[:, 0] / real(share), (u[:, 0] - real(share)) / real(1 - share)))
        if fault == "number not rescaled":
            v = u[:, 0]
        sin = v ** real(1 / (inverse + 2))
        phi = real(2 * PI) * u[:, 1]
        m = np.stack([sin * np.cos(phi), sin * np.sin(phi), np.sqrt(np.maximum(1 - sin * sin, 0))], -1)
        w = np.where(cloth[:, None], reflect(wo, m), by_cosine(v, u[:, 1]))
        return w, np.where(cloth & (dot(wo, m) <= 0), 0, pdf(wo, w))

    def f(wo: Array, w: Array) -> Array:
        return np.where((wo[:, 2] > 0) & (w[:, 2] > 0), albedo / PI, 0)

    return Sampler("", 2, sample, pdf, f, f"alpha={alpha:.3g} share={share:.3g}")


def projected_suns(rng: Rng, real: type, fault: str) -> Sampler:
    """Spherical lights above the horizon, each by projected solid angle: evenly on the ellipse below it."""
    n = int(rng.integers(1, 6))
    radius = np.exp(rng.uniform(np.log(0.03), np.log(0.5), n))  # half angles
    axis = np.array([random_direction(rng, float(np.sin(b + 0.05))) for b in radius])
    p = rng.dirichlet(np.full(n, 2.0))
    cdf = np.cumsum(p).astype(real)
    area = PI * np.sin(radius) ** 2 * axis[:, 2]
    horizontal = axis[:, :2] / np.maximum(np.linalg.norm(axis[:, :2], axis=1), 1e-12)[:, None]
    a, c, s, e = (v.astype(real) for v in (axis, np.cos(radius), np.sin(radius), horizontal))
    scale = (p / area).astype(real)
    gap = np.asarray(4 * np.sin(radius / 2) ** 2, real)
    if fault == "pdf of another light":
        scale = np.roll(scale, 1) if n > 1 else scale / 2

    def pdf(wo: Array, w: Array) -> Array:
        total = np.zeros(len(w), real)
        for k in range(n):
            d = w - a[k]
            cos = real(1 / PI) if fault == "missing Jacobian" else w[:, 2]
            total += np.where(dot(d, d) <= gap[k], scale[k] * cos, 0)
        return total

    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        k = np.minimum(np.searchsorted(cdf, u[:, 2], side="right"), n - 1)
        r, phi = u[:, 0] if fault == "missing root" else np.sqrt(u[:, 0]), real(2 * PI) * u[:, 1]
        r = r * real(1 - 1e-5)
        x, y = r * np.cos(phi) * s[k] * a[k, 2], r * np.sin(phi) * s[k]
        along = np.linalg.norm(axis[:, :2], axis=1).astype(real)[k] * c[k] + x
        px, py = along * e[k, 0] - y * e[k, 1], along * e[k, 1] + y * e[k, 0]
        w = unit(np.stack([px, py, np.sqrt(np.maximum(1 - px * px - py * py, 0))], -1))
        return w, pdf(wo, w)

    return Sampler("wo=none", 3, sample, pdf, None, f"n={n} half angles={radius.round(3)}")


def tree_of_triangles(rng: Rng, real: type, fault: str) -> Sampler:
    """4 to 32 triangles over the sphere, one by a binary tree whose levels use the same number (Estevez and Kulla 2018)."""
    n = 2 ** int(rng.integers(2, 6))
    centre = np.array([random_direction(rng) * log_uniform(rng, 1, 3) for _ in range(n)])
    corner = (
        centre[:, None] + rng.normal(size=(n, 3, 3)) * np.exp(rng.uniform(np.log(0.1), np.log(0.5), n))[:, None, None]
    )
    edge1, edge2 = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
    twice = np.linalg.norm(np.cross(edge1, edge2), axis=1)
    importance = [rng.gamma(1.0, size=n) + 0.05]
    while len(importance[-1]) > 1:
        boost = rng.uniform(0.5, 2, len(importance[-1]) // 2)  # a node's bound is not the sum of its children
        importance.append(importance[-1].reshape(-1, 2).sum(1) * boost)
    p = np.ones(1)
    for level in importance[-2::-1]:
        pair = level.reshape(-1, 2)
        p = (p[:, None] * pair / pair.sum(1)[:, None]).ravel()
    levels = [v.astype(real) for v in importance]
    a, b, c, pa = (v.astype(real) for v in (corner[:, 0], edge1, edge2, 2 * p / twice))
    across = np.cross(c, b)
    for_x, for_y, volume = np.cross(c, -a), np.cross(-a, b), dot(c, np.cross(-a, b))
    if fault == "pdf of another light":
        pa = np.roll(pa, 1)

    def pdf(wo: Array, w: Array) -> Array:
        total = np.zeros(len(w), real)
        for k in range(n):  # Moeller and Trumbore 1997, from the origin
            det = w @ across[k]
            safe = np.where(np.abs(det) > real(1e-9), det, real(1))
            x, y, t = (w @ for_x[k]) / safe, (w @ for_y[k]) / safe, volume[k] / safe
            slack = real(1e-5)
            hit = (np.abs(det) > real(1e-9)) & (x >= -slack) & (y >= -slack) & (x + y <= 1 + slack) & (t > 0)
            cos = np.abs(det) / real(twice[k])
            total += np.where(
                hit, pa[k] * (1 if fault == "missing Jacobian" else t * t / np.maximum(cos, real(1e-7))), 0
            )
        return total

    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        k, v = np.zeros(len(u), int), u[:, 2].copy()
        for level in levels[-2::-1]:
            left = level[2 * k] / (level[2 * k] + level[2 * k + 1])
            right = v >= left
            v = below_one(np.where(right, (v - left) / (1 - left), v / left))
            k = 2 * k + (~right if fault == "exchanged children" else right)
        root = u[:, 0] if fault == "missing root" else np.sqrt(u[:, 0])
        x, y = 1 - root, root * u[:, 1]
        w = unit(a[k] + x[:, None] * b[k] + y[:, None] * c[k])
        return w, pdf(wo, w)

    return Sampler("domain=sphere wo=none", 3, sample, pdf, None, f"n={n}")


def hair(rng: Rng, real: type, fault: str) -> Sampler:
    """A fibre along x: d'Eon et al. 2011 along it, and about it one of three logistic lobes by what remains of a number."""
    v = log_uniform(rng, 0.02, 1)
    width = log_uniform(rng, 0.15, 0.8)
    share = rng.dirichlet(np.full(3, 2.0))
    shift = np.array([0, PI, rng.uniform(0.5, 2.5)])
    cdf = np.cumsum(share)
    low = 1 / (1 + np.exp(PI / width))
    normal = (1 - 2 * low) * width
    of_pdf = share[::-1] if fault == "exchanged lobe weights" else share

    def pdf(wo: Array, w: Array) -> Array:
        o, i = wo.astype(float), w.astype(float)
        so, si = o[:, 0], i[:, 0]
        co, ci = np.sqrt(np.maximum(1 - so * so, 0)), np.sqrt(np.maximum(1 - si * si, 0))
        x = co * ci / v
        along = special.ive(0, x) * np.exp(x - si * so * (1 if fault != "mirrored along the fibre" else -1) / v - 1 / v)
        along /= v * -np.expm1(-2 / v)  # over sin(theta)
        phi = np.arctan2(i[:, 2], i[:, 1]) - np.arctan2(o[:, 2], o[:, 1])
        about = np.zeros(len(w))
        for k in range(3):
            e = np.exp(-np.abs((phi - shift[k] + PI) % (2 * PI) - PI) / width)
            about += of_pdf[k] * e / (normal * (1 + e) ** 2)
        return (along * about * (ci if fault == "missing Jacobian" else 1)).astype(real)

    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        o = wo.astype(float)
        k = np.minimum(np.searchsorted(cdf, u[:, 0], side="right"), 2)
        rest = np.clip((u[:, 0] - cdf[k] + share[k]) / share[k], 1e-9, 1 - 1e-9)
        c = 1 + v * np.log(np.maximum(u[:, 1] + (1 - u[:, 1]) * np.exp(-2 / v), 1e-300))
        co = np.sqrt(np.maximum(1 - o[:, 0] ** 2, 0))
        si = -c * o[:, 0] + np.sqrt(np.maximum(1 - c * c, 0)) * np.cos(2 * PI * u[:, 2]) * co
        si = np.clip(si, -1, 1)
        q = low + rest * (1 - 2 * low)
        phi = np.arctan2(o[:, 2], o[:, 1]) + shift[k] + width * np.log(q / (1 - q))
        ci = np.sqrt(np.maximum(1 - si * si, 0))
        w = np.stack([si, ci * np.cos(phi), ci * np.sin(phi)], -1).astype(real)
        return w, pdf(wo, w)

    return Sampler("domain=sphere wo=both reciprocal=no f=cos", 3, sample, pdf, None, f"v={v:.3g} width={width:.3g}")


def microflakes(rng: Rng, real: type, fault: str) -> Sampler:
    """Mirror flakes in a medium by their visible normals (SGGX, Heitz et al. 2015): a phase function."""
    scale = np.exp(rng.uniform(np.log(0.1), 0, 3))
    turn = frame(random_direction(rng))
    root = turn.T @ np.diag(scale) @ turn  # S^(1/2)
    matrix = root @ root
    inverse, det = np.linalg.inv(matrix), np.linalg.det(matrix)
    r, s_inverse, s = root.astype(real), inverse.astype(real), matrix.astype(real)

    def pdf(wo: Array, w: Array) -> Array:
        h = wo + w
        h2 = dot(h, h)
        m = h / np.sqrt(np.maximum(h2, real(1e-12)))[:, None]
        d = 1 / (PI * np.sqrt(det) * dot(m @ s_inverse, m) ** 2)
        sigma = np.sqrt(dot(wo @ s, wo))
        return np.where(h2 > real(1e-12), d / sigma * (dot(wo, m) if fault == "missing Jacobian" else 0.25), 0).astype(
            real
        )

    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        o = unit(wo @ r)  # S^(1/2) w_o: the sphere seen from there, cosine weighted
        sign = np.copysign(real(1), o[:, 2])
        a = -1 / (sign + o[:, 2])
        b = o[:, 0] * o[:, 1] * a
        t = np.stack([1 + sign * o[:, 0] ** 2 * a, sign * b, -sign * o[:, 0]], -1)
        q = np.stack([b, sign + o[:, 1] ** 2 * a, -o[:, 1]], -1)
        c = by_cosine(u[:, 0], u[:, 1])
        m = unit((c[:, :1] * t + c[:, 1:2] * q + c[:, 2:] * o) @ r)
        w = reflect(wo, m)
        return w, pdf(wo, w)

    return Sampler("domain=sphere wo=both f=cos reciprocal=no", 2, sample, pdf, pdf, f"scale={scale.round(3)}")


def sky_times_cosine(rng: Rng, real: type, fault: str) -> Sampler:
    """Cells of a sky in latitude and longitude times the cosine at their middle, by rows and columns."""
    h, w_cells = int(rng.integers(3, 25)), int(rng.integers(4, 49))
    z = (np.cos(PI / 2 * np.arange(h) / h) + np.cos(PI / 2 * (np.arange(h) + 1) / h)) / 2
    size = np.diff(-np.cos(PI / 2 * np.arange(h + 1) / h)) * 2 * PI / w_cells  # sr
    mass = rng.gamma(log_uniform(rng, 0.5, 3), size=(h, w_cells)) * (z * size)[:, None] + 1e-6
    mass /= mass.sum()
    rows, columns = np.cumsum(mass.sum(1)), np.cumsum(mass, 1) / mass.sum(1)[:, None]
    shuffled = np.roll(mass, 1, 1) if fault == "pdf of the next cell" else mass
    value = shuffled / (mass.mean() if fault == "missing Jacobian" else size[:, None])
    if fault == "missing Jacobian":
        value = value / (2 * PI)
    value = value.astype(real)
    top = np.cos(PI / 2 * np.arange(h + 1) / h).astype(real)
    start, share = (np.append(0, rows)[:-1]).astype(real), mass.sum(1).astype(real)
    column_start, column_share = (
        (columns - np.diff(columns, axis=1, prepend=0)).astype(real),
        np.diff(columns, axis=1, prepend=0).astype(real),
    )

    def pdf(wo: Array, w: Array) -> Array:
        j = np.clip(np.searchsorted(-top, -w[:, 2], side="right") - 1, 0, h - 1)
        i = np.minimum(((np.arctan2(w[:, 1], w[:, 0]) / real(2 * PI)) % 1 * w_cells).astype(int), w_cells - 1)
        return np.where(w[:, 2] > 0, value[j, i], 0).astype(real)

    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        j = np.clip(np.searchsorted(start, u[:, 0], side="right") - 1, 0, h - 1)
        i = (u[:, 1:2] >= column_start[j]).sum(1) - 1
        y = below_one(np.clip((u[:, 0] - start[j]) / share[j], 0, 1).astype(real))
        x = below_one(np.clip((u[:, 1] - column_start[j, i]) / column_share[j, i], 0, 1).astype(real))
        w = polar(top[j] + (top[j + 1] - top[j]) * y, (i + x) / real(w_cells)).astype(real)
        return w, pdf(wo, w)

    return Sampler("wo=none", 2, sample, pdf, None, f"{h} x {w_cells}")


def rejection(rng: Rng, real: type, fault: str) -> Sampler:
    """Two attempts from the given numbers, and the cosine if both are rejected."""
    base = rng.uniform(0.05, 0.6)
    axis = random_direction(rng, 0)
    a = axis.astype(real)
    accepted = base + (1 - base) / 3  # the mean of base + (1 - base) (w . a)^2 over the hemisphere
    rest = (1 - accepted) ** 2
    of_pdf = 1 - accepted if fault == "second attempt not counted" else rest

    def pdf(wo: Array, w: Array) -> Array:
        g = real(base) + real(1 - base) * (w @ a) ** 2
        p = real((1 - of_pdf) / (2 * PI * accepted)) * g + real(of_pdf / PI) * w[:, 2]
        return np.where(w[:, 2] > 0, p, 0).astype(real)

    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        first, second = polar(u[:, 0], u[:, 1]), polar(u[:, 2], u[:, 3])
        g1, g2 = (real(base) + real(1 - base) * (w @ a) ** 2 for w in (first, second))
        w = np.where((u[:, 5] < g2)[:, None], second, by_cosine(u[:, 6], u[:, 7]))
        w = np.where((u[:, 4] < g1)[:, None], first, w)
        return w, pdf(wo, w)

    return Sampler("wo=none", 8, sample, pdf, None, f"base={base:.3g}")


def own_rejection(rng: Rng, real: type, fault: str) -> Sampler:
    """f cos itself by rejection with random numbers of its own, as a weight without a pdf."""
    base, albedo = rng.uniform(0.05, 0.6), rng.uniform(0.2, 0.9)
    axis = random_direction(rng, 0)
    own = np.random.default_rng(int(rng.integers(2**60)))
    mean = base + (1 - base) * (1 + axis[2] ** 2) / 4  # of base + (1 - base) (w . a)^2, cosine weighted
    weight = albedo * mean * (1.02 if fault == "weight 2 % too large" else 1)

    def f(wo: Array, w: Array) -> Array:
        value = albedo / PI * (base + (1 - base) * (w.astype(float) @ axis) ** 2)
        return np.where((w[:, 2] > 0) & (wo[:, 2] > 0), value, 0)

    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        n = len(u)
        w, open_rows = np.empty((n, 3), real), np.arange(n)
        while len(open_rows):
            v = own.random((len(open_rows), 3), dtype=real)
            trial = by_cosine(v[:, 0], v[:, 1])
            take = v[:, 2] < base + (1 - base) * (trial @ axis.astype(real)) ** 2
            if fault == "every proposal accepted":
                take[:] = True
            w[open_rows[take]] = trial[take]
            open_rows = open_rows[~take]
        return w, np.ones(n, real), np.full(n, weight, real)

    def pdf(wo: Array, w: Array) -> Array:
        return f(np.array([[0, 0, 1.0]]), w) * w[:, 2] / (albedo * mean)

    return Sampler("pdf=no weight=yes random=own reciprocal=no", 2, sample, pdf, f, f"base={base:.3g}")


def only_weights(rng: Rng, real: type, fault: str) -> Sampler:
    """A mixture without a pdf: f cos over the density of both lobes as a weight; the lobe by an alias table of cells."""
    n = int(rng.integers(3, 40))
    p = rng.dirichlet(np.full(n, 1.0)) + 1e-3
    p /= p.sum()
    keep, other = alias_table(p)
    keep = keep.astype(real)
    albedo, slope = rng.uniform(0.2, 0.9), rng.uniform(0, 0.9)
    if fault == "wrong alias entry":
        other[np.argmin(keep)] = np.argmin(keep)

    def f(wo: Array, w: Array) -> Array:
        value = albedo / PI * (1 + slope * w[:, 0] * wo[:, 0]) / 2
        return np.where((w[:, 2] > 0) & (wo[:, 2] > 0), value, 0)

    def pdf(wo: Array, w: Array) -> Array:
        k = np.minimum((np.arctan2(w[:, 1], w[:, 0]) / real(2 * PI) % 1 * n).astype(int), n - 1)
        return np.where(w[:, 2] > 0, p.astype(real)[k] * n * w[:, 2] / real(PI), 0)

    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        k = np.minimum((u[:, 2] * n).astype(int), n - 1)
        k = np.where(u[:, 3] < keep[k], k, other[k])
        x = (k + np.clip(u[:, 1], 1e-5, 1 - 1e-5)) / n
        w = by_cosine(u[:, 0], x.astype(real))
        density = p[k] * n * (1 if fault == "missing Jacobian" else w[:, 2] / PI)
        weight = f(wo, w) * w[:, 2] / np.maximum(density, 1e-30)
        return w, np.ones(len(u)), weight

    return Sampler("pdf=no weight=yes", 4, sample, pdf, f, f"n={n} slope={slope:.3g}")


FAMILIES: dict[Family, tuple[str, ...]] = {
    glossy_lobes: ("wrong alias entry", "exchanged lobe weights", "number not rescaled"),
    portals: ("pdf of another light", "missing Jacobian"),
    octahedral_warp: ("missing Jacobian", "wrong half of the map"),
    beckmann_visible: ("G1 of w_i", "missing Jacobian"),
    student_normals: ("pdf of another exponent", "missing Jacobian"),
    sheen: ("exchanged lobe weights", "missing Jacobian", "number not rescaled"),
    projected_suns: ("pdf of another light", "missing Jacobian", "missing root"),
    tree_of_triangles: ("pdf of another light", "missing Jacobian", "exchanged children", "missing root"),
    hair: ("exchanged lobe weights", "mirrored along the fibre", "missing Jacobian"),
    microflakes: ("missing Jacobian",),
    sky_times_cosine: ("pdf of the next cell", "missing Jacobian"),
    rejection: ("second attempt not counted",),
    own_rejection: ("weight 2 % too large", "every proposal accepted"),
    only_weights: ("wrong alias entry", "missing Jacobian"),
}

# ---- Faults of any family.


def with_constant(s: Sampler) -> Sampler:
    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        w, p, *weight = s.sample(wo, u)
        return w, p * p.dtype.type(1.03), *weight

    return replace(s, sample=sample, pdf=lambda wo, w: s.pdf(wo, w) * w.dtype.type(1.03))


def with_leak(s: Sampler) -> Sampler:
    """1 % of the draws are even over the hemisphere."""

    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        w, p, *weight = s.sample(wo, u)
        taken = (u[:, 0] * 8192 % 1) < 0.01
        even = polar(u[:, 0] * 8192 % 1 * 100, u[:, 1] * 64 % 1).astype(w.dtype)
        w = np.where(taken[:, None], even, w)
        return w, np.where(taken, s.pdf(wo, w), p), *weight

    return replace(s, sample=sample)


def with_rotation(s: Sampler) -> Sampler:
    """Draws are turned by 0.1 rad about x."""
    c, d = np.cos(0.1), np.sin(0.1)

    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        w, p, *weight = s.sample(wo, u)
        turned = np.stack([w[:, 0], c * w[:, 1] - d * w[:, 2], d * w[:, 1] + c * w[:, 2]], -1).astype(w.dtype)
        return turned, np.where(p > 0, s.pdf(wo, turned), p), *weight

    return replace(s, sample=sample)


def with_nan(s: Sampler) -> Sampler:
    """The density overflows in a sixteenth of the numbers, as of a large exponent in single precision."""

    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        w, p, *weight = s.sample(wo, u)
        large = np.exp(np.float32(1500) * u[:, 0].astype(np.float32))
        return w, np.where(u[:, 0] > 1 - 1 / 16, large / large * p, p), *weight

    return replace(s, sample=sample)


def with_gap(s: Sampler) -> Sampler:
    """p is 0 for an eighth of the azimuths, where the sampler still draws."""

    def gap(w: Array, p: Array) -> Array:
        return np.where(np.arctan2(w[:, 1], w[:, 0]) / (2 * PI) % 1 < 0.125, 0, p)

    def sample(wo: Array, u: Array) -> tuple[Array, ...]:
        w, p, *weight = s.sample(wo, u)
        return w, gap(w, p), *weight

    return replace(s, sample=sample, pdf=lambda wo, w: gap(w, s.pdf(wo, w)))


COMMON: dict[str, Callable[[Sampler], Sampler]] = {
    "constant of 3 %": with_constant,
    "leak of 1 %": with_leak,
    "turned by 0.1": with_rotation,
    "overflow": with_nan,
    "missing support": with_gap,
}


@dataclass(frozen=True)
class Case:
    family: str
    real: type
    fault: str
    sampler: Sampler
    wo: Array


def case_of(of: dict[Family, tuple[str, ...]], of_set: str, seed: int, number: int) -> Case:
    families = list(of)
    family = families[number % len(families)]
    rng = np.random.default_rng([zlib.crc32(of_set.encode()), seed, number])
    real = (np.float32, np.float64)[int(rng.integers(2))]
    wo = random_direction(rng, 0.05)
    fault = ""
    if of_set == "faults":
        of_family = of[family]
        common = () if "pdf=no" in family(np.random.default_rng(0), real, "").hello else tuple(COMMON)
        faults = of_family + common
        fault = faults[number // len(families) % len(faults)]
    sampler = family(rng, real, "" if fault in COMMON else fault)
    if fault in COMMON:
        sampler = COMMON[fault](sampler)
    return Case(family.__name__, real, fault, sampler, wo)


# ---- The protocol.


def serve(c: Case, requests: BinaryIO, answers: BinaryIO) -> None:
    s, real = c.sampler, c.real
    np.seterr(all="ignore")
    requests.readline()
    bits = 24 if real is np.float32 else 53
    answers.write(f"hello 2 {c.family} u={s.numbers} u_bits={bits} {s.hello} block=f64\n".encode())
    answers.flush()
    while len(what := requests.read(4)) == 4:
        count = int.from_bytes(requests.read(4), "little")
        columns = 3 + s.numbers if what == b"smpl" else 6
        rows = np.frombuffer(requests.read(8 * count * columns)).reshape(count, columns).astype(real)
        wo, rest = rows[:, :3], rows[:, 3:]
        if what == b"smpl":
            w, p, *weight = s.sample(wo, rest)
            out = np.column_stack([w, p, *weight])
        elif what == b"pdf_":
            out = s.pdf(wo, rest)
        else:
            out = s.f(wo, rest) if s.f else np.full(count, np.nan)
        answers.write(count.to_bytes(4, "little") + np.ascontiguousarray(out, float).tobytes())
        answers.flush()


def check(c: Case, crescent: str, options: list[str]) -> dict[str, Any]:
    """A forked process serves: a start of Python costs more than a check. `cat` connects it with crescent."""
    with tempfile.TemporaryDirectory() as folder:
        to, back, report = (f"{folder}/{name}" for name in ("to", "back", "report.json"))
        os.mkfifo(to)
        os.mkfifo(back)
        child = os.fork()
        if child == 0:
            with open(to, "rb") as requests, open(back, "wb") as answers:
                serve(c, requests, answers)
            os._exit(0)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        start = time.monotonic()
        done = subprocess.run(
            [crescent, "check", "--exec", f"cat {back} & exec cat > {to}", "--quiet", "--json", report, *options],
            capture_output=True,
            text=True,
            check=False,
        )
        os.waitpid(child, 0)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        if not os.path.exists(report):
            return {"state": "error", "text": done.stdout + done.stderr}
        found = json.loads(Path(report).read_text())
    failed = [v for v in found["verdicts"] if v["state"] not in ("right", "skipped")]
    return {
        "state": found["state"],
        "failed": [{k: v.get(k) for k in ("case", "name", "state", "message", "cause")} for v in failed],
        "text": done.stdout if failed else "",
        "cpu": round(used, 2),
        "wall": round(time.monotonic() - start, 2),
    }


# ---- A verification that shares nothing with crescent.


def verify(c: Case, rng: Rng, count: int = 200_000, caps: int = 24) -> tuple[float, float]:
    """The mass in caps about draws by counting against that by quadrature of p, and the whole; the largest of their z."""
    s, wo = c.sampler, np.tile(c.wo.astype(c.real), (count, 1))
    u = (rng.integers(0, 2**24, (count, s.numbers)) / 2**24).astype(c.real)
    w, p, *_ = s.sample(wo, u)
    w, alive = w.astype(float), (p > 0) & (s.over_sphere | (w[:, 2] > 0))
    worst = 0.0
    for k in range(caps):
        middle = w[alive][rng.integers(alive.sum())]
        size = 2.0 if k == 0 else log_uniform(rng, 1e-3, 1.5)  # 1 - cos; the first is the sphere
        inside = alive & (w @ middle >= 1 - size)
        even = unit(polar(1 - size * rng.random(count), rng.random(count)) @ frame(middle))
        value = np.where(s.over_sphere | (even[:, 2] > 0), s.pdf(wo, even.astype(c.real)), 0).astype(float)
        value *= 2 * PI * size
        share = inside.mean()
        variance = share * (1 - share) / count + value.var() / count
        worst = max(worst, abs(share - value.mean()) / np.sqrt(variance + 1e-12))
    # A draw that is one of `caps` centres is in its own cap: one in `count`, below the noise.
    return worst, float(np.nanmax(np.abs(np.linalg.norm(w[alive], axis=1) - 1)))


# ---- Tables.


def upper(k: int, n: int) -> float:
    return 1.0 if k == n else float(stats.beta.ppf(0.95, k + 1, n - k))


def print_table(records: list[dict[str, Any]], key: str) -> None:
    print(f"| {key} | checks | wrong | inconclusive | error | CPU s |\n|---|---|---|---|---|---|")
    for name in [*dict.fromkeys(r[key] for r in records), "all"]:
        rs = [r for r in records if name in (r[key], "all")]
        counts = [sum(r["state"] == s for r in rs) for s in ("wrong", "inconclusive", "error")]
        cpu = np.mean([r.get("cpu", 0) for r in rs])
        print(f"| {name} | {len(rs)} | {counts[0]} | {counts[1]} | {counts[2]} | {cpu:.2f} |")
    wrong = sum(r["state"] in ("wrong", "error") for r in records)
    print(f"\nReported wrong: at most {100 * upper(wrong, len(records)):.2g} % (95 %, one-sided).")


def main(families: dict[Family, tuple[str, ...]]) -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("task", choices=["right", "faults", "verify", "table", "serve"])
    parser.add_argument("rest", nargs="*", help="of serve: right or faults, the seed, the number; of table: files")
    parser.add_argument("--crescent", default="crescent")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--cases", default="0:28", metavar="FROM:TO")
    parser.add_argument("--whole", action="store_true", help="all w_o of a quick check, not one")
    parser.add_argument("--out", type=Path, help="file to which a line for each check is appended")
    a = parser.parse_args()
    if a.task == "serve":
        serve(case_of(families, a.rest[0], int(a.rest[1]), int(a.rest[2])), sys.stdin.buffer, sys.stdout.buffer)
        return
    if a.task == "table":
        records = [json.loads(line) for name in a.rest for line in Path(name).read_text().splitlines()]
        for key in ("family", "fault") if any(r["fault"] for r in records) else ("family",):
            print_table(records, key)
        return
    np.seterr(all="ignore")
    records = []
    for number in range(*(int(v) for v in a.cases.split(":"))):
        c = case_of(families, "right" if a.task == "verify" else a.task, a.seed, number)
        known = {"family": c.family, "real": c.real.__name__, "case": number, "seed": a.seed, "fault": c.fault}
        if a.task == "verify":
            z, length = verify(c, np.random.default_rng([a.seed, number]))
            text = " ".join(c.sampler.parameters.split())
            print(f"{c.family:20} {c.real.__name__} z={z:.2f} |w|-1: {length:.1e} {text}")
            continue
        wo = [] if a.whole or c.sampler.without_wo else ["--wo", ",".join(repr(float(v)) for v in c.wo)]
        found = check(c, a.crescent, [*wo, "--seed", str(a.seed * 100_000 + number)])
        records.append({**known, **found, "parameters": c.sampler.parameters})
        if a.out:
            with a.out.open("a") as file:
                file.write(json.dumps(records[-1]) + "\n")
    if records:
        print_table(records, "family")


if __name__ == "__main__":
    main(FAMILIES)
