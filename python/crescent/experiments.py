"""Experiments and runs in memory: :func:`load`, :func:`parse`, :func:`run`, :func:`join`.

e = crescent.load("experiments/gallery.toml")
e["image.width"] = 320                      # checked as the file is; ValueError names what is wrong
measured = crescent.run(e)
measured.films["phong", 64].y               # [height, width], the memory of the run itself
"""

from __future__ import annotations

import csv
import io
import json
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from os import PathLike, fspath
from os.path import abspath
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _crescent
from ._sampler import whole

Progress = Callable[[str, float, float], None]


def _toml(value: Any) -> str:
    """A value as an override gives it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value)
    if isinstance(value, (int, float, np.number)):
        return repr(value.item() if isinstance(value, np.number) else value)
    if isinstance(value, Iterable) and not isinstance(value, Mapping):
        return "[" + ", ".join(_toml(v) for v in value) + "]"
    raise TypeError(
        f"{type(value).__name__} is no value of an experiment: expected a number, a text, or a list of them"
    )


def _overrides(changes: Mapping[str, Any]) -> list[str]:
    """KEY=VALUE of each; a table gives one for each of its keys."""
    out: list[str] = []
    for path, value in changes.items():
        if isinstance(value, Mapping) and value:
            out += _overrides({f"{path}.{key}": v for key, v in value.items()})
        else:
            out.append(f"{path}={_toml(value)}")
    return out


def _lines(table: Mapping[str, Any], path: str = "") -> Iterator[str]:
    """A table as the lines of a file."""
    inside = {key: value for key, value in table.items() if isinstance(value, Mapping)}
    yield from (f"{json.dumps(key)} = {_toml(value)}" for key, value in table.items() if key not in inside)
    for key, value in inside.items():
        at = f"{path}.{json.dumps(key)}" if path else json.dumps(key)
        yield from (f"[{at}]", *_lines(value, at))


class Experiment:
    """A checked experiment: read and change it by its keys, ``e["sphere.s"] = 8``. A change is checked as a whole.

    A table is set by a dictionary, ``e["arms.phong"] = {"n": [4]}``, and taken out by ``del e["arms.phong"]``.
    """

    def __init__(self, core: _crescent.Experiment) -> None:
        self._core = core

    def __getitem__(self, path: str) -> Any:
        at: Any = tomllib.loads(self._core.text)
        for i, word in enumerate(path.split(".")):
            if not isinstance(at, Mapping) or word not in at:
                inside = ".".join(path.split(".")[:i])
                has = ", ".join(at) if isinstance(at, Mapping) else "no keys"
                raise KeyError(f"{path}: {inside or 'the experiment'} has {has}")
            at = at[word]
        return at

    def __setitem__(self, path: str, value: Any) -> None:
        self._core = _crescent.parse(self._core.text, self._core.file, _overrides({path: value}))

    def __delitem__(self, path: str) -> None:
        _ = self[path]  # KeyError where it is not there
        whole = tomllib.loads(self._core.text)
        above, _, word = path.rpartition(".")
        at: Any = whole
        for step in above.split(".") if above else ():
            at = at[step]
        del at[word]
        self._core = _crescent.parse("\n".join(_lines(whole)), self._core.file, [])

    def __contains__(self, path: object) -> bool:
        try:
            self[str(path)]
        except KeyError:
            return False
        return True

    def __iter__(self) -> Iterator[str]:
        """The keys and tables of the file."""
        return iter(tomllib.loads(self._core.text))

    def with_(self, changes: Mapping[str, Any]) -> Experiment:
        """Another experiment, with these keys changed all at once."""
        return Experiment(_crescent.parse(self._core.text, self._core.file, _overrides(changes)))

    @property
    def text(self) -> str:
        """The experiment as a file: every key with its effective value."""
        return self._core.text

    @property
    def hash(self) -> str:
        """What identifies an experiment, computed from every value but the number of seeds."""
        return self._core.hash

    def __reduce__(self) -> tuple[Any, ...]:
        return parse, (self.text, self._core.file)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Experiment) and self.hash == other.hash and self["seeds"] == other["seeds"]

    def __repr__(self) -> str:
        return f"<Experiment {self._core.file} {self.hash}>"


def load(path: str | PathLike[str], changes: Mapping[str, Any] | None = None) -> Experiment:
    """An experiment file; ValueError names every mistake with line and column."""
    return Experiment(_crescent.load(fspath(path), _overrides(changes or {})))


def parse(text: str, name: str = "text.toml") -> Experiment:
    """The same from text; `name` stands for the file in messages."""
    return Experiment(_crescent.parse(text, name, []))


@dataclass(frozen=True, repr=False)
class Film:
    """Per pixel what n samples of one arm came to. Rows run bottom-up; radiance in W/(sr m^2), linear Rec. 709."""

    arm: str
    n: int
    s: float
    seed: int
    planes: Mapping[str, NDArray[Any]]  #: r, g, b, y, y2, var, largest, horizon, hits

    def __getattr__(self, name: str) -> NDArray[Any]:
        if name in ("r", "g", "b", "y", "y2", "var", "largest", "horizon", "hits", "error"):
            return self.planes[name]
        raise AttributeError(name)

    def __repr__(self) -> str:
        height, width = self.planes["y"].shape
        return f"<Film {self.arm} n={self.n} s={self.s:g} seed={self.seed}: {width} x {height}>"

    @property
    def rgb(self) -> NDArray[np.float32]:
        """[height, width, 3]."""
        return np.stack([self.planes[c] for c in "rgb"], -1)


class Films(Mapping[tuple[str, int], Film]):
    """Films by (arm, n) at the experiment's own s, or by (arm, n, s)."""

    def __init__(self, films: list[Film], s: float) -> None:
        self._films = {(f.arm, f.n, f.s): f for f in films}
        self._s = s

    def __getitem__(self, key: tuple[Any, ...]) -> Film:
        at: Any = (*key, self._s)[:3] if isinstance(key, tuple) else key
        if at not in self._films:
            told = ", ".join(f"{a} n={m} s={t:g}" for a, m, t in self._films)
            raise KeyError(f"no film {key!r}, expected (arm, n) or (arm, n, s): there are {told}")
        return self._films[at]

    def __iter__(self) -> Iterator[Any]:
        return iter(self._films)

    def __len__(self) -> int:
        return len(self._films)


class Measured:
    """A run: films as arrays without a copy, and every number."""

    def __init__(self, core: _crescent.Measured, s: float) -> None:
        self._core = core
        self.films = Films([Film(*film) for film in core.films], s)
        self.references = {s: planes for s, planes in core.references}  #: by s: r, g, b, y, error

    @property
    def metrics(self) -> dict[str, Any]:
        """metrics.json as data: bands over seeds, ladders, furnaces, assertions, provenance."""
        numbers: dict[str, Any] = json.loads(self._core.json())
        return numbers

    @property
    def holds(self) -> bool:
        """No assertion of the experiment fails; those on plates, or on seeds that were not run, are skipped."""
        return bool(self._core.holds)

    def records(self) -> list[dict[str, Any]]:
        """One row a number: arm, n, s, seed, meter, region, value; a data frame takes it as it is."""
        rows = csv.DictReader(io.StringIO(self._core.csv(), newline=""))
        kinds: dict[str, Callable[[str], Any]] = {"n": int, "s": float, "seed": int, "value": _number}
        return [{k: kinds.get(k, str)(v) for k, v in row.items()} for row in rows]

    def to_xarray(self) -> Any:
        """An xarray.Dataset: a variable a meter over (arm, n, s, seed), and region where it has one; NaN: not run."""
        import xarray

        rows = self.records()
        axes = {axis: sorted({r[axis] for r in rows}) for axis in ("n", "s", "seed")}
        axes = {"arm": list(dict.fromkeys(r["arm"] for r in rows)), **axes}
        regions = [r for r in dict.fromkeys(r["region"] for r in rows) if r]
        out: dict[str, Any] = {}
        for meter in dict.fromkeys(r["meter"] for r in rows):
            mine = [r for r in rows if r["meter"] == meter]
            coords = {**axes, "region": regions} if any(r["region"] for r in mine) else axes
            values = xarray.DataArray(np.full([len(c) for c in coords.values()], np.nan), coords, list(coords))
            for r in mine:
                values.loc[{axis: r[axis] for axis in coords}] = r["value"]
            out[meter] = values
        return xarray.Dataset(out)

    def write(self, folder: str | PathLike[str]) -> None:
        """metrics.json, metrics.csv, junit.xml and films/*.exr, which appear as one; the program draws plates."""
        self._core.write(fspath(folder))

    def __repr__(self) -> str:
        return f"<Measured: {len(self.films)} films; assertions {'hold' if self.holds else 'fail'}>"


def _number(text: str) -> float:
    return float(text) if text else float("nan")


def run(
    experiment: Experiment | str | PathLike[str],
    *,
    seeds: tuple[int, int] = (1, 0),
    threads: int = 0,
    isa: str = "",
    studies: bool = False,
    out: str | PathLike[str] | None = None,
    progress: Progress | None = None,
) -> Measured:
    """Runs an experiment, or the file of one.

    `seeds`: the first and last of its series, from 1; 0: to the end. `studies`: tails, furnaces and evidence too.
    `out`: a folder for metrics and films. Films are the same bits whatever `threads` and `isa` say.
    """
    folder = None if out is None else abspath(out)
    e = experiment if isinstance(experiment, Experiment) else load(experiment)
    if len(np.shape(seeds)) != 1 or len(seeds) != 2:
        raise ValueError(f"seeds is {seeds!r}: expected the first and the last of the series, (1, 0) for all")
    threads = whole("threads", threads, 0, 1024, "expected a whole number, 0 for one a core")
    core = _crescent.run(e._core, seeds[0], seeds[1], threads=threads, isa=isa, studies=studies, progress=progress)
    measured = Measured(core, e._core.s())
    if folder is not None:
        measured.write(folder)
    return measured


def join(parts: Sequence[str | PathLike[str]], out: str | PathLike[str] | None = None) -> Measured:
    """Joins runs of parts of one experiment's seeds, as `crescent join` does.

    `parts`: folders of runs, or their metrics.json. `out`: a folder for the metrics. There are no films.
    """
    folder = None if out is None else abspath(out)
    core, s = _crescent.join([fspath(part) for part in parts])
    measured = Measured(core, s)
    if folder is not None:
        measured.write(folder)
    return measured
