"""The numbers that figures and tables show: values over seeds, and a metric of several arms at equal cost."""

from __future__ import annotations

import operator
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _crescent
from ._cost import Costs, at_cost, budget_of, seconds_a_sample
from ._intervals import best_of, half_width, rounded
from ._metric_names import LARGEST_IS_BEST, RANKED, listed

if TYPE_CHECKING:
    from .experiments import Film, Measured


def arms_of(r: Measured, arms: Sequence[str] | None) -> list[str]:
    """These arms, or all of the result."""
    if isinstance(arms, str):
        raise TypeError(f"arms is {arms!r}: expected a list of names, [{arms!r}]")
    known = list(dict.fromkeys(film.arm for film in r.films.values()))
    known = known or list(dict.fromkeys(row["arm"] for row in r.records()))
    for arm in arms or ():
        if arm not in known:
            near = _crescent.nearest(str(arm), known)
            hint = f"; did you mean '{near}'?" if near else ""
            raise KeyError(f"no arm {arm!r}: there are {', '.join(known)}{hint}")
    return list(arms) if arms else known


def named_arms(what: str, given: Mapping[str, str] | None, known: Sequence[str]) -> Mapping[str, str]:
    """Labels or colours by arm; KeyError for a name that is no arm."""
    if given is not None and not isinstance(given, Mapping):
        raise TypeError(f"{what} is {given!r}: expected a dictionary by arm, such as {{{known[0]!r}: ...}}")
    for name in given or {}:
        if name not in known:
            near = _crescent.nearest(str(name), list(known))
            hint = f"; did you mean '{near}'?" if near else ""
            raise KeyError(f"{what} has {name!r}: there are {', '.join(known)}{hint}")
    return given or {}


def box_in(what: str, given: Any, width: int, height: int) -> tuple[int, int, int, int]:
    """A box [x0, y0, x1, y1) in a picture of this size."""
    expected = f"expected a box [x0, y0, x1, y1] with x0 < x1 <= {width} and y0 < y1 <= {height}"
    try:
        x0, y0, x1, y1 = map(operator.index, given)
    except (TypeError, ValueError):
        raise ValueError(f"{what} is {given!r}: {expected}") from None
    if not (0 <= x0 < x1 <= width and 0 <= y0 < y1 <= height):
        raise ValueError(f"{what} is {[x0, y0, x1, y1]}: {expected}")
    return x0, y0, x1, y1


def amount_of(what: str, given: Any) -> float:
    """A cost above 0."""
    if isinstance(given, (bool, str)) or not isinstance(given, (int, float, np.number)) or not 0 < given < np.inf:
        raise ValueError(f"{what} is {given!r}: expected an amount above 0")
    return float(given)


def values_of(r: Measured, metric: str, region: str, s: float | None) -> dict[str, dict[int, list[float]]]:
    """By arm and N, the metric's values over seeds. KeyError where the result has no such metric or region."""
    at = r.s if s is None else s
    if metric in LARGEST_IS_BEST:
        of_arms = values_of(r, "var", region, s)
        cost = {arm: 1.0 if metric == "efficiency_n" else seconds_a_sample(r, arm, at) for arm in of_arms}
        return {
            arm: {n: [1 / (v * n * cost[arm]) if v > 0 else np.inf for v in over] for n, over in of.items()}
            for arm, of in of_arms.items()
        }
    rows = r.records()
    out: dict[str, dict[int, list[float]]] = {}
    for row in rows:
        if row["metric"] == metric and row["region"] == region and row["s"] == at and row["value"] is not None:
            out.setdefault(row["arm"], {}).setdefault(row["n"], []).append(row["value"])
    if not out:
        exponents = sorted({row["s"] for row in rows})
        if rows and at not in exponents:
            raise KeyError(f"nothing at s = {at:g}: there are s = {', '.join(f'{k:g}' for k in exponents)}")
        there = listed(rows, metric, region)
        raise KeyError(f"no {metric} of {region or 'the frame'} at s = {at:g}: there are {there}")
    return out


def only_region(r: Measured, metric: str, region: str | None) -> str:
    """`region`, or the first of the experiment's where the metric has regions and none is named."""
    if region is not None:
        return region
    metric = "var" if metric in LARGEST_IS_BEST else metric
    return next((row["region"] for row in r.records() if row["metric"] == metric), "")


def heavy_arms(r: Measured, region: str, s: float | None) -> set[str]:
    """The arms whose samples have a heavy tail, by the measured k-hat: intervals of them mean nothing."""
    at = r.s if s is None else s
    return {
        row["arm"]
        for row in r.records()
        if row["metric"] == "tail_k" and row["region"] == region and row["s"] == at and (row["value"] or 0) >= 0.5
    }


def best_in(values: Mapping[str, NDArray[Any]], metric: str) -> set[str]:
    """The arms of which none is significantly worse than the best; none with one seed, or of a metric without order."""
    if metric in LARGEST_IS_BEST:
        return best_of({arm: 1 / v for arm, v in values.items()})
    return best_of(values) if metric in RANKED else set()


@dataclass(frozen=True)
class Compared:
    """A metric of several arms at one cost."""

    values: dict[str, NDArray[Any]]  #: by arm, one a seed
    n: dict[str, float]  #: by arm, the sample count of that cost
    cost: float
    costs: Costs
    best: set[str]  #: the arms of which none is significantly worse than the best
    missing: list[str]  #: the arms that have no such N

    def where(self) -> str:
        """The cost in words."""
        if self.costs.against == "n":
            return f"at N = {self.cost:g}"
        threads = f", {self.costs.threads} thread{'s' * (self.costs.threads != 1)}"
        return f"in {self.costs.text(self.cost)}" + (threads if self.costs.against == "time" and self.costs.threads else "")


def compared_at(
    r: Measured, metric: str, region: str, s: float | None, arms: Sequence[str], against: str, n: float | None,
    budget: float | None,
) -> Compared:  # fmt: skip
    """`n` with against="n", and `budget` else: by default the largest that every arm has."""
    costs = Costs(r, against, r.s if s is None else s)
    if against == "n" and budget is not None or against != "n" and n is not None:
        raise TypeError(f"against is {against!r}: expected {'n=' if against == 'n' else 'budget='}, the amount of it")
    by_arm = {arm: of for arm, of in values_of(r, metric, region, s).items() if arm in arms and costs.knows(arm)}
    if not by_arm:
        raise KeyError(f"no {metric} of {', '.join(arms)}")
    if against == "n":
        shared = Counter(k for of in by_arm.values() for k in of)
        cost = float(n if n is not None else max(shared, key=lambda k: (shared[k], k)))
    else:
        cost = float(budget_of(by_arm, costs) if budget is None else amount_of("budget", budget))
    found = {a: at for a in arms if a in by_arm and (at := at_cost(by_arm[a], a, costs, cost, metric, against == "n"))}
    if not found:
        raise KeyError(f"no arm has N = {cost:g}: expected one of {sorted({k for of in by_arm.values() for k in of})}")
    values = {arm: at.values for arm, at in found.items()}
    best = best_in(values, metric)
    return Compared(
        values, {arm: at.n for arm, at in found.items()}, cost, costs, best, [a for a in by_arm if a not in found]
    )


def with_interval(over: NDArray[Any]) -> str:
    """The mean over seeds, with the half width of its 95 % interval."""
    finite = over.size > 1 and np.isfinite(over).all()
    mean, half = rounded(float(np.mean(over)), half_width(over) if finite else None)
    return mean if half is None else f"{mean} ± {half}"


def film_at(r: Measured, arm: str, n: float, s: float) -> Film | None:
    """The film of an arm with the sample count nearest to n, by ratio."""
    films = [f for f in r.films.values() if f.arm == arm and f.s == s]
    return min(films, key=lambda f: abs(np.log(f.n / n)), default=None)
