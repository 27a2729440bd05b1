"""The state of a sampler as plain values, for its identity: code, defaults, closures, the globals that the code names,
attributes of objects, and what these hold in turn.

Two samplers with the same state give the same results; a value that changes what a sampler computes changes its state.
Libraries (installed packages, the standard library) count by their version.
"""

from __future__ import annotations

import functools
import hashlib
import importlib.metadata
import inspect
import pickle
import sys
import uuid
from collections.abc import Iterable, Iterator, Mapping
from types import BuiltinFunctionType, CodeType, FunctionType, MethodType, ModuleType
from typing import Any

import numpy as np

_PLAIN = (type(None), bool, int, float, complex, str, bytes)
_OF_EVERY_CLASS = frozenset({"__dict__", "__weakref__", "__doc__", "__module__", "__annotations__", "__abstractmethods__"})


_PROCESS = uuid.uuid4().hex  # in the state of what cannot be hashed: no other process reuses its results


def state_of(value: Any) -> Any:
    """The state of a value as lists, numbers and texts."""
    return _Walk().state(value, frozenset())


def unhashable_in(value: Any) -> list[str]:
    """The types of the objects in the state of a value that cannot be hashed."""
    walk = _Walk()
    walk.state(value, frozenset())
    return list(dict.fromkeys(walk.unhashable))


def _sha(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


@functools.cache
def _distributions() -> Mapping[str, list[str]]:
    return importlib.metadata.packages_distributions()


@functools.cache
def library(module: str) -> tuple[Any, ...] | None:
    """The name of a library and its versions; None for a module of the user."""
    package = module.partition(".")[0]
    if package in ("builtins", "crescent") or package in sys.stdlib_module_names:
        return (package,) if package != "__main__" else None
    file = getattr(sys.modules.get(package), "__file__", None) or ""
    if package in _distributions() and ("site-packages" in file or "dist-packages" in file or not file.endswith(".py")):
        return (package, *(f"{d} {importlib.metadata.version(d)}" for d in sorted(set(_distributions()[package]))))
    return None


def _codes(code: CodeType) -> Iterator[CodeType]:
    """A code object and those inside it."""
    yield code
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _codes(constant)


class _Walk:
    """Follows references; a value that was met before is its number, so that a cycle ends."""

    def __init__(self) -> None:
        self._met: dict[int, int] = {}
        self._alive: list[Any] = []  # ids are of living values
        self.unhashable: list[str] = []

    def state(self, value: Any, names: frozenset[str]) -> Any:
        """`names`: what the code that refers to this value names; of a module only these count."""
        if isinstance(value, _PLAIN):
            return [type(value).__name__, value.hex() if isinstance(value, (float, bytes)) else repr(value)]
        if id(value) in self._met and not isinstance(value, ModuleType):
            return ["met", self._met[id(value)]]
        self._met[id(value)] = len(self._met)
        self._alive.append(value)
        if isinstance(value, ModuleType):
            return self._module(value, names)
        if isinstance(value, MethodType):
            return ["method", self.state(value.__func__, names), self.state(value.__self__, names)]
        if isinstance(value, FunctionType):
            return self._function(value)
        if isinstance(value, functools.partial):
            return ["partial", *(self.state(part, names) for part in (value.func, value.args, value.keywords))]
        if isinstance(value, type):
            return self._class(value)
        if isinstance(value, BuiltinFunctionType) or getattr(value, "__wrapped__", None) is not None:
            return self._wrapper(value, names)
        return self._data(value, names)

    def _many(self, values: Iterable[Any], names: frozenset[str]) -> list[Any]:
        return [self.state(value, names) for value in values]

    def _data(self, value: Any, names: frozenset[str]) -> Any:
        if isinstance(value, np.ndarray) and value.dtype != object:
            return ["array", value.dtype.str, list(value.shape), _sha(np.ascontiguousarray(value).tobytes())]
        if isinstance(value, (list, tuple)):
            return [type(value).__name__, *self._many(value, names)]
        if isinstance(value, Mapping):
            pairs = [[self.state(key, names), self.state(inside, names)] for key, inside in value.items()]
            return [type(value).__name__, *pairs]
        if isinstance(value, (set, frozenset)):
            return [type(value).__name__, *sorted(self._many(sorted(value, key=repr), names), key=repr)]
        return self._object(value, names)

    def _module(self, module: ModuleType, names: frozenset[str]) -> Any:
        if (known := library(module.__name__)) is not None:
            return ["library", *known]
        there = vars(module)
        return [module.__name__, *([n, self.state(there[n], names - {n})] for n in sorted(names) if n in there)]

    def _function(self, function: FunctionType) -> Any:
        if (known := library(function.__module__ or "")) is not None:
            return ["library", *known, function.__qualname__]
        codes = list(_codes(function.__code__))
        names = frozenset(name for code in codes for name in code.co_names)
        constants = [c for code in codes for c in code.co_consts if not isinstance(c, CodeType)]
        used = {n: function.__globals__[n] for n in sorted(names) if n in function.__globals__}
        cells = []
        for cell in function.__closure__ or ():
            try:
                cells.append(self.state(cell.cell_contents, names))
            except ValueError:  # of a name that has no value yet
                cells.append("empty")
        return [
            "function", [[_sha(code.co_code), list(code.co_names), list(code.co_varnames)] for code in codes],
            self._many(constants, names), self._many((function.__defaults__, function.__kwdefaults__), names), cells,
            [[name, self.state(value, names)] for name, value in used.items()],
            [[name, self.state(value, names)] for name, value in sorted(vars(function).items()) if name != "__wrapped__"],
            self.state(vars(function).get("__wrapped__"), names),
        ]  # fmt: skip

    def _wrapper(self, value: Any, names: frozenset[str]) -> Any:
        """A function of C, or one of C around one of Python, such as that of functools.lru_cache."""
        inside = getattr(value, "__wrapped__", None)
        own = getattr(value, "__self__", None)
        about = [getattr(value, "__module__", None) or "", getattr(value, "__qualname__", type(value).__qualname__)]
        bound = None if isinstance(own, ModuleType) else own
        return ["wrapper", *about, self.state(inside, names), self.state(bound, names)]

    def _class(self, kind: type) -> Any:
        if (known := library(kind.__module__)) is not None:
            return ["library", *known, kind.__qualname__]
        members = sorted((name, value) for name, value in vars(kind).items() if name not in _OF_EVERY_CLASS)
        return ["class", kind.__qualname__, self._many(kind.__bases__, frozenset()),
            [[name, self._member(value)] for name, value in members]]  # fmt: skip

    def _member(self, value: Any) -> Any:
        none: frozenset[str] = frozenset()
        if isinstance(value, (staticmethod, classmethod)):
            return self.state(value.__func__, none)
        if isinstance(value, property):
            return self._many((value.fget, value.fset), none)
        if inspect.ismemberdescriptor(value) or inspect.isgetsetdescriptor(value):
            return "slot"
        return self.state(value, none)

    def _object(self, value: Any, names: frozenset[str]) -> Any:
        """An object of the user by its class and attributes, one of a library by its pickle."""
        kind = type(value)
        if library(kind.__module__) is None:
            slots = [name for c in kind.__mro__ for name in _slots(c) if hasattr(value, name)]
            attributes = {**getattr(value, "__dict__", {}), **{name: getattr(value, name) for name in slots}}
            return ["object", self.state(kind, names), self._pairs(attributes, names)]
        try:
            return ["object", kind.__qualname__, _sha(pickle.dumps(value, protocol=4))]
        except Exception:  # anything that a library raises
            self.unhashable.append(f"{kind.__module__}.{kind.__qualname__}")
            return ["unhashable", kind.__qualname__, _PROCESS, id(value)]

    def _pairs(self, attributes: Mapping[str, Any], names: frozenset[str]) -> list[Any]:
        return [[name, self.state(value, names)] for name, value in sorted(attributes.items())]


def _slots(kind: type) -> Iterable[str]:
    slots = vars(kind).get("__slots__", ())
    return [name for name in ((slots,) if isinstance(slots, str) else slots) if name not in ("__dict__", "__weakref__")]
