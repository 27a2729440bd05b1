"""Points of other domains than directions: a lens, a triangle, a choice among entries, a distance, a wavelength."""

import numpy as np

from crescent import Sampler
from crescent.field import Fault

A, B, C = (
    np.array([0.2, 0.2]),
    np.array([0.9, 0.3]),
    np.array([0.4, 0.8]),
)  # a triangle in the unit square
AREA = abs((B - A)[0] * (C - A)[1] - (B - A)[1] * (C - A)[0]) / 2


def lens(power):
    """A point of the disk of radius u0^power."""

    def sample(u):
        r, phi = u[:, 0] ** power, 2 * np.pi * u[:, 1]
        return np.stack([r * np.cos(phi), r * np.sin(phi)], -1), np.full(len(u), 1 / np.pi)

    return Sampler(sample, lambda x: np.full(len(x), 1 / np.pi), domain="disk", name="lens")


def triangle(origin):
    """A point of the triangle ABC by two edges from `origin`, mirrored at the diagonal."""

    def pdf(x):
        d = x - A
        e, f = B - A, C - A
        det = e[0] * f[1] - e[1] * f[0]
        s, t = (
            (d[:, 0] * f[1] - d[:, 1] * f[0]) / det,
            (e[0] * d[:, 1] - e[1] * d[:, 0]) / det,
        )
        return np.where((s >= 0) & (t >= 0) & (s + t <= 1), 1 / AREA, 0.0)

    def sample(u):
        s, t = u[:, 0], u[:, 1]
        over = s + t > 1
        s, t = np.where(over, 1 - s, s), np.where(over, 1 - t, t)
        return origin + s[:, None] * (B - A) + t[:, None] * (C - A), np.full(len(u), 1 / AREA)

    return Sampler(sample, pdf, domain="square", name="triangle")


WEIGHTS = np.array([10.0, 10.0, 1.0, 1.0])
OWN = np.array([1.0, 1.0, 2 / 11, 2 / 11])  # probability of each bin's own entry
OTHER = np.array([0, 1, 0, 1])  # the entry that is drawn else


def choice(chosen, other=OTHER):
    """An entry by an alias table: `chosen(bin, whether it is the bin's own, the other entry)`. Walker 1977."""
    p = WEIGHTS / WEIGHTS.sum()

    def sample(u):
        i = np.minimum((u[:, 0] * len(p)).astype(int), len(p) - 1)
        entry = chosen(i, u[:, 1] < OWN[i], other[i])
        return entry, p[entry]

    return Sampler(sample, lambda i: p[i], domain=f"set:{len(p)}", name="alias table")


def by_table(i, is_own, other):
    return np.where(is_own, i, other)


RIGHT_CHOICE = choice(by_table)


def stream(n, from_first):
    """One of n entries of a stream: entry r replaces the one that is kept with the probability 1 / (r + 1), or 1 / r."""

    def sample(u):
        kept = np.zeros(len(u), int)
        for r in range(1, n):
            kept = np.where((u[:, r - 1] * (r + from_first)).astype(int) == 0, r, kept)
        return kept, np.full(len(u), 1 / n)

    return Sampler(
        sample,
        lambda i: np.full(len(i), 1 / n),
        domain=f"set:{n}",
        u=n - 1,
        name="stream",
    )


SIGMA = 1.5
LENGTH = 2.0  # of the ray's direction


def distance(in_units_of_the_ray):
    """The ray's parameter t at a free-flight distance; distances are t times LENGTH."""

    def pdf(t):
        return SIGMA * LENGTH * np.exp(-SIGMA * LENGTH * t)

    def sample(u):
        d = -np.log1p(-u[:, 0]) / SIGMA
        t = d / LENGTH if in_units_of_the_ray else d * LENGTH
        return t, pdf(t)

    return Sampler(sample, pdf, domain="line:0,inf", u=1, name="distance")


CHANNELS = np.array([0.5, 1.0, 3.0])  # extinction of red, green and blue


def spectral_distance(mean_of_channels):
    """A distance by the extinction of a random channel; the density is that of this channel or the mean of all."""

    def pdf(t):
        return np.mean(CHANNELS * np.exp(-CHANNELS * t[:, None]), axis=1)

    def sample(u):
        sigma = CHANNELS[np.minimum((u[:, 1] * 3).astype(int), 2)]
        t = -np.log1p(-u[:, 0]) / sigma
        return t, pdf(t) if mean_of_channels else sigma * np.exp(-sigma * t)

    return Sampler(sample, pdf, domain="line:0,inf", name="spectral distance")


def wavelength(weight_is_inverse):
    """A wavelength in nm by a response of a sensor; the weight is 1 / p, or the integral of the response."""
    centre, width, lower, upper = 550.0, 60.0, 360.0, 830.0
    grid = np.linspace(lower, upper, 20001)
    response = 0.1 + np.exp(-(((grid - centre) / width) ** 2))
    cdf = np.concatenate([[0.0], np.cumsum((response[1:] + response[:-1]) / 2 * np.diff(grid))])
    total = cdf[-1]

    def pdf(x):
        return np.interp(x, grid, response) / total

    def sample(u):
        x = np.interp(u[:, 0] * total, cdf, grid)
        p = pdf(x)
        return x, p, (1 / p if weight_is_inverse else np.full(len(x), total))

    def f(x):
        return np.ones(len(x))

    return Sampler(sample, pdf, f, domain=f"line:{lower:g},{upper:g}", u=1, name="wavelength")


FAULTS = [
    Fault(
        "a lens without the square root of the radius",
        "THREE.js-PathTracing-Renderer",
        "https://github.com/erichlof/THREE.js-PathTracing-Renderer/issues/36",
        "The radius on the aperture is u instead of its square root: points cluster in the middle.",
        ("density",),
        lens(1.0),
        lens(0.5),
    ),
    Fault(
        "a triangle sampled at the origin",
        "Bevy",
        "https://github.com/bevyengine/bevy/pull/12766",
        "The point is not translated by the first vertex: the triangle is sampled near the origin.",
        ("density", "identity"),
        triangle(np.zeros(2)),
        triangle(A),
    ),
    Fault(
        "an alias table that returns the bin's own entry for its alias",
        "Hypothesis",
        "https://github.com/HypothesisWorks/hypothesis/pull/1049",
        "If the alias is chosen, the bin's own entry is returned all the same: every entry is equally likely.",
        ("density",),
        choice(lambda i, is_own, other: i),
        RIGHT_CHOICE,
    ),
    Fault(
        "an alias table whose entries are off by one",
        "PyTorch",
        "https://github.com/pytorch/pytorch/pull/21324",
        "One is added to the bin's own entry and subtracted from every draw: aliases are one too low.",
        ("density",),
        choice(lambda i, is_own, other: np.where(is_own, i, np.maximum(other - 1, 0))),
        RIGHT_CHOICE,
    ),
    Fault(
        "an alias table with a bin that keeps itself",
        "EGSnrc",
        "https://github.com/nrc-cnrc/EGSnrc/pull/557",
        "For the weights 10, 10, 1, 1 the last bin has no alias: entries are drawn 10 : 5.5 : 1 : 5.5.",
        ("density",),
        choice(by_table, other=np.array([0, 1, 0, 3])),
        RIGHT_CHOICE,
    ),
    Fault(
        "a reservoir whose probabilities are off by one",
        "LightGBM",
        "https://github.com/lightgbm-org/LightGBM/pull/4450",
        "Entry r of a stream replaces the one that is kept with the probability 1 / r instead of 1 / (r + 1).",
        ("density",),
        stream(7, 0),
        stream(7, 1),
    ),
    Fault(
        "a free-flight distance multiplied by the length of the ray's direction",
        "pbrt-v3",
        "https://github.com/mmp/pbrt-v3/issues/159",
        "A distance is turned into the ray's parameter by a multiplication with the length of its direction instead "
        "of a division.",
        ("density",),
        distance(False),
        distance(True),
    ),
    Fault(
        "the density of a distance in the chosen channel alone",
        "Mitsuba 2",
        "https://github.com/mitsuba-renderer/mitsuba2/issues/323",
        "A distance is drawn by the extinction of a random channel and divided by the density of that channel, not by "
        "the mean of the three.",
        ("identity",),
        spectral_distance(False),
        spectral_distance(True),
    ),
    Fault(
        "a weight of wavelengths that is not 1 / p",
        "Mitsuba 3",
        "https://github.com/mitsuba-renderer/mitsuba3/pull/1710",
        "With a response given by the user, the weight of a wavelength is the integral of the response instead of the "
        "inverse density.",
        ("identity",),
        wavelength(False),
        wavelength(True),
    ),
]
