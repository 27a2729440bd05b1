"""Faults of public projects: each is rewritten from its public description, together with the same sampler fixed."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from .._check import check
from .._result import CheckResult
from .._sampler import Sampler


@dataclass(frozen=True)
class Fault:
    """A faulty sampler of a project."""

    name: str  #: a few words
    project: str
    source: str  #: the report by the project or its users
    says: str  #: what was wrong, in a sentence
    caught_by: tuple[str, ...]  #: verdicts that detect it
    sampler: Sampler | Callable[[], Sampler]  #: a callable: what is made only when it is checked, as a shader
    fixed: Sampler | Callable[[], Sampler]
    estimates: float | None = None  #: the number that both estimate, for samplers of domain="number"

    def checked(self, fixed: bool = False) -> CheckResult:
        """Returns the result for the fault, or for its fixed version."""
        given = self.fixed if fixed else self.sampler
        sampler = given if isinstance(given, Sampler) else given()
        wo_deg = (W_O if given is sampler else W_O[2:]) if sampler.of_directions() and sampler.wo != "none" else None
        return check(sampler, wo_deg=wo_deg, estimates=self.estimates)


W_O = [
    (30.0, 0.0),
    (60.0, 250.0),
    (80.0, 75.0),
]  #: w_o of each check, in degrees; of a shader the last


def faults_in(folder: str | Path) -> list[Fault]:
    """Returns FAULTS of every file of a folder, tests/field of the repository, in the order of their names."""
    path = Path(folder).resolve()
    if not path.is_dir():
        raise ValueError(f"{folder}: no such folder")
    sys.path.insert(0, str(path))
    try:
        out: list[Fault] = []
        for file in sorted(path.glob("*.py")):
            spec = importlib.util.spec_from_file_location(file.stem, file)
            assert spec and spec.loader
            module = sys.modules[file.stem] = importlib.util.module_from_spec(spec)
            spec.loader.exec_module(module)
            out += getattr(module, "FAULTS", [])
    finally:
        sys.path.remove(str(path))
    return out
