"""Samplers in files: "mine.py:sampler" is found as by pytest, with the same imports.

As in pytest's import mode "prepend": the first parent folder of the file that is not a package (has no ``__init__.py``)
is put at the front of ``sys.path``, and the file is imported by its name below that folder. So a sampler's file may
import the files next to it, and a test that imports it too has the same module.
"""

from __future__ import annotations

import importlib
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

from . import _crescent
from ._sampler import Sampler


#: Names in a file or class that state what its sampler is, as the fields of a Sampler do.
_STATED = ("domain", "numbers", "own_random", "weight", "target", "merge")


def names_a_file(text: str) -> bool:
    """Returns whether it is "FILE.py", "FILE.py:NAME" or "module:NAME"."""
    return ":" in text or text.endswith(".py")


def _module_in(path: Path) -> ModuleType:
    """Returns the module of a file."""
    if path.exists() and not path.is_file():
        raise ValueError(f"{path}: expected a regular file")
    if not path.is_file():
        near = _crescent.nearest(path.name, [at.name for at in path.parent.glob("*.py")])
        raise ValueError(f"{path}: no such file" + (f"; did you mean '{path.with_name(near)}'?" if near else ""))
    at = path.resolve()
    folder = at.parent
    while (folder / "__init__.py").is_file():
        folder = folder.parent
    if sys.path[:1] != [str(folder)]:
        sys.path.insert(0, str(folder))
    name = ".".join(part for part in at.relative_to(folder).with_suffix("").parts if part != "__init__")
    module = importlib.import_module(name)
    if Path(module.__file__ or "").resolve() != at:
        raise ValueError(f"{path}: the module '{name}' is {module.__file__} already; expected a name of its own")
    return module


def object_at(where: str, root: Path | None = None) -> Any:
    """Returns what "FILE.py:NAME" or "module:NAME" is, or the module of "FILE.py"; a file is searched from `root`."""
    name, colon, inside = where.rpartition(":") if not where.endswith(".py") else (where, "", "")
    found: Any = _module_in((root or Path()) / name) if name.endswith(".py") else importlib.import_module(name)
    if colon:
        if not hasattr(found, inside):
            near = _crescent.nearest(inside, [n for n in vars(found) if not n.startswith("_")])
            raise ValueError(f"{name} has no '{inside}'" + (f"; did you mean '{near}'?" if near else ""))
        found = getattr(found, inside)
    return found


def sampler_at(where: str, root: Path | None = None) -> Sampler:
    """Returns the sampler there, see :func:`object_at`."""
    found = object_at(where, root)
    name, _, inside = where.rpartition(":") if not where.endswith(".py") else (where, "", "")
    return as_sampler(found() if isinstance(found, type) else found, where, inside or Path(name).stem)


def as_sampler(found: Any, where: str, name: str) -> Sampler:
    """Returns the sampler of a module, or of an object with its callables; `where` it is, for messages."""
    if isinstance(found, Sampler):
        return found
    if not hasattr(found, "sample"):
        raise ValueError(f"{where} has no sample(wo, u)")
    known = {key: getattr(found, key) for key in _STATED if hasattr(found, key)}
    return Sampler(found.sample, getattr(found, "pdf", None), getattr(found, "f", None), name=name, **known)
