"""The state of a sampler as plain values, for its identity: code, defaults, closures, the globals that the code names,
attributes of objects, and what these hold in turn.

Two samplers with the same state give the same results; a value that changes what a sampler computes changes its state.
Libraries (installed packages, the standard library) count by their version.
"""

from __future__ import annotations

import dis
import functools
import hashlib
import importlib
import importlib.machinery
import importlib.metadata
import importlib.util
import inspect
import io
import json
import pickle
import sys
import uuid
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from types import BuiltinFunctionType, CodeType, FunctionType, MappingProxyType, MethodType, ModuleType
from typing import Any

import numpy as np

_PLAIN = (type(None), bool, int, float, complex, str, bytes)
_CONTAINERS = (list, tuple, dict, set, frozenset)
#: What every class has, and what is made from its other members.
_OF_EVERY_CLASS = frozenset({
    "__dict__", "__weakref__", "__doc__", "__module__", "__annotations__", "__abstractmethods__", "_abc_impl",
    "__dataclass_fields__", "__dataclass_params__",
})  # fmt: skip
#: Built-in functions by which code reads what its names do not tell.
_HIDING = frozenset({"globals", "eval", "exec", "__import__", "open"})


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
def versions_of(package: str) -> tuple[str, ...]:
    """The distributions of a top-level module with their versions; none of a module of the user."""
    try:
        return (f"{package} {importlib.metadata.version(package)}",)
    except importlib.metadata.PackageNotFoundError:  # of another name: the list of all takes seconds
        return tuple(f"{d} {importlib.metadata.version(d)}" for d in sorted(set(_distributions().get(package, ()))))


def _file_of(package: str) -> str:
    """The file of a top-level module, whether it is imported or not; nothing if it has none."""
    if package in sys.modules:
        return getattr(sys.modules[package], "__file__", None) or ""
    try:
        spec = importlib.util.find_spec(package)
    except (ImportError, ValueError):
        spec = None
    return (spec.origin or "") if spec else ""


@functools.cache
def library(module: str) -> tuple[Any, ...] | None:
    """The name of a library and its versions; of a user's compiled module the hash of its file; None for another module
    of the user."""
    package = module.partition(".")[0]
    if package in ("builtins", "crescent") or package in sys.stdlib_module_names:
        return (package,)
    if package in ("", "__main__"):
        return None
    file = _file_of(package)
    installed = "site-packages" in file or "dist-packages" in file
    if (installed or not file.endswith(".py")) and (versions := versions_of(package)):
        return (package, *versions)
    own = getattr(sys.modules.get(module), "__file__", None) or ""
    return (module, _sha(Path(own).read_bytes())) if own.endswith(tuple(importlib.machinery.EXTENSION_SUFFIXES)) else None


def _module_of(value: Any) -> str:
    """The name of the module of a class or function; nothing if it has none."""
    name = getattr(value, "__module__", None)
    return name if isinstance(name, str) else ""


def _codes(code: CodeType) -> Iterator[CodeType]:
    """A code object and those inside it."""
    yield code
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _codes(constant)


def _words(code: CodeType) -> set[str]:
    """The names that a code object uses, and its texts that may be names: getattr(module, "name")."""
    return {*code.co_names, *(c for c in code.co_consts if isinstance(c, str) and c.isidentifier())}


def _hiding(code: CodeType) -> Iterator[str]:
    """The built-in functions of `_HIDING` that a code object names."""
    for step in dis.get_instructions(code):
        if step.opname in ("LOAD_GLOBAL", "LOAD_NAME") and step.argval in _HIDING:
            yield step.argval


def _imports(code: CodeType, package: str) -> Iterator[str]:
    """The modules that a code object imports when it runs, by their whole names."""
    constants: list[Any] = []
    for step in dis.get_instructions(code):
        if step.opname in ("LOAD_CONST", "LOAD_SMALL_INT"):
            constants.append(step.argval)
        if step.opname != "IMPORT_NAME":
            continue
        level, names = constants[-2:]
        name = importlib.util.resolve_name("." * level + step.argval, package) if level else step.argval
        yield name
        yield from (f"{name}.{inside}" for inside in names or () if inside != "*")


def _of_user(kind: type) -> bool:
    """Whether a class is the user's."""
    return library(_module_of(kind)) is None


class _Pickler(pickle.Pickler):
    """Pickles an object of a library; functions, classes and objects of the user in it are their states."""

    def __init__(self, file: io.BytesIO, walk: _Walk, names: frozenset[str]) -> None:
        super().__init__(file, protocol=4)
        self._walk, self._names = walk, names

    def persistent_id(self, value: Any) -> str | None:
        """The state of what pickle would store by its name alone; None of all else."""
        kind = type(value)
        if kind in _PLAIN or kind in _CONTAINERS:
            return None
        if isinstance(value, type):
            stated = _of_user(value)
        else:
            stated = isinstance(value, (FunctionType, MethodType, ModuleType)) or _of_user(kind)
        return json.dumps(self._walk.state(value, self._names)) if stated else None


class _Walk:
    """Follows references; a value that was met before is its number, so that a cycle ends."""

    def __init__(self) -> None:
        self._met: dict[int, int] = {}
        self._alive: list[Any] = []  # ids are of living values
        self.unhashable: list[str] = []

    def state(self, value: Any, names: frozenset[str]) -> Any:
        """`names`: what the code that refers to this value names; of a module only these count."""
        if type(value) in _PLAIN:
            return _plain(value)
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
        if _of_user(type(value)):
            return self._object(value, names)
        if isinstance(value, BuiltinFunctionType) or getattr(value, "__wrapped__", None) is not None:
            return self._wrapper(value, names)
        return self._data(value, names)

    def _many(self, values: Iterable[Any], names: frozenset[str]) -> list[Any]:
        return [self.state(value, names) for value in values]

    def _data(self, value: Any, names: frozenset[str]) -> Any:
        kind = type(value)
        if kind in (np.ndarray, np.memmap):
            if value.dtype.hasobject:
                return ["objects", value.dtype.str, list(value.shape), self._many(value.ravel().tolist(), names)]
            return ["array", value.dtype.str, list(value.shape), _sha(np.ascontiguousarray(value).tobytes())]
        if kind in _CONTAINERS or kind is MappingProxyType:
            return self._container(value, names)
        return self._of_library(value, names)

    def _container(self, value: Any, names: frozenset[str]) -> Any:
        kind = type(value).__name__
        if isinstance(value, (dict, MappingProxyType)):
            return [kind, *([self.state(key, names), self.state(inside, names)] for key, inside in value.items())]
        if isinstance(value, (set, frozenset)):
            return [kind, *sorted(self._many(sorted(value, key=repr), names), key=repr)]
        return [kind, *self._many(value, names)]

    def _module(self, module: ModuleType, names: frozenset[str]) -> Any:
        if (known := library(module.__name__)) is not None:
            return ["library", *known]
        there = vars(module)
        return [module.__name__, *([n, self.state(there[n], names - {n})] for n in sorted(names) if n in there)]

    def _imported(self, name: str, names: frozenset[str]) -> Any:
        """A module that code imports when it runs, as it would import it."""
        try:
            return self.state(importlib.import_module(name), names)
        except Exception:  # anything that a module raises, or the name is not of a module
            return None

    def _function(self, function: FunctionType) -> Any:
        if (known := library(_module_of(function))) is not None:
            return ["library", *known, function.__qualname__, *self._held(function)]
        codes = list(_codes(function.__code__))
        names = frozenset(name for code in codes for name in _words(code))
        self.unhashable += [f"{name}()" for code in codes for name in _hiding(code) if name not in function.__globals__]
        package = str(function.__globals__.get("__package__") or "")
        imported = sorted({name for code in codes for name in _imports(code, package) if library(name) is None})
        constants = [c for code in codes for c in code.co_consts if not isinstance(c, CodeType)]
        used = {n: function.__globals__[n] for n in sorted(names) if n in function.__globals__}
        return [
            "function", [[_sha(code.co_code), list(code.co_names), list(code.co_varnames)] for code in codes],
            self._many(constants, names), self._held(function),
            [[name, self.state(value, names)] for name, value in used.items()],
            [[name, self._imported(name, names)] for name in imported],
        ]  # fmt: skip

    def _held(self, function: FunctionType) -> list[Any]:
        """What a function holds beside its code: defaults, a closure, attributes. Of a function of a library, by which
        it may call functions of the user."""
        names = frozenset(name for code in _codes(function.__code__) for name in code.co_names)
        out: list[Any] = [[key, self.state(value, names)] for key, value in (function.__kwdefaults__ or {}).items()]
        out += self._many(function.__defaults__ or (), names)
        for cell in function.__closure__ or ():
            try:
                out.append(self.state(cell.cell_contents, names))
            except ValueError:  # of a name that has no value yet
                out.append("empty")
        return out + self._pairs(vars(function), names)

    def _wrapper(self, value: Any, names: frozenset[str]) -> Any:
        """A function of C, or one of C around one of Python, such as that of functools.lru_cache."""
        inside = getattr(value, "__wrapped__", None)
        own = getattr(value, "__self__", None)
        about = [_module_of(value), *(library(_module_of(value)) or ()), getattr(value, "__qualname__", type(value).__qualname__)]
        bound = None if isinstance(own, ModuleType) else own
        return ["wrapper", *about, self.state(inside, names), self.state(bound, names)]

    def _class(self, kind: type) -> Any:
        if (known := library(_module_of(kind))) is not None:
            return ["library", *known, kind.__qualname__]
        members = sorted((name, value) for name, value in vars(kind).items() if name not in _OF_EVERY_CLASS)
        bases = (*kind.__bases__, type(kind))
        return ["class", kind.__qualname__, self._many(bases, frozenset()),
            [[name, self._member(value)] for name, value in members]]  # fmt: skip

    def _member(self, value: Any) -> Any:
        none: frozenset[str] = frozenset()
        if isinstance(value, (staticmethod, classmethod)):
            return self.state(value.__func__, none)
        if isinstance(value, property):
            return self._many((value.fget, value.fset), none)
        if isinstance(value, functools.cached_property):
            return self.state(value.func, none)
        if isinstance(value, functools.partialmethod):
            return self._many((value.func, value.args, value.keywords), none)
        if inspect.ismemberdescriptor(value) or inspect.isgetsetdescriptor(value):
            return "slot"
        return self.state(value, none)

    def _object(self, value: Any, names: frozenset[str]) -> Any:
        """An object of the user by its class, its attributes and what it is otherwise: a list, a number, an array."""
        kind = type(value)
        try:
            reduced = value.__reduce_ex__(4)
        except Exception:  # what is not in Python, and anything that a class raises
            return self._unhashable(value)
        if isinstance(reduced, str):  # it is known by its name
            return ["named", _module_of(value), *(library(_module_of(value)) or ()), reduced]
        slots = [name for c in kind.__mro__ for name in _slots(c) if hasattr(value, name)]
        attributes = {**getattr(value, "__dict__", {}), **{name: getattr(value, name) for name in slots}}
        out = ["object", self.state(kind, names), self._pairs(attributes, names)]
        if isinstance(value, np.ndarray):
            out.append(self.state(np.asarray(value), names))
        out += [self._container(value, names) for base in _CONTAINERS if isinstance(value, base)]
        bases: Any = _PLAIN[1:]
        return out + [_plain(base(value)) for base in bases if isinstance(value, base)]

    def _unhashable(self, value: Any) -> Any:
        kind = type(value)
        self.unhashable.append(f"{_module_of(kind)}.{kind.__qualname__}")
        return ["unhashable", kind.__qualname__, _PROCESS, id(value)]

    def _of_library(self, value: Any, names: frozenset[str]) -> Any:
        """An object of a library by its pickle."""
        data = io.BytesIO()
        try:
            _Pickler(data, self, names).dump(value)
        except Exception:  # anything that a library raises
            return self._unhashable(value)
        return ["object", type(value).__qualname__, _sha(data.getvalue())]

    def _pairs(self, attributes: Mapping[str, Any], names: frozenset[str]) -> list[Any]:
        return [[name, self.state(value, names)] for name, value in sorted(attributes.items())]


def _plain(value: Any) -> list[str]:
    """The state of a number or a text."""
    return [type(value).__name__, value.hex() if isinstance(value, (float, bytes)) else repr(value)]


def _slots(kind: type) -> Iterable[str]:
    """The names of the slots of a class, as attributes have them: of a private one with the name of the class."""
    slots = vars(kind).get("__slots__", ())
    own = kind.__name__.lstrip("_")
    for name in (slots,) if isinstance(slots, str) else slots:
        if name not in ("__dict__", "__weakref__"):
            yield f"_{own}{name}" if own and name.startswith("__") and not name.endswith("__") else name
