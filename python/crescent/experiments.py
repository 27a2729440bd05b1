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
import re
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from os import PathLike, fspath
from os.path import abspath, dirname
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _crescent
from ._callable_arms import Samplers, all_counts, callable_arms, table_of
from ._progress import bar
from ._sampler import whole
from ._summaries import Summary

Progress = Callable[[str, float, float], None]


def _toml(value: Any) -> str:
    """Formats a value for an override."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value)
    if isinstance(value, (int, float, np.number)):
        return repr(value.item() if isinstance(value, np.number) else value)
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{json.dumps(str(key))} = {_toml(v)}" for key, v in value.items()) + "}"
    if isinstance(value, Iterable):
        return "[" + ", ".join(_toml(v) for v in value) + "]"
    raise TypeError(
        f"{type(value).__name__} is not a value of an experiment: expected a number, a text, or a list of them"
    )


def _quoted(key: str) -> str:
    """Formats a key as a step of a path: quoted if it is more than a bare word."""
    return key if re.fullmatch(r"[\w-]+", key) else f"'{key}'" if '"' in key else f'"{key}"'


def _overrides(changes: Mapping[str, Any]) -> list[str]:
    """Returns KEY=VALUE for each; a table gives one for each of its keys."""
    out: list[str] = []
    for path, value in changes.items():
        if isinstance(value, Mapping) and value:
            out += _overrides({f"{path}.{_quoted(key)}": v for key, v in value.items()})
        else:
            out.append(f"{path}={_toml(value)}")
    return out


def _steps(path: str) -> list[str]:
    """Splits shapes.'a ball'.center[1] into shapes, a ball, center, 1, as --set reads a path."""
    found = [next(filter(None, step)) for step in re.findall(r"\"([^\"]*)\"|'([^']*)'|([^.\[\]\"']+)", path)]
    if not found:
        raise KeyError(f"{path!r}: expected a path such as sphere.s or shapes.sphere.s")
    return found


def _inside(at: Any, step: str) -> Any:
    """Returns the value of a key of a table or at an index of a list; KeyError names the existing keys, and the
    nearest."""
    if isinstance(at, Mapping):
        if step in at:
            return at[step]
        near = _crescent.nearest(step, list(at))
        raise KeyError(f"has {', '.join(at)}" + (f"; did you mean '{near}'?" if near else ""))
    if isinstance(at, list) and at:
        if step.isdecimal() and int(step) < len(at):
            return at[int(step)]
        raise KeyError(f"has items 0 to {len(at) - 1}")
    raise KeyError("has no keys")


def _found(tree: Mapping[str, Any], path: str) -> tuple[list[str], Any]:
    """Returns the steps from the top to a value, and the value. A path may begin at a name, as for --set: key.radius.
    """
    steps = _steps(path)
    families = [key for key, value in tree.items() if isinstance(value, Mapping) and steps[0] in value]
    starts = [steps] if steps[0] in tree else []
    starts += [[family, *steps] for family in families if isinstance(tree[family][steps[0]], Mapping)]
    found, problem = [], ""
    for start in starts:
        at: Any = tree
        for i, step in enumerate(start):
            try:
                at = _inside(at, step)
            except KeyError as e:
                problem = problem or f"{path}: {'.'.join(start[:i])} {e.args[0]}"
                break
        else:
            found.append((start, at))
    if len(found) > 1 and found[0][0] is not steps:
        raise KeyError(f"{path} is ambiguous: expected {' or '.join('.'.join(start) for start, _ in found)}")
    if found:
        return found[0]
    if problem:
        raise KeyError(problem)
    tables = [value for value in tree.values() if isinstance(value, Mapping)]
    names = [name for table in tables for name, inside in table.items() if isinstance(inside, Mapping)]
    near = _crescent.nearest(steps[0], [*tree, *names])
    hint = f"; did you mean '{near}'?" if near else ""
    raise KeyError(f"{path}: the experiment has {', '.join(tree)}, and the names {', '.join(names)}{hint}")


def _lines(table: Mapping[str, Any], path: str = "") -> Iterator[str]:
    """A table as the lines of a file."""
    inside = {key: value for key, value in table.items() if isinstance(value, Mapping)}
    yield from (f"{json.dumps(key)} = {_toml(value)}" for key, value in table.items() if key not in inside)
    for key, value in inside.items():
        at = f"{path}.{json.dumps(key)}" if path else json.dumps(key)
        yield from (f"[{at}]", *_lines(value, at))


@dataclass(frozen=True)
class _Source:
    """What was read, and what was changed since. A change is applied to what was read, as by --set: a value that a file
    does not give may depend on the changed key."""

    text: str
    name: str  #: of the file, in messages
    folder: str  #: absolute; paths of the file are relative to it
    changes: tuple[str, ...] = ()

    def changed(self, more: Sequence[str]) -> _Source:
        """With more changes; one of the key that was changed last replaces it."""
        kept = list(self.changes)
        for change in more:
            if kept and kept[-1].partition("=")[0] == change.partition("=")[0]:
                kept.pop()
            kept.append(change)
        return _Source(self.text, self.name, self.folder, tuple(kept))

    def core(self) -> _crescent.Experiment:
        return _crescent.parse(self.text, self.name, list(self.changes), self.folder)

    def tree(self) -> dict[str, Any]:
        """The keys that the file, or a change, gives."""
        return tomllib.loads(_crescent.text_with_overrides(self.text, self.name, list(self.changes)))


class Experiment:
    """A checked experiment: read and change it by its keys, ``e["sphere.s"] = 8``. The whole is checked after a change.

    Keys are those of ``crescent run --set``: a whole path, ``shapes.sphere.s``, or one that begins at a name,
    ``sphere.s``; an item of a list is ``camera.eye[1]``. A table is set by a dictionary, ``e["arms.phong"] = {"n":
    [4]}``, and removed by ``del e["arms.phong"]``. Values are read as copies.
    """

    def __init__(
        self, core: _crescent.Experiment, samplers: Mapping[str, Any] | None = None, source: _Source | None = None
    ) -> None:
        self._core = core
        self._source = source or _Source(core.text, core.file, dirname(abspath(core.file)))
        self.samplers: Samplers = Samplers()  #: samplers in Python by the name of their arm, which :func:`run` adds
        self.samplers.update(samplers or {})

    def _tree(self) -> dict[str, Any]:
        """Returns every value, including those that a shape inherits."""
        return tomllib.loads(re.sub(r"(?m)^# inherited: ", "", self._core.text))

    def __getitem__(self, path: str) -> Any:
        return _found(self._tree(), path)[1]

    def __setitem__(self, path: str, value: Any) -> None:
        changed = self.with_({path: value})
        self._core, self._source = changed._core, changed._source

    def __delitem__(self, path: str) -> None:
        whole = self._source.tree()
        try:
            steps, _ = _found(whole, path)
        except KeyError:
            if path in self:
                raise KeyError(f"{path}: has its default value; expected a key that the file, or a change, gives") from None
            raise
        at: Any = whole
        for step in steps[:-1]:
            at = _inside(at, step)
        del at[int(steps[-1]) if isinstance(at, list) else steps[-1]]
        source = _Source("\n".join(_lines(whole)), self._source.name, self._source.folder)
        self._core, self._source = source.core(), source

    def __contains__(self, path: object) -> bool:
        try:
            self[str(path)]
        except KeyError:
            return False
        return True

    def __iter__(self) -> Iterator[str]:
        """The keys and tables of the file."""
        return iter(self._tree())

    def with_(self, changes: Mapping[str, Any]) -> Experiment:
        """Another experiment, with these keys changed all at once."""
        return self._with_overrides(_overrides(changes))

    def _with_overrides(self, overrides: Sequence[str]) -> Experiment:
        """The same with PATH=VALUE each, as --set takes it."""
        source = self._source.changed(overrides)
        return Experiment(source.core(), self.samplers, source)

    def _with_arms(self) -> Experiment:
        """With an arm for each of `samplers`, at the sample counts of the other arms."""
        arms = self._tree()["arms"]
        for name in self.samplers:
            if name in arms:
                raise ValueError(f"samplers: the experiment has an arm '{name}': expected another name")
        if not self.samplers:
            return self
        counts = all_counts(arms.values())
        tables = {f"arms.{_quoted(n)}": {**table_of(s), "n": counts} for n, s in self.samplers.items()}
        return Experiment(_crescent.with_arms(self._core, _overrides(tables)))

    @property
    def text(self) -> str:
        """The experiment as a file: every key with its effective value."""
        return self._core.text

    @property
    def hash(self) -> str:
        """What identifies an experiment: every value but the number of seeds, and the files of its samplers."""
        return self._with_arms()._core.hash

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (self._source, dict(self.samplers))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Experiment) or self.samplers != other.samplers:
            return False
        return self.hash == other.hash and self["seeds"] == other["seeds"]

    def __repr__(self) -> str:
        return f"<Experiment {self._core.file} {self.hash}>"


def _restored(source: _Source, samplers: Mapping[str, Any]) -> Experiment:
    """An experiment that was pickled or copied."""
    return Experiment(source.core(), samplers, source)


def load(path: str | PathLike[str], changes: Mapping[str, Any] | None = None) -> Experiment:
    """An experiment file; ValueError names every mistake with line and column."""
    name, overrides = fspath(path), _overrides(changes or {})
    core = _crescent.load(name, overrides)
    text = Path(name).read_bytes().decode("utf-8-sig")
    return Experiment(core, None, _Source(text, name, dirname(abspath(name)), tuple(overrides)))


def parse(text: str, name: str = "text.toml") -> Experiment:
    """The same from text; `name` is the file's name in messages."""
    return Experiment(_crescent.parse(text, name, []), None, _Source(text, name, dirname(abspath(name))))


@dataclass(frozen=True, repr=False)
class Film:
    """Per-pixel statistics of n samples of one arm. Rows run bottom-up; radiance in W/(sr m^2), linear Rec. 709."""

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


class RunInterrupted(KeyboardInterrupt):
    """Ctrl-C during :func:`run`."""

    def __init__(self, result: Measured | None) -> None:
        super().__init__("no seed is complete" if result is None else "the complete seeds are in .result")
        self.result = result  #: of the seeds that are complete; None: none is


class Measured:
    """A run: films as arrays without a copy, and every number. It can be pickled and copied."""

    def __init__(self, core: _crescent.RunResult) -> None:
        self._core = core
        self.films: Films = Films([Film(*film) for film in core.films], core.s)
        self.references: dict[float, Mapping[str, NDArray[np.float32]]] = {s: planes for s, planes in core.references}  #: by s: r, g, b, y, error

    @property
    def metrics(self) -> dict[str, Any]:
        """metrics.json as data: bands over seeds, ladders, furnaces, assertions, provenance."""
        numbers: dict[str, Any] = json.loads(self._core.json)
        return numbers

    @property
    def holds(self) -> bool:
        """Whether no assertion of the experiment fails; those on plates, or on seeds that were not run, are skipped."""
        return bool(self._core.holds)

    def __reduce__(self) -> tuple[Any, ...]:
        return Measured, (self._core,)

    def records(self) -> list[dict[str, Any]]:
        """One row per number: arm, n, s, seed, `meter`, region, value; suitable for a data frame.

        Counts are int, other numbers float, None if there is none; region is "" for the whole frame. Each changed key
        has a column, whose values are those of the file.
        """
        rows = csv.DictReader(io.StringIO(self._core.csv, newline=""))
        return [{key: _field(key, text, row["meter"]) for key, text in row.items()} for row in rows]

    @property
    def boxes(self) -> dict[str, tuple[int, int, int, int]]:
        """x0, y0, x1, y1 of each region in pixels, both ends inclusive, from the bottom-left."""
        return {name: box for name, *box in self._core.boxes}  # type: ignore[misc]

    @property
    def times(self) -> dict[str, float]:
        """Seconds of wall-clock time of each arm at its highest N and the experiment's own s: the median over seeds of
        the medians over `repeats`. They vary between equal runs."""
        rows = [(arm, seconds) for arm, _, s, _, seconds in self._core.times if s == self.s]
        arms = dict.fromkeys(arm for arm, _ in rows)
        return {arm: float(np.median([t for a, t in rows if a == arm])) for arm in arms}

    def metric(self, name: str, arm: str, n: int, region: str = "", s: float | None = None) -> Summary:
        """A metric of :meth:`records`, "tail_k", "bias_sq", "flip" (of the first `flip_seeds` seeds; of the frame of the
        first seed), or "efficiency_n" and "efficiency_time": 1 / (variance of one sample) and 1 / (variance times
        seconds), as a mean over seeds with its 95 % interval (Student's t)."""
        from ._summaries import summary

        return summary(self, name, arm, n, region, self.s if s is None else s)

    def to_pandas(self) -> Any:
        """The rows of :meth:`records` as a pandas.DataFrame."""
        import pandas  # type: ignore[import-untyped,unused-ignore]

        return pandas.DataFrame(self.records())

    def to_latex(
        self,
        table: str = "rmse",
        region: str | None = None,
        *,
        s: float | None = None,
        bold: str | None = "best",
        digits: int = 3,
    ) -> str:
        """A metric as a LaTeX table (booktabs): a row an arm, a column a sample count, means over seeds with the half
        width of their 95 % intervals.

        `bold="best"`: arms of which none is significantly worse than the best are bold, if some other arm is (paired t
        over seeds at 5 %, shared by the arms); with one seed, or a metric of which the smallest is not the best, nothing is
        ranked. None: nothing is bold.
        """
        from ._tables import latex

        if bold not in ("best", None):
            raise ValueError(f"bold is {bold!r}: expected 'best' or None")
        return latex(self, table, region, self.s if s is None else s, bold == "best", digits)

    @property
    def s(self) -> float:
        """The experiment's own Phong exponent."""
        return float(self._core.s)

    @property
    def provenance(self) -> str:
        """One line for an appendix: program, experiment, hash, seeds, compiler."""
        p = self.metrics["provenance"]
        seeds = sorted({row["seed"] for row in self.records()})
        return (
            f"crescent {p['version']} ({p['commit']}, {p['compiler']}), experiment {p['experiment']['file']} "
            f"{p['experiment']['hash']}, {len(seeds)} seed{'s' * (len(seeds) != 1)} from {seeds[0]}"
        )

    def to_xarray(self) -> Any:
        """An xarray.Dataset: one variable per metric over (arm, n, s, seed), and region if it has one; NaN: not run."""
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
                values.loc[{axis: r[axis] for axis in coords}] = np.nan if r["value"] is None else r["value"]
            out[meter] = values
        return xarray.Dataset(out)

    def write(self, folder: str | PathLike[str]) -> None:
        """Writes metrics.json, metrics.csv, junit.xml and films/*.exr, all at once; only the program draws plates."""
        self._core.write(fspath(folder))

    def __repr__(self) -> str:
        return f"<Measured: {len(self.films)} films; assertions {'hold' if self.holds else 'fail'}>"


_COUNTS = frozenset(_crescent.counting_metrics())


def _field(column: str, text: str, meter: str) -> Any:
    """Reads a field of metrics.csv: a number by its column, None if there is none; a key's value as in the file."""
    if column in ("arm", "meter", "region"):
        return text
    if column in ("n", "seed") or (column == "value" and meter in _COUNTS):
        return int(text) if text else None
    if column in ("s", "value"):
        number = float(text) if text else np.nan
        return None if np.isnan(number) else number
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text or None


def run(
    experiment: Experiment | str | PathLike[str],
    *,
    seeds: tuple[int, int] = (1, 0),
    threads: int = 0,
    isa: str = "",
    studies: bool = False,
    out: str | PathLike[str] | None = None,
    progress: Progress | bool | None = None,
    code: bool = True,
    repeats: int = 1,
) -> Measured:
    """Runs an experiment, or the file of one.

    `progress`: a callable progress(what, done, total); True or False for tqdm's bar or none; by default a bar where
    tqdm is installed and stderr is a terminal or a notebook. `repeats`: how often each arm is run for
    :attr:`Measured.times`, which are medians. Ctrl-C raises :class:`RunInterrupted`, a KeyboardInterrupt whose `result`
    has the seeds that are complete; with `out` it is written there.

    `seeds`: the first and last of its series, from 1; 0: to the end. `studies`: tails, furnaces and evidence too.
    `out`: a folder for metrics and films. Films have the same bits for any `threads` and `isa`.

    Each sampler of ``e.samplers`` is an arm of its name, at the sample counts of the other arms. What it raises is
    raised here. `code`: False refuses an experiment whose file names a plugin, a program or a Python file.
    """
    folder = None if out is None else abspath(out)
    e = experiment if isinstance(experiment, Experiment) else load(experiment)
    if not code:
        _crescent.refuse_code(e._core)
    if len(np.shape(seeds)) != 1 or len(seeds) != 2:
        raise ValueError(f"seeds is {seeds!r}: expected the first and the last of the series, (1, 0) for all")
    threads = whole("threads", threads, 0, 1024, "expected a whole number, 0 for one a core")
    with_arms = e._with_arms()
    repeats = whole("repeats", repeats, 1, 1000, "expected how often each arm is run")
    kept: list[_crescent.RunResult] = []
    with bar(progress) as shown:
        try:
            core = _crescent.run(
                with_arms._core,
                seeds[0],
                seeds[1],
                threads=threads,
                isa=isa,
                studies=studies,
                progress=shown,
                callables=callable_arms(e.samplers, with_arms._tree()["arms"]),
                repeats=repeats,
                kept=kept,
            )
        except KeyboardInterrupt:
            part = Measured(kept[0]) if kept else None
            if part is not None and folder is not None:
                part.write(folder)
            raise RunInterrupted(part) from None
    measured = Measured(core)
    if folder is not None:
        measured.write(folder)
    return measured


def join(parts: Sequence[str | PathLike[str]], out: str | PathLike[str] | None = None) -> Measured:
    """Joins runs of parts of one experiment's seeds, as `crescent join` does.

    `parts`: folders of runs, or their metrics.json. `out`: a folder for the metrics. There are no films.
    """
    folder = None if out is None else abspath(out)
    core = _crescent.join([fspath(part) for part in parts])
    measured = Measured(core)
    if folder is not None:
        measured.write(folder)
    return measured
