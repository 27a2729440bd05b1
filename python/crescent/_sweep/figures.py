"""Figures of a sweep: curves over one axis, heat maps over two, and the map of checks, in the style of crescent.plot."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _crescent
from .grid import UsageError, hint, short
from .summary import Numbers, geometric, state_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Axis = tuple[str, list[Any]]  #: a swept key and its values


_COLOURS = {
    "right": "#009e73", "heavy-tailed": "#e69f00", "inconclusive": "#bdbdbd", "wrong": "#d55e00", "error": "#000000",
}  # fmt: skip


def axes_over(numbers: Numbers, over: Sequence[str] | None) -> list[Axis]:
    """The swept keys with several values; or these, one or two."""
    if over is None:
        return [axis for axis in numbers.axes.items() if len(axis[1]) > 1]
    if isinstance(over, str):
        raise UsageError(f"over is {over!r}: expected a list of one or two swept keys, [{over!r}]")
    for path in over:
        if path not in numbers.axes:
            near = _crescent.nearest(path, list(numbers.axes))
            raise UsageError(f"over has {path!r}: expected one of {', '.join(numbers.axes)}" + hint(near))
    return [(path, numbers.axes[path]) for path in over]


def figure_of(
    folder: str | PathLike[str], metric: str, over: Sequence[str] | None, arms: Sequence[str] | None
) -> Figure:
    """Curves over one axis, or heat maps over two; of a sweep of checks the map of kinds."""
    if state_of(folder).get("kind") == "check":
        if metric or over is not None or arms is not None:
            raise UsageError(f"{folder}: a sweep of checks has one map: expected no metric, over and arms")
        return map_of_checks(folder)
    numbers = Numbers(folder)
    if isinstance(arms, str):
        raise UsageError(f"arms is {arms!r}: expected a list of names, [{arms!r}]")
    name, region = numbers.chosen(metric)
    measured_arms = [arm for arm in numbers.arms() if numbers.counts(arm, name, region)]
    for arm in arms or ():
        if arm not in measured_arms:
            near = _crescent.nearest(str(arm), measured_arms)
            raise KeyError(f"no arm {arm!r}: there are {', '.join(measured_arms)}" + hint(near))
    axes = axes_over(numbers, over)
    if not axes:
        raise UsageError("the sweep has one point: expected several values of a key")
    if len(axes) > 2:
        raise UsageError(
            f"the sweep has {len(axes)} axes: expected over= one or two of {', '.join(p for p, _ in axes)}"
        )
    if len(axes) == 1:
        return curves(numbers, name, region, arms or measured_arms, axes[0])
    across, up = axes if over is not None else sorted(axes, key=lambda axis: -len(axis[1]))
    return heat_maps(numbers, name, region, arms or measured_arms, across, up)


def grid_of(numbers: Numbers, across: Axis, up: Axis, arm: str, n: int, metric: str, region: str) -> Any:
    """The mean of a metric over the points of each pair of values."""
    means: dict[tuple[int, int], list[float]] = {}
    for point in numbers.points():
        if values := numbers.values.get((point["scene"], arm, n, metric, region)):
            cell = (up[1].index(point["values"][up[0]]), across[1].index(point["values"][across[0]]))
            means.setdefault(cell, []).append(geometric(values))
    out = np.full((len(up[1]), len(across[1])), np.nan)
    for cell, of_points in means.items():
        out[cell] = geometric(of_points)
    return out


def heat_map(ax: Any, values: Any, across: Axis, up: Axis, **how: Any) -> Any:
    drawn = ax.imshow(values, origin="lower", aspect="auto", **how)
    ax.set_xticks(range(len(across[1])), [short(v) for v in across[1]], rotation=45 if len(across[1]) > 5 else 0)
    ax.set_yticks(range(len(up[1])), [short(v) for v in up[1]])
    ax.set_xlabel(across[0])
    ax.set_ylabel(up[0])
    return drawn


def heat_maps(numbers: Numbers, metric: str, region: str, arms: Sequence[str], across: Axis, up: Axis) -> Figure:
    """The metric of each arm over two axes, on one logarithmic scale; the mean over further axes."""
    from matplotlib.figure import Figure
    from matplotlib.colors import LogNorm, Normalize

    from .. import plot

    maps = []
    for arm in arms:
        n = max(numbers.counts(arm, metric, region))
        maps.append((arm, n, grid_of(numbers, across, up, arm, n, metric, region)))
    finite = np.concatenate([m[np.isfinite(m)] for *_, m in maps])
    if finite.size == 0:
        raise UsageError(f"the sweep has no {metric} yet")
    low, high = finite.min(), finite.max()
    norm: Any = LogNorm(low, high if high > low else low * 1.01) if low > 0 else Normalize(low, high)
    with plot.style():
        columns = min(len(maps), 3)
        rows = -(-len(maps) // columns)
        size = (3.2 * columns + 0.8, (0.9 + 0.28 * max(len(up[1]), 3)) * rows + 0.4)
        figure = Figure(figsize=size, layout="constrained")
        grid_axes = figure.subplots(rows, columns, squeeze=False)
        for ax in grid_axes.ravel()[len(maps) :]:
            ax.set_visible(False)
        for ax, (arm, n, values) in zip(grid_axes.ravel(), maps, strict=False):
            drawn = heat_map(ax, values, across, up, cmap="cividis", norm=norm)
            ax.set_title(f"{arm}, N = {n}")
            if values.size <= 100:
                for (y, x), value in np.ndenumerate(values):
                    if np.isfinite(value):
                        colour = "white" if norm(value) < 0.55 else "black"
                        ax.text(x, y, f"{value:.3g}", ha="center", va="center", fontsize=6, color=colour)
        figure.colorbar(drawn, ax=list(grid_axes.ravel()), label=plot._label(metric, region), shrink=0.9)
    return figure


def curves(numbers: Numbers, metric: str, region: str, arms: Sequence[str], axis: Axis) -> Figure:
    """The metric of each arm over the values of an axis, with the band over seeds (and over the other axes)."""
    from matplotlib.figure import Figure

    from .. import plot

    path, values = axis
    numeric = all(isinstance(v, (int, float)) and not isinstance(v, bool) for v in values)
    with plot.style():
        figure = Figure(figsize=(plot.COLUMN_MM / 25.4, 2.4 + 0.12 * len(arms)), layout="constrained")
        ax = figure.subplots()
        for k, arm in enumerate(arms):
            n = max(numbers.counts(arm, metric, region), default=0)
            found: dict[Any, list[float]] = {}
            for p in numbers.points():
                x = p["values"][path] if numeric else values.index(p["values"][path])
                found.setdefault(x, []).extend(numbers.values.get((p["scene"], arm, n, metric, region), []))
            found = {x: over_seeds for x, over_seeds in found.items() if over_seeds}
            band(ax, list(found), list(found.values()), k, f"{arm}, N = {n}")
        if not numeric:
            ax.set_xticks(range(len(values)), [short(v) for v in values])
        elif min(values) > 0 and max(values) / min(values) > 5:
            ax.set_xscale("log")
            ax.set_xticks(values, [short(v) for v in values])
            ax.tick_params(axis="x", which="minor", bottom=False, labelbottom=False)
        ax.set_yscale("log")
        ax.set_xlabel(path)
        ax.set_ylabel(plot._label(metric, region))
        ax.grid(True)
        ax.legend(frameon=False, loc="upper center", bbox_to_anchor=(0.5, 0), borderaxespad=4.5, ncols=2)
    return figure


def band(ax: Any, x: list[Any], over_seeds: list[list[float]], k: int, name: str) -> None:
    """Medians over seeds with the band of crescent.plot."""
    from .. import plot

    if not x:
        return
    low, high = (5.0, 95.0) if min(map(len, over_seeds)) >= 20 else (0.0, 100.0)
    colour = plot._COLOURS[k % len(plot._COLOURS)]
    marker, dashes = plot._MARKERS[k % len(plot._MARKERS)], plot._DASHES[k % len(plot._DASHES)]
    ax.plot(x, [np.median(v) for v in over_seeds], marker, ls=dashes, ms=3, color=colour, label=name)
    bounds = [[np.percentile(v, share) for v in over_seeds] for share in (low, high)]
    ax.fill_between(x, *bounds, color=colour, alpha=0.2, lw=0)


def map_of_checks(folder: str | PathLike[str]) -> Figure:
    """The worst kind at each pair of values of the first two axes."""
    from matplotlib.colors import ListedColormap
    from matplotlib.figure import Figure
    from matplotlib.patches import Patch

    from .. import plot
    from .check_sweep import KINDS, found_checks, map_of_kinds

    points = found_checks(folder)
    if not points:
        raise UsageError(f"{folder}: no point was checked yet")
    paths, across, up, kinds = map_of_kinds(points, state_of(folder)["axes"])
    with plot.style():
        figure = Figure(figsize=(1.8 + 0.5 * len(across), 1.3 + 0.35 * len(up)), layout="constrained")
        ax = figure.subplots()
        axes = (paths[0], across), (paths[1] if len(paths) > 1 else "", up)
        colours = ListedColormap([_COLOURS[kind] for kind in KINDS])
        heat_map(ax, np.ma.masked_less(kinds, 0), *axes, cmap=colours, vmin=-0.5, vmax=len(KINDS) - 0.5)
        found = [KINDS[k] for k in sorted({int(k) for k in kinds.ravel() if k >= 0})]
        patches = [Patch(color=_COLOURS[kind], label=kind) for kind in found]
        ax.legend(handles=patches, frameon=False, loc="upper left", bbox_to_anchor=(1.01, 1))
    return figure
