"""DIR/report.html: heat maps over two axes and ladders of the points, in the style of crescent.plot."""

from __future__ import annotations

import base64
import html
import io
from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import Any

from .figures import axes_over, band, curves, heat_maps
from .grid import label
from .store import write_whole
from .summary import Numbers, state_of, summary

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


def _over_axes(numbers: Numbers, metric: str, region: str) -> str:
    """The curves over one axis, or the heat maps over the first two."""
    axes = axes_over(numbers)
    arms = [arm for arm in numbers.arms() if numbers.counts(arm, metric, region)]
    what = f"{metric}{' of ' + region if region else ''}"
    if len(axes) == 1:
        figure = curves(numbers, metric, region, arms, axes[0])
        return f"<h2>{what} over {axes[0][0]}</h2>\n" + _image(figure, "curves")
    if len(axes) < 2:
        return ""
    across, up = sorted(axes[:2], key=lambda axis: -len(axis[1]))
    if (maps := heat_maps(numbers, metric, region, arms, across, up)) is None:
        return ""
    more = "" if len(axes) < 3 else f'<p class="note">Mean over {", ".join(path for path, _ in axes[2:])}.</p>\n'
    return f"<h2>{what} over {across[0]} and {up[0]}</h2>\n{more}" + _image(maps, "heat maps")


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
                band(ax, at, [numbers.values[point["scene"], arm, n, metric, region] for n in at], k, arm)
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
        parts += [_over_axes(numbers, name, region), _ladders(numbers, name, region)]
    except ImportError:
        parts.append('<p class="note">No figures: pip install matplotlib</p>\n')
    parts.append(f"<h2>Table</h2>\n<pre>{html.escape(summary(out, metric))}</pre>\n")
    write_whole(path, "".join(parts))
    return path
