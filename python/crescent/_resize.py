"""The boxes of an experiment in a picture of another size."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from ._paths import path_of
from ._sampler import whole
from ._source import Source


def resized(tree: Mapping[str, Any], width: int, height: int) -> dict[str, Any]:
    """The changes that give the picture this size: of boxes too, which show what they showed.

    The field of view is vertical, so everything is scaled by the ratio of the heights, about the centre.
    """
    width = whole("width", width, 1, 16384, "expected 1 to 16384 pixels")
    height = whole("height", height, 1, 16384, "expected 1 to 16384 pixels")
    old = (tree["image"]["width"], tree["image"]["height"])
    boxes = {
        ("regions", name, "box"): table["box"] for name, table in tree.get("regions", {}).items() if "box" in table
    }
    boxes |= {
        ("plates", name, "crop"): table["crop"] for name, table in tree.get("plates", {}).items() if "crop" in table
    }
    out: dict[str, Any] = {"image.width": width, "image.height": height}
    for steps, box in boxes.items():
        ends = [_scaled(box[k::2], old[k], (width, height)[k], height / old[1]) for k in (0, 1)]
        if any(low > high for low, high in ends):
            raise ValueError(
                f"{path_of(steps)} = {box} is outside a picture of {width} x {height}: expected a wider one"
            )
        out[path_of(steps)] = [ends[0][0], ends[1][0], ends[0][1], ends[1][1]]
    return out


def _scaled(ends: Sequence[int], old: int, new: int, scale: float) -> tuple[int, int]:
    """The first and the last pixel of a range, both included, in the other picture."""
    low, high = ((edge - old / 2) * scale + new / 2 for edge in (ends[0], ends[1] + 1))
    first = round(low)
    return max(first, 0), min(max(round(high) - 1, first), new - 1)


def resize_hint(before: Mapping[str, Any], changed: Source, kinds: Sequence[str]) -> str:
    """How to change the size of the picture together with its boxes, if only these are wrong; else nothing."""
    old, new = before["image"], changed.tree().get("image", {})
    if not isinstance(new, Mapping):
        return ""
    sizes = [(image.get("width"), image.get("height")) for image in (old, new)]
    if sizes[0] == sizes[1] or set(kinds) != {"box off image"}:
        return ""
    return f"e.resize({sizes[1][0]}, {sizes[1][1]}) also scales regions and crops"
