"""The table of a sweep: a metric at every point, with its interval over seeds."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from .. import _crescent
from .._intervals import log_interval
from .dataset import read
from .grid import UsageError, hint, short
from .store import read_json

Rows = list[dict[str, Any]]


def state_of(out: str | PathLike[str]) -> dict[str, Any]:
    """The contents of sweep.json."""
    state = read_json(Path(out) / "sweep.json")
    if not state:
        raise UsageError(f"{out}: no sweep: expected a folder that `crescent sweep --out` made")
    return dict(state)


class Numbers:
    """Values over seeds by point, arm, N, metric and region. Suspect rows are left out."""

    def __init__(self, out: str | PathLike[str]) -> None:
        self.state = state_of(out)
        names = ("point", "arm", "n", "s", "metric", "region", "value", "suspect")
        table = read(out).select(names)
        columns = {name: table[name].to_pylist() for name in names}
        self.axes: dict[str, list[Any]] = {
            path: sorted(values, key=lambda v: (isinstance(v, str), v)) if all(
                isinstance(v, (int, float, str)) for v in values
            ) else values
            for path, values in self.state["axes"].items()
        }  # fmt: skip
        self.values: dict[tuple[str, str, int, str, str], list[float]] = {}
        self.metrics: dict[str, list[str]] = {}
        self.suspect = 0
        points = {point["scene"] for point in self.state["points"]}
        main = self._main_exponents(columns)
        for point, arm, n, s, metric, region, value, marked in zip(*columns.values(), strict=True):
            self.suspect += bool(marked)
            if marked or point not in points or value is None or s != main[point, arm]:
                continue
            self.values.setdefault((point, arm, n, metric, region), []).append(value)
            regions = self.metrics.setdefault(metric, [])
            if region not in regions:
                regions.append(region)

    @staticmethod
    def _main_exponents(columns: dict[str, list[Any]]) -> dict[tuple[str, str], float]:
        """The exponent with most rows of each point and arm: others are those of the exponent control."""
        rows: dict[tuple[str, str], Counter[float]] = {}
        for point, arm, s in zip(columns["point"], columns["arm"], columns["s"], strict=True):
            rows.setdefault((point, arm), Counter())[s] += 1
        return {key: counter.most_common(1)[0][0] for key, counter in rows.items()}

    def chosen(self, given: str) -> tuple[str, str]:
        """The metric and region of "rmse.H", "rmse" or "": by default the first metric in its first region."""
        if not self.metrics:
            raise UsageError("the sweep has no results yet")
        if not given:
            metric = next((name for name in ("rmse", "rmse_frame") if name in self.metrics), next(iter(self.metrics)))
            return metric, self.metrics[metric][0]
        metric, _, region = given.partition(".")
        words = [f"{m}.{r}" if r else m for m, regions in self.metrics.items() for r in regions]
        if metric in self.metrics and (region in self.metrics[metric] or not region):
            return metric, region or self.metrics[metric][0]
        near = _crescent.nearest(given, [*self.metrics, *words])
        raise UsageError(f"--metric {given}: expected one of {', '.join(words)}" + hint(near))

    def points(self) -> list[dict[str, Any]]:
        """The points in the order of the axes' values."""
        return sorted(
            self.state["points"],
            key=lambda p: tuple(self.axes[path].index(p["values"][path]) for path in self.axes if path in p["values"]),
        )

    def arms(self) -> list[str]:
        """The arms of any point, in order."""
        return list(dict.fromkeys(arm for p in self.state["points"] for arm in p["arms"]))

    def counts(self, arm: str, metric: str, region: str) -> list[int]:
        """The sample counts of an arm, ascending."""
        return sorted({n for (_, a, n, m, r) in self.values if (a, m, r) == (arm, metric, region)})


def geometric(values: Sequence[float]) -> float:
    """The geometric mean; the arithmetic mean if a value is not positive."""
    v = np.asarray(values, dtype=float)
    return float(np.exp(np.log(v).mean())) if (v > 0).all() else float(v.mean())


def summary(out: str | PathLike[str], metric: str = "") -> str:
    """A row for each point, a column for each sampler at its largest N: the mean over seeds with its 95 % interval."""
    state = state_of(out)
    if state.get("kind") == "check":
        from .check_sweep import summary_of_checks

        return summary_of_checks(out)
    numbers = Numbers(out)
    notes = [f"{numbers.suspect} suspect rows are left out"] if numbers.suspect else []
    notes += [f"failed: {place}: {error}" for place, error in state.get("failed", {}).items()]
    if not numbers.metrics:
        return "\n".join(["no results", *notes])
    name, region = numbers.chosen(metric)
    arms = numbers.arms()
    head = [*numbers.axes, *(f"{arm} N={max(numbers.counts(arm, name, region), default=0)}" for arm in arms), "seeds"]
    timed = region in numbers.metrics.get("efficiency_time", []) and name != "efficiency_time"
    head += [f"{arm} efficiency" for arm in arms] if timed else []
    rows = [head]
    for point in numbers.points():
        cells = [short(point["values"].get(path, "")) for path in numbers.axes]
        seeds = 0
        for arm in arms:
            n = max(numbers.counts(arm, name, region), default=0)
            values = numbers.values.get((point["scene"], arm, n, name, region), [])
            seeds = max(seeds, len(values))
            cells.append(_with_interval(values))
        cells.append(str(seeds))
        for arm in arms if timed else ():
            n = max(numbers.counts(arm, "efficiency_time", region), default=0)
            cells.append(_with_interval(numbers.values.get((point["scene"], arm, n, "efficiency_time", region), [])))
        rows.append(cells)
    widths = [max(len(row[k]) for row in rows) for k in range(len(head))]
    text = "\n".join("  ".join(cell.rjust(w) for cell, w in zip(row, widths, strict=True)) for row in rows)
    title = f"{name}{' of region ' + region if region else ''}: geometric mean over seeds [95 % interval]"
    title += "; efficiency at equal time, 1/(variance times seconds on one thread)" if timed else ""
    return "\n".join([title, text, *notes])


def _with_interval(values: Sequence[float]) -> str:
    if not values:
        return "-"
    interval = log_interval(values)
    mean = f"{geometric(values):.4g}"
    return mean if interval is None else f"{mean} [{interval[0]:.4g}, {interval[1]:.4g}]"
