"""Arrays of Dr.Jit, in either form of its callables; those of Mitsuba's variant if one is set.

tensors: [n, 3] like those of NumPy, ``wo[:, 2]``; vectors: one array per component, ``wo.z``, ``u.x``. Results may have
either form.
"""

from __future__ import annotations

import importlib
import math
import sys
from collections.abc import Callable
from typing import Any

import numpy as np

from . import _arrays
from ._arrays import Array
from ._libraries import Library


def rows_of(value: Any, n: int) -> Any:
    """Returns NumPy's rows of an array of Dr.Jit; a vector of a single entry is repeated for all `n`."""
    if not _arrays.is_drjit(value):
        return value
    rows = _arrays.of_drjit(value)
    return np.broadcast_to(rows, (n, rows.shape[1])) if rows.ndim == 2 and len(rows) == 1 else rows


def _types(module: Any) -> Any:
    """Returns the source of Float, TensorXf and vectors: Mitsuba's variant, the given module, or the one that Dr.Jit
    finds."""
    mi = sys.modules.get("mitsuba")
    if getattr(module, "__name__", module) in ("drjit", "mitsuba"):
        if mi is not None and mi.variant() and not str(mi.variant()).startswith("scalar"):
            return mi
        return importlib.import_module("drjit.auto.ad")
    return module


class DrJit(Library):
    """Takes rows of doubles and returns Dr.Jit's arrays of single precision, or of double in a variant of Mitsuba's;
    and back."""

    def __init__(self, module: Any = "drjit", tensors: bool = False) -> None:
        super().__init__(np)
        self.name, self._keeps, self._compiles, self._tensors = "drjit", True, True, tensors
        self._types = _types(module)

    def _vector(self, k: int) -> Any:
        """Returns the type of k components: Mitsuba's own for points and directions."""
        of = self._types
        if mine := getattr(of, {2: "Point2f", 3: "Vector3f"}.get(k, ""), None):
            return mine
        base = importlib.import_module(of.Float.__module__)
        return getattr(base, (f"Array{k}f" if k < 5 else "ArrayXf") + ("64" if of.Float is not base.Float else ""))

    def _made(self, rows: Array) -> Any:
        of = self._types
        if self._tensors:
            return of.TensorXf(np.ascontiguousarray(rows))
        columns = [of.Float(np.ascontiguousarray(rows[:, i])) for i in range(rows.shape[1])]
        vector = self._vector(len(columns))
        return vector(*columns) if len(columns) < 5 else vector(columns)

    def _keep(self, rows: Array, own: Any) -> None:
        dr = importlib.import_module("drjit")
        shape = (self._length(len(rows)), *rows.shape[1:])
        if dr.width(own) not in (shape[0], math.prod(shape)):
            return
        if self._tensors:
            own = own if dr.is_tensor_v(own) else self._types.TensorXf(dr.ravel(own), shape)
        elif not isinstance(own, vector := self._vector(rows.shape[1])):
            own = vector(own)
        super()._keep(rows, own)

    def into(self, rows: Array) -> Any:
        own = super().into(rows)
        return type(own)(own)  # shares the memory; an array that a callable writes into is a copy

    def _on_host(self, answer: Any, length: int) -> Any:
        return rows_of(answer, length)

    def fits(self, sample: Callable[..., Any], rows: tuple[Array, ...]) -> bool:
        """Returns whether `sample` returns one draw per row for arrays of this form."""
        try:
            wi = _arrays.draws(self.asks(sample)(*rows), len(rows[-1]), "")[0]
        except Exception:
            return False
        return len(np.unique(wi, axis=0)) > 1


def drjit_for(module: Any, sample: Callable[..., Any], rows: tuple[Array, ...]) -> DrJit:
    """Returns the form that `sample` takes. Tensors are tried first: code written for vectors would take their rows,
    and so return too few."""
    tensors = DrJit(module, tensors=True)
    return tensors if tensors.fits(sample, rows) else DrJit(module)
