"""One metric of one arm over seeds, with its interval."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ._cost import seconds_a_sample
from ._intervals import Values, half_width, rounded
from ._metric_names import LARGEST_IS_BEST, listed
from ._values import arms_of

if TYPE_CHECKING:
    from .experiments import Measured


@dataclass(frozen=True)
class Summary:
    """A metric over seeds: its mean, and the half width of the 95 % interval (None with one seed)."""

    metric: str
    arm: str
    n: int
    region: str
    values: tuple[float, ...]  #: one a seed
    heavy: bool = False  #: k-hat of the samples there is 0.5 or more: an interval means nothing

    @property
    def mean(self) -> float:
        return float(np.mean(self.values))

    @property
    def half(self) -> float | None:
        finite = len(self.values) > 1 and np.isfinite(self.values).all()
        return half_width(np.asarray(self.values)) if finite else None

    def __str__(self) -> str:
        if self.heavy:
            return f"{self.mean:.4g} (heavy tail)"
        mean, half = rounded(self.mean, self.half, 4)
        return mean if half is None else f"{mean} ± {half}"


def _rows(result: Measured, metric: str, arm: str, n: int, region: str, s: float) -> list[dict[str, Any]]:
    wanted = {"metric": metric, "arm": arm, "n": n, "region": region, "s": s}
    return [r for r in result.records() if all(r[k] == v for k, v in wanted.items()) and r["value"] is not None]


def _values(result: Measured, metric: str, arm: str, n: int, region: str, s: float) -> Values:
    rows = _rows(result, metric, arm, n, region, s)
    if not rows:
        arms_of(result, [arm] if result.records() else None)
        of_arm = [r for r in result.records() if r["arm"] == arm]
        what = f"{metric} of {region or 'the frame'}, {arm} n={n} s={s:g}"
        if of_arm and not any(r["n"] == n and r["s"] == s for r in of_arm):
            there = ", ".join(sorted({f"n={r['n']} s={r['s']:g}" for r in of_arm}))
        else:
            there = listed(of_arm, metric, region)
        raise KeyError(f"no {what}: there are {there}")
    return np.array([r["value"] for r in rows], float)


def _flip(result: Measured, arm: str, n: int, region: str, s: float) -> Values:
    """The mean of FLIP over the frame, or a region that the run did not measure, of the films of the first seed."""
    from . import _crescent

    film, reference = result.films[arm, n, s], result.references[s]
    image: Any = _crescent.flip(*(np.ascontiguousarray(reference[c]) for c in "rgb"), *(film.planes[c] for c in "rgb"))
    if region:
        x0, y0, x1, y1 = result.boxes[region]
        image = image[y0 : y1 + 1, x0 : x1 + 1]
    return np.array([float(np.mean(image))])


def summary(result: Measured, metric: str, arm: str, n: int, region: str, s: float) -> Summary:
    tail = _rows(result, "tail_k", arm, n, region, s)
    heavy = bool(tail) and float(tail[0]["value"]) >= 0.5 and metric not in ("tail_k", "flip")
    if metric == "flip" and not _rows(result, "flip", arm, n, region, s):
        values = _flip(result, arm, n, region, s)
    elif metric in LARGEST_IS_BEST:
        cost = 1.0 if metric == "efficiency_n" else seconds_a_sample(result, arm, s)
        variance = _values(result, "var", arm, n, region, s)
        values = np.divide(1, variance * n * cost, out=np.full(variance.shape, np.inf), where=variance > 0)
    else:
        values = _values(result, metric, arm, n, region, s)
    return Summary(metric, arm, n, region, tuple(float(v) for v in values), heavy)
