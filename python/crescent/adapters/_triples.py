"""Triples sample, eval, pdf of array libraries. eval(wo, wi) is f |cos|, as renderers have it; it becomes f.

What the callables take are arrays of their library, on the device and of the dtype that is asked for; what they give
stays there until it is judged.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from .. import _arrays
from .._arrays import Array
from .._check import Sampler

Call = Callable[..., Any]


def _f_of(eval: Call) -> Call:
    """f of an eval that holds the cosine."""

    def f(wo: Array, wi: Array) -> Array:
        cosine = np.abs(wi[:, 2])
        held = _arrays.channels(eval(wo, wi), len(wi), "eval")
        return np.where(cosine[:, None] > 0, held / np.where(cosine > 0, cosine, 1)[:, None], 0)

    return f


def _sampler(
    into: Callable[[Array], Any],
    outof: Callable[[Any, int], Any],
    sample: Call,
    eval: Call | None,
    pdf: Call | None,
    known: dict[str, Any],
) -> Sampler:
    """Callables of a library that `into` hands arrays to; `outof(answer, n)` takes its first n rows."""

    def of(call: Call) -> Call:
        def asked(*arrays: Array) -> Any:
            return outof(call(*map(into, arrays)), len(arrays[0]))

        return asked

    known.setdefault("name", getattr(sample, "__name__", ""))
    return Sampler(of(sample), pdf and of(pdf), eval and _f_of(of(eval)), **known)


def _as_it_is(answer: Any, n: int) -> Any:
    return answer


def numpy(
    sample: Call, eval: Call | None = None, pdf: Call | None = None, *, dtype: Any = np.float64, **known: Any
) -> Sampler:
    """NumPy callables; `known`: fields of :class:`crescent.Sampler`."""
    return _sampler(lambda a: np.asarray(a, dtype), _as_it_is, sample, eval, pdf, known)


def torch(
    sample: Call,
    eval: Call | None = None,
    pdf: Call | None = None,
    *,
    device: Any = "cpu",
    dtype: Any = None,
    **known: Any,
) -> Sampler:
    """PyTorch callables: tensors on `device`, of torch.float32 where no dtype is given. Called by one thread."""
    import torch as library

    known.setdefault("serial", True)
    kind = dtype or library.float32
    return _sampler(
        lambda a: library.from_numpy(np.ascontiguousarray(a)).to(device=device, dtype=kind),
        _as_it_is,
        sample,
        eval,
        pdf,
        known,
    )


def jax(sample: Call, eval: Call | None = None, pdf: Call | None = None, *, dtype: Any = None, **known: Any) -> Sampler:
    """JAX callables, jitted or not: rows are filled up to a power of two, so that few shapes are compiled."""
    import jax.numpy as library

    def into(a: Array) -> Any:
        rows = 1 << max(len(a) - 1, 63).bit_length()
        filled = np.concatenate([a, np.broadcast_to(a[-1:], (rows - len(a), a.shape[1]))])
        return library.asarray(filled, dtype or library.float32)

    def outof(answer: Any, n: int) -> Any:
        if isinstance(answer, dict):
            return {key: outof(part, n) for key, part in answer.items()}
        if isinstance(answer, (tuple, list)):
            return tuple(outof(part, n) for part in answer)
        return answer if answer is None or np.ndim(answer) == 0 else answer[:n]

    return _sampler(into, outof, sample, eval, pdf, known)
