"""Triples sample, eval, pdf of array libraries. eval(wo, wi) is f |cos|, as in renderers; it is converted to f.

The callables take arrays of their library, on the requested device and of the requested dtype; their results stay there
between calls (_libraries.py).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from .. import _arrays
from .._arrays import Array
from .._sampler import Sampler, rows_to_look_with
from .._libraries import Library, library_named

Call = Callable[..., Any]


def _f_of(eval: Call) -> Call:
    """Returns f of an eval that includes the cosine."""

    def f(wo: Array, wi: Array) -> Array:
        cosine = np.abs(wi[:, 2])
        held = _arrays.channels(eval(wo, wi), len(wi), "eval")
        return np.where(cosine[:, None] > 0, held / np.where(cosine > 0, cosine, 1)[:, None], 0)

    return f


def _sampler(library: Library, sample: Call, eval: Call | None, pdf: Call | None, known: dict[str, Any]) -> Sampler:
    known.setdefault("name", getattr(sample, "__name__", ""))
    asks = library.asks
    return Sampler(
        library.samples(sample, known["name"]), pdf and asks(pdf), eval and _f_of(asks(eval)), array_module=np, **known
    )


def numpy(
    sample: Call, eval: Call | None = None, pdf: Call | None = None, *, dtype: Any = np.float64, **known: Any
) -> Sampler:
    """NumPy callables; `known`: fields of :class:`crescent.Sampler`."""
    return _sampler(Library(np, dtype=dtype), sample, eval, pdf, known)


def torch(
    sample: Call,
    eval: Call | None = None,
    pdf: Call | None = None,
    *,
    device: Any = "cpu",
    dtype: Any = None,
    **known: Any,
) -> Sampler:
    """PyTorch callables: tensors on `device`, of torch's default dtype if none is given. Called by one thread."""
    known.setdefault("serial", True)
    return _sampler(Library("torch", device, dtype), sample, eval, pdf, known)


def jax(
    sample: Call,
    eval: Call | None = None,
    pdf: Call | None = None,
    *,
    device: Any = None,
    dtype: Any = None,
    **known: Any,
) -> Sampler:
    """JAX callables, jitted or not: batches have one of few lengths, for which they are compiled."""
    return _sampler(Library("jax", device, dtype), sample, eval, pdf, known)


def drjit(sample: Call, eval: Call | None = None, pdf: Call | None = None, *, u: int = 2, **known: Any) -> Sampler:
    """Dr.Jit callables, of tensors [n, 3] or of vectors with x, y, z; arrays of Mitsuba's variant if one is set."""
    known.setdefault("serial", True)
    rows = rows_to_look_with(8, u)
    library = library_named("drjit", None, sample, rows if known.get("wo") != "none" else rows[1:])
    return _sampler(library, sample, eval, pdf, {"u": u, **known})
