"""DIR/report.html: heat maps over two axes and ladders of the points, in the style of crescent.plot."""

from __future__ import annotations

import base64
import html
import io
from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from .grid import label, short
from .store import write_whole
from .summary import Numbers, geometric, state_of, summary

_MOST_LADDERS = 12  # of more points, some ladders are only in the dataset
_HEAD = """<!doctype html><html lang="en"><meta charset="utf-8"><title>{title}</title><style>
body{{font:15px/1.5 Inter,system-ui,sans-serif;max-width:70rem;margin:2rem auto;padding:0 1rem;color:#1a1a1a}}
pre{{overflow-x:auto;font:13px/1.45 ui-monospace,monospace;background:#f6f6f4;padding:.8rem}}
img{{max-width:100%}}.failed{{color:#a40000}}.note{{color:#555}}h1{{font-size:1.5rem}}h2{{font-size:1.15rem;margin-top:2rem}}
</style><h1>{title}</h1>
"""


def opening(title: str, note: str, state: Mapping[str, Any]) -> list[str]:
    """The head of a page, a note, and the list of failures."""
    failed = (f"failed: {place}: {error}" for place, error in state.get("failed", {}).items())
    return [
        _HEAD.format(title=html.escape(title)),
        f'<p class="note">{html.escape(note)}</p>\n',
        *(f'<p class="failed">{html.escape(line)}</p>\n' for line in failed),
    ]


def _image(figure: Any, alt: str) -> str:
    """A figure as an inlined PNG of 160 dots per inch."""
    from .. import plot

    data = io.BytesIO()
    with plot.style():
        figure.savefig(data, format="png", dpi=160)
    return f'<img alt="{html.escape(alt)}" src="data:image/png;base64,{base64.b64encode(data.getvalue()).decode()}">\n'


def _grid_of(points: list[dict[str, Any]], across: tuple[str, list[Any]], up: tuple[str, list[Any]], of: Any) -> Any:
    """The mean of `of` over the points of each pair of values."""
    out = np.full((len(up[1]), len(across[1])), np.nan)
    sums: dict[tuple[int, int], list[float]] = {}
    for point in points:
        value = of(point)
        if value is not None:
            at = (up[1].index(point["values"][up[0]]), across[1].index(point["values"][across[0]]))
            sums.setdefault(at, []).append(value)
    for at, values in sums.items():
        out[at] = geometric(values)
    return out


def _heat_map(ax: Any, values: Any, across: tuple[str, list[Any]], up: tuple[str, list[Any]], **how: Any) -> Any:
    drawn = ax.imshow(values, origin="lower", aspect="auto", **how)
    ax.set_xticks(range(len(across[1])), [short(v) for v in across[1]], rotation=45 if len(across[1]) > 5 else 0)
    ax.set_yticks(range(len(up[1])), [short(v) for v in up[1]])
    ax.set_xlabel(across[0])
    ax.set_ylabel(up[0])
    return drawn


def _heat_maps(numbers: Numbers, metric: str, region: str) -> str:
    """The metric of each arm over the first two axes, on one logarithmic scale."""
    from matplotlib.figure import Figure
    from matplotlib.colors import LogNorm, Normalize

    from .. import plot

    axes = [axis for axis in numbers.axes.items() if len(axis[1]) > 1]
    if len(axes) < 2:
        return ""
    across, up = sorted(axes[:2], key=lambda axis: -len(axis[1]))
    arms = [arm for arm in numbers.arms() if numbers.counts(arm, metric, region)]
    maps = []
    for arm in arms:
        n = max(numbers.counts(arm, metric, region))

        def mean(point: dict[str, Any], arm: str = arm, n: int = n) -> float | None:
            values = numbers.values.get((point["scene"], arm, n, metric, region))
            return geometric(values) if values else None

        maps.append((arm, n, _grid_of(numbers.points(), across, up, mean)))
    every = np.concatenate([m.ravel() for *_, m in maps])
    every = every[np.isfinite(every)]
    if every.size == 0:
        return ""
    norm: Any = Normalize(every.min(), every.max())
    if every.min() > 0:
        norm = LogNorm(every.min(), every.max() if every.max() > every.min() else every.min() * 1.01)
    with plot.style():
        columns = min(len(maps), 3)
        rows = -(-len(maps) // columns)
        size = (3.2 * columns + 0.8, (0.9 + 0.28 * max(len(up[1]), 3)) * rows + 0.4)
        figure = Figure(figsize=size, layout="constrained")
        grid_axes = figure.subplots(rows, columns, squeeze=False)
        for ax in grid_axes.ravel()[len(maps) :]:
            ax.set_visible(False)
        for ax, (arm, n, values) in zip(grid_axes.ravel(), maps, strict=False):
            drawn = _heat_map(ax, values, across, up, cmap="cividis", norm=norm)
            ax.set_title(f"{arm}, N = {n}")
            if values.size <= 100:
                for (y, x), value in np.ndenumerate(values):
                    if np.isfinite(value):
                        dark = norm(value) < 0.55
                        ax.text(
                            x,
                            y,
                            f"{value:.3g}",
                            ha="center",
                            va="center",
                            fontsize=6,
                            color="white" if dark else "black",
                        )
        figure.colorbar(drawn, ax=list(grid_axes.ravel()), label=plot._label(metric, region), shrink=0.9)
    more = "" if len(axes) < 3 else f'<p class="note">Mean over {", ".join(path for path, _ in axes[2:])}.</p>\n'
    return f"<h2>{metric}{' of ' + region if region else ''} over {across[0]} and {up[0]}</h2>\n{more}" + _image(
        figure, "heat maps"
    )


def _curves(numbers: Numbers, metric: str, region: str) -> str:
    """With one axis: the metric of each arm over its values, with the band over seeds."""
    from matplotlib.figure import Figure

    from .. import plot

    axes = [axis for axis in numbers.axes.items() if len(axis[1]) > 1]
    if len(axes) != 1 or not all(isinstance(v, (int, float)) for v in axes[0][1]):
        return ""
    path, values = axes[0]
    with plot.style():
        figure = Figure(figsize=(5.2, 3.2), layout="constrained")
        ax = figure.subplots()
        for k, arm in enumerate(numbers.arms()):
            n = max(numbers.counts(arm, metric, region), default=0)
            found = [
                (p["values"][path], numbers.values[p["scene"], arm, n, metric, region])
                for p in numbers.points()
                if (p["scene"], arm, n, metric, region) in numbers.values
            ]
            _band(ax, [x for x, _ in found], [v for _, v in found], k, f"{arm}, N = {n}")
        if min(values) > 0 and max(values) / min(values) > 5:
            ax.set_xscale("log")
            ax.set_xticks(values, [short(v) for v in values])
            ax.tick_params(axis="x", which="minor", bottom=False, labelbottom=False)
        ax.set_yscale("log")
        ax.set_xlabel(path)
        ax.set_ylabel(plot._label(metric, region))
        ax.grid(True)
        ax.legend(frameon=False)
    return f"<h2>{metric}{' of ' + region if region else ''} over {path}</h2>\n" + _image(figure, "curves")


def _band(ax: Any, x: list[Any], over: list[list[float]], k: int, name: str) -> None:
    """Medians over seeds with the band of crescent.plot."""
    from .. import plot

    if not x:
        return
    low, high = (5.0, 95.0) if min(map(len, over)) >= 20 else (0.0, 100.0)
    colour = plot._COLOURS[k % len(plot._COLOURS)]
    ax.plot(x, [np.median(v) for v in over], "o-", ms=3, color=colour, label=name)
    ax.fill_between(
        x, [np.percentile(v, low) for v in over], [np.percentile(v, high) for v in over], color=colour, alpha=0.2, lw=0
    )


def _ladders(numbers: Numbers, metric: str, region: str) -> str:
    """The metric against N of each arm at some points, all on one scale."""
    from matplotlib.figure import Figure

    from .. import plot

    points = [p for p in numbers.points() if any(key[0] == p["scene"] for key in numbers.values)]
    arms = numbers.arms()
    if not points or max((len(numbers.counts(arm, metric, region)) for arm in arms), default=0) < 2:
        return ""
    shown = points
    if len(points) > _MOST_LADDERS:
        shown = [points[round(k * (len(points) - 1) / (_MOST_LADDERS - 1))] for k in range(_MOST_LADDERS)]
    columns = min(len(shown), 3)
    rows = -(-len(shown) // columns)
    with plot.style():
        figure = Figure(figsize=(3.1 * columns + 0.3, 2.3 * rows + 0.4), layout="constrained")
        axes = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=True)
        for ax in axes.ravel()[len(shown) :]:
            ax.set_visible(False)
        counts = sorted({n for arm in arms for n in numbers.counts(arm, metric, region)})
        for ax, point in zip(axes.ravel(), shown, strict=False):
            for k, arm in enumerate(arms):
                at = [n for n in counts if (point["scene"], arm, n, metric, region) in numbers.values]
                _band(ax, at, [numbers.values[point["scene"], arm, n, metric, region] for n in at], k, arm)
            ax.set_title(label(point["values"]))
            ax.set_xscale("log", base=2)
            ax.set_yscale("log")
            ax.set_xticks(counts, [str(n) for n in counts])
            ax.tick_params(axis="x", which="minor", bottom=False, labelbottom=False)
            ax.grid(True)
        axes[0][0].legend(frameon=False)
        figure.supxlabel("samples a pixel, N", fontsize=8)
        figure.supylabel(plot._label(metric, region), fontsize=8)
    note = "Lines are medians over seeds. Bands reach from the smallest to the largest seed, or from 5 % to 95 % of 20 "
    note += "seeds or more."
    if len(shown) < len(points):
        note += f" {len(shown)} of {len(points)} points are shown."
    return f'<h2>Ladders</h2>\n<p class="note">{note}</p>\n' + _image(figure, "ladders")


def write_report(out: str | PathLike[str], metric: str = "") -> Path | None:
    """Writes report.html; without matplotlib there are no figures. None if there are no results."""
    state = state_of(out)
    path = Path(out) / "report.html"
    if state.get("kind") == "check":
        from .check_sweep import page_of_checks

        write_whole(path, page_of_checks(out))
        return path
    if not any((Path(out) / "data").glob("*.parquet")):
        return None
    numbers = Numbers(out)
    if not numbers.metrics:
        return None
    name, region = numbers.chosen(metric)
    note = f"{state['file']}, {len(state['points'])} points, {state['seeds']} seeds; crescent {state['numerics']}"
    parts = opening(f"Sweep: {state['title']}", note, state)
    try:
        parts += [_heat_maps(numbers, name, region), _curves(numbers, name, region), _ladders(numbers, name, region)]
    except ImportError:
        parts.append('<p class="note">No figures: pip install matplotlib</p>\n')
    parts.append(f"<h2>Table</h2>\n<pre>{html.escape(summary(out, metric))}</pre>\n")
    write_whole(path, "".join(parts))
    return path
