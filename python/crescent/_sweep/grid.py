"""The grid of a sweep: ``PATH=VALUES`` as axes, and their points."""

from __future__ import annotations

import itertools
import math
import tomllib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from .. import _crescent


class UsageError(ValueError):
    """A mistake in the call: exit code 2."""


@dataclass(frozen=True)
class Axis:
    """One swept key: its path as for ``--set``, and its values."""

    path: str
    values: tuple[Any, ...]


def hint(near: str) -> str:
    """The suggestion of the nearest valid word for a message; empty if there is none."""
    return f"; did you mean '{near}'?" if near else ""


_SPACINGS = ("log", "lin")


def _item(text: str) -> Any:
    """The value of TOML text; the text itself if it is not TOML."""
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text


def _items(text: str) -> list[str]:
    """Splits at commas outside brackets and quotes."""
    out, depth, quote = [""], 0, ""
    for c in text:
        if quote:
            quote = "" if c == quote else quote
        elif c in "\"'":
            quote = c
        elif c in "[{":
            depth += 1
        elif c in "]}":
            depth -= 1
        if c == "," and depth == 0 and not quote:
            out.append("")
        else:
            out[-1] += c
    return [item.strip() for item in out]


def _spaced(path: str, kind: str, text: str) -> list[float]:
    """The values of ``log:A:B:K`` or ``lin:A:B:K``, both ends included."""
    form = f"--over {path}: expected {kind}:FIRST:LAST:COUNT, as in {kind}:0.05:0.8:9, not '{kind}:{text}'"
    fields = text.split(":")
    if len(fields) != 3:
        raise UsageError(form)
    try:
        a, b, count = float(fields[0]), float(fields[1]), int(fields[2])
    except ValueError:
        raise UsageError(form) from None
    if not (math.isfinite(a) and math.isfinite(b)) or not 2 <= count <= 10_000:
        raise UsageError(f"{form}; COUNT is 2 to 10000")
    if kind == "log" and not (a > 0 and b > 0):
        raise UsageError(f"--over {path}: log: needs two numbers above 0, not {fields[0]} and {fields[1]}")
    steps = [k / (count - 1) for k in range(count)]
    if kind == "lin":
        return [a + (b - a) * t for t in steps[:-1]] + [b]
    # Ten digits, so that the values can be typed.
    return [a, *(float(f"{a * (b / a) ** t:.10g}") for t in steps[1:-1]), b]


def axis_of(text: str) -> Axis:
    """The axis of ``PATH=VALUES``: a list with commas, ``log:A:B:K`` or ``lin:A:B:K``."""
    path, equals, values = text.partition("=")
    path, values = path.strip(), values.strip()
    if not equals or not path or not values:
        raise UsageError(f"--over {text!r}: expected PATH=VALUES, as in sphere.s=8,32,128 or key.radius=log:0.02:0.5:5")
    kind, colon, rest = values.partition(":")
    if colon and kind.isalpha():
        if kind not in _SPACINGS:
            near = _crescent.nearest(kind, list(_SPACINGS))
            raise UsageError(f"--over {path}: no spacing '{kind}': expected log or lin" + hint(near))
        return Axis(path, tuple(_spaced(path, kind, rest)))
    return _axis(path, [_item(item) for item in _items(values)])


def _axis(path: str, values: Iterable[Any]) -> Axis:
    out: list[Any] = []
    for value in values:
        value = value.item() if hasattr(value, "item") and not isinstance(value, (list, tuple)) else value
        if value == "" or (isinstance(value, float) and not math.isfinite(value)):
            raise UsageError(
                f"--over {path}: {value!r} is no value: expected numbers, words or lists, with commas between"
            )
        if value not in out:
            out.append(value)
    if not out:
        raise UsageError(f"--over {path}: expected at least one value")
    return Axis(path, tuple(out))


def axes_of(over: Mapping[str, Any] | Sequence[str] | str | None) -> list[Axis]:
    """The axes of ``--over``, or of a dictionary from paths to values (or a text of values)."""
    given: list[Axis] = []
    if isinstance(over, str):
        over = [over]
    if isinstance(over, Mapping):
        for path, values in over.items():
            if isinstance(values, str):
                given.append(axis_of(f"{path}={values}"))
            elif isinstance(values, Iterable):
                given.append(_axis(path, values))
            else:
                given.append(_axis(path, [values]))
    else:
        given = [axis_of(text) for text in over or ()]
    paths = [axis.path for axis in given]
    for path in paths:
        if paths.count(path) > 1:
            raise UsageError(f"--over {path} is given twice: expected one list of values for each path")
    return given


def grid(axes: Sequence[Axis], zip_: bool = False) -> list[dict[str, Any]]:
    """The points: all combinations, the last axis fastest; with `zip_` the k-th values of all axes together."""
    if not axes:
        return [{}]
    if zip_:
        lengths = {axis.path: len(axis.values) for axis in axes}
        if len(set(lengths.values())) > 1:
            found = ", ".join(f"{path} has {count}" for path, count in lengths.items())
            raise UsageError(f"--zip: expected axes of equal length; {found}")
        rows: Iterable[tuple[Any, ...]] = zip(*(axis.values for axis in axes), strict=True)
    else:
        rows = itertools.product(*(axis.values for axis in axes))
    return [dict(zip((axis.path for axis in axes), row, strict=True)) for row in rows]


def short(value: Any) -> str:
    """A value for labels and tables."""
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def label(values: Mapping[str, Any]) -> str:
    """A point in one line: "sphere.s=8, key.radius=0.1"."""
    return ", ".join(f"{path}={short(value)}" for path, value in values.items()) or "the experiment"
