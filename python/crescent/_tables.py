"""Tables of a result for a paper."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from ._cost import Costs, at_cost, budget_of
from ._intervals import Values, half_width, rounded
from ._metric_names import NAMES, UNITS
from ._sampler import whole
from ._values import amount_of, arms_of, best_in, heavy_arms, named_arms, only_region, values_of

if TYPE_CHECKING:
    from .experiments import Measured

_SPECIAL = str.maketrans(
    {c: "\\" + c for c in "&%$#_{}"}
    | {"\\": r"\textbackslash{}", "^": r"\textasciicircum{}", "~": r"\textasciitilde{}", "\n": " "}
)
_BUDGETS = 3  # columns at equal time


def _cell(values: Values, digits: int, bold: bool, heavy: bool) -> str:
    finite = values.size > 1 and np.isfinite(values).all()
    mean, half = rounded(float(np.mean(values)), half_width(values) if finite else None, digits)
    mean, _, power = mean.replace("∞", r"\infty").partition("e")
    text = rf"\mathbf{{{mean}}}" if bold else mean
    if half is not None:
        text += rf" \pm {half.partition('e')[0]}"
    if power:
        text = rf"({text}) \times 10^{{{int(power)}}}"
    return f"${text}" + (r"{}^{\dagger}$" if heavy else "$")


def _budgets(by_arm: Mapping[str, Mapping[int, Sequence[float]]], costs: Costs) -> list[float]:
    """Up to three budgets in steps of four, of at least a sample of every arm, about the one that every arm reaches."""
    middle = budget_of(by_arm, costs)
    least = max(costs.of(arm, 1) for arm in by_arm) * (1 - 1e-9)
    most = max(costs.of(arm, max(of)) for arm, of in by_arm.items()) * (1 + 1e-9)
    steps = [middle * 4.0**k for k in range(-_BUDGETS + 1, _BUDGETS)]
    possible = [b for b in steps if least <= b <= most]
    below = [b for b in possible if b <= middle]
    return [*below, *(b for b in possible if b > middle)][:_BUDGETS]


def latex(
    result: Measured, metric: str, region: str | None, s: float, rank: bool, digits: int, against: str = "n",
    budgets: Sequence[float] | None = None, arms: Sequence[str] | None = None, labels: Mapping[str, str] | None = None,
) -> str:  # fmt: skip
    """See :meth:`crescent.Measured.to_latex`."""
    labels = named_arms("labels", labels, arms_of(result, None))
    digits = whole("digits", digits, 1, 17, "expected 1 to 17 digits")
    region = only_region(result, metric, region)
    by_arm = values_of(result, metric, region, s)
    costs = Costs(result, against, s)
    order = [arm for arm in arms_of(result, arms) if arm in by_arm and costs.knows(arm)]
    by_arm = {arm: by_arm[arm] for arm in order}
    budgets = None if budgets is None else [amount_of("a budget of budgets", b) for b in budgets]
    if against == "n":
        columns = [float(n) for n in (budgets or sorted({n for of in by_arm.values() for n in of}))]
    else:
        columns = sorted(float(b) for b in budgets) if budgets else _budgets(by_arm, costs)
    heavy = heavy_arms(result, region, s)
    cells: dict[tuple[str, float], str] = {}
    for column in columns:
        found = {
            arm: at.values
            for arm, of in by_arm.items()
            if (at := at_cost(of, arm, costs, column, metric, against == "n")) is not None
        }
        best = best_in(found, metric) if rank else set()
        for arm, values in found.items():
            cells[arm, column] = _cell(values, digits, arm in best, arm in heavy)
    empty = [column for column in columns if not any((arm, column) in cells for arm in order)]
    if empty and (budgets or len(empty) == len(columns)):
        there = sorted({n for of in by_arm.values() for n in of})
        what = "N" if against == "n" else "cost"
        raise KeyError(f"budgets has {empty[0]:g}: no arm has {metric} at this {what}: N are {there}")
    columns = [column for column in columns if column not in empty]
    name = NAMES.get(metric, metric.translate(_SPECIAL)) + (f", region {region}".translate(_SPECIAL) if region else "")
    name += f" [{UNITS[metric]}]" if metric in UNITS else ""
    heads = [f"$N = {n:g}$" if against == "n" else costs.text(n).replace("µs", r"\textmu s") for n in columns]
    lines = [
        rf"% {result.provenance}".translate({ord("\n"): " "}),
        rf"\begin{{tabular}}{{l{'r' * len(columns)}}}",
        r"\toprule",
        rf"{name} & " + " & ".join(heads) + r" \\",
        r"\midrule",
    ]
    for arm in order:
        row = [cells.get((arm, column), "--") for column in columns]
        lines.append(f"{labels.get(arm, arm).translate(_SPECIAL)} & " + " & ".join(row) + r" \\")
    lines.append(r"\bottomrule")
    notes = [r"$^{\dagger}$ heavy tail: the intervals mean nothing"] if heavy & set(order) else []
    if against == "time":
        notes.append(f"{costs.threads} threads, the median of the measured times")
    lines += [rf"\multicolumn{{{len(columns) + 1}}}{{l}}{{\footnotesize {note}}} \\" for note in notes]
    return "\n".join([*lines, r"\end{tabular}", ""])
