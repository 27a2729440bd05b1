"""Arrays of other libraries: a callable receives arrays of its own library, on its device and of its dtype.

Arrays stay on the device between calls: directions returned by `sample` and passed to `pdf` and `f` are not copied, and
neither are rows used before. Checked values are brought to the host by DLPack, or by NumPy's protocol if the host
cannot read them in place.

JAX, Dr.Jit and callables of torch.compile compile code for each shape. Their batches are filled up to one of few lengths by copies of the last row,
and the answers are cut on the host: a check, or a run, compiles each callable a few times.
"""

from __future__ import annotations

import importlib
import sys
import threading
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from . import _arrays
from ._arrays import Array

Call = Callable[..., Any]

#: The module of an array's type, and the library that its callables take; they reject others with an error.
KNOWN = {"torch": "torch", "jax": "jax", "jaxlib": "jax", "cupy": "cupy", "drjit": "drjit", "mitsuba": "drjit"}
_KEPT = 4  # arrays per thread: w_o, the numbers, drawn directions, queried directions
_COMPILING = ("jax", "drjit")  # libraries that compile code for each shape
#: Rows of a filled batch. Most batches of a check have 1 to 64 or 4,096 to 5,600 rows; a longer one has a multiple of
#: the last.
_LENGTHS = (64, 512, 2048, 8192, 32768, 131072)


def filled_length(n: int) -> int:
    """Returns the length to which a batch of n rows is filled."""
    return next((length for length in _LENGTHS if n <= length), -(-n // _LENGTHS[-1]) * _LENGTHS[-1])


def is_compiled(call: Call) -> bool:
    """Whether torch.compile made a callable: it compiles again for other lengths, and calls want one thread."""
    return hasattr(call, "_torchdynamo_orig_callable") or getattr(call, "_compiled_call_impl", None) is not None


class Library:
    """The arrays of one library: takes rows of doubles and returns its own arrays; and back."""

    def __init__(self, module: Any, device: Any = None, dtype: Any = None) -> None:
        name = module if isinstance(module, str) else module.__name__
        self.name = name.partition(".")[0]
        if isinstance(module, str) or self.name == "jax":
            module = importlib.import_module("jax" if self.name == "jax" else name)
        self._module, self._device, self._dtype = module, device, dtype
        self._keeps = self.name in ("torch", "jax")  # for these, it is known whether a callable writes into an array
        self._compiles = self.name in _COMPILING
        self._of_thread: dict[int, list[tuple[Array, Any, int]]] = {}  # a threading.local ends with each call

    def _length(self, n: int) -> int:
        """The rows of an array that a callable receives for n rows."""
        return filled_length(n) if self._compiles else n

    def _filled(self, rows: Array) -> Array:
        more = self._length(len(rows)) - len(rows)
        return np.concatenate([rows, np.broadcast_to(rows[-1:], (more, *rows.shape[1:]))]) if more else rows

    def _made(self, rows: Array) -> Any:
        if self.name == "torch":
            kind = self._dtype or self._module.get_default_dtype()
            return self._module.from_numpy(np.require(rows, requirements="W")).to(device=self._device or "cpu", dtype=kind)
        if self.name == "jax":
            # Converted by NumPy: JAX would compile the conversion.
            kind = np.dtype(self._dtype or np.float32)
            return self._module.device_put(np.ascontiguousarray(rows, kind), self._device)
        more = {key: value for key, value in (("dtype", self._dtype), ("device", self._device)) if value is not None}
        return self._module.asarray(rows, **more)

    def _kept(self) -> list[tuple[Array, Any, int]]:
        return self._of_thread.setdefault(threading.get_ident(), [])

    def _keep(self, rows: Array, own: Any) -> None:
        if self._keeps:
            kept = self._kept()
            kept.insert(0, (rows, own, getattr(own, "_version", 0)))
            del kept[_KEPT:]

    def into(self, rows: Array) -> Any:
        """Returns the library's array of these rows, reusing an existing one with the same values."""
        kept = self._kept()
        for i, (host, own, version) in enumerate(kept):
            if host.shape != rows.shape or not np.array_equal(host[:1], rows[:1]) or not np.array_equal(host, rows):
                continue
            kept.insert(0, kept.pop(i))
            if getattr(own, "_version", 0) == version:  # PyTorch counts writes into a tensor
                return own
            del kept[0]
            break
        own = self._made(self._filled(rows))
        self._keep(rows, own)
        return own

    def _cut(self, answer: Any, n: int) -> Any:
        """Returns the requested rows of a result with more, which are on the host if the library compiles code: JAX
        would compile the cut."""
        if isinstance(answer, Mapping):
            return {key: self._cut(part, n) for key, part in answer.items()}
        if isinstance(answer, (tuple, list)):
            return tuple(self._cut(part, n) for part in answer)
        if not self._compiles or not np.shape(answer):
            return answer
        length = self._length(n)
        rows = self._on_host(answer, length)
        if np.ndim(rows) == 0:
            return rows
        if len(rows) != length:
            raise ValueError(f"{len(rows)} rows for {length} requested: expected one for each")
        return rows[:n]

    def _on_host(self, answer: Any, length: int) -> Any:
        """Returns NumPy's array of an answer for so many rows."""
        return _arrays.as_numpy(answer, self.name)

    def asks(self, call: Call) -> Call:
        """Wraps `call` to receive arrays of the library instead of NumPy's."""

        self._compiles |= is_compiled(call)

        def asked(*rows: Array) -> Any:
            return self._cut(call(*map(self.into, rows)), len(rows[-1]))

        return asked

    def samples(self, sample: Call, name: str) -> Call:
        """The same for `sample`, whose directions stay on the device."""
        if not self._keeps:
            return self.asks(sample)
        self._compiles |= is_compiled(sample)

        def asked(*rows: Array) -> Any:
            n = len(rows[-1])
            whole = sample(*map(self.into, rows))
            parts = self._cut(whole, n)
            named = isinstance(parts, Mapping)
            if not (named and "wi" in parts) and not (isinstance(parts, tuple) and len(parts) > 1):
                return parts  # reported by code that checks shapes
            wi = _arrays.directions(parts["wi"] if named else parts[0], n, f"{name}: sample's wi")
            self._keep(wi, whole["wi"] if named else whole[0])
            return {**parts, "wi": wi} if named else (wi, *parts[1:])

        return asked


def library_of(answer: Any) -> str | None:
    """Returns the library of a result; None: NumPy, or an unknown one."""
    part = next(iter(answer.values()), None) if isinstance(answer, Mapping) else answer
    part = part[0] if isinstance(part, (tuple, list)) and part else part
    return KNOWN.get(type(part).__module__.partition(".")[0])


def library_wanted(call: Call, *rows: Array) -> Library | None:
    """Returns the library whose arrays `call` takes: that of its result for NumPy's arrays; if it rejects those, a
    loaded library that it accepts. If there is none, the exception for NumPy's arrays is raised."""
    try:
        name = library_of(call(*rows))
    except Exception as refused:
        for loaded in dict.fromkeys(KNOWN.values()):
            if loaded in sys.modules and (library := _taken(call, loaded, rows)):
                return library
        raise refused
    return _taken(call, name, rows) if name else None


def _taken(call: Call, name: str, rows: tuple[Array, ...]) -> Library | None:
    library = library_named(name, None, call, rows)
    try:
        library.asks(call)(*rows)
    except Exception:
        return None
    return library


def library_named(module: Any, device: Any, call: Call, rows: tuple[Array, ...]) -> Library:
    """Returns the library of that name, or of that module; for Dr.Jit in the form that `call` takes."""
    from ._drjit import drjit_for  # which depends on this file

    name = module if isinstance(module, str) else module.__name__
    if KNOWN.get(name.partition(".")[0]) == "drjit":
        return drjit_for(module, call, rows)
    return Library(module, device)
