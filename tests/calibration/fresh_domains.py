"""Right samplers of points that were written after everything in `check` was tuned: a set of their own for `domains.py`.

    python fresh_domains.py right --seed 81 --cases 0:660 --out right.jsonl
    python fresh_domains.py table right.jsonl

Not one of them was used to tune a limit.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import domains
import numpy as np
from domains import Array, Case, by_scipy, by_table, log_uniform, middle_of_cell, polar
from scipy import special, stats


def entry_of(cdf: Array, u: Array) -> Array:
    """The first entry whose cumulative probability is above u."""
    return np.minimum(np.searchsorted(cdf, u, side="right"), len(cdf) - 1)


def rest_of(u: Array, before: Array, share: Array) -> Array:
    """The random number that remains of one that chose an interval."""
    return np.clip((u - before) / share, 0, 1 - 2.0**-24)


def located(d: Callable[..., Any], rng: np.random.Generator) -> Case:
    loc, scale = rng.uniform(-5, 5), log_uniform(rng, 0.01, 50)
    return by_scipy("line:-inf,inf", d(loc, scale), f"loc={loc:.4g} scale={scale:.4g}")


def logistic(rng: np.random.Generator) -> Case:
    """Logistic on the whole line."""
    return located(stats.logistic, rng)


def laplace(rng: np.random.Generator) -> Case:
    """Laplace on the whole line, with a kink."""
    return located(stats.laplace, rng)


def gumbel(rng: np.random.Generator) -> Case:
    """Gumbel on the whole line, whose tails differ."""
    return located(stats.gumbel_r, rng)


def rayleigh(rng: np.random.Generator) -> Case:
    """Rayleigh, 0 at its end."""
    scale = log_uniform(rng, 1e-3, 1e3)
    return by_scipy("line:0,inf", stats.rayleigh(scale=scale), f"scale={scale:.4g}")


def maxwell_to_end(rng: np.random.Generator) -> Case:
    """Maxwell downwards from an end, on a line from -inf."""
    d, end = stats.maxwell(scale=log_uniform(rng, 1e-2, 1e2)), rng.uniform(-100, 100)
    draw = lambda u: end - d.ppf(middle_of_cell(u[:, 0]))  # noqa: E731
    return Case(f"line:-inf,{end!r}", 1, draw, lambda x: d.pdf(end - x), f"end={end:.4g}")


def inverse_gaussian(rng: np.random.Generator) -> Case:
    """Inverse Gaussian, narrow to heavy-tailed."""
    mean = log_uniform(rng, 0.1, 5)
    return by_scipy("line:0,inf", stats.invgauss(mean), f"mean={mean:.4g}")


def kumaraswamy(rng: np.random.Generator) -> Case:
    """Kumaraswamy on [0, 1], with singular and with smooth ends."""
    a, b = log_uniform(rng, 0.5, 6), log_uniform(rng, 0.5, 6)
    draw = lambda u: (1 - (1 - middle_of_cell(u[:, 0])) ** (1 / b)) ** (1 / a)  # noqa: E731

    def density(x: Array) -> Array:
        x = np.clip(x, 1e-300, 1 - 1e-16)
        return a * b * x ** (a - 1) * (1 - x**a) ** (b - 1)

    return Case("line:0,1", 1, draw, density, f"a={a:.4g} b={b:.4g}")


def tent(rng: np.random.Generator) -> Case:
    """A triangle's outline on an interval, as of a tent filter."""
    top, a, length = rng.random(), rng.uniform(-3, 3), log_uniform(rng, 0.1, 30)
    return by_scipy(f"line:{a!r},{a + length!r}", stats.triang(top, a, length), f"top={top:.4g}")


def equiangular(rng: np.random.Generator) -> Case:
    """Distances along a ray by the angle at a light (Kulla and Fajardo 2012)."""
    away, end, nearest = log_uniform(rng, 0.02, 5), log_uniform(rng, 0.5, 50), rng.uniform(-2, 20)
    low, high = np.arctan(-nearest / away), np.arctan((end - nearest) / away)
    draw = lambda u: np.clip(nearest + away * np.tan(low + (high - low) * u[:, 0]), 0, end)  # noqa: E731
    density = lambda t: away / ((high - low) * (away**2 + (t - nearest) ** 2))  # noqa: E731
    return Case(f"line:0,{end!r}", 1, draw, density, f"away={away:.4g} end={end:.4g} nearest={nearest:.4g}")


def histogram(rng: np.random.Generator) -> Case:
    """A histogram of 2 to 300 bins, some of them empty."""
    n = int(log_uniform(rng, 2, 300))
    p = rng.gamma(log_uniform(rng, 0.3, 4), size=n) * (rng.random(n) < rng.choice([1, 0.6]))
    p[rng.integers(n)] += 0.5
    p /= p.sum()
    cdf, last = np.cumsum(p), int(np.flatnonzero(p)[-1])
    a, length = rng.uniform(-3, 3), log_uniform(rng, 0.1, 300)

    def draw(u: Array) -> Array:
        k = np.minimum(entry_of(cdf, u[:, 0]), last)
        return a + length * np.minimum((k + rest_of(u[:, 0], cdf[k] - p[k], p[k])) / n, 1 - 1e-12)

    density = lambda x: p[np.clip(((x - a) / length * n).astype(int), 0, n - 1)] * n / length  # noqa: E731
    return Case(f"line:{a!r},{a + length!r}", 1, draw, density, f"n={n} empty={int((p == 0).sum())}")


def layers(rng: np.random.Generator) -> Case:
    """A free flight through 2 to 7 layers of their own extinction."""
    n = int(rng.integers(2, 8))
    rate = np.exp(rng.uniform(np.log(0.05), np.log(10), n))
    start = np.append(0, np.cumsum(np.exp(rng.uniform(np.log(0.05), np.log(2), n - 1))))
    depth = np.append(0, np.cumsum(rate[:-1] * np.diff(start)))

    def draw(u: Array) -> Array:
        optical = -np.log1p(-u[:, 0])
        k = np.searchsorted(depth, optical, side="right") - 1
        return start[k] + (optical - depth[k]) / rate[k]

    def density(x: Array) -> Array:
        k = np.searchsorted(start, x, side="right") - 1
        return rate[k] * np.exp(-depth[k] - rate[k] * (x - start[k]))

    return Case("line:0,inf", 1, draw, density, f"rate={rate.round(3)} start={start.round(3)}")


def channels(rng: np.random.Generator) -> Case:
    """A free flight by the extinction of one of 2 to 4 channels, with the density of all."""
    n = int(rng.integers(2, 5))
    rate, share = np.exp(rng.uniform(np.log(0.05), np.log(20), n)), rng.dirichlet(np.ones(n))
    cdf = np.cumsum(share)

    def draw(u: Array) -> Array:
        k = entry_of(cdf, u[:, 0])
        return -np.log1p(-rest_of(u[:, 0], cdf[k] - share[k], share[k])) / rate[k]

    density = lambda x: np.exp(-rate * x[:, None]) @ (share * rate)  # noqa: E731
    return Case("line:0,inf", 1, draw, density, f"rate={rate.round(3)} share={share.round(3)}")


def single_exponential(rng: np.random.Generator) -> Case:
    """An exponential in single precision."""
    rate = np.float32(log_uniform(rng, 0.01, 100))
    draw = lambda u: (-np.log1p(-u[:, 0].astype(np.float32)) / rate).astype(float)  # noqa: E731
    density = lambda x: (rate * np.exp(-rate * x.astype(np.float32))).astype(float)  # noqa: E731
    return Case("line:0,inf", 1, draw, density, f"rate={rate:.4g}")


def geometric(rng: np.random.Generator) -> Case:
    """Geometric, cut to 3 to 3000 entries."""
    n, q = int(log_uniform(rng, 3, 3000)), rng.uniform(0.5, 0.9999)
    return by_table(q ** np.arange(n) + 1e-300, f"n={n} q={q:.4g}")


def light_tree(rng: np.random.Generator) -> Case:
    """A light by a binary tree of powers, whose levels use the same random number."""
    depth = int(rng.integers(2, 13))
    powers = [rng.gamma(0.7, size=2**depth) + 1e-9]
    p = powers[0] / powers[0].sum()
    while len(powers[-1]) > 1:
        powers.append(powers[-1].reshape(-1, 2).sum(1))

    def draw(u: Array) -> Array:
        v, i = u[:, 0].copy(), np.zeros(len(u), int)
        for power in powers[-2::-1]:
            left = power[2 * i] / (power[2 * i] + power[2 * i + 1])
            right = v >= left
            v = np.where(right, (v - left) / np.maximum(1 - left, 1e-300), v / np.maximum(left, 1e-300))
            i = 2 * i + right
        return i

    return Case(f"set:{len(p)}", 1, draw, lambda i: p[np.asarray(i).astype(int)], f"depth={depth}")


def stream(rng: np.random.Generator) -> Case:
    """An entry of 2 to 6 by a reservoir that takes a random number for each."""
    n = int(rng.integers(2, 7))
    p = rng.dirichlet(np.ones(n))
    cdf = np.cumsum(p)

    def draw(u: Array) -> Array:
        kept = np.zeros(len(u), int)
        for i in range(1, n):
            kept = np.where(u[:, i] * cdf[i] < p[i], i, kept)
        return kept

    return Case(f"set:{n}", n, draw, lambda i: p[np.asarray(i).astype(int)], f"p={p.round(3)}")


def ring(rng: np.random.Generator) -> Case:
    """Uniform on a ring of the disk."""
    hole = rng.uniform(0.1, 0.9) ** 2
    draw = lambda u: polar(np.sqrt(hole + (1 - hole) * u[:, 0]), 2 * np.pi * u[:, 1])  # noqa: E731
    inside = lambda x: (x * x).sum(1) >= hole * (1 - 1e-12)  # noqa: E731
    return Case("disk", 2, draw, lambda x: inside(x) / (np.pi * (1 - hole)), f"hole={hole:.4g}")


def blades(rng: np.random.Generator) -> Case:
    """Uniform on an aperture of 3 to 9 blades."""
    n, turn = int(rng.integers(3, 10)), rng.uniform(0, 2 * np.pi)
    wedge = 2 * np.pi / n
    area = n / 2 * np.sin(wedge)

    def draw(u: Array) -> Array:
        k = np.minimum((u[:, 0] * n).astype(int), n - 1)
        v, r, begin = u[:, 0] * n - k, np.sqrt(u[:, 1]), turn + k * wedge
        return polar(r * (1 - v), begin) + polar(r * v, begin + wedge)

    def density(x: Array) -> Array:
        phi = (np.arctan2(x[:, 1], x[:, 0]) - turn) % wedge - wedge / 2
        return (np.hypot(x[:, 0], x[:, 1]) * np.cos(phi) <= np.cos(wedge / 2) * (1 + 1e-9)) / area

    return Case("disk", 2, draw, density, f"n={n}")


def off_centre(rng: np.random.Generator) -> Case:
    """Uniform on a smaller disk away from the centre."""
    radius = rng.uniform(0.2, 0.6)
    centre = polar(rng.uniform(0, 1 - radius, 1), rng.uniform(0, 2 * np.pi, 1))
    draw = lambda u: centre + polar(radius * np.sqrt(u[:, 0]) * (1 - 1e-9), 2 * np.pi * u[:, 1])  # noqa: E731
    inside = lambda x: ((x - centre) ** 2).sum(1) <= radius**2  # noqa: E731
    return Case("disk", 2, draw, lambda x: inside(x) / (np.pi * radius**2), f"radius={radius:.4g} centre={centre}")


def single_disk(rng: np.random.Generator) -> Case:
    """Uniform on the disk in single precision."""

    def draw(u: Array) -> Array:
        v = u.astype(np.float32)
        return polar(np.sqrt(v[:, 0]), np.float32(2 * np.pi) * v[:, 1]).astype(float) * (1 - 1e-7)

    return Case("disk", 2, draw, lambda x: np.full(len(x), float(np.float32(1 / np.pi))))


def image(rng: np.random.Generator) -> Case:
    """An image of 2 to 200 pixels a side by rows, some of them black."""
    h, w = (int(n) for n in np.exp(rng.uniform(np.log(2), np.log(200), 2)))
    p = rng.gamma(log_uniform(rng, 0.2, 3), size=(h, w)) + 1e-7
    if rng.random() < 0.4:
        p *= rng.random((h, w)) < 0.7
        p[0, 0] += 0.1
    p /= p.sum()
    row = p.sum(1)
    cdf, in_row = np.cumsum(row), np.cumsum(p / np.where(row > 0, row, 1)[:, None], axis=1)
    last, last_in_row = int(np.flatnonzero(row)[-1]), w - 1 - (p > 0)[:, ::-1].argmax(1)

    def draw(u: Array) -> Array:
        i = np.minimum(entry_of(cdf, u[:, 0]), last)
        j = np.minimum((in_row[i] <= u[:, 1:2]).sum(1), last_in_row[i])
        here = p[i, j] / row[i]
        y = i + rest_of(u[:, 0], cdf[i] - row[i], row[i])
        x = j + rest_of(u[:, 1], in_row[i, j] - here, here)
        return np.minimum(np.column_stack([x / w, y / h]), 1 - 1e-12)

    def density(x: Array) -> Array:
        i, j = (x[:, 1] * h).astype(int), (x[:, 0] * w).astype(int)
        return p[np.minimum(i, h - 1), np.minimum(j, w - 1)] * h * w

    return Case("square", 2, draw, density, f"h={h} w={w} black={int((p == 0).sum())}")


def bilinear(rng: np.random.Generator) -> Case:
    """Bilinear between four corners."""
    v = np.exp(rng.uniform(np.log(0.01), np.log(10), 4))
    v /= v.mean()

    def linear(u: Array, a: Any, b: Any) -> Array:
        return np.minimum(u * (a + b) / (a + np.sqrt((1 - u) * a * a + u * b * b)), 1 - 1e-12)

    def draw(u: Array) -> Array:
        y = linear(u[:, 1], v[0] + v[1], v[2] + v[3])
        return np.column_stack([linear(u[:, 0], v[0] * (1 - y) + v[2] * y, v[1] * (1 - y) + v[3] * y), y])

    def density(p: Array) -> Array:
        x, y = p.T
        return (1 - y) * ((1 - x) * v[0] + x * v[1]) + y * ((1 - x) * v[2] + x * v[3])

    return Case("square", 2, draw, density, f"corners={v.round(3)}")


def ridge(rng: np.random.Generator) -> Case:
    """A normal ridge along the diagonal of the square, of width 0.003 to 0.5."""
    s = log_uniform(rng, 0.003, 0.5)

    def draw(u: Array) -> Array:
        low, high = special.ndtr(-u[:, 0] / s), special.ndtr((1 - u[:, 0]) / s)
        z = special.ndtri(low + (high - low) * middle_of_cell(u[:, 1]))
        return np.column_stack([u[:, 0], np.clip(u[:, 0] + s * z, 0, 1)])

    def density(p: Array) -> Array:
        x, z = p[:, 0], (p[:, 1] - p[:, 0]) / s
        return np.exp(-z * z / 2) / (np.sqrt(2 * np.pi) * s * (special.ndtr((1 - x) / s) - special.ndtr(-x / s)))

    return Case("square", 2, draw, density, f"s={s:.4g}")


def cut_triangle(rng: np.random.Generator) -> Case:
    """Uniform where b0 is below a number."""
    limit = rng.uniform(0.1, 0.9)
    share = 1 - (1 - limit) ** 2

    def draw(u: Array) -> Array:
        b0 = 1 - np.sqrt(1 - share * u[:, 0])
        return np.column_stack([b0, (1 - b0) * u[:, 1]])

    return Case("triangle", 2, draw, lambda b: (b[:, 0] <= limit * (1 + 1e-12)) * 2 / share, f"limit={limit:.4g}")


def linear_triangle(rng: np.random.Generator) -> Case:
    """In proportion to b0."""
    d = stats.beta(2, 2)

    def draw(u: Array) -> Array:
        b0 = d.ppf(middle_of_cell(u[:, 0]))
        return np.column_stack([b0, (1 - b0) * u[:, 1]])

    return Case("triangle", 2, draw, lambda b: 6 * b[:, 0])


def grid(rng: np.random.Generator) -> Case:
    """A grid of 2 to 8 cells a side in the cube, as of a medium."""
    n = int(rng.integers(2, 9))
    p = rng.dirichlet(np.full(n**3, 0.8)).reshape(n, n, n)
    cdf = np.cumsum(p)

    def draw(u: Array) -> Array:
        cell = np.column_stack(np.unravel_index(entry_of(cdf, u[:, 0]), p.shape))
        return np.minimum((cell + u[:, 1:]) / n, 1 - 1e-12)

    return Case("cube", 4, draw, lambda x: p[tuple(np.minimum((x * n).astype(int), n - 1).T)] * n**3, f"n={n}")


def lens_and_time(rng: np.random.Generator) -> Case:
    """A point of a lens, and a time by a power."""
    a = rng.uniform(0.5, 4)
    draw = lambda u: np.column_stack([polar(np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1]), u[:, 2] ** (1 / a)])  # noqa: E731
    density = lambda x: a * np.maximum(x[:, 2], 1e-300) ** (a - 1) / np.pi  # noqa: E731
    return Case("disk x line:0,1", 3, draw, density, f"a={a:.4g}")


def lens_and_pixel(rng: np.random.Generator) -> Case:
    """A point of a lens, and a point of a pixel by a normal filter."""
    s = log_uniform(rng, 0.1, 0.6)
    d = stats.truncnorm(-0.5 / s, 0.5 / s, 0.5, s)

    def draw(u: Array) -> Array:
        return np.column_stack([polar(np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1]), d.ppf(middle_of_cell(u[:, 2:]))])

    return Case("disk x square", 4, draw, lambda x: d.pdf(x[:, 2]) * d.pdf(x[:, 3]) / np.pi, f"s={s:.4g}")


def triangle_of_mesh(rng: np.random.Generator) -> Case:
    """A triangle of 2 to 19 by its area, and a point of it."""
    n = int(rng.integers(2, 20))
    p = rng.dirichlet(np.ones(n))
    cdf = np.cumsum(p)

    def draw(u: Array) -> Array:
        root = np.sqrt(u[:, 1])
        return np.column_stack([entry_of(cdf, u[:, 0]), 1 - root, root * u[:, 2]])

    return Case(f"set:{n} x triangle", 3, draw, lambda x: 2 * p[x[:, 0].astype(int)], f"n={n}")


def channel_and_distance(rng: np.random.Generator) -> Case:
    """A channel of 3, and a distance by its extinction."""
    rate, share = np.exp(rng.uniform(np.log(0.05), np.log(20), 3)), rng.dirichlet(np.ones(3))
    cdf = np.cumsum(share)

    def draw(u: Array) -> Array:
        k = entry_of(cdf, u[:, 0])
        return np.column_stack([k, -np.log1p(-u[:, 1]) / rate[k]])

    def density(x: Array) -> Array:
        k = x[:, 0].astype(int)
        return share[k] * rate[k] * np.exp(-rate[k] * x[:, 1])

    return Case("set:3 x line:0,inf", 2, draw, density, f"rate={rate.round(3)} share={share.round(3)}")


FAMILIES: tuple[Callable[[np.random.Generator], Case], ...] = (
    *(logistic, laplace, gumbel, rayleigh, maxwell_to_end, inverse_gaussian, kumaraswamy, tent, equiangular, histogram),
    *(layers, channels, single_exponential, geometric, light_tree, stream),
    *(ring, blades, off_centre, single_disk, image, bilinear, ridge, cut_triangle, linear_triangle, grid),
    *(lens_and_time, lens_and_pixel, triangle_of_mesh, channel_and_distance),
)

if __name__ == "__main__":
    domains.FAMILIES = FAMILIES
    domains.main()
