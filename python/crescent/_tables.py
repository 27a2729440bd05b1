"""Tables of a result for a paper."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from ._intervals import Values, best_of, half_width
from ._metric_names import NAMES, RANKED, UNITS

if TYPE_CHECKING:
    from .experiments import Measured

_SPECIAL = str.maketrans({c: "\\" + c for c in "&%$#_{}"})


def _cell(values: Values, digits: int, bold: bool) -> str:
    mean = float(np.mean(values))
    places = max(0, digits - 1 - math.floor(math.log10(abs(mean)))) if mean else digits - 1
    half = 0.0
    if values.size > 1:
        half = half_width(values)
        if half > 0:  # its first figure at least
            places = max(places, min(places + 3, -math.floor(math.log10(half))))
    text = f"{mean:.{places}f}"
    out = rf"\mathbf{{{text}}}" if bold else text
    if values.size > 1:
        out += rf" \pm {half:.{places}f}"
    return f"${out}$"


def latex(result: Measured, metric: str, region: str | None, s: float, rank: bool, digits: int) -> str:
    rows = [r for r in result.records() if r["meter"] == metric and r["s"] == s and r["value"] is not None]
    region = next((r["region"] for r in rows), "") if region is None else region
    rows = [r for r in rows if r["region"] == region]
    if not rows:
        there = sorted({(r["meter"], r["region"]) for r in result.records()})
        raise KeyError(f"no {metric} of {region or 'the frame'} at s = {s:g}: there are {there}")
    counts = sorted({r["n"] for r in rows})
    arms = list(dict.fromkeys(r["arm"] for r in rows))
    by = {
        (a, n): np.array([r["value"] for r in rows if (r["arm"], r["n"]) == (a, n)], float) for a in arms for n in counts
    }
    best: dict[int, set[str]] = {}
    for n in counts:
        of = {a: by[a, n] for a in arms if by[a, n].size}
        found = best_of(of) if rank and metric in RANKED else set()
        best[n] = found if len(found) < len(of) else set()
    name = NAMES.get(metric, metric.translate(_SPECIAL)) + (f", region {region}".translate(_SPECIAL) if region else "")
    name += f" [{UNITS[metric]}]" if metric in UNITS else ""
    lines = [
        rf"% {result.provenance}".translate({ord("\n"): " "}),
        rf"\begin{{tabular}}{{l{'r' * len(counts)}}}",
        r"\toprule",
        rf"{name} & " + " & ".join(f"$N = {n}$" for n in counts) + r" \\",
        r"\midrule",
    ]
    for a in arms:
        cells = [_cell(by[a, n], digits, a in best[n]) if by[a, n].size else "--" for n in counts]
        lines.append(f"{a.translate(_SPECIAL)} & " + " & ".join(cells) + r" \\")
    return "\n".join([*lines, r"\bottomrule", r"\end{tabular}", ""])
