"""What samples cost: an arm's samples, its seconds or its rays, and a metric at equal cost.

Seconds are those of the wall clock for all pixels, from the medians over seeds of the measured times of an arm at its
largest N (``crescent.run(repeats=...)``): N samples of the same arm take N times as long as one. Rays are per pixel.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np

from ._intervals import Values

if TYPE_CHECKING:
    from .experiments import Measured

Against = Literal["n", "time", "rays"]

#: metric ~ cost^power for independent samples of finite variance
_POWER = {
    "rmse": -0.5, "rmse_frame": -0.5, "var": -1.0, "mse": -1.0, "relmse": -1.0, "efficiency_n": 0.0, "efficiency_time": 0.0,
}  # fmt: skip


def checked(against: str) -> Against:
    """`against`, or a ValueError."""
    if against not in get_args(Against):
        raise ValueError(f"against is {against!r}: expected one of {', '.join(map(repr, get_args(Against)))}")
    return against  # type: ignore[return-value]


_SECONDS = (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6))


class Costs:
    """The cost of one sample of each arm."""

    def __init__(self, r: Measured, against: str, s: float) -> None:
        self.against = checked(against)
        self.threads = r.threads
        self._of: dict[str, float] = {}
        if against == "time":
            times: dict[str, list[float]] = {}
            for arm, n, at, _, seconds in r._core.times:
                if at == s and n > 0:
                    times.setdefault(arm, []).append(seconds / n)
            if not times:
                raise KeyError(f"the result has no times at s = {s:g}: those of crescent.run have, and folders of them")
            self._of = {arm: float(np.median(each)) for arm, each in times.items()}
        elif against == "rays":
            rays: dict[str, list[float]] = {}
            for row in r.records():
                if row["metric"] == "rays" and row["s"] == s and row["value"]:
                    rays.setdefault(row["arm"], []).append(row["value"])
            self._of = {arm: float(np.median(each)) for arm, each in rays.items()}

    def of(self, arm: str, n: float) -> float:
        """The cost of N samples a pixel of an arm."""
        if self.against == "n":
            return float(n)
        if arm not in self._of:
            raise KeyError(f"the result has no {self.against} of {arm}: there are {', '.join(self._of)}")
        return self._of[arm] * n

    def knows(self, arm: str) -> bool:
        """Whether the cost of this arm is known."""
        return self.against == "n" or arm in self._of

    def unit(self, most: float) -> tuple[float, str]:
        """The unit of an axis up to this cost: its size and its name."""
        if self.against != "time":
            return 1.0, ""
        return next(((size, name) for name, size in _SECONDS if most >= 2 * size), (1e-6, "µs"))

    def label(self, most: float) -> str:
        """The name of an axis up to this cost, with its unit."""
        if self.against == "n":
            return "samples a pixel, N"
        if self.against == "rays":
            return "rays a pixel"
        threads = f", {self.threads} thread{'s' * (self.threads != 1)}" if self.threads else ""
        return f"time [{self.unit(most)[1]}]{threads}"

    def text(self, cost: float) -> str:
        """An amount with its name."""
        if self.against == "n":
            return f"N = {cost:g}"
        return seconds_text(cost) if self.against == "time" else f"{cost:.3g} ray{'s' * (cost != 1)}"


def seconds_a_sample(r: Measured, arm: str, s: float) -> float:
    """Wall-clock seconds of one sample of one pixel: the median over seeds."""
    found = [t / m for a, _, at, m, t in r._core.times if a == arm and at == s and m > 0]
    if not found:
        raise KeyError(f"no time of {arm} at s = {s:g}: results of crescent.run have times, and folders of them")
    return float(np.median(found))


def seconds_text(seconds: float) -> str:
    """A time with three digits in s, ms or µs."""
    for unit, size in _SECONDS:
        if seconds >= size or unit == "µs":
            return f"{seconds / size:.3g} {unit}"
    return ""


@dataclass(frozen=True)
class At:
    """A metric of an arm at a cost."""

    values: Values  #: one a seed
    n: float  #: the sample count of that cost; a fraction where it was interpolated


def budget_of(by_arm: Mapping[str, Mapping[int, Sequence[float]]], costs: Costs) -> float:
    """The largest cost that every arm reaches, or that of one sample of the most expensive arm if that is more."""
    return max(min(costs.of(arm, max(of)) for arm, of in by_arm.items()), max(costs.of(arm, 1) for arm in by_arm))


def at_cost(
    of: Mapping[int, Sequence[float]], arm: str, costs: Costs, budget: float, metric: str, keep: bool = False
) -> At | None:
    """The metric at a cost: measured there; interpolated between two sample counts, linearly in logarithms; or for
    metrics of the variance, from the nearest count by their law, N^-1, N^-1/2 for its root and N^0 for efficiencies. None where none of these
    is possible, and of less than one sample. `keep`: measured values only."""
    counts = sorted(of)
    wanted = budget / costs.of(arm, 1)
    if wanted < 1 - 1e-9:
        return None
    for n in counts:
        if math.isclose(n, wanted, rel_tol=1e-9):
            return At(np.asarray(of[n], float), n)
    if keep:
        return None
    below, above = [n for n in counts if n < wanted], [n for n in counts if n > wanted]
    if below and above:
        low, high = below[-1], above[0]
        seeds = min(len(of[low]), len(of[high]))
        a, b = np.asarray(of[low][:seeds], float), np.asarray(of[high][:seeds], float)
        share = math.log(wanted / low) / math.log(high / low)
        positive = (a > 0) & (b > 0) & np.isfinite(a) & np.isfinite(b)
        logs = np.exp((1 - share) * np.log(np.where(positive, a, 1)) + share * np.log(np.where(positive, b, 1)))
        return At(np.where(positive, logs, (1 - share) * a + share * b), wanted)
    if metric not in _POWER:
        return None
    nearest = below[-1] if below else above[0]
    return At(np.asarray(of[nearest], float) * (wanted / nearest) ** _POWER[metric], wanted)
