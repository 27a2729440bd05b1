"""Figures for a paper from the results of :func:`crescent.run`, drawn by matplotlib.

    r = crescent.run("gallery.toml", seeds=(1, 4))
    crescent.plot.save(crescent.plot.ladder(r, region="H"), "ladder.pdf")

Each function draws into `ax` where one is given and returns the axes; otherwise it makes a figure of one column,
85 mm wide. :func:`save` embeds its fonts, so that text stays text. Colours are those of Okabe and Ito (2008), which
readers with any common colour vision can tell apart; they follow the arm, so an arm has one colour in all figures of a
result. Lines are medians over seeds, bands reach from the smallest to the largest seed (from 5 % to 95 % with 20 seeds
or more).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from os import PathLike
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from ._arrays import channels
from ._cost import Against, Costs
from ._html import tone
from ._intervals import differ, fitted_slope, half_width, t_of
from ._metric_names import LARGEST_IS_BEST, NAMES, RADIANCE, UNITS
from ._sampler import whole
from ._values import arms_of, box_in, compared_at, film_at, heavy_arms, named_arms, only_region, values_of, with_interval

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .experiments import Film, Measured

__all__ = [
    "bars",
    "crops",
    "heat",
    "hemisphere",
    "ladder",
    "page",
    "save",
    "significance",
    "style",
    "sweep",
    "where_noise_moved",
]

COLUMN_MM = 85.0  #: width of one column
_COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000", "#f0e442")
_STYLE: dict[Any, Any] = {
    "font.family": ["Inter", "DejaVu Sans"],
    "font.size": 8.0,
    "axes.titlesize": 8.0,
    "axes.labelsize": 8.0,
    "legend.fontsize": 7.0,
    "xtick.labelsize": 7.0,
    "ytick.labelsize": 7.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.6,
    "lines.linewidth": 1.2,
    "grid.linewidth": 0.4,
    "grid.color": "#d9d9d9",
    "pdf.fonttype": 42,  # TrueType: text stays text
    "svg.fonttype": "none",
    "savefig.dpi": 300,
    "savefig.bbox": "tight",
}


def style() -> AbstractContextManager[None]:
    """The settings of these figures as a context, for other figures of the user."""
    import logging

    import matplotlib as mpl

    logging.getLogger("matplotlib.font_manager").setLevel(logging.ERROR)  # Inter need not be installed
    return mpl.rc_context(_STYLE)


def save(ax: Axes | Sequence[Axes] | Figure, path: str | PathLike[str]) -> None:
    """Writes the figure of these axes, or a figure, as PDF, SVG or PNG, by the ending of `path`; 300 dots an inch."""
    import matplotlib as mpl

    with style():
        first: Any = ax[0] if isinstance(ax, Sequence) else ax
        figure: Any = getattr(first, "figure", None) or first
        with mpl.rc_context(
            {"savefig.bbox": None} if figure.get_label() == "page" else {}
        ):  # a page has its exact width
            figure.savefig(path)


def _axes(ax: Axes | None, height_mm: float = 60.0) -> Axes:
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt

    return plt.subplots(figsize=(COLUMN_MM / 25.4, height_mm / 25.4), layout="constrained")[1]


_MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*", "<", ">", "p")
_DASHES: tuple[Any, ...] = ("-", "--", "-.", (0, (1, 1)), (0, (5, 1, 1, 1, 1, 1)))
_HATCHES = ("", "////", "....", "xxxx", "----", "\\\\\\\\", "++++", "||||", "oooo")


@dataclass(frozen=True)
class _Look:
    """How an arm is drawn: readers tell two arms apart in grey too, by marker, dashes and hatching."""

    colour: str
    marker: str
    dashes: Any
    hatch: str
    label: str


def _look(
    r: Measured, arm: str, labels: Mapping[str, str] | None = None, colours: Mapping[str, str] | None = None
) -> _Look:
    from matplotlib.colors import is_color_like

    known = arms_of(r, None)
    labels, colours = named_arms("labels", labels, known), named_arms("colours", colours, known)
    for name, colour in colours.items():
        if not is_color_like(colour):
            raise ValueError(f"colours[{name!r}] is {colour!r}: expected a colour such as '#0072b2' or 'black'")
    k = known.index(arm)
    return _Look(
        colours.get(arm, _COLOURS[k % len(_COLOURS)]),
        _MARKERS[k % len(_MARKERS)],
        _DASHES[k % len(_DASHES)],
        _HATCHES[k % len(_HATCHES)],
        labels.get(arm, arm),
    )


def _label(metric: str, region: str) -> str:
    """The name of a metric with its unit, in a second line if it is long."""
    name, unit = NAMES.get(metric, metric) + (f", region {region}" if region else ""), UNITS.get(metric, "")
    return name + (f"{chr(10) if len(name) > 22 else ' '}[{unit}]" if unit else "")


def ladder(
    r: Measured,
    metric: str = "rmse",
    region: str | None = None,
    arms: Sequence[str] | None = None,
    s: float | None = None,
    ax: Axes | None = None,
    *,
    against: Against = "n",
    labels: Mapping[str, str] | None = None,
    colours: Mapping[str, str] | None = None,
    log: bool = True,
    legend: bool = True,
) -> Axes:
    """A metric against the sample count N, the seconds (`against="time"`) or the rays of an arm, one line an arm, with
    its band over seeds; on two logarithmic axes, or with `log=False` on linear ones.

    The legend states the fitted slope with its 95 % interval over seeds (two seeds at least); independent samples of
    finite variance have -0.5. An arm whose metric is 0 is at the lower edge, one of an infinite efficiency at the upper
    one. A heavy tail is named. `labels` and
    `colours` are by arm.
    """
    region = only_region(r, metric, region)
    values = values_of(r, metric, region, s)
    costs = Costs(r, against, r.s if s is None else s)
    heavy = heavy_arms(r, region, s)
    with style():
        new = ax is None
        ax = _axes(ax, 62.0 + 2.0 * len(values) * legend)
        ticks: set[float] = set()
        at_the_edge = []
        for arm in arms_of(r, arms):
            if arm not in values or not costs.knows(arm):
                continue
            n = np.array(sorted(values[arm]))
            over = [np.array(values[arm][k]) for k in n]
            x = np.array([costs.of(arm, k) for k in n])
            low, high = (5.0, 95.0) if min(map(len, over)) >= 20 else (0.0, 100.0)
            middle = np.array([np.median(v) for v in over])
            look = _look(r, arm, labels, colours)
            slope = fitted_slope(n, over)
            name = look.label if slope is None else f"{look.label}: slope {slope.text().replace('-', '−')}"
            name += (": 0" if not middle.any() else ": ∞" if np.isinf(middle).all() else "")
            name += ", heavy tail" if arm in heavy else ""
            shown = np.where(np.isfinite(middle) & ((middle > 0) | (not log)), middle, np.nan)
            ends = [np.where(shown > 0, [_finite_percentile(v, q) for v in over], np.nan) for q in (low, high)]
            ax.plot(x, shown, look.marker, ls=look.dashes, ms=3, color=look.colour, label=name, gid=arm)
            ax.fill_between(x, ends[0], ends[1], color=look.colour, alpha=0.2, lw=0)
            if log and (middle <= 0).any():
                at_the_edge.append((x[middle <= 0], look, 0.02, "0"))
            if np.isinf(middle).any():
                at_the_edge.append((x[np.isinf(middle)], look, 0.98, "∞"))
            ticks |= set(x)
        if log:
            ax.set_xscale("log", base=2 if against == "n" else 10)
            ax.set_yscale("log")
            _log_ticks(ax.yaxis, 6)
            if against != "n":
                _log_ticks(ax.xaxis, 4, costs.unit(max(ticks))[0])
        for x, look, edge, gid in at_the_edge:  # 0 has no logarithm
            ax.plot(
                x, np.full(len(x), edge), look.marker, ls=look.dashes, ms=4, color=look.colour, fillstyle="none",
                transform=ax.get_xaxis_transform(), clip_on=False, gid=gid,
            )  # fmt: skip
        if against == "n":
            ax.set_xticks(sorted(ticks), [f"{k:g}" for k in sorted(ticks)])
            ax.minorticks_off()
        ax.set_xlabel(costs.label(max(ticks, default=1.0) if log else float("inf")))
        ax.set_ylabel(_label(metric, region))
        ax.grid(True)
        if legend:
            # Below the axes, where no line is; the distance is in font sizes, for the labels of the axis.
            for line in ax.get_lines() if new else ():
                line.set_label(_in_lines(str(line.get_label()), COLUMN_MM - 12, 7.0))
            longest = max((len(str(line.get_label())) for line in ax.get_lines()), default=0)
            ax.legend(
                frameon=False, loc="upper center", bbox_to_anchor=(0.5, 0), borderaxespad=4.5,
                ncols=2 if longest <= 30 else 1, columnspacing=1.2, handlelength=2.6,
            )  # fmt: skip
    return ax


def _finite_percentile(values: NDArray[Any], q: float) -> float:
    """A percentile of the finite values; NaN without one."""
    finite = values[np.isfinite(values)]
    return float(np.percentile(finite, q)) if finite.size else float("nan")


def _log_ticks(axis: Any, most: int, unit: float = 1.0) -> None:
    """At most so many labels, in a unit, on a logarithmic axis: powers of ten, or 1, 2 and 5 times these within a short range."""
    low, high = (end / unit for end in sorted(axis.get_view_interval()))
    powers = range(int(np.floor(np.log10(low))), int(np.ceil(np.log10(high))) + 1)
    for digits in ((1.0,), (1.0, 2.0, 5.0), tuple(range(1, 10)), tuple(np.arange(10, 100) / 10)):
        values = [d * 10.0**k for k in powers for d in digits if low <= d * 10.0**k <= high]
        if len(values) >= 2:
            break
    values = [value * unit for value in values[:: -(-len(values) // most)]]
    low, high = low * unit, high * unit

    def text(value: float) -> str:
        value /= unit
        if 1e-3 < value < 1e4:
            return f"{value:.4g}"
        power = int(np.floor(np.log10(value) + 1e-9))
        digits = f"{value / 10.0**power:.3g}"
        return f"$10^{{{power}}}$" if digits == "1" else rf"${digits}\cdot10^{{{power}}}$"

    from matplotlib.ticker import NullFormatter

    axis.set_ticks(values, [text(v) for v in values])
    axis.set_minor_formatter(NullFormatter())
    axis.set_view_interval(low, high, ignore=True)


def bars(
    r: Measured,
    metric: str = "rmse",
    region: str | None = None,
    n: int | None = None,
    arms: Sequence[str] | None = None,
    s: float | None = None,
    ax: Axes | None = None,
    *,
    against: Against = "n",
    budget: float | None = None,
    labels: Mapping[str, str] | None = None,
    colours: Mapping[str, str] | None = None,
    log: bool = False,
    names: Literal["beside", "above"] = "beside",
) -> Axes:
    """A metric of each arm at one N, at equal time or at equal rays, smallest on top; arms of 0 too.

    `n` is by default the largest that all arms have, or most of them, `budget` (in s, or rays a pixel) the largest that all arms reach.
    An arm that has no N of exactly that cost is interpolated between two, in logarithms. A bar is the mean over seeds,
    its line the 95 % interval of that mean; the number is bold if the arm is not significantly worse than the
    best (paired t over seeds). `names="above"`: over the bars, where there is room for long ones.
    """
    region = only_region(r, metric, region)
    compared = compared_at(r, metric, region, s, arms_of(r, arms), against, n, budget)
    heavy = heavy_arms(r, region, s)
    found = sorted(compared.values.items(), key=lambda of: float(of[1].mean()), reverse=metric not in LARGEST_IS_BEST)
    with style():
        ax = _axes(ax, 12.0 + 7.0 * len(found))
        height = 0.7 if names == "beside" else 0.36
        low = min((float(v.mean()) for _, v in found if 0 < v.mean() < np.inf), default=1.0)
        absent = [(arm, np.array([])) for arm in compared.missing]
        found = [*absent, *found]
        for y, (arm, v) in enumerate(found):
            look = _look(r, arm, labels, colours)
            if names == "above":
                _name_above(ax, y + height / 2, look)
            if not v.size:
                text = f"no {compared.costs.text(compared.cost)}" if against == "n" else "less than one sample"
                ax.annotate(
                    text,
                    (0, y),
                    (3, 0),
                    xycoords=("axes fraction", "data"),
                    textcoords="offset points",
                    va="center",
                    size=7,
                )
                continue
            mean, half = float(v.mean()), half_width(v) if v.size > 1 and np.isfinite(v).all() else 0.0
            left = low / 4 if log else 0.0
            if not np.isfinite(mean):  # no variance: there is no end of the bar
                mean = left
            ax.barh(
                y, max(mean - left, 0), left=left, color=look.colour, height=height, hatch=look.hatch, ec="white", lw=0
            )
            if half > 0:
                ax.plot([max(mean - half, left), mean + half], [y, y], color="black", lw=1)
            end = max(mean + half, left)
            text = with_interval(v) + (", heavy tail" if arm in heavy else "")
            ax.annotate(
                text, (end, y), (3, 0), textcoords="offset points", va="center", size=7,
                weight="bold" if arm in compared.best else "normal",
            )  # fmt: skip
        if log:
            ax.set_xscale("log")
        ax.margins(x=0.15)  # room for the numbers
        ax.set_axisbelow(True)
        shown = [_look(r, arm, labels, colours).label for arm, _ in found] if names == "beside" else []
        ax.set_yticks(range(len(found)) if shown else [], shown)
        ax.set_xlabel(f"{_label(metric, region)}{chr(10) if against == 'time' else ' '}{compared.where()}")
        if not log:
            ax.set_xlim(left=0)
        ax.grid(True, axis="x")
        _room_for_texts(ax)
        if log:
            _log_ticks(ax.xaxis, 5)
    return ax


def _name_above(ax: Axes, y: float, look: _Look) -> None:
    """The marker and the label of an arm over its bar; a label that is longer than the axis has smaller letters."""
    name: Any = ax.annotate(
        look.label, (0, y), (8, 1.5), xycoords=("axes fraction", "data"), textcoords="offset points", va="bottom",
        size=6.5, gid="name",
    )  # fmt: skip
    figure: Any = ax.figure
    room = ax.get_window_extent().width - 8 * figure.dpi / 72
    name.set_size(6.5 * min(1.0, room / max(_width(ax, name), 1.0)))
    where = ax.get_yaxis_transform() + _offset(ax, 3, 4.5)
    ax.plot([0], [y], look.marker, color=look.colour, ms=4, clip_on=False, transform=where)


def _offset(ax: Axes, x: float, y: float) -> Any:
    """A shift in points."""
    from matplotlib.transforms import ScaledTranslation

    figure: Any = ax.figure
    return ScaledTranslation(x / 72, y / 72, figure.dpi_scale_trans)


def _renderer(ax: Axes) -> Any:
    figure: Any = ax.figure
    return figure.canvas.get_renderer() if hasattr(figure.canvas, "get_renderer") else None


def _width(ax: Axes, text: Any) -> float:
    """The width of a text in dots."""
    return float(text.get_window_extent(_renderer(ax)).width)


def _room_for_texts(ax: Axes) -> None:
    """Widens the axis until the numbers behind the bars are inside."""
    numbers = [t for t in ax.texts if t.get_gid() != "name"]
    for _ in range(4):
        right = max((t.get_window_extent(_renderer(ax)).x1 for t in numbers), default=0.0)
        box = ax.get_window_extent()
        if right <= box.x1:
            return
        low, high = ax.get_xlim()
        scale = (right - box.x0) / (box.x1 - box.x0)
        if ax.get_xscale() == "log":
            ax.set_xlim(low, low * (high / low) ** scale)
        else:
            ax.set_xlim(low, low + (high - low) * scale)


def _film(r: Measured, arm: str, n: int, s: float | None) -> Film:
    return r.films[(arm, n) if s is None else (arm, n, s)]


def _cut(plane: NDArray[Any], box: Sequence[int] | None) -> NDArray[Any]:
    """Rows top-down of the box [x0, y0, x1, y1) in pixels, y upwards as in the experiment file."""
    height, width = plane.shape[:2]
    x0, y0, x1, y1 = box_in("box", (0, 0, width, height) if box is None else box, width, height)
    return plane[y0:y1, x0:x1][::-1]


def _picture(ax: Axes, image: NDArray[Any], title: str, **how: Any) -> Any:
    drawn = ax.imshow(image, interpolation="nearest", **how)
    ax.set_xticks([])
    ax.set_yticks([])
    ax.spines[:].set_visible(False)
    ax.set_title(title)
    return drawn


_MOST_IN_A_ROW = 6  # pictures, so that each has 27 mm or more of a page


def _rows_of_pictures(count: int, aspect: float, more: float) -> list[Axes]:
    """The axes of a new figure, in rows of equal length; `aspect`: height over width of a picture, `more`: the height
    in inches of the texts of a row."""
    import matplotlib.pyplot as plt

    rows = -(-count // _MOST_IN_A_ROW)
    columns = -(-count // rows)
    width = min(2 * COLUMN_MM + 5, 42.0 * columns) / 25.4
    size = (width, rows * (width / columns * aspect + more))
    made = plt.subplots(rows, columns, figsize=size, layout="constrained", squeeze=False)[1]
    axes = list(made.ravel())
    for unused in axes[count:]:
        unused.set_visible(False)
    return axes[:count]


def _in_lines(text: str, width: float, size: float) -> str:
    """A text in lines of so many mm at a size in points."""
    from ._page import lines_of

    return "\n".join(lines_of(text, width, size))


def _broken(text: str, ax: Axes) -> str:
    """A title in lines that are not wider than its picture's part of the figure."""
    figure: Any = ax.figure
    columns = ax.get_subplotspec().get_gridspec().ncols  # type: ignore[union-attr]
    return _in_lines(text, figure.get_size_inches()[0] * 25.4 / columns - 3, float(ax.title.get_fontsize()))


def _scale(ax: Axes, drawn: Any, label: str, extend: str) -> None:
    """A colour scale as high as the picture."""
    ax.figure.colorbar(drawn, cax=ax.inset_axes((1.03, 0, 0.04, 1)), label=label, extend=extend)


def heat(
    r: Measured,
    arm: str | Sequence[str],
    n: int,
    what: Literal["error", "relative", "var"] = "error",
    s: float | None = None,
    box: Sequence[int] | None = None,
    top: float | None = None,
    ax: Axes | None = None,
    *,
    labels: Mapping[str, str] | None = None,
    background: Literal["light", "dark"] = "light",
) -> Axes | list[Axes]:
    """The error |Y - reference|, or `what` = "relative", the error over the reference, or "var", the variance of Y, of
    each pixel, with a colour scale in its unit.

    Several arms are drawn on one scale, six in a row. `top`: the end of the scale; the 99th percentile where none is
    given.
    `background`: light for paper, where 0 is the lightest, or dark.
    """
    arms = [arm] if isinstance(arm, str) else list(arm)
    if ax is not None and len(arms) > 1:
        raise TypeError("ax is given for several arms: expected one arm, or no ax")
    units = {
        "error": f"|error of Y| [{RADIANCE}]",
        "relative": "|error of Y| / reference",
        "var": f"variance of Y [({RADIANCE})$^2$]",
    }
    if what not in units:
        raise ValueError(f"what is {what!r}: expected 'error', 'relative' or 'var'")
    if background not in ("light", "dark"):
        raise ValueError(f"background is {background!r}: expected 'light' or 'dark'")
    images = [_cut(_plane(_film(r, name, n, s), r, what), box) for name in arms]
    limit = float(np.nanpercentile(np.stack(images), 99)) if top is None else top
    with style():
        if ax is None and len(arms) > 1:
            axes = _rows_of_pictures(len(arms), images[0].shape[0] / images[0].shape[1], 0.35)
        else:
            axes = [_axes(ax)]
        for at, name, image in zip(axes, arms, images, strict=True):
            title = f"{_look(r, name, labels).label}, N = {n}"
            title = _broken(title, at) if len(arms) > 1 else title
            drawn = _picture(
                at, image, title, cmap="inferno" if background == "dark" else "magma_r", vmin=0, vmax=limit or 1.0
            )
        if len(axes) > 1:
            axes[0].figure.colorbar(drawn, ax=axes, label=units[what], extend="max", fraction=0.03, pad=0.01)
        else:
            _scale(axes[0], drawn, units[what], "max")
    return axes if len(axes) > 1 else axes[0]


def _plane(film: Film, r: Measured, what: str) -> NDArray[Any]:
    """The values of a map; NaN where the reference is 0 and the error is relative to it."""
    if what == "var":
        return film.var
    if film.s not in r.references:
        raise KeyError(f"the result has no reference at s = {film.s:g}")
    reference = r.references[film.s]["y"]
    error = np.abs(film.y - reference)
    if what == "error":
        return error
    return np.divide(error, reference, out=np.full(error.shape, np.nan, error.dtype), where=reference > 0)


def _tiles(plane: NDArray[Any], tile: int, least: int = 2) -> NDArray[Any]:
    """The pixels of each tile, [rows, columns, pixels]."""
    tile = whole("tile", tile, least, 4096, f"expected {least} or more pixels")
    height, width = (size - size % tile for size in plane.shape)
    if height == 0 or width == 0:
        raise ValueError(f"tile is {tile}: expected at most the size of the picture, {min(plane.shape)}")
    cut = plane[:height, :width].reshape(height // tile, tile, width // tile, tile)
    return cut.transpose(0, 2, 1, 3).reshape(height // tile, width // tile, tile * tile)


def _noise_map(
    r: Measured, a: str, b: str, n: int, values: NDArray[Any], limit: float, what: str, ax: Axes | None,
    labels: Mapping[str, str] | None,
) -> Axes:  # fmt: skip
    """Values of tiles from -limit to limit, blue where `b` has less noise, grey where one of the two has no variance.
    `what`: the label of the scale, with places for the names of `b` and of `a`."""
    first, second = (_look(r, arm, labels).label for arm in (a, b))
    with style():
        ax = _axes(ax)
        width = 0.7 * COLUMN_MM
        title = _in_lines(f"{second} against {first}, N = {n}", width, 8.0)
        drawn = _picture(ax, values, title, cmap="RdBu_r", vmin=-limit, vmax=limit)
        ax.set_facecolor("#bfbfbf")
        high = max(0.8 * width * values.shape[0] / values.shape[1], 25.0)
        _scale(ax, drawn, _in_lines(what.format(second, first), high, 8.0), "both")
    return ax


def where_noise_moved(
    r: Measured,
    a: str,
    b: str,
    n: int,
    s: float | None = None,
    box: Sequence[int] | None = None,
    tile: int = 8,
    ax: Axes | None = None,
    *,
    labels: Mapping[str, str] | None = None,
    significant: bool = False,
    top: float | None = None,
) -> Axes:
    """log2 of the variance of `b` over that of `a`, over tiles of `tile` pixels: blue where `b` has less, grey where one
    has none.

    `significant`: only tiles in which the two differ significantly are coloured, the others are white: paired t of the
    variances of the pixels of a tile, with 5 % of false discoveries among the coloured tiles (Benjamini and Hochberg 1995).
    The scale ends at `top` doublings, at 6 at most where none is given.
    """
    least = 2 if significant else 1
    of_a, of_b = (_tiles(_cut(_film(r, arm, n, s).var.astype(float), box), tile, least) for arm in (a, b))
    mean_a, mean_b = of_a.mean(-1), of_b.mean(-1)
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.where((mean_a > 0) & (mean_b > 0), np.log2(mean_b / mean_a), np.nan)
    limit = min(float(np.nanpercentile(np.abs(ratio), 98)) if np.isfinite(ratio).any() else 1.0, 6.0)
    limit = (limit or 1.0) if top is None else top
    if significant:
        ratio = np.where(differ(of_b - of_a) | ~np.isfinite(ratio), ratio, 0.0)
    return _noise_map(r, a, b, n, ratio, limit, "log₂ variance of {} / {}", ax, labels)


def significance(
    r: Measured,
    a: str,
    b: str,
    n: int,
    s: float | None = None,
    box: Sequence[int] | None = None,
    tile: int = 8,
    ax: Axes | None = None,
    *,
    labels: Mapping[str, str] | None = None,
    top: float = 6.0,
) -> Axes:
    """How significant the difference of two variances is: Student's t of the paired variances of the pixels of each tile,
    blue where `b` has less. Beyond 2 in size a single tile differs at about 5 %."""
    apart = _tiles(_cut((_film(r, b, n, s).var.astype(float) - _film(r, a, n, s).var), box), tile)
    return _noise_map(r, a, b, n, t_of(apart), top, "t of the variance of {} - {}", ax, labels)


def crops(
    r: Measured,
    n: int | None,
    box: Sequence[int],
    arms: Sequence[str] | None = None,
    metric: str = "rmse",
    region: str | None = None,
    s: float | None = None,
    exposure: float = 1.0,
    *,
    against: Against = "n",
    budget: float | None = None,
    labels: Mapping[str, str] | None = None,
) -> list[Axes]:
    """The same crop of the reference and of several arms, six in a row; below each the mean of its metric over seeds,
    with the half width of its 95 % interval.

    `box`: [x0, y0, x1, y1) in pixels, y upwards. With `against="time"` or "rays" `n` is None, and each arm's film is that
    of the N nearest to `budget`, by default what every arm reaches; the title has its N, and the metric is that of
    :func:`bars`.
    """
    at = r.s if s is None else s
    region = only_region(r, metric, region)
    compared = compared_at(r, metric, region, s, arms_of(r, arms), against, n, budget)
    films: dict[str, Film] = {}
    for arm, count in compared.n.items():
        film = film_at(r, arm, count, at)
        if film is not None and (against != "n" or film.n == count):
            films[arm] = film
    if not films:
        raise KeyError(f"no arm has a film {compared.where()} and s = {at:g}")
    reference = r.references.get(at)
    heavy = heavy_arms(r, region, s)
    name = NAMES.get(metric, metric) + (f", region {region}" if region else "")
    count = len(films) + (reference is not None)
    with style():
        height, width = next(iter(films.values())).y.shape
        box = box_in("box", box, width, height)
        axes = _rows_of_pictures(count, (box[3] - box[1]) / (box[2] - box[0]), 0.6)
        if reference is not None:
            rgb = np.stack([reference[c] for c in "rgb"], -1)
            _picture(axes[0], tone(_cut(rgb, box), exposure), "reference")
            unit = UNITS.get(metric, "")
            cost = "" if against == "n" else f"\n{compared.where()}"
            axes[0].set_xlabel(_broken(name, axes[0]) + (f"\n[{unit}]" if unit else "") + cost.replace(", ", "\n"))
        for ax, (arm, film) in zip(axes[count - len(films) :], films.items()):
            label = _look(r, arm, labels).label
            cost = "" if against == "n" else f"\n{compared.costs.text(compared.costs.of(arm, film.n))}"
            _picture(ax, tone(_cut(film.rgb, box), exposure), _broken(f"{label}, N = {film.n}", ax) + cost)
            text = with_interval(compared.values[arm]) + ("\nheavy tail" if arm in heavy else "")
            ax.set_xlabel(text if reference is not None else f"{name}\n{text}")
    return axes


def sweep(
    folder: str | PathLike[str],
    metric: str = "",
    over: Sequence[str] | None = None,
    arms: Sequence[str] | None = None,
) -> Figure:
    """A metric of a sweep, such as "rmse.H" or "efficiency_time.H": of each arm at its largest N, over one axis as curves
    with bands over seeds, over two as heat maps on one scale. Of a sweep of checks, the map of the kinds of its points.

    `over`: one or two of the swept keys, the mean is over the others; by default all that have several values.
    """
    from ._sweep.figures import figure_of

    return figure_of(folder, metric, over, arms)


def page(
    r: Measured,
    insets: Sequence[Any] | None = None,
    *,
    arms: Sequence[str] | None = None,
    metric: str = "rmse",
    region: str | None = None,
    against: Against = "n",
    n: int | None = None,
    budget: float | None = None,
    labels: Mapping[str, str] | None = None,
    colours: Mapping[str, str] | None = None,
    columns: Literal[1, 2] = 2,
    log: bool = True,
    s: float | None = None,
    exposure: float = 1.0,
    show: Sequence[Literal["picture", "grid", "ladder", "bars"]] = ("picture", "grid", "ladder", "bars"),
    picture: str | None = None,
) -> Figure:
    """The figure page of a paper: the whole picture with marked insets, a ladder and bars, and a grid of insets with a
    column for each method, its metric below, and the reference last.

    `insets`: names of regions or boxes [x0, y0, x1, y1) in pixels, y upwards; by default every region. `arms` is the
    order. `labels` and `colours` are by arm: ``labels={"mine": "Ours"}``. `columns`: 85 or 178 mm wide. `against`, `n`
    and `budget` as for :func:`bars`; at equal time the film of an arm is that of the nearest N, which is printed with
    its time. Bold is what is not significantly worse than the best. `log=False`: a linear ladder. `show`: the parts.
    `picture`: the arm in the whole picture, by default the reference. :func:`save` keeps the width.
    """
    from . import _page

    return _page.page(
        r, insets, arms=arms, metric=metric, region=region, against=against, n=n, budget=budget, labels=labels,
        colours=colours, columns=columns, log=log, s=s, exposure=exposure, show=show, picture=picture,
    )  # fmt: skip


def hemisphere(
    pdf: Callable[..., Any],
    integrand: Callable[..., Any] | None = None,
    wo_deg: float = 45.0,
    size: int = 256,
    title: str = "",
    ax: Axes | None = None,
) -> Axes:
    """A density over the upper hemisphere as seen from above, with contours of the integrand it is meant to follow.

    `pdf(wo[n,3], wi[n,3])` in 1/sr and `integrand(wo, wi)`, such as f cos theta L, are NumPy callables; w_o is at
    `wo_deg` from the normal in the xz plane. A direction is at (w.x, w.y). Contours are at 10, 50 and 90 % of the
    integrand's largest value.
    """
    side = (np.arange(size) + 0.5) / size * 2 - 1
    x, y = np.meshgrid(side, side)
    inside = x * x + y * y < 1
    wi = np.stack([x[inside], y[inside], np.sqrt(1 - x[inside] ** 2 - y[inside] ** 2)], -1)
    theta = np.radians(wo_deg)
    wo = np.broadcast_to([np.sin(theta), 0.0, np.cos(theta)], wi.shape)

    def over(f: Callable[..., Any], what: str) -> NDArray[Any]:
        out = np.full(x.shape, np.nan)
        out[inside] = channels(f(wo[:8], wi[:8]), 8, what).mean(-1)[0]  # a wrong shape of all rows may need much memory
        out[inside] = channels(f(wo, wi), len(wi), what).mean(-1)
        return out

    with style():
        ax = _axes(ax, 70.0)
        density = over(pdf, "pdf")
        drawn = _picture(
            ax, density, title, origin="lower", extent=(-1, 1, -1, 1), cmap="cividis", vmin=0,
            vmax=float(np.nanpercentile(density, 99.9)) or 1.0,
        )  # fmt: skip
        _scale(ax, drawn, "pdf [sr$^{-1}$]", "max")
        if integrand is not None:
            aim = over(integrand, "integrand")
            peak = float(np.nanmax(aim))
            if peak > 0:
                ax.contour(x, y, aim / peak, levels=[0.1, 0.5, 0.9], colors="white", linewidths=0.8)
        ax.plot([np.sin(theta)], [0], "x", color="#d55e00", ms=5, mew=1.2)
        ax.annotate("$\\omega_o$", (np.sin(theta), 0), (4, 4), textcoords="offset points", color="#d55e00")
    return ax
