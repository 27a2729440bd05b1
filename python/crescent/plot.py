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
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._arrays import channels
from ._intervals import fitted_slope, half_width, log_interval
from ._metric_names import NAMES, RADIANCE, UNITS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .experiments import Film, Measured

__all__ = ["bars", "crops", "heat", "hemisphere", "ladder", "save", "style", "where_noise_moved"]

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


def save(ax: Axes | Sequence[Axes], path: str | PathLike[str]) -> None:
    """Writes the figure of these axes as PDF, SVG or PNG, by the ending of `path`; 300 dots an inch."""
    with style():
        figure: Any = (ax[0] if isinstance(ax, Sequence) else ax).figure
        figure.savefig(path)


def _axes(ax: Axes | None, height_mm: float = 60.0) -> Axes:
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt

    return plt.subplots(figsize=(COLUMN_MM / 25.4, height_mm / 25.4), layout="constrained")[1]


def _arms(r: Measured, arms: Sequence[str] | None) -> list[str]:
    known = list(dict.fromkeys(film.arm for film in r.films.values()))
    known = known or list(dict.fromkeys(row["arm"] for row in r.records()))
    for arm in arms or ():
        if arm not in known:
            raise KeyError(f"no arm {arm!r}: there are {', '.join(known)}")
    return list(arms) if arms else known


def _colour(r: Measured, arm: str) -> str:
    return _COLOURS[_arms(r, None).index(arm) % len(_COLOURS)]


def _values(r: Measured, metric: str, region: str, s: float | None) -> dict[str, dict[int, list[float]]]:
    """By arm and N, the metric's values over seeds. KeyError where the result has no such metric or region."""
    at = r.s if s is None else s
    rows = r.records()
    out: dict[str, dict[int, list[float]]] = {}
    for row in rows:
        if row["meter"] == metric and row["region"] == region and row["s"] == at and row["value"] is not None:
            out.setdefault(row["arm"], {}).setdefault(row["n"], []).append(row["value"])
    if not out:
        there = sorted({f"{row['meter']} of {row['region']}" if row["region"] else row["meter"] for row in rows})
        raise KeyError(f"no {metric} of {region or 'the frame'} at s = {at:g}: there are {', '.join(there)}")
    return out


def _only_region(r: Measured, metric: str, region: str | None) -> str:
    """`region`, or the first of the experiment's where the metric has regions and none is named."""
    if region is not None:
        return region
    return next((row["region"] for row in r.records() if row["meter"] == metric), "")


def _label(metric: str, region: str) -> str:
    unit = UNITS.get(metric, "")
    return NAMES.get(metric, metric) + (f", region {region}" if region else "") + (f" [{unit}]" if unit else "")


def ladder(
    r: Measured,
    metric: str = "rmse",
    region: str | None = None,
    arms: Sequence[str] | None = None,
    s: float | None = None,
    ax: Axes | None = None,
) -> Axes:
    """A metric against the sample count N on two logarithmic axes, one line an arm, with its band over seeds.

    The legend states the fitted slope with its 95 % interval over seeds (two seeds at least); independent samples of
    finite variance have -0.5.
    """
    region = _only_region(r, metric, region)
    values = _values(r, metric, region, s)
    with style():
        ax = _axes(ax, 62.0 + 2.0 * len(values))
        for arm in _arms(r, arms):
            if arm not in values:
                continue
            n = np.array(sorted(values[arm]))
            over = [np.array(values[arm][k]) for k in n]
            low, high = (5.0, 95.0) if min(map(len, over)) >= 20 else (0.0, 100.0)
            middle = np.array([np.median(v) for v in over])
            slope = fitted_slope(n, over)
            name = arm if slope is None else f"{arm}: slope {slope.text().replace('-', '−')}"
            ax.plot(n, middle, "o-", ms=3, color=_colour(r, arm), label=name)
            ax.fill_between(
                n, [np.percentile(v, low) for v in over], [np.percentile(v, high) for v in over],
                color=_colour(r, arm), alpha=0.2, lw=0,
            )  # fmt: skip
        counts = sorted({k for of in values.values() for k in of})
        ax.set_xscale("log", base=2)
        ax.set_yscale("log")
        ax.set_xticks(counts, [str(k) for k in counts])
        ax.minorticks_off()
        ax.set_xlabel("samples a pixel, N")
        ax.set_ylabel(_label(metric, region))
        ax.grid(True)
        # Below the axes, where no line is; the distance is in font sizes, for the labels of the axis.
        ax.legend(
            frameon=False, loc="upper center", bbox_to_anchor=(0.5, 0), borderaxespad=4.5, ncols=2, columnspacing=1.2
        )
    return ax


def _geometric(values: NDArray[Any]) -> float:
    return float(np.exp(np.log(values).mean())) if (values > 0).all() else float(values.mean())


def bars(
    r: Measured,
    metric: str = "rmse",
    region: str | None = None,
    n: int | None = None,
    arms: Sequence[str] | None = None,
    s: float | None = None,
    ax: Axes | None = None,
) -> Axes:
    """A metric of each arm at one N (the largest that all arms have), smallest on top.

    A bar is the geometric mean over seeds, its line the 95 % interval of that mean.
    """
    region = _only_region(r, metric, region)
    values = {arm: of for arm, of in _values(r, metric, region, s).items() if arm in _arms(r, arms)}
    shared = set.intersection(*(set(of) for of in values.values()))
    if n is None and not shared:
        raise ValueError("the arms have no sample count in common: name one as n")
    at = max(shared) if n is None else n
    found = sorted(((arm, np.array(of[at])) for arm, of in values.items() if at in of), key=lambda x: -_geometric(x[1]))
    if not found:
        raise KeyError(f"no arm has N = {at}: expected one of {sorted({k for of in values.values() for k in of})}")
    with style():
        ax = _axes(ax, 12.0 + 7.0 * len(found))
        for y, (arm, v) in enumerate(found):
            ax.barh(y, _geometric(v), color=_colour(r, arm), height=0.7)
            end = _geometric(v)
            if (interval := log_interval(v)) is not None:
                ax.plot(interval, [y, y], color="black", lw=1)
                end = max(end, interval[1])
            ax.annotate(f"{_geometric(v):.3g}", (end, y), (3, 0), textcoords="offset points", va="center", size=7)
        ax.margins(x=0.15)  # room for the numbers
        ax.set_axisbelow(True)
        ax.set_yticks(range(len(found)), [arm for arm, _ in found])
        ax.set_xlabel(f"{_label(metric, region)} at N = {at}")
        ax.set_xlim(left=0)
        ax.grid(True, axis="x")
    return ax


def _film(r: Measured, arm: str, n: int, s: float | None) -> Film:
    return r.films[(arm, n) if s is None else (arm, n, s)]


def _cut(plane: NDArray[Any], box: Sequence[int] | None) -> NDArray[Any]:
    """Rows top-down of the box [x0, y0, x1, y1) in pixels, y upwards as in the experiment file."""
    height, width = plane.shape[:2]
    x0, y0, x1, y1 = box if box is not None else (0, 0, width, height)
    if not (0 <= x0 < x1 <= width and 0 <= y0 < y1 <= height):
        raise ValueError(f"box is {[x0, y0, x1, y1]}: expected x0 < x1 <= {width} and y0 < y1 <= {height}")
    return plane[y0:y1, x0:x1][::-1]


def _picture(ax: Axes, image: NDArray[Any], title: str, **how: Any) -> Any:
    drawn = ax.imshow(image, interpolation="nearest", **how)
    ax.set_xticks([])
    ax.set_yticks([])
    ax.spines[:].set_visible(False)
    ax.set_title(title)
    return drawn


def _scale(ax: Axes, drawn: Any, label: str, extend: str) -> None:
    """A colour scale as high as the picture."""
    ax.figure.colorbar(drawn, cax=ax.inset_axes((1.03, 0, 0.04, 1)), label=label, extend=extend)


def heat(
    r: Measured,
    arm: str,
    n: int,
    what: str = "error",
    s: float | None = None,
    box: Sequence[int] | None = None,
    top: float | None = None,
    ax: Axes | None = None,
) -> Axes:
    """The error |Y - reference|, or `what` = "var", the variance of Y, of each pixel, with a colour scale in its unit.

    `top`: the end of the scale; the 99th percentile where none is given.
    """
    film = _film(r, arm, n, s)
    if what == "error":
        if film.s not in r.references:
            raise KeyError(f"the result has no reference at s = {film.s:g}")
        plane, unit = np.abs(film.y - r.references[film.s]["y"]), f"|error of Y| [{RADIANCE}]"
    elif what == "var":
        plane, unit = film.var, f"variance of Y [({RADIANCE})$^2$]"
    else:
        raise ValueError(f"what is {what!r}: expected 'error' or 'var'")
    image = _cut(plane, box)
    with style():
        ax = _axes(ax)
        limit = float(np.nanpercentile(image, 99)) if top is None else top
        drawn = _picture(ax, image, f"{arm}, N = {n}", cmap="inferno", vmin=0, vmax=limit or 1.0)
        _scale(ax, drawn, unit, "max")
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
) -> Axes:
    """log2 of the variance of `b` over that of `a`, over tiles of `tile` pixels: blue where `b` has less, grey where one
    has none.

    The scale ends at a factor of 64 at most.
    """
    planes = [_cut(_film(r, arm, n, s).var.astype(float), box) for arm in (a, b)]
    height, width = (size - size % tile for size in planes[0].shape)
    if height == 0 or width == 0:
        raise ValueError(f"tile is {tile}: expected at most the size of the picture, {min(planes[0].shape)}")
    of_a, of_b = (
        p[:height, :width].reshape(height // tile, tile, width // tile, tile).mean((1, 3)) for p in planes
    )
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.where((of_a > 0) & (of_b > 0), np.log2(of_b / of_a), np.nan)
    with style():
        ax = _axes(ax)
        limit = min(float(np.nanpercentile(np.abs(ratio), 98)) if np.isfinite(ratio).any() else 1.0, 6.0)
        drawn = _picture(ax, ratio, f"{b} against {a}, N = {n}", cmap="RdBu_r", vmin=-limit, vmax=limit)
        ax.set_facecolor("#bfbfbf")  # of tiles without variance
        _scale(ax, drawn, f"log$_2$ variance of {b} / {a}", "both")
    return ax


def _tone(rgb: NDArray[Any], exposure: float) -> NDArray[Any]:
    """Linear Rec. 709 to sRGB (IEC 61966-2-1), clipped to [0, 1]."""
    x = np.clip(rgb * exposure, 0, 1)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)


def _with_interval(over: NDArray[Any]) -> str:
    """The mean over seeds, with the half width of its 95 % interval."""
    mean = float(np.mean(over))
    if over.size < 2:
        return f"{mean:.3g}"
    return f"{mean:.3g} ± {half_width(over):.2g}"


def crops(
    r: Measured,
    n: int,
    box: Sequence[int],
    arms: Sequence[str] | None = None,
    metric: str = "rmse",
    region: str | None = None,
    s: float | None = None,
    exposure: float = 1.0,
) -> list[Axes]:
    """The same crop of the reference and of several arms in a row; below each the mean of its metric over seeds, with
    the half width of its 95 % interval.

    `box`: [x0, y0, x1, y1) in pixels, y upwards.
    """
    import matplotlib.pyplot as plt

    at = r.s if s is None else s
    region = _only_region(r, metric, region)
    values = _values(r, metric, region, s)
    films: Mapping[Any, Film] = r.films
    shown = [arm for arm in _arms(r, arms) if (arm, n, at) in films]
    if not shown:
        raise KeyError(f"no arm has a film at N = {n} and s = {at:g}")
    reference = r.references.get(at)
    name = NAMES.get(metric, metric) + (f", region {region}" if region else "")
    count = len(shown) + (reference is not None)
    with style():
        aspect = (box[3] - box[1]) / (box[2] - box[0])
        width = min(2 * COLUMN_MM + 5, 42.0 * count) / 25.4
        figure, row = plt.subplots(1, count, figsize=(width, width / count * aspect + 0.6), layout="constrained")
        axes = list(np.atleast_1d(row))
        if reference is not None:
            rgb = np.stack([reference[c] for c in "rgb"], -1)
            _picture(axes[0], _tone(_cut(rgb, box), exposure), "reference")
            unit = UNITS.get(metric, "")
            axes[0].set_xlabel(f"{name}" + (f"\n[{unit}]" if unit else ""))
        for ax, arm in zip(axes[count - len(shown) :], shown):
            _picture(ax, _tone(_cut(films[arm, n, at].rgb, box), exposure), f"{arm}, N = {n}")
            over = np.array(values.get(arm, {}).get(n, []))
            if over.size:
                ax.set_xlabel(_with_interval(over) if reference is not None else f"{name}\n{_with_interval(over)}")
    return axes


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


