"""Names and units of the metrics in figures and tables, and those of which the smallest is the best."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from . import _crescent

RADIANCE = "W sr$^{-1}$ m$^{-2}$"
UNITS = {
    **dict.fromkeys(("y_mean", "rmse", "rmse_frame", "largest"), RADIANCE),
    **dict.fromkeys(("var", "bias2", "mse"), f"({RADIANCE})$^2$"),
    "efficiency_n": f"({RADIANCE})$^{{-2}}$",
    "efficiency_time": f"({RADIANCE})$^{{-2}}$ s$^{{-1}}$",
}
NAMES = {
    "rmse": "RMSE",
    "rmse_frame": "RMSE of the frame",
    "var": "variance",
    "y_mean": "mean Y",
    "tail_k": "k-hat",
    "relmse": "relMSE",
    "smape": "SMAPE",
    "bias2": "squared bias",
    "flip": "FLIP",
    "horizon_frac": "horizon share",
    "efficiency_n": "efficiency at equal N",
    "efficiency_time": "efficiency at equal time",
}
RANKED = frozenset({"rmse", "rmse_frame", "var", "mse", "relmse", "smape", "flip", "fireflies"})

#: Efficiencies, 1 / (variance of N samples times N) and 1 / (variance times seconds): the largest is the best.
LARGEST_IS_BEST = frozenset({"efficiency_n", "efficiency_time"})

NO_METRICS = "no metrics: run(references=False) has films alone"


def listed(rows: Iterable[Mapping[str, Any]], metric: str, region: str) -> str:
    """The metrics of these rows with their regions, for a message, and the nearest one, or the nearest region."""
    rows = list(rows)
    there = sorted({f"{row['metric']} of {row['region']}" if row["region"] else row["metric"] for row in rows})
    metrics = [*dict.fromkeys(str(row["metric"]) for row in rows), *sorted(LARGEST_IS_BEST)]
    if metric not in metrics:
        near = _crescent.nearest(metric, metrics)
    else:
        near = _crescent.nearest(region, list(dict.fromkeys(row["region"] for row in rows if row["region"])))
    return (", ".join(there) or NO_METRICS) + (f"; did you mean '{near}'?" if near else "")
