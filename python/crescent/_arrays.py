"""Converts the results of a sampler's callables to arrays of doubles; errors name the first bad row.

Any array that supports DLPack or NumPy's protocol is accepted. Directions are ``[n, 3]``, densities ``[n]``, weights
and f ``[n]`` or ``[n, 3]``, one row for each row of the query. A plain number means the same number in every row.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def as_numpy(value: Any, what: str) -> NDArray[Any]:
    """Returns the array of `value`, on the host; ValueError if it is none, with the first row that does not fit."""
    if isinstance(value, np.ndarray):
        return value
    if hasattr(value, "detach"):  # a tensor that autograd tracks, or that is on a device
        value = value.detach().cpu()
    if is_drjit(value):
        return of_drjit(value)
    if hasattr(value, "__dlpack__"):
        try:
            return np.from_dlpack(value)
        except (BufferError, RuntimeError, TypeError, ValueError):
            pass  # another device, or a scalar: NumPy's protocol converts it
    try:
        return np.asarray(value)
    except ValueError:
        raise ValueError(f"{what}: {_first_ragged(value)}") from None


def is_drjit(value: Any) -> bool:
    """Returns whether it is an array of Dr.Jit, as Mitsuba's are."""
    return type(value).__module__.partition(".")[0] in ("drjit", "mitsuba") and hasattr(value, "numpy")


def of_drjit(value: Any) -> NDArray[Any]:
    """Returns its rows: Dr.Jit's vectors have one component per row. An array of a single entry is a number."""
    array = np.asarray(value.numpy())
    if sys.modules["drjit"].is_tensor_v(value):
        return array
    return array.T if array.ndim > 1 else array[0] if len(array) == 1 else array


def _first_ragged(rows: Sequence[Any]) -> str:
    """Returns the first of a list of rows whose length differs from that of row 0."""
    first = np.shape(rows[0])
    for i, row in enumerate(rows):
        if np.shape(row) != first:
            return f"row {i} has shape {np.shape(row)}, row 0 has {first}"
    return "its rows are no numbers"


def numbers(value: Any, what: str) -> NDArray[Any]:
    """An array of real numbers."""
    array = as_numpy(value, what)
    if array.dtype.kind in "fiub":
        return array
    if array.dtype.kind == "O":
        return _unpacked(array, what)
    raise ValueError(f"{what}: dtype {array.dtype}, expected floating-point numbers")


def _unpacked(objects: NDArray[Any], what: str) -> Array:
    """Objects, each a real number."""
    if objects.ndim == 0:
        raise ValueError(f"{what} is {type(objects.item()).__name__}, expected an array of numbers")
    for i in range(len(objects)):
        odd = next((v for v in objects[i : i + 1].ravel() if not isinstance(v, Real)), 0.0)
        if not isinstance(odd, Real):
            raise ValueError(f"{what}: row {i} has {type(odd).__name__}, expected numbers")
    return objects.astype(np.float64)


def _rows(array: NDArray[Any], n: int, what: str) -> None:
    if len(array) < n:
        raise ValueError(
            f"{what}: {len(array)} rows for {n} that were asked: row {len(array)} is the first without one"
        )
    if len(array) > n:
        raise ValueError(f"{what}: {len(array)} rows for {n} that were asked: row {n} is the first too many")


def column(value: Any, n: int, what: str) -> Array:
    """``[n]``."""
    array = numbers(value, what)
    if array.ndim == 0:
        return np.full(n, array, np.float64)
    if array.ndim != 1:
        raise ValueError(f"{what}: shape {array.shape}, expected ({n},): row 0 has shape {array.shape[1:]}")
    _rows(array, n, what)
    return np.ascontiguousarray(array, np.float64)


def directions(value: Any, n: int, what: str) -> Array:
    """``[n, 3]``."""
    array = numbers(value, what)
    if array.ndim != 2 or array.shape[1] != 3:
        row = f": row 0 has shape {array.shape[1:]}" if array.ndim > 0 and len(array) else ""
        raise ValueError(f"{what}: shape {array.shape}, expected ({n}, 3){row}")
    _rows(array, n, what)
    return np.asarray(array, np.float64)


def channels(value: Any, n: int, what: str) -> Array:
    """``[n, 1]`` or ``[n, 3]``, from ``[n]``, ``[n, 1]`` or ``[n, 3]``."""
    array = numbers(value, what)
    if array.ndim < 2:
        return column(array, n, what)[:, None]
    if array.ndim != 2 or array.shape[1] not in (1, 3):
        raise ValueError(f"{what}: shape {array.shape}, expected ({n},) or ({n}, 3): row 0 has shape {array.shape[1:]}")
    _rows(array, n, what)
    return np.asarray(array, np.float64)


Parts = tuple[Array, Array, Array | None, Array | None]


def draws(answer: Any, n: int, name: str) -> Parts:
    """Returns (wi, pdf, weight or None, delta or None) from the result of `sample`: a tuple of two to four, or a
    mapping."""
    if isinstance(answer, Mapping):
        unknown = set(answer) - {"wi", "pdf", "weight", "delta"}
        if unknown or not {"wi", "pdf"} <= set(answer):
            raise ValueError(f"{name}: sample gave the keys {sorted(answer)}, expected wi and pdf, weight, delta")
        answer = tuple(answer.get(key) for key in ("wi", "pdf", "weight", "delta"))
    if not isinstance(answer, (tuple, list)) or not 2 <= len(answer) <= 4:
        got = f"{len(answer)} values" if isinstance(answer, (tuple, list)) else type(answer).__name__
        raise ValueError(
            f"{name}: sample gave {got}, expected (wi, pdf), (wi, pdf, weight) or (wi, pdf, weight, delta)"
        )
    wi, pdf, weight, delta = (*answer, None, None)[:4]
    told = f"{name}: sample's "
    p = column(pdf, n, told + "pdf")
    if delta is not None:
        kind = as_numpy(delta, told + "delta").dtype.kind
        chosen = column(delta, n, told + "delta")
        delta = np.where(chosen != 0, p, 0.0) if kind in "biu" else chosen
    return (
        directions(wi, n, told + "wi"),
        p,
        None if weight is None else channels(weight, n, told + "weight"),
        delta,
    )


def asks_sample(sample: Callable[..., Any], name: str, takes_wo: bool) -> Callable[[Array, Array], Parts]:
    """Wraps `sample` for the core: arrays of doubles in, all four parts out."""

    def ask(wo: Array, u: Array) -> Parts:
        return draws(sample(wo, u) if takes_wo else sample(u), len(u), name)

    return ask


def asks_pdf(pdf: Callable[..., Any], name: str, takes_wo: bool) -> Callable[[Array, Array], Array]:
    """Wraps `pdf` for the core."""

    def ask(wo: Array, wi: Array) -> Array:
        return column(pdf(wo, wi) if takes_wo else pdf(wi), len(wi), f"{name}: pdf")

    return ask


def asks_f(f: Callable[..., Any], name: str, count: int) -> Callable[[Array, Array], Array]:
    """Wraps `f` for the core, with `count` channels."""

    def ask(wo: Array, wi: Array) -> Array:
        values = channels(f(wo, wi), len(wi), f"{name}: f")
        if values.shape[1] > count:
            raise ValueError(f"{name}: f has {values.shape[1]} channels, expected {count}")
        return values

    return ask
