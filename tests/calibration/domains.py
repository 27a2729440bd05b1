"""Measures `crescent.check` over domains of points: lines, sets, disks, squares, cubes, triangles and products.

The samplers have the distributions of SciPy by their inverse functions, and tables. Each case has random parameters, a
function of the set, the seed and its number. Needs crescent and SciPy; the set `mitsuba` needs Mitsuba 3.

    python domains.py right --seed 1 --cases 0:400 --out right.jsonl
    python domains.py table right.jsonl
"""

from __future__ import annotations

import argparse
import json
import re
import sys
import zlib
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import crescent
import numpy as np
from crescent import _crescent
from scipy import special, stats

Array = np.ndarray


@dataclass(frozen=True)
class Case:
    """A right sampler: points of random numbers, and their density."""

    domain: str
    numbers: int
    draw: Callable[[Array], Array]
    density: Callable[[Array], Array]
    parameters: str = ""
    own_random: bool = False

    def sample(self, u: Array) -> tuple[Array, Array]:
        x = self.draw(u)
        return x, self.density(x)


def middle_of_cell(u: Array) -> Array:
    """Random numbers in (0, 1): the middles of the cells of 2^-24."""
    return (np.floor(u * 2**24) + 0.5) / 2**24


def log_uniform(rng: np.random.Generator, low: float, high: float) -> float:
    """Log-uniform."""
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def by_scipy(domain: str, d: Any, parameters: str) -> Case:
    return Case(domain, 1, lambda u: d.ppf(middle_of_cell(u[:, 0])), d.pdf, parameters)


# ---- Lines. The sentence of each family is its documentation, and is printed by `families`.


def beta(rng: np.random.Generator) -> Case:
    """Beta on [0, 1], with singular and with smooth ends."""
    a, b = log_uniform(rng, 0.4, 8), log_uniform(rng, 0.4, 8)
    return by_scipy("line:0,1", stats.beta(a, b), f"a={a:.4g} b={b:.4g}")


def exponential(rng: np.random.Generator) -> Case:
    """Exponential from 0 or another end, with mean free paths from 0.001 to 1000."""
    scale, end = log_uniform(rng, 1e-3, 1e3), float(rng.choice([0, 2.5, -10]))
    return by_scipy(f"line:{end:g},inf", stats.expon(end, scale), f"scale={scale:.4g} end={end:g}")


def gamma(rng: np.random.Generator) -> Case:
    """Gamma, with a singular end if its shape is below 1."""
    a, scale = log_uniform(rng, 0.5, 8), log_uniform(rng, 0.1, 10)
    return by_scipy("line:0,inf", stats.gamma(a, scale=scale), f"a={a:.4g} scale={scale:.4g}")


def weibull(rng: np.random.Generator) -> Case:
    """Weibull, with a singular end if its shape is below 1."""
    c, scale = log_uniform(rng, 0.6, 5), log_uniform(rng, 0.1, 10)
    return by_scipy("line:0,inf", stats.weibull_min(c, scale=scale), f"c={c:.4g} scale={scale:.4g}")


def lognormal(rng: np.random.Generator) -> Case:
    """Log-normal, narrow to heavy-tailed."""
    s, scale = log_uniform(rng, 0.1, 2), log_uniform(rng, 0.1, 10)
    return by_scipy("line:0,inf", stats.lognorm(s, scale=scale), f"s={s:.4g} scale={scale:.4g}")


def pareto(rng: np.random.Generator) -> Case:
    """Pareto, with and without a mean."""
    b, scale = log_uniform(rng, 0.5, 5), log_uniform(rng, 0.1, 10)
    return by_scipy(f"line:{scale!r},inf", stats.pareto(b, scale=scale), f"b={b:.4g} scale={scale:.4g}")


def normal(rng: np.random.Generator) -> Case:
    """Normal on the whole line."""
    at, scale = rng.uniform(-20, 20), log_uniform(rng, 1e-2, 1e2)
    return by_scipy("line:-inf,inf", stats.norm(at, scale), f"loc={at:.4g} scale={scale:.4g}")


def student(rng: np.random.Generator) -> Case:
    """Student's t on the whole line."""
    df, at = log_uniform(rng, 1.2, 20), rng.uniform(-3, 3)
    return by_scipy("line:-inf,inf", stats.t(df, at), f"df={df:.4g} loc={at:.4g}")


def cauchy(rng: np.random.Generator) -> Case:
    """Cauchy on the whole line, and its half on a line to infinity."""
    at, scale, half = rng.uniform(-3, 3), log_uniform(rng, 1e-2, 1e2), rng.random() < 0.5
    d = stats.halfcauchy(at, scale) if half else stats.cauchy(at, scale)
    return by_scipy(f"line:{at!r},inf" if half else "line:-inf,inf", d, f"loc={at:.4g} scale={scale:.4g} half={half}")


def uniform(rng: np.random.Generator) -> Case:
    """Uniform on an interval, or on a part of it where p is above 0."""
    a, length, part = rng.uniform(-5, 5), log_uniform(rng, 0.01, 100), rng.choice([1, 0.3])
    d = stats.uniform(a, part * length)
    return by_scipy(f"line:{a!r},{a + length!r}", d, f"a={a:.4g} length={length:.4g} part={part:g}")


def cut_line(rng: np.random.Generator) -> Case:
    """A normal or an exponential cut to an interval: a normal by the end that is far from its tails."""
    a, length = rng.uniform(-2, 1), rng.uniform(0.5, 3)
    if rng.random() < 0.5:
        d = stats.truncnorm(a, a + length)
        return by_scipy(f"line:{a!r},{a + length!r}", d, f"normal a={a:.4g} length={length:.4g}")
    d = stats.truncexpon(length, a)
    return by_scipy(f"line:{a!r},{a + length!r}", d, f"exponential a={a:.4g} length={length:.4g}")


def mixture(rng: np.random.Generator) -> Case:
    """Three normals of widths from 0.01 to 3 on the whole line; the first random number is used for both choices."""
    share, at = rng.dirichlet([1, 1, 1]), rng.uniform(-10, 10, 3)
    scale = np.exp(rng.uniform(np.log(0.01), np.log(3), 3))
    before = np.cumsum(share)

    def draw(u: Array) -> Array:
        k = np.minimum(np.searchsorted(before, u[:, 0], side="right"), 2)
        return at[k] + scale[k] * special.ndtri(middle_of_cell((u[:, 0] - before[k] + share[k]) / share[k]))

    def density(x: Array) -> Array:
        z = (x[:, None] - at) / scale
        return np.exp(-z * z / 2) @ (share / scale) / np.sqrt(2 * np.pi)

    return Case("line:-inf,inf", 1, draw, density, f"share={share.round(3)} loc={at.round(2)} scale={scale.round(3)}")


# ---- Sets.


def by_table(p: Array, parameters: str) -> Case:
    cdf = np.cumsum(p / p.sum())
    p, last = p / p.sum(), int(np.flatnonzero(p)[-1])
    draw = lambda u: np.minimum(np.searchsorted(cdf, u[:, 0], side="right"), last)  # noqa: E731
    return Case(f"set:{len(p)}", 1, draw, lambda i: p[np.asarray(i).astype(int)], parameters)


def zipf(rng: np.random.Generator) -> Case:
    """Zipf's law cut to a set."""
    n, s = int(log_uniform(rng, 2, 1e4)), rng.uniform(0.3, 2.5)
    return by_table(np.arange(1, n + 1) ** -s, f"n={n} s={s:.4g}")


def poisson(rng: np.random.Generator) -> Case:
    """Poisson counts cut to a set."""
    mean = log_uniform(rng, 0.5, 300)
    n = int(mean + 6 * np.sqrt(mean) + 6)
    return by_table(stats.poisson(mean).pmf(np.arange(n)), f"n={n} mean={mean:.4g}")


def binomial(rng: np.random.Generator) -> Case:
    """Binomial counts."""
    n, p = int(log_uniform(rng, 1, 1000)), rng.uniform(0.05, 0.95)
    return by_table(stats.binom(n, p).pmf(np.arange(n + 1)), f"n={n} p={p:.4g}")


def weights(rng: np.random.Generator) -> Array:
    """Random probabilities of 2 to 10^4 entries; some tables have zeros."""
    w = rng.gamma(log_uniform(rng, 0.3, 5), size=int(log_uniform(rng, 2, 1e4))) + 1e-6
    if rng.random() < 0.3:
        w *= rng.random(len(w)) < 0.8
        w[rng.integers(len(w))] = 1
    return w / w.sum()


def table(rng: np.random.Generator) -> Case:
    """A random table by search, in some with zeros."""
    p = weights(rng)
    return by_table(p, f"n={len(p)} zeros={int((p == 0).sum())}")


def alias_table(p: Array) -> tuple[Array, Array]:
    """Vose 1991: the share of each cell that is its own, and the entry of the rest."""
    n = len(p)
    scaled, own, other = p * n, np.ones(n), np.arange(n)
    small, large = [i for i in range(n) if scaled[i] < 1], [i for i in range(n) if scaled[i] >= 1]
    while small and large:
        s, g = small.pop(), large.pop()
        own[s], other[s] = scaled[s], g
        scaled[g] -= 1 - scaled[s]
        (small if scaled[g] < 1 else large).append(g)
    for i in small:  # 1 but for rounding
        own[i] = 1
    return own, other


def by_alias(rng: np.random.Generator, numbers: int) -> Case:
    p = weights(rng)
    own, other = alias_table(p)

    def draw(u: Array) -> Array:
        at = u[:, 0] * len(p)
        k = np.minimum(at.astype(int), len(p) - 1)
        return np.where((u[:, 1] if numbers == 2 else at - k) < own[k], k, other[k])

    return Case(f"set:{len(p)}", numbers, draw, lambda i: p[np.asarray(i).astype(int)], f"n={len(p)}")


def alias_one(rng: np.random.Generator) -> Case:
    """An alias table by one random number, which chooses the cell and, by its rest, the entry."""
    return by_alias(rng, 1)


def alias_two(rng: np.random.Generator) -> Case:
    """An alias table by two random numbers."""
    return by_alias(rng, 2)


def pairs(rng: np.random.Generator) -> Case:
    """A product of two sets: a row, and an entry of it."""
    n, m = (int(v) for v in rng.integers(2, 60, 2))
    p = rng.dirichlet(np.full(n * m, 1.5)).reshape(n, m)
    row = p.sum(1)
    cdf, cdf_row = np.cumsum(row), np.cumsum(p / row[:, None], axis=1)

    def draw(u: Array) -> Array:
        i = np.minimum(np.searchsorted(cdf, u[:, 0], side="right"), n - 1)
        return np.column_stack([i, np.minimum((cdf_row[i] <= u[:, 1:]).sum(1), m - 1)])

    def density(x: Array) -> Array:
        return p[x[:, 0].astype(int), x[:, 1].astype(int)]

    return Case(f"set:{n} x set:{m}", 2, draw, density, f"n={n} m={m}")


# ---- Areas and volumes.


def dirichlet(rng: np.random.Generator) -> Case:
    """Dirichlet on the triangle by two betas."""
    a = np.exp(rng.uniform(np.log(0.6), np.log(5), 3))
    first, second = stats.beta(a[0], a[1] + a[2]), stats.beta(a[1], a[2])

    def draw(u: Array) -> Array:
        b0 = first.ppf(middle_of_cell(u[:, 0]))
        return np.column_stack([b0, (1 - b0) * second.ppf(middle_of_cell(u[:, 1]))])

    def density(b: Array) -> Array:
        b = np.column_stack([b[:, 0], b[:, 1], np.maximum(1 - b[:, 0] - b[:, 1], 1e-300)])
        return np.exp(special.xlogy(a - 1, b).sum(1) + special.gammaln(a.sum()) - special.gammaln(a).sum())

    return Case("triangle", 2, draw, density, f"a={a.round(4)}")


def triangle(rng: np.random.Generator) -> Case:
    """Uniform on the triangle, by Turk's root or by folding the unit square."""
    fold = rng.random() < 0.5

    def draw(u: Array) -> Array:
        if fold:
            return np.where(u.sum(1, keepdims=True) > 1, 1 - u, u)
        root = np.sqrt(u[:, 0])
        return np.column_stack([1 - root, root * u[:, 1]])

    return Case("triangle", 2, draw, lambda b: np.full(len(b), 2.0), f"fold={fold}")


def by_betas(rng: np.random.Generator, domain: str, count: int) -> Case:
    ds = [stats.beta(log_uniform(rng, 0.6, 5), log_uniform(rng, 0.6, 5)) for _ in range(count)]
    return Case(
        domain,
        count,
        lambda u: np.column_stack([d.ppf(middle_of_cell(u[:, k])) for k, d in enumerate(ds)]),
        lambda x: np.prod([d.pdf(np.clip(x[:, k], 1e-300, 1 - 1e-16)) for k, d in enumerate(ds)], axis=0),
        " ".join(f"({d.args[0]:.4g}, {d.args[1]:.4g})" for d in ds),
    )


def square(rng: np.random.Generator) -> Case:
    """A product of betas on the square."""
    return by_betas(rng, "square", 2)


def cube(rng: np.random.Generator) -> Case:
    """A product of betas in the cube."""
    return by_betas(rng, "cube", 3)


def polar(r: Array, phi: Array) -> Array:
    return np.column_stack([r * np.cos(phi), r * np.sin(phi)])


def disk(rng: np.random.Generator) -> Case:
    """Uniform on the disk by polar coordinates."""
    turn = rng.uniform(0, 2 * np.pi)
    draw = lambda u: polar(np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1] + turn)  # noqa: E731
    return Case("disk", 2, draw, lambda x: np.full(len(x), 1 / np.pi), f"turn={turn:.4g}")


def concentric(rng: np.random.Generator) -> Case:
    """Uniform on the disk by the concentric map of Shirley and Chiu 1997."""

    def draw(u: Array) -> Array:
        a, b = 2 * u[:, 0] - 1, 2 * u[:, 1] - 1
        wide = np.abs(a) > np.abs(b)
        r = np.where(wide, a, b)
        quotient = np.where(wide, b, a) / np.where(r == 0, 1, r)
        return polar(r, np.where(wide, np.pi / 4 * quotient, np.pi / 2 - np.pi / 4 * quotient))

    return Case("disk", 2, draw, lambda x: np.full(len(x), 1 / np.pi))


def gaussian_disk(rng: np.random.Generator) -> Case:
    """A normal about the centre, cut to the disk, and lens falloffs (1 - r^2)^n."""
    if rng.random() < 0.5:
        s2 = log_uniform(rng, 0.02, 2)
        share = -np.expm1(-0.5 / s2)
        draw = lambda u: polar(np.sqrt(-2 * s2 * np.log1p(-share * u[:, 0])), 2 * np.pi * u[:, 1])  # noqa: E731
        density = lambda x: np.exp(-(x * x).sum(1) / (2 * s2)) / (2 * np.pi * s2 * share)  # noqa: E731
        return Case("disk", 2, draw, density, f"s2={s2:.4g}")
    n = rng.uniform(0.2, 6)
    draw = lambda u: polar(np.sqrt(1 - (1 - u[:, 0]) ** (1 / (n + 1))), 2 * np.pi * u[:, 1])  # noqa: E731
    density = lambda x: (n + 1) / np.pi * np.maximum(1 - (x * x).sum(1), 0) ** n  # noqa: E731
    return Case("disk", 2, draw, density, f"n={n:.4g}")


# ---- Products.


def direction(z: Array, phi: Array) -> Array:
    r = np.sqrt(np.maximum(0, 1 - z * z))
    return np.column_stack([r * np.cos(phi), r * np.sin(phi), z])


def flight(rng: np.random.Generator) -> Case:
    """A direction by Henyey and Greenstein, and a distance whose mean free path depends on it."""
    g, rate, by = rng.uniform(-0.8, 0.8), log_uniform(rng, 0.05, 20), rng.uniform(-0.8, 0.8)

    def draw(u: Array) -> Array:
        s = (1 - g * g) / (1 - g + 2 * g * u[:, 0])
        z = np.clip((1 + g * g - s * s) / (2 * g), -1, 1)
        return np.column_stack([direction(z, 2 * np.pi * u[:, 1]), -np.log1p(-u[:, 2]) / (rate * (1 + by * z))])

    def density(x: Array) -> Array:
        z, sigma = x[:, 2], rate * (1 + by * x[:, 2])
        phase = (1 - g * g) / (4 * np.pi * (1 + g * g - 2 * g * z) ** 1.5)
        return phase * sigma * np.exp(-sigma * x[:, 3])

    return Case("sphere x line:0,inf", 3, draw, density, f"g={g:.4g} rate={rate:.4g} by={by:.4g}")


def lobes(rng: np.random.Generator) -> Case:
    """A lobe of 2 to 7, and a direction by its power of the cosine."""
    k = int(rng.integers(2, 8))
    share, power = rng.dirichlet(np.full(k, 2.0)), np.exp(rng.uniform(0, np.log(100), k)) - 1
    cdf = np.cumsum(share)

    def draw(u: Array) -> Array:
        i = np.minimum(np.searchsorted(cdf, u[:, 0], side="right"), k - 1)
        return np.column_stack([i, direction(u[:, 1] ** (1 / (power[i] + 1)), 2 * np.pi * u[:, 2])])

    def density(x: Array) -> Array:
        i = x[:, 0].astype(int)
        return share[i] * (power[i] + 1) / (2 * np.pi) * np.maximum(x[:, 3], 0) ** power[i]

    return Case(f"set:{k} x hemisphere", 3, draw, density, f"share={share.round(3)} power={power.round(2)}")


def two_lines(rng: np.random.Generator) -> Case:
    """A time by an exponential, and a place by a normal whose width grows with it."""
    rate, width = log_uniform(rng, 0.1, 10), log_uniform(rng, 0.1, 3)
    spread = lambda t: width * np.sqrt(0.1 + rate * t)  # noqa: E731

    def draw(u: Array) -> Array:
        t = -np.log1p(-u[:, 0]) / rate
        return np.column_stack([t, spread(t) * special.ndtri(middle_of_cell(u[:, 1]))])

    def density(x: Array) -> Array:
        s = spread(x[:, 0])
        z = x[:, 1] / s
        return rate * np.exp(-rate * x[:, 0] - z * z / 2) / (s * np.sqrt(2 * np.pi))

    return Case("line:0,inf x line:-inf,inf", 2, draw, density, f"rate={rate:.4g} width={width:.4g}")


def wavelengths(rng: np.random.Generator) -> Case:
    """An emitter of a set, and a wavelength from 380 to 720 nm about its own."""
    k = int(rng.integers(2, 30))
    share, at, width = rng.dirichlet(np.ones(k)), rng.uniform(400, 700, k), rng.uniform(10, 120, k)
    cdf, low, high = np.cumsum(share), special.ndtr((380 - at) / width), special.ndtr((720 - at) / width)

    def draw(u: Array) -> Array:
        i = np.minimum(np.searchsorted(cdf, u[:, 0], side="right"), k - 1)
        x = at[i] + width[i] * special.ndtri(low[i] + (high[i] - low[i]) * middle_of_cell(u[:, 1]))
        return np.column_stack([i, np.clip(x, 380, 720)])

    def density(x: Array) -> Array:
        i = x[:, 0].astype(int)
        z = (x[:, 1] - at[i]) / width[i]
        return share[i] * np.exp(-z * z / 2) / (np.sqrt(2 * np.pi) * width[i] * (high[i] - low[i]))

    return Case(f"set:{k} x line:380,720", 2, draw, density, f"k={k}")


FAMILIES: tuple[Callable[[np.random.Generator], Case], ...] = (
    *(beta, exponential, gamma, weibull, lognormal, pareto, normal, student, cauchy, uniform, cut_line, mixture),
    *(zipf, poisson, binomial, table, alias_one, alias_two, pairs),
    *(dirichlet, triangle, square, cube, disk, concentric, gaussian_disk),
    *(flight, lobes, two_lines, wavelengths),
)


# ---- Charts: coordinates in [0, 1) in which a uniform point of the domain is uniform.


def lines_of(domain: str, x: Array) -> list[Any]:
    """For each part an infinite line's chart, fitted to draws as `check` fits it; else None."""
    out, column = [], 0
    for part in domain.split(" x "):
        chart = _crescent.domain_chart(part)
        if chart.infinite:
            chart.fit(np.ascontiguousarray(x[:, column : column + 1]))
        out.append(chart if chart.infinite else None)
        column += chart.coordinates
    return out


class Chart:
    """A domain's parts as the unit cube; entries of sets are spread evenly, and infinite lines have equal masses."""

    def __init__(self, case: Case, rng: np.random.Generator) -> None:
        self.domain, self.rng = case.domain, rng
        x = rows(case.draw(rng.random((2**14, case.numbers))))
        self.parts = list(zip(case.domain.split(" x "), lines_of(case.domain, x), strict=True))

    @staticmethod
    def ends(part: str) -> tuple[float, float]:
        low, high = part[5:].split(",")
        return float(low), float(high)

    def to(self, x: Array, spread: Array) -> Array:
        out, c = [], 0
        for part, chart in self.parts:
            kind = part.split(":")[0]
            a = x[:, c]
            if kind in ("sphere", "hemisphere"):
                z = x[:, c + 2]
                out += [(1 - z) / 2 if kind == "sphere" else 1 - z, np.arctan2(x[:, c + 1], a) / (2 * np.pi) % 1]
            elif kind == "disk":
                out += [a * a + x[:, c + 1] ** 2, np.arctan2(x[:, c + 1], a) / (2 * np.pi) % 1]
            elif kind == "triangle":
                out += [(1 - a) ** 2, x[:, c + 1] / np.maximum(1 - a, 1e-300)]
            elif kind == "set":
                out.append((a + spread) / int(part[4:]))
            elif kind == "line" and chart:
                w, _ = chart.directions(np.ascontiguousarray(a[:, None]), np.full((len(a), 1), 0.5))
                out.append((1 - w[:, 2]) / 2)
            elif kind == "line":
                low, high = self.ends(part)
                out.append((a - low) / (high - low))
            else:
                out += [x[:, c + k] for k in range(2 if kind == "square" else 3)]
            c += 3 if kind in ("sphere", "hemisphere", "cube") else 2 if kind in ("disk", "triangle", "square") else 1
        return np.column_stack(out)

    def of(self, y: Array) -> Array:
        out: list[Array] = []
        d = 0
        for part, chart in self.parts:
            kind = part.split(":")[0]
            a = y[:, d]
            if kind in ("sphere", "hemisphere"):
                out += list(direction(1 - 2 * a if kind == "sphere" else 1 - a, 2 * np.pi * y[:, d + 1]).T)
            elif kind == "disk":
                out += list(polar(np.sqrt(a), 2 * np.pi * y[:, d + 1]).T)
            elif kind == "triangle":
                out += [1 - np.sqrt(a), np.sqrt(a) * y[:, d + 1]]
            elif kind == "set":
                out.append(np.minimum(np.floor(a * int(part[4:])), int(part[4:]) - 1))
            elif kind == "line" and chart:
                x, _ = chart.points(np.ascontiguousarray(direction(1 - 2 * a, np.full(len(a), 1.0))))
                out.append(x[:, 0])
            elif kind == "line":
                low, high = self.ends(part)
                out.append(np.clip(low + (high - low) * a, low, high))
            else:
                out += [y[:, d + k] for k in range(2 if kind == "square" else 3)]
            d += 1 if kind in ("line", "set") else 3 if kind == "cube" else 2
        return as_points(np.column_stack(out), self.domain)

    @property
    def dimensions(self) -> int:
        of = {"line": 1, "set": 1, "cube": 3}
        return sum(of.get(part.split(":")[0], 2) for part, _ in self.parts)


def rows(x: Array) -> Array:
    x = np.asarray(x, float)
    return x[:, None] if x.ndim == 1 else x


def as_points(x: Array, domain: str) -> Array:
    if x.shape[1] == 1:
        x = x[:, 0]
    return x.astype(int) if domain.startswith("set") and " x " not in domain else x


# ---- Faults: other draws with the density of the case, or another density.


def more_numbers(u: Array, count: int) -> Array:
    """Random numbers of the sampler's own, which it declares: those of a function of u would jump at every step of u."""
    return _OWN.random((len(u), count))


_OWN = np.random.default_rng(17)


@dataclass(frozen=True)
class Fault:
    """A faulty sampler, with the causes that are true of it."""

    case: Case
    true: str = ""  # a regular expression; "": no cause can be named
    size: float = 0
    where: str = ""


def with_draws(
    case: Case, draw: Callable[[Array], Array], true: str = "", size: float = 0, where: str = "", own: bool = False
) -> Fault:
    """own: it uses more_numbers()."""
    return Fault(replace(case, draw=draw, own_random=case.own_random or own), true, size, where)


def constant(case: Case, size: float, rng: np.random.Generator) -> Fault:
    return Fault(replace(case, density=lambda x: case.density(x) * (1 + size)), r"constant|factor|times|divided", size)


def leak(case: Case, size: float, rng: np.random.Generator) -> Fault | None:
    """None: p is uniform."""
    chart = Chart(case, rng)
    p = case.density(chart.of(rng.random((64, chart.dimensions))))
    if np.ptp(p) <= 1e-9 * p.max():
        return None

    def draw(u: Array) -> Array:
        x, v = case.draw(u), more_numbers(u, 1 + chart.dimensions)
        at = v[:, 0] < size
        x = np.array(x)
        x[at] = chart.of(v[at, 1:])
        return x

    return with_draws(case, draw, r"uniform|even", size, own=True)


def draw_again(case: Case, keep: Callable[[Array, Array], Array]) -> Callable[[Array], Array]:
    """Draws again where keep(points, random number) is false."""

    def draw(u: Array) -> Array:
        x = np.array(case.draw(u))
        again = np.flatnonzero(~keep(x, more_numbers(u, 1)[:, 0]))
        for _ in range(60):
            if len(again) == 0:
                break
            v = more_numbers(u[again], case.numbers + 1)
            x[again] = case.draw(np.asfortranarray(np.floor(v[:, :-1] * 2**24) / 2**24))
            again = again[~keep(x[again], v[:, -1])]
        return x

    return draw


def gap(case: Case, size: float, rng: np.random.Generator) -> Fault | None:
    """A box about a draw, in the coordinates of the chart, with this share of p. None: entries are too coarse."""
    chart = Chart(case, rng)
    x = case.draw(rng.random((2**18, case.numbers)))
    y = chart.to(rows(x), np.full(len(x), 0.5))
    far = np.abs(y - y[0]).max(1)
    width = float(np.quantile(far, size))
    mass = float((far <= width).mean())
    if not 0.8 * size < mass < 1.3 * size:
        return None
    keep = lambda x, _: np.abs(chart.to(rows(x), np.full(len(x), 0.5)) - y[0]).max(1) > width  # noqa: E731
    return with_draws(case, draw_again(case, keep), r"never drawn|not drawn", size, f"about {x[0]}", own=True)


def shift(case: Case, size: float, rng: np.random.Generator) -> Fault:
    """Along every second dimension from the first or the second on, by a share of its range."""
    chart = Chart(case, rng)
    from_first = chart.dimensions == 1 or rng.random() < 0.5

    def draw(u: Array) -> Array:
        y = chart.to(rows(case.draw(u)), more_numbers(u, 1)[:, 0])
        at = np.s_[:, (0 if from_first else 1) :: 2]
        y[at] = 1 - np.abs(1 - y[at] - size)
        return chart.of(np.minimum(y, 1 - 2.0**-53))

    return with_draws(case, draw, r"shift|moved", size, "first" if from_first else "second", own=True)


def parameter(case: Case, size: float, rng: np.random.Generator) -> Fault:
    """Draws by p^(1 + size)."""
    pilot = case.draw(rng.random((2**16, case.numbers)))
    most = float(case.density(pilot).max())
    keep = lambda x, v: v < np.minimum(case.density(x) / most, 1) ** size  # noqa: E731
    return with_draws(case, draw_again(case, keep), r"exponent|power|multiplied", size, own=True)


def no_root(case: Case, size: float, rng: np.random.Generator) -> Fault:
    return with_draws(case, lambda u: case.draw(np.column_stack([u[:, 0] ** 2, u[:, 1]])), r"square root is missing")


def rate(case: Case, size: float, rng: np.random.Generator) -> Fault:
    """Distances from the end, or from 0, longer by this share."""
    part = case.domain.split(" x ")[-1]
    low, high = Chart.ends(part)
    end = low if np.isfinite(low) else 0.0

    def draw(u: Array) -> Array:
        x = np.array(case.draw(u))
        at = x if x.ndim == 1 else x[:, -1]
        at[:] = end + (at - end) * (1 + size)
        return x

    return with_draws(case, draw, r"multiplied|scale", size)


def exchanged(case: Case, size: float, rng: np.random.Generator) -> Fault:
    def draw(u: Array) -> Array:
        x = np.array(case.draw(u))
        x[:, [0, 1]] = x[:, [1, 0]]
        return x

    return with_draws(case, draw, r"exchanged")


def off_by_one(case: Case, size: float, rng: np.random.Generator) -> Fault:
    n = int(case.domain[4:])
    return with_draws(case, lambda u: (case.draw(u) + 1) % n, r"off by one")


def one_entry(case: Case, size: float, rng: np.random.Generator) -> Fault:
    """An entry, chosen by p, is drawn more rarely by this share; the one after the next is drawn instead."""
    n = int(case.domain[4:])
    entry = int(case.draw(rng.random((1, case.numbers)))[0])
    p = float(case.density(np.array([entry]))[0])
    instead = (entry + 2) % n if n > 2 else (entry + 1) % n

    def draw(u: Array) -> Array:
        i = case.draw(u)
        return np.where((i == entry) & (more_numbers(u, 1)[:, 0] < size), instead, i)

    return with_draws(case, draw, "", size, f"entry {entry} p={p:.3g} instead {instead}", own=True)


FAULTS: tuple[tuple[str, Callable[..., Fault | None], tuple[float, ...], tuple[Any, ...]], ...] = (
    ("square root missing", no_root, (0,), (disk, gaussian_disk)),
    ("rate", rate, (0.02, 0.05, 0.1), (exponential, gamma, weibull, lognormal, pareto, flight)),
    ("coordinates exchanged", exchanged, (0,), (square, cube, dirichlet)),
    ("off by one", off_by_one, (0,), (zipf, poisson, binomial, table, alias_two)),
    ("an entry drawn too rarely", one_entry, (0.1, 0.25, 0.5), (zipf, poisson, binomial, table, alias_one)),
    ("constant", constant, (0.005, 0.02), FAMILIES),
    ("leak", leak, (0.03,), (beta, uniform, cut_line, table, dirichlet, square, cube, gaussian_disk, lobes, pairs)),
    ("gap", gap, (0.01,), FAMILIES),
    ("shift", shift, (0.01,), FAMILIES),
)
SIZES: dict[str, Callable[..., Fault | None]] = {
    "constant": constant,
    "leak": leak,
    "gap": gap,
    "shift": shift,
    "parameter": parameter,
}


# ---- Checks.


def run_check(case: Case, seed: int, full: bool = False, with_f: bool = False) -> Any:
    f = (lambda x: case.density(x) * (1 + 0.5 * np.sin(rows(x).sum(1)))) if with_f else None
    known = {"domain": case.domain, "numbers": case.numbers, "own_random": case.own_random, "wo": "none"}
    return crescent.check(case.sample, case.density, f, seed=seed, full=full, threads=1, **known)


def record(result: Any, **of: Any) -> dict[str, Any]:
    not_right = [v for v in result.verdicts if v.state not in ("right", "skipped")]
    return {
        **of,
        "state": result.state,
        "evaluations": result.questions,
        "verdicts": {v.name: v.state for v in not_right},
        "message": [v.message + v.status for v in not_right],
        "causes": sorted({v.cause for v in result.verdicts if v.cause and v.state == "wrong"}),
    }


def make_case(family: Callable[..., Case], what: str, seed: int, number: int) -> tuple[Case, np.random.Generator, int]:
    key = [zlib.crc32(what.encode()), seed, number]
    rng = np.random.default_rng(key)
    return family(rng), rng, int(rng.integers(1, 2**31))


def check_right(seed: int, number: int, full: bool) -> list[dict[str, Any]]:
    family = FAMILIES[number % len(FAMILIES)]
    case, rng, of_check = make_case(family, "right", seed, number)
    with_f = bool(rng.random() < 0.5)
    of = {"set": "right", "case": number, "family": family.__name__, "parameters": case.parameters}
    return [record(run_check(case, of_check, full, with_f), **of, domain=case.domain, f=with_f)]


def check_fault(fault_case: Fault, of_check: int, full: bool, **of: Any) -> dict[str, Any]:
    out = record(run_check(fault_case.case, of_check, full), **of, size=fault_case.size, where=fault_case.where)
    out["true"] = [c for c in out["causes"] if fault_case.true and re.search(fault_case.true, c)]
    return out


KINDS = [(name, make, size, families) for name, make, sizes, families in FAULTS for size in sizes]


def check_faults(seed: int, number: int, full: bool) -> list[dict[str, Any]]:
    name, make, size, families = KINDS[number % len(KINDS)]
    family = families[number // len(KINDS) % len(families)]
    case, rng, of_check = make_case(family, "faults", seed, number)
    fault = make(case, size, rng)
    if fault is None:
        return []
    of = {"set": "faults", "case": number, "family": family.__name__, "parameters": case.parameters, "fault": name}
    return [check_fault(fault, of_check, full, **of)]


def check_stated(seed: int, number: int, full: bool) -> list[dict[str, Any]]:
    family = FAMILIES[number % len(FAMILIES)]
    case, rng, of_check = make_case(family, "stated", seed, number)
    case = replace(case, own_random=True)  # as the faults are, so that the sizes are of the same tests
    result = run_check(case, of_check, full)
    sizes: dict[str, float] = {}
    for v in result.verdicts:
        sizes |= v.evidence.get("would_have_found", {})
    of = {"set": "stated", "case": number, "family": family.__name__, "parameters": case.parameters}
    out = [record(result, **of, fault="none", stated=sizes)]
    for name, make in SIZES.items():
        if not 0 < sizes.get(name, 0) < 1 or (fault := make(case, sizes[name], rng)) is None:
            continue
        out.append(check_fault(fault, of_check + 1, full, **of, fault=name))
    return out


# ---- Mitsuba 3, whose own tests of these functions are not used.


def mitsuba_cases() -> list[tuple[str, Case]]:
    import mitsuba as mi

    mi.set_variant("scalar_rgb")
    mi.set_variant("llvm_ad_rgb" if "llvm_ad_rgb" in mi.variants() else "scalar_rgb")
    warp, two = mi.warp, lambda u: mi.Point2f(np.float32(u[:, 0]), np.float32(u[:, 1]))

    def array(x: Any) -> Array:
        x = np.array(x, float)
        return x.T if x.ndim == 2 else x

    def warp_case(name: str, domain: str, argument: float | None = None) -> tuple[str, Case]:
        arguments = () if argument is None else (argument,)
        to, density = getattr(warp, "square_to_" + name), getattr(warp, f"square_to_{name}_pdf")
        point = mi.Vector3f if domain in ("sphere", "hemisphere") else mi.Point2f

        def pdf(x: Array) -> Array:
            return np.broadcast_to(array(density(point(*np.float32(x).T), *arguments)), len(x))

        return name, Case(domain, 2, lambda u: array(to(two(u), *arguments)), pdf)

    out = [
        warp_case("uniform_disk", "disk"),
        warp_case("uniform_disk_concentric", "disk"),
        warp_case("uniform_triangle", "triangle"),
        warp_case("uniform_sphere", "sphere"),
        warp_case("uniform_hemisphere", "hemisphere"),
        warp_case("cosine_hemisphere", "hemisphere"),
        warp_case("beckmann", "hemisphere", 0.3),
        warp_case("von_mises_fisher", "sphere", 10.0),
    ]
    rng = np.random.default_rng(3)
    for n in (2, 37, 1000):
        w = np.float32(rng.random(n) + 0.01)
        d = mi.DiscreteDistribution(w)
        out.append(
            (
                f"DiscreteDistribution of {n}",
                Case(
                    f"set:{n}",
                    1,
                    lambda u, d=d: np.array(d.sample(mi.Float(np.float32(u[:, 0])))).astype(int),
                    lambda i, d=d: np.array(d.eval_pmf_normalized(mi.UInt32(np.asarray(i).astype(np.uint32))), float),
                ),
            )
        )
        c = mi.ContinuousDistribution(mi.ScalarVector2f(380, 720), w)
        out.append(
            (
                f"ContinuousDistribution of {n}",
                Case(
                    "line:380,720",
                    1,
                    lambda u, c=c: np.clip(np.array(c.sample(mi.Float(np.float32(u[:, 0]))), float), 380, 720),
                    lambda x, c=c: np.array(c.eval_pdf_normalized(mi.Float(np.float32(x))), float),
                ),
            )
        )
    for extinction in (0.3, 1.7, 25.0):
        out.append((f"homogeneous medium, {extinction} / m", medium_case(mi, extinction)))
    return out


def medium_case(mi: Any, extinction: float) -> Case:
    """The distances that a homogeneous medium samples along a ray that nothing else ends."""
    import drjit as dr

    medium = mi.load_dict({"type": "homogeneous", "sigma_t": extinction, "albedo": 0.8})

    def sample(u: Array) -> Array:
        ray = mi.Ray3f(mi.Point3f(dr.zeros(mi.Float, len(u)), 0, 0), mi.Vector3f(0, 0, 1))
        number = mi.Float(np.ascontiguousarray(u[:, 0], np.float32))
        return np.array(medium.sample_interaction(ray, number, mi.UInt32(0), mi.Bool(True)).t, float)

    def pdf(distance: Array) -> Array:
        at = dr.zeros(mi.MediumInteraction3f, len(distance))
        at.t = mi.Float(np.ascontiguousarray(distance, np.float32))
        at.combined_extinction = mi.Color3f(extinction)
        end = dr.zeros(mi.SurfaceInteraction3f, len(distance))
        end.t = dr.inf
        return np.array(medium.transmittance_eval_pdf(at, end, mi.Bool(True))[1].x, float)

    return Case("line:0,inf", 1, sample, pdf)


def check_mitsuba(seed: int, number: int, full: bool) -> list[dict[str, Any]]:
    cases = mitsuba_cases()
    if number >= len(cases):
        return []
    name, case = cases[number]
    return [record(run_check(case, seed, full), set="mitsuba", case=number, family=name, parameters="")]


# ---- Tables.


def bounds(k: int, n: int) -> tuple[float, float]:
    """Clopper and Pearson, one-sided, 95 %."""
    return (stats.beta.ppf(0.05, k, n - k + 1) if k else 0.0), (stats.beta.ppf(0.95, k + 1, n - k) if k < n else 1.0)


def print_table(records: list[dict[str, Any]]) -> None:
    for what in ("right", "mitsuba"):
        of = [r for r in records if r["set"] == what]
        if not of:
            continue
        print(f"| {what} | cases | wrong | inconclusive |\n|---|---|---|---|")
        for family in (*dict.fromkeys(r["family"] for r in of), None):
            rs = [r for r in of if family in (r["family"], None)]
            count = {s: sum(r["state"] == s for r in rs) for s in ("wrong", "error", "inconclusive")}
            print(f"| {family or 'all'} | {len(rs)} | {count['wrong'] + count['error']} | {count['inconclusive']} |")
        wrong = sum(r["state"] in ("wrong", "error") for r in of)
        print(f"\nAt most {100 * bounds(wrong, len(of))[1]:.2g} % are reported wrong (95 %).\n")
    of = [r for r in records if r["set"] == "faults"]
    if of:
        print("| fault | size | found | a true cause | another cause |\n|---|---|---|---|---|")
        for name, size in dict.fromkeys((r["fault"], r["size"]) for r in of):
            rs = [r for r in of if (r["fault"], r["size"]) == (name, size)]
            found = [r for r in rs if r["state"] == "wrong"]
            true = sum(bool(r["true"]) for r in found)
            false = sum(bool(r["causes"]) and not r["true"] for r in found)
            print(f"| {name} | {size or ''} | {len(found)} of {len(rs)} | {true} | {false} |")
        print()
    of = [r for r in records if r["set"] == "stated" and r["fault"] != "none"]
    if of:
        print("| fault of the stated size | cases | median size | found | lower bound |\n|---|---|---|---|---|")
        for name in SIZES:
            rs = [r for r in of if r["fault"] == name]
            k = sum(r["state"] == "wrong" for r in rs)
            middle = float(np.median([r["size"] for r in rs])) if rs else 0
            print(f"| {name} | {len(rs)} | {middle:.3g} | {k} | {bounds(k, len(rs))[0] if rs else 0:.2f} |")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("set", choices=["right", "faults", "stated", "mitsuba", "table", "families"])
    parser.add_argument("files", nargs="*", type=Path, help="of table: files of records")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--cases", default="0:30", metavar="FROM:TO")
    parser.add_argument("--full", action="store_true", help="checks in full mode")
    parser.add_argument("--out", type=Path, help="file to which a line for each check is appended")
    a = parser.parse_args()
    if a.set == "families":
        for family in FAMILIES:
            print(f"{family.__name__}: {family.__doc__}")
        return
    if a.set == "table":
        print_table([json.loads(line) for file in a.files for line in file.read_text().splitlines()])
        return
    run = {"right": check_right, "faults": check_faults, "stated": check_stated, "mitsuba": check_mitsuba}[a.set]
    records: list[dict[str, Any]] = []
    for number in range(*(int(v) for v in a.cases.split(":"))):
        new = run(a.seed, number, a.full)
        records += new
        if a.out:
            with a.out.open("a") as file:
                file.writelines(json.dumps(r) + "\n" for r in new)
        for r in new:
            if a.set in ("right", "mitsuba") and r["state"] != "right":
                print(json.dumps(r), file=sys.stderr, flush=True)
    print_table(records)


if __name__ == "__main__":
    main()
