"""Arrays of other libraries: a callable receives arrays of its own library, on its device and of its dtype.

Arrays stay on the device between calls: directions returned by `sample` and passed to `pdf` and `f` are not copied, and
neither are rows used before. Checked values are brought to the host by DLPack, or by NumPy's protocol if the host
cannot read them in place.
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


class Library:
    """The arrays of one library: takes rows of doubles and returns its own arrays; and back."""

    def __init__(self, module: Any, device: Any = None, dtype: Any = None) -> None:
        name = module if isinstance(module, str) else module.__name__
        self.name = name.partition(".")[0]
        if isinstance(module, str) or self.name == "jax":
            module = importlib.import_module("jax.numpy" if self.name == "jax" else name)
        self._module, self._device, self._dtype = module, device, dtype
        self._keeps = self.name in ("torch", "jax")  # for these, it is known whether a callable writes into an array
        self._of_thread: dict[int, list[tuple[Array, Any, int]]] = {}  # a threading.local ends with each call

    def _made(self, rows: Array) -> Any:
        if self.name == "torch":
            kind = self._dtype or self._module.get_default_dtype()
            return self._module.from_numpy(rows).to(device=self._device or "cpu", dtype=kind)
        if self.name == "jax":  # padded to a power of two, so that few shapes are compiled
            count = 1 << max(len(rows) - 1, 63).bit_length()
            rows = np.concatenate([rows, np.broadcast_to(rows[-1:], (count - len(rows), rows.shape[1]))])
            made = self._module.asarray(rows, self._dtype or self._module.float32)
            if self._device is None:
                return made
            return importlib.import_module("jax").device_put(made, self._device)
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
        own = self._made(rows)
        self._keep(rows, own)
        return own

    def _cut(self, answer: Any, n: int) -> Any:
        """Returns the requested rows of a result with more."""
        if isinstance(answer, Mapping):
            return {key: self._cut(part, n) for key, part in answer.items()}
        if isinstance(answer, (tuple, list)):
            return tuple(self._cut(part, n) for part in answer)
        return answer if self.name != "jax" or answer is None or np.ndim(answer) == 0 else answer[:n]

    def asks(self, call: Call) -> Call:
        """Wraps `call` to receive arrays of the library instead of NumPy's."""

        def asked(*rows: Array) -> Any:
            return self._cut(call(*map(self.into, rows)), len(rows[-1]))

        return asked

    def samples(self, sample: Call, name: str) -> Call:
        """The same for `sample`, whose directions stay on the device."""
        if not self._keeps:
            return self.asks(sample)

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
