"""Intervals over seeds: Student's t on logarithms, fitted slopes, and which of several arms is best."""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Values = NDArray[np.float64]


@functools.cache
def t_quantile(p: float, freedom: int) -> float:
    """The quantile `p` in (0.5, 1) of Student's t with `freedom` degrees, to 1e-6 of itself.

    The density in x = tan(a) is cos(a)^(freedom - 1) over a constant: it is summed by the midpoint rule.
    """
    steps = 200_000
    edge = math.sqrt(freedom)
    a = (np.arange(steps) + 0.5) / steps * (math.pi / 2)
    weight = np.cos(a) ** (freedom - 1)
    mass = np.cumsum(weight) / weight.sum()  # of |t| up to edge tan(a)
    k = int(np.searchsorted(mass, 2 * p - 1))
    below = mass[k - 1] if k else 0.0
    part = (2 * p - 1 - below) / (mass[k] - below)
    return edge * math.tan((k + part) / steps * (math.pi / 2))


def half_width(values: Values, level: float = 0.95) -> float:
    """Half the width of the interval of the mean of two or more values."""
    return t_quantile((1 + level) / 2, values.size - 1) * float(np.std(values, ddof=1)) / math.sqrt(values.size)


def rounded(mean: float, half: float | None, digits: int = 3) -> tuple[str, str | None]:
    """A mean and the half width of its interval as texts: the half width with two digits, the mean with the same places;
    a mean without an interval with so many digits. Both have an exponent, or none has."""
    if math.isinf(mean):
        return "∞", None
    if half is None or not math.isfinite(half) or not math.isfinite(mean):
        return f"{mean:.{digits}g}", None
    if half == 0:
        return f"{mean:.{digits}g}", "0"
    places = 1 - math.floor(math.log10(half))
    if round(half, places) >= 10 ** (2 - places):  # 0.0999 is 0.10
        places -= 1
    largest = max(abs(mean), half)
    if places > 6 or largest >= 1e6:
        power = math.floor(math.log10(largest))
        shown = max(places + power, 0)
        return f"{mean / 10**power:.{shown}f}e{power}", f"{half / 10**power:.{shown}f}e{power}"
    shown = max(places, 0)
    return f"{round(mean, places):.{shown}f}", f"{round(half, places):.{shown}f}"


def log_interval(values: Values | Sequence[float], level: float = 0.95) -> tuple[float, float] | None:
    """The interval of the mean of the logarithm over seeds, as values; None with one seed or where a value is not
    positive."""
    v = np.asarray(values, dtype=float)
    if v.size < 2 or not (v > 0).all():
        return None
    logs = np.log(v)
    half = half_width(logs, level)
    return float(np.exp(logs.mean() - half)), float(np.exp(logs.mean() + half))


@dataclass(frozen=True)
class Slope:
    """Of log(metric) over log(N), with its interval over seeds where there are two."""

    value: float
    half: float | None

    def text(self) -> str:
        return f"{self.value:.2f}" + ("" if self.half is None else f" ± {self.half:.2f}")


def fitted_slope(n: NDArray[np.int64], over: Sequence[Values]) -> Slope | None:
    """The slope by least squares, one fit a seed. None with fewer than two counts, or where a value is not positive."""
    seeds = min((len(v) for v in over), default=0)
    if len(n) < 2 or seeds == 0 or any(not ((v > 0) & np.isfinite(v)).all() for v in over):
        return None
    x = np.log(np.asarray(n, dtype=float))
    y = np.log(np.array([v[:seeds] for v in over]))
    slopes = ((x - x.mean())[:, None] * (y - y.mean(0))).sum(0) / ((x - x.mean()) ** 2).sum()
    if seeds < 2:
        return Slope(float(slopes[0]), None)
    half = half_width(slopes)
    return Slope(float(slopes.mean()), float(half))


def best_of(values: Mapping[str, Values], alpha: float = 0.05) -> set[str]:
    """The arms of which none is significantly worse than the smallest in mean logarithm: paired t over seeds, alpha
    shared by Bonferroni. If a value is not positive, the values themselves are compared. Empty, nothing is ranked, with
    fewer than two arms, or if an arm has fewer than two seeds, other seeds than another, or a value that is not finite."""
    arms = {arm: np.asarray(v, dtype=float) for arm, v in values.items()}
    if len(arms) < 2 or len({len(v) for v in arms.values()}) != 1:
        return set()
    if any(len(v) < 2 or not np.isfinite(v).all() for v in arms.values()):
        return set()
    if all((v > 0).all() for v in arms.values()):
        arms = {arm: np.log(v) for arm, v in arms.items()}
    best = min(arms, key=lambda arm: float(arms[arm].mean()))
    out = {best}
    for arm, compared in arms.items():
        if arm == best:
            continue
        apart = compared - arms[best]
        error, mean = apart.std(ddof=1) / math.sqrt(apart.size), apart.mean()
        if mean <= error * t_quantile(1 - alpha / (len(arms) - 1), apart.size - 1):
            out.add(arm)
    return out


def t_of(values: Values) -> Values:
    """Student's t of the means over the last axis; NaN where nothing varies."""
    error = values.std(-1, ddof=1) / math.sqrt(values.shape[-1])
    out: Values = np.divide(values.mean(-1), error, out=np.full(error.shape, np.nan), where=error > 0)
    return out


def _p_values(t: Values, freedom: int) -> Values:
    """Two-sided p-values of |t|, by the midpoint rule of :func:`t_quantile`, summed from the tail."""
    steps = 20_000
    a = (np.arange(steps) + 0.5) / steps * (math.pi / 2)
    weight = np.cos(a) ** (freedom - 1)
    above = np.cumsum(weight[::-1])[::-1] / weight.sum()  # of |t| from the lower end of each step
    out: Values = np.interp(np.arctan(np.abs(t) / math.sqrt(freedom)), a - a[0], above)
    return out


def differ(values: Values, rate: float = 0.05) -> NDArray[np.bool_]:
    """Where the means over the last axis differ from 0, with this rate of false discoveries (Benjamini and Hochberg
    1995)."""
    t = t_of(values)
    p = np.where(np.isfinite(t), _p_values(np.nan_to_num(t), values.shape[-1] - 1), np.inf)
    known = np.sort(p[np.isfinite(p)])
    below = np.flatnonzero(known <= rate * np.arange(1, known.size + 1) / max(known.size, 1))
    out: NDArray[np.bool_] = p <= (known[below[-1]] if below.size else -1.0)
    return out
