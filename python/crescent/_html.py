"""Results as HTML for notebooks: pictures in data URLs, and tables."""

from __future__ import annotations

import base64
import html
import struct
import zlib
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._metric_names import NAMES

if TYPE_CHECKING:
    from .experiments import Experiment, Film, Measured


def tone(rgb: NDArray[Any], exposure: float = 1.0) -> NDArray[Any]:
    """Linear Rec. 709 to sRGB (IEC 61966-2-1), clipped to [0, 1]."""
    x = np.clip(rgb * exposure, 0, 1)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)


def png(rgb: NDArray[Any]) -> bytes:
    """A picture [height, width, 3] in [0, 1], rows top-down, as a PNG file (ISO/IEC 15948) of 8 bits."""
    height, width = rgb.shape[:2]
    pixels = np.round(np.nan_to_num(rgb) * 255).astype(np.uint8).reshape(height, -1)
    rows = np.concatenate([np.zeros((height, 1), np.uint8), pixels], axis=1).tobytes()

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def picture(film: Film, width: int) -> str:
    """A film, tone-mapped, of at most this width on the page."""
    data = base64.b64encode(png(tone(film.rgb[::-1].astype(float)))).decode()
    title = html.escape(f"{film.arm}, N = {film.n}")
    width = min(width, film.y.shape[1] * 4)
    return (
        f'<figure style="display:inline-block;margin:4px"><img src="data:image/png;base64,{data}" alt="{title}" '
        f'style="width:{width}px;image-rendering:pixelated"><figcaption>{title}</figcaption></figure>'
    )


def table(head: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """A table of texts."""

    def row(cells: Sequence[Any], kind: str) -> str:
        return "<tr>" + "".join(f"<{kind}>{html.escape(str(cell))}</{kind}>" for cell in cells) + "</tr>"

    return (
        f"<table><thead>{row(head, 'th')}</thead><tbody>{''.join(row(cells, 'td') for cells in rows)}</tbody></table>"
    )


def of_experiment(e: Experiment) -> str:
    """The title, the arms with their sample counts, and what else has a name."""
    tree = e._tree()
    arms = e._with_arms()._tree()["arms"]
    image = tree["image"]
    rows = [
        (name, arm.get("kind", arm.get("sampler", "")), ", ".join(map(str, arm["n"]))) for name, arm in arms.items()
    ]
    named = ("shapes", "lights", "disks", "regions", "plates", "assertions")
    names = [(family, ", ".join(tree[family])) for family in named if tree.get(family)]
    size = f"{image['width']} x {image['height']} pixels, {tree['seeds']} seeds from {tree['seed']}, hash {e.hash}"
    title = html.escape(str(tree.get("title", e._core.file)))
    return f"<p><b>{title}</b><br>{size}</p>" + table(("arm", "kind", "N"), rows) + table(("", "names"), names)


def of_film(film: Film) -> str:
    """The picture with its size."""
    height, width = film.y.shape
    return (
        picture(film, 640) + f"<p>{width} x {height}, s = {film.s:g}, seed {film.seed}, mean Y {film.y.mean():.4g}</p>"
    )


def of_measured(r: Measured) -> str:
    """The films of every arm at its largest N, a table of the main metric, and the assertions."""
    largest = {film.arm: film for film in sorted(r.films.values(), key=lambda f: f.n) if film.s == r.s}
    pictures = "".join(picture(film, 240) for film in largest.values())
    metric, regions = ("rmse", list(r.boxes)) if r.boxes else ("rmse_frame", [""])
    arms = {(row["arm"], row["n"]): None for row in r.records() if row["s"] == r.s}

    def cell(arm: str, n: int, region: str) -> str:
        try:
            return str(r.metric(metric, arm, n, region))
        except KeyError:
            return "-"

    head = ("arm", "N", *(f"{NAMES.get(metric, metric)} {region}".strip() for region in regions))
    body = [(arm, n, *(cell(arm, n, region) for region in regions)) for arm, n in arms]
    checks = [
        (a["name"], "skipped: " + a["skipped"] if a.get("skipped") else "holds" if a["pass"] else "fails", a["text"])
        for a in r.metrics["assertions"]
    ]
    out = pictures + table(head, body)
    return out + (table(("assertion", "", "measured"), checks) if checks else "")
