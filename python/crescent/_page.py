"""The figure page of a paper: the whole picture with marked insets, a grid of insets by method, a ladder and bars.

Everything is placed in mm, and names are broken into lines by their measured widths, so that no text overlaps another.
The arrangement is that of papers of the field, and of figuregen (Mirbauer et al. 2022): a column a method, the reference
last, the metric below.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from . import _crescent, plot
from ._html import tone
from ._metric_names import NAMES, UNITS
from ._values import arms_of, box_in, compared_at, film_at, heavy_arms, only_region, with_interval

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .experiments import Measured

WIDTH_MM = {1: 85.0, 2: 178.0}  #: of one column and of the page
_GAP_MM = 1.2
_MARGIN_MM = 0.8
_POINT_MM = 25.4 / 72
_NAME_PT, _NUMBER_PT = 7.0, 6.5
_LEAST_CELL_MM = {1: 18.0, 2: 24.0}  #: of an inset: more methods go into another band
_INSETS = ("#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")


class _Sheet:
    """A figure of a width that grows downwards."""

    def __init__(self, width: float) -> None:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        self.width = width
        self.height = 0.0
        self.figure = Figure(label="page", dpi=300)
        FigureCanvasAgg(self.figure)
        self._measures: Any = self.figure.canvas.get_renderer()  # type: ignore[attr-defined]
        self._axes: list[tuple[Any, tuple[float, float, float, float]]] = []
        self._texts: list[tuple[Any, float, float]] = []

    def axes(self, x: float, y: float, width: float, height: float) -> Any:
        """Axes in mm from the left and the top."""
        ax = self.figure.add_axes((0, 0, 1, 1), label=str(len(self._axes)))
        self._axes.append((ax, (x, y, width, height)))
        self.height = max(self.height, y + height)
        return ax

    def text(self, x: float, y: float, text: str, size: float, **how: Any) -> None:
        """A line of text whose top is at y."""
        drawn = self.figure.text(0, 0, text, size=size, va="top", **how)
        self._texts.append((drawn, x, y))
        self.height = max(self.height, y + size * _POINT_MM * 1.25)

    def width_of(self, text: str, size: float, weight: str = "normal") -> float:
        """The width of a text in mm."""
        from matplotlib.font_manager import FontProperties

        font = FontProperties(size=size, weight=weight)
        return float(self._measures.get_text_width_height_descent(text, font, False)[0]) * 25.4 / 300

    def lines(self, text: str, width: float, size: float, weight: str = "normal") -> list[str]:
        """A text as lines of this width, broken behind blanks and hyphens, and inside a word that is longer."""
        out = [""]
        for part in re.findall(r"[^\s_/-]*[\s_/-]|[^\s_/-]+", text):
            if self.width_of((out[-1] + part).rstrip(), size, weight) <= width:
                out[-1] += part
                continue
            if out[-1]:
                out.append("")
            for letter in part:
                if out[-1] and self.width_of(out[-1] + letter, size, weight) > width:
                    out.append("")
                out[-1] += letter
        return [line.strip() for line in out if line.strip()]

    def finished(self) -> Figure:
        """The figure, with everything in its place."""
        height = self.height + _MARGIN_MM
        self.figure.set_size_inches(self.width / 25.4, height / 25.4)
        for ax, (x, y, w, h) in self._axes:
            ax.set_position((x / self.width, 1 - (y + h) / height, w / self.width, h / height))
        for text, x, y in self._texts:
            text.set_position((x / self.width, 1 - y / height))
        return self.figure


def lines_of(text: str, width: float, size: float) -> list[str]:
    """A text as lines of so many mm at a size in points."""
    return _Sheet(width).lines(text, width, size)


def _boxes(r: Measured, insets: Any, size: tuple[int, int]) -> list[tuple[int, int, int, int]]:
    """Boxes [x0, y0, x1, y1) of boxes, or of names of regions; by default of every region."""
    width, height = size
    out = []
    if isinstance(insets, str):
        raise TypeError(f"insets is {insets!r}: expected a list of regions and boxes, [{insets!r}]")
    for given in list(r.boxes) if insets is None else insets:
        if isinstance(given, str):
            if given not in r.boxes:
                near = _crescent.nearest(given, list(r.boxes))
                hint = f"; did you mean '{near}'?" if near else ""
                raise KeyError(
                    f"insets has {given!r}: expected a box [x0, y0, x1, y1] or a region: {', '.join(r.boxes)}{hint}"
                )
            x0, y0, x1, y1 = r.boxes[given]
            given = (x0, y0, x1 + 1, y1 + 1)
        out.append(box_in("a box of insets", given, width, height))
    return out


def _picture(ax: Any, rgb: NDArray[Any], exposure: float, colour: str | None = None) -> None:
    ax.imshow(tone(rgb, exposure), interpolation="nearest", aspect="auto", gid="picture")
    ax.set_xticks([])
    ax.set_yticks([])
    for spine in ax.spines.values():
        spine.set_visible(colour is not None)
        spine.set_color(colour)
        spine.set_linewidth(1.2)


def _mark(ax: Any, box: Sequence[int], height: int, k: int, label: str) -> None:
    """The outline of an inset in the whole picture, with its letter."""
    from matplotlib.patches import Rectangle

    x0, y0, x1, y1 = box
    for width, colour in ((2.4, "white"), (1.2, _INSETS[k % len(_INSETS)])):
        ax.add_patch(Rectangle((x0 - 0.5, height - y1 - 0.5), x1 - x0, y1 - y0, fill=False, ec=colour, lw=width))
    if label:
        ax.text(
            x1, height - y1, label, size=6.5, color="white", va="bottom", ha="left",
            bbox={"fc": _INSETS[k % len(_INSETS)], "ec": "none", "pad": 1.0},
        )  # fmt: skip


def page(
    r: Measured,
    insets: Sequence[Any] | None = None,
    *,
    arms: Sequence[str] | None = None,
    metric: str = "rmse",
    region: str | None = None,
    against: Literal["n", "time", "rays"] = "n",
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
    """See :func:`crescent.plot.page`."""
    if columns not in WIDTH_MM:
        raise ValueError(f"columns is {columns!r}: expected 1 or 2")
    parts = ("picture", "grid", "ladder", "bars")
    if isinstance(show, str):
        raise TypeError(f"show is {show!r}: expected a list of {', '.join(parts)}")
    for name in show:
        if name not in parts:
            raise ValueError(f"show has {name!r}: expected {', '.join(parts)}")
    at = r.s if s is None else s
    region = only_region(r, metric, region)
    order = arms_of(r, arms)
    compared = compared_at(r, metric, region, s, order, against, n, budget)
    films = {arm: film for arm, count in compared.n.items() if (film := film_at(r, arm, count, at)) is not None}
    if not films:
        raise KeyError("the result has no films: that of crescent.run has, and the folder of one that was written")
    reference = r.references.get(at)
    of_reference = None if reference is None else np.stack([reference[c] for c in "rgb"], -1)[::-1]
    height, width = next(iter(films.values())).y.shape
    if picture is not None and picture not in films:
        raise KeyError(f"picture is {picture!r}: expected one of {', '.join(films)}")
    whole = films[picture].rgb[::-1] if picture is not None else of_reference
    if whole is None:
        whole = next(reversed(films.values())).rgb[::-1]
    boxes = _boxes(r, insets, (width, height))
    with plot.style():
        sheet = _Sheet(WIDTH_MM[columns])
        inner = sheet.width - 2 * _MARGIN_MM
        y = _MARGIN_MM
        charts = [name for name in show if name in ("ladder", "bars")]
        charts_at = partial(
            _charts, sheet, r=r, metric=metric, region=region, s=s, order=order, compared=compared, labels=labels,
            colours=colours, log=log, n=n, budget=budget,
        )  # fmt: skip
        beside = columns == 2 and bool(charts)
        if "picture" in show:
            w = inner * (0.44 if beside else 1.0)
            h = w * height / width
            ax = sheet.axes(_MARGIN_MM, y, w, h)
            _picture(ax, whole, exposure)
            for k, box in enumerate(boxes):
                _mark(ax, box, height, k, chr(ord("a") + k) if len(boxes) > 1 else "")
        if beside:
            left = _MARGIN_MM + (inner * 0.44 if "picture" in show else 0)
            charts_at(left, y, _MARGIN_MM + inner - left, charts)
        y = sheet.height + 1.6
        if "grid" in show:
            _grid(
                sheet, y, inner, columns, r, films, compared, of_reference, boxes, metric, region, s, labels, exposure
            )
            y = sheet.height + 1.6
        if charts and not beside:
            for name in charts:
                charts_at(_MARGIN_MM, y, inner, [name])
                y = sheet.height + 1.6
        return sheet.finished()


def _charts(
    sheet: _Sheet, left: float, top: float, width: float, charts: Sequence[str], r: Measured, metric: str, region: str,
    s: float | None, order: Sequence[str], compared: Any, labels: Mapping[str, str] | None,
    colours: Mapping[str, str] | None, log: bool, n: int | None, budget: float | None,
) -> None:  # fmt: skip
    """The ladder and the bars side by side; the names at the bars are the legend of both."""
    against = compared.costs.against
    rows = len(compared.values) + len(compared.missing)
    room, below = 14.5, 13.5 if against == "time" else 10.0  # of the labels of the axes
    height = max(38.0, rows * 6.2 + below + 2.0)
    share = width / len(charts)
    for k, name in enumerate(charts):
        x = left + k * share
        if name == "ladder":
            ax = sheet.axes(x + room, top + 1.5, share - room - 3.5, height - below)
            plot.ladder(
                r, metric, region, order, s, ax, against=against, labels=labels, colours=colours, log=log, legend=False
            )
            ax.set_ylabel(ax.get_ylabel().replace(" [", "\n[", 1), size=7)
            ax.yaxis.set_label_coords(-8.5 / (share - room - 3.5), 0.5)
            sheet.height = max(sheet.height, top + height + 1.0)
        else:
            ax = sheet.axes(x + 3.0, top + 1.5, share - 5.0, height - below)
            _with_size(sheet, ax, share - 5.0, height - below)
            plot.bars(
                r, metric, region, n, order, s, ax, against=against, budget=budget, labels=labels, colours=colours,
                log=False, names="above",
            )  # fmt: skip
            ax.set_ylim(-0.5, rows - 0.2)
            ax.xaxis.label.set_size(7)
            sheet.height = max(sheet.height, top + height + 1.0)


def _with_size(sheet: _Sheet, ax: Any, width: float, height: float) -> None:
    """Gives the axes their final size now: what is drawn measures its room."""
    sheet.figure.set_size_inches(sheet.width / 25.4, 200 / 25.4)
    ax.set_position((0.01, 0.1, width / sheet.width, height / 200))


def _grid(
    sheet: _Sheet, top: float, inner: float, columns: int, r: Measured, films: Mapping[str, Any], compared: Any,
    reference: NDArray[Any] | None, boxes: Sequence[Sequence[int]], metric: str, region: str, s: float | None,
    labels: Mapping[str, str] | None, exposure: float,
) -> None:  # fmt: skip
    """A column a method, the reference last, in as many bands as they need; a row an inset; the metric below."""
    if not boxes:
        height, width = next(iter(films.values())).y.shape
        boxes = [(0, 0, width, height)]
    methods: list[str | None] = [*films, *([None] if reference is not None else [])]
    most = int((inner + _GAP_MM) // (_LEAST_CELL_MM[columns] + _GAP_MM))
    bands = -(-len(methods) // most)
    each = -(-len(methods) // bands)
    cell = min((inner - (each - 1) * _GAP_MM) / each, 0.3 * inner)
    start = _MARGIN_MM + (inner - each * cell - (each - 1) * _GAP_MM) / 2
    heavy = heavy_arms(r, region, s)
    line = _NAME_PT * _POINT_MM * 1.25
    y = top
    unit = UNITS.get(metric, "")
    caption = NAMES.get(metric, metric) + (f", region {region}" if region else "") + (f" [{unit}]" if unit else "")
    caption += f", {compared.where()}"
    for first in range(0, len(methods), each):
        band = methods[first : first + each]
        names = []
        for arm in band:
            label = "Reference" if arm is None else plot._look(r, arm, labels).label
            text = sheet.lines(label, cell, _NAME_PT)
            if arm is not None and compared.costs.against != "n":
                text += sheet.lines(
                    f"N = {films[arm].n}, {compared.costs.text(compared.costs.of(arm, films[arm].n))}", cell, 6.0
                )
            names.append(text)
        rows = max(map(len, names))
        for k, name in enumerate(names):
            middle = start + k * (cell + _GAP_MM) + cell / 2
            for i, words in enumerate(name):
                sheet.text(middle, y + (rows - len(name) + i) * line, words, _NAME_PT, ha="center")
        y += rows * line + 0.4
        for i, box in enumerate(boxes):
            x0, y0, x1, y1 = box
            h = min(cell * (y1 - y0) / (x1 - x0), 1.6 * cell)
            for k, arm in enumerate(band):
                image = reference if arm is None else films[arm].rgb[::-1]
                assert image is not None
                ax = sheet.axes(start + k * (cell + _GAP_MM), y, cell, h)
                _picture(
                    ax, image[image.shape[0] - y1 : image.shape[0] - y0, x0:x1], exposure, _INSETS[i % len(_INSETS)]
                )
                if k == 0 and len(boxes) > 1:
                    ax.text(
                        0.0, 1.0, chr(ord("a") + i), size=6.5, color="white", va="top", ha="left", transform=ax.transAxes,
                        bbox={"fc": _INSETS[i % len(_INSETS)], "ec": "none", "pad": 1.0},
                    )  # fmt: skip
            y += h + _GAP_MM
        y -= _GAP_MM - 0.7
        numbers = 1
        for k, arm in enumerate(band):
            if arm is None:
                continue
            best = arm in compared.best
            shown = sheet.lines(with_interval(compared.values[arm]), cell, _NUMBER_PT, "bold") + (
                ["heavy tail"] if arm in heavy else []
            )
            numbers = max(numbers, len(shown))
            for i, words in enumerate(shown):
                middle = start + k * (cell + _GAP_MM) + cell / 2
                sheet.text(middle, y + i * line, words, _NUMBER_PT, ha="center", weight="bold" if best else "normal")
        y += numbers * line + 1.0
    for k, words in enumerate(sheet.lines(caption, inner, 6.5)):
        sheet.text(_MARGIN_MM + inner / 2, y + k * line, words, 6.5, ha="center")
