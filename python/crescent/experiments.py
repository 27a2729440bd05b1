"""Experiments and runs in memory: :func:`load`, :func:`parse`, :func:`run`, :func:`join`.

e = crescent.load("gallery")
e["image.width"] = 320                      # checked as the file is; ValueError names what is wrong
measured = crescent.run(e)
measured.films["phong", 64].y               # [height, width], the memory of the run itself
"""

from __future__ import annotations

import csv
import hashlib
import io
import json
import re
import tomllib
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from os import PathLike, fspath
from os.path import abspath, dirname
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _crescent, _saved
from ._callable_arms import Samplers, all_counts, callable_arms, counts_of, table_of
from ._cost import Against
from ._installed import experiment_file
from ._live import live
from ._paths import found, inside, nearest_key, overrides, path_of, quoted, steps_of, toml
from ._progress import bar
from ._resize import resize_hint, resized
from ._sampler import whole
from ._source import Source, mistakes_of, taken_out
from ._summaries import Summary

Progress = Callable[[str, float, float], None]

#: What a stranger tries, and what does it.
_INSTEAD = {
    "keys": "list(e), the keys and tables of the file",
    "values": "e[path] for path in e",
    "items": "(path, e[path]) for path in e",
    "get": "e[path], and `path in e` whether there is one",
    "update": "e.with_(changes), another experiment, or e[path] = value",
    "pop": "e.remove(path)",
    "clear": "crescent.parse(text), another experiment",
    "copy": "e.with_()",
    "set": "e[path] = value",
    "save": "Path(file).write_text(e.text)",
    "write": "Path(file).write_text(e.text)",
    "run": "crescent.run(e)",
    "check": "crescent.check(e, sampler=NAME)",
    "sweep": "crescent.sweep(e, over={path: values})",
}


class Experiment:
    """A checked experiment: read and change it by its keys, ``e["sphere.s"] = 8``. The whole is checked after a change.

    Keys are those of ``crescent run --set``: a whole path, ``shapes.sphere.s``, or one that begins at a name,
    ``sphere.s``; an item of a list is ``camera.eye[1]``. Tables and lists that are read are those of the experiment:
    ``e["image"]["width"] = 320`` and ``e["arms"].pop("phong")`` change it. A table is replaced by a dictionary,
    ``e["arms.phong"] = {"n": [4]}``. ``del e["arms.phong"]`` removes it together with the plates, assertions and other
    tables that name it, which a warning lists; :meth:`remove` returns them.
    """

    def __init__(
        self, core: _crescent.Experiment, samplers: Mapping[str, Any] | None = None, source: Source | None = None
    ) -> None:
        self._core = core
        self._source = source or Source(core.text, core.file, dirname(abspath(core.file)))
        self.samplers = Samplers()
        self.samplers.update(samplers or {})

    def __setattr__(self, name: str, value: Any) -> None:
        if name == "samplers":
            samplers = Samplers()  #: samplers in Python by the name of their arm, which :func:`run` adds
            samplers.update(value)
            object.__setattr__(self, name, samplers)
        elif name in ("_core", "_source"):
            object.__setattr__(self, name, value)
        else:
            raise AttributeError(self._without_attribute(name, f" = {value!r}"))

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        raise AttributeError(self._without_attribute(name, ""))

    def __delattr__(self, name: str) -> None:
        raise AttributeError(f"'{name}' cannot be deleted: expected del e[path], or e.samplers.pop(name)")

    def _without_attribute(self, name: str, rest: str) -> str:
        if name in _INSTEAD:
            return f"an experiment has no attribute '{name}': expected {_INSTEAD[name]}"
        if name in dir(type(self)):
            return f"'{name}' cannot be set: a change of a key changes it, such as e['seed'] = 7"
        return f"an experiment has no attribute '{name}': expected e[{name!r}]{rest}"

    def _tree(self) -> dict[str, Any]:
        """Returns every value, including those that a shape inherits."""
        return tomllib.loads(re.sub(r"(?m)^# inherited: ", "", self._core.text))

    def _at(self, steps: Sequence[str]) -> Any:
        """The value at these steps."""
        at: Any = self._tree()
        for step in steps:
            at = inside(at, step)
        return at

    def __getitem__(self, path: str) -> Any:
        return live(self, *found(self._tree(), path))

    def __setitem__(self, path: str, value: Any) -> None:
        self._change({path: value}, stacklevel=4)

    def _change(self, changes: Mapping[str, Any], stacklevel: int) -> None:
        changed, removed = self._changed(changes)
        self._core, self._source = changed._core, changed._source
        _warn_of(removed, stacklevel)
        if "n" in changes:
            changed._warn_of_unused_n(stacklevel)

    def _warn_of_unused_n(self, stacklevel: int) -> None:
        """Says that the experiment's n is of no arm, if each has its own."""
        arms = self._source.tree().get("arms", {})
        if all("n" in arm for arm in arms.values()):
            paths = ", ".join(f"e[{path_of(['arms', name, 'n'])!r}]" for name in arms)
            warnings.warn(f"no arm takes n = {self['n']}, each has its own: {paths}", stacklevel=stacklevel)

    def _set(self, changes: Mapping[tuple[str, ...], Any]) -> None:
        """Sets values at steps; inside a list, the list is set as a whole."""
        tree, out = self._tree(), {}
        for steps, value in changes.items():
            at: Any = tree
            for k, step in enumerate(steps):
                if isinstance(at, list):
                    _put(at, steps[k:], value)
                    steps, value = steps[:k], at
                    break
                at = at.get(step, {}) if isinstance(at, Mapping) else {}
            out[path_of(steps)] = value
        self._change(out, stacklevel=5)

    def __delitem__(self, path: str) -> None:
        self._take_out(self._steps_to_remove(path), stacklevel=3)

    def remove(self, path: str) -> list[str]:
        """Removes a key or a table, and the tables that name it: plates, assertions, regions, arms and others without
        which the experiment would be wrong. Returns the paths of these."""
        return self._take_out(self._steps_to_remove(path), stacklevel=0)

    def _steps_to_remove(self, path: str) -> tuple[str, ...]:
        try:
            return tuple(found(self._source.tree(), path)[0])
        except KeyError:
            if path in self:
                raise KeyError(f"{path}: has its default value; expected a key that the file, or a change, gives") from None
            raise

    def _take_out(self, steps: tuple[str, ...], stacklevel: int) -> list[str]:
        """Removes what is at these steps; `stacklevel` 0: without a warning of what is removed with it."""
        before: Any = self._source.tree()
        at, in_list = before, 0
        for k, step in enumerate(steps):
            if isinstance(at, list):
                in_list = in_list or k
            try:
                at = inside(at, step)
            except KeyError:
                raise KeyError(
                    f"{path_of(steps)}: has its default value; expected a key that the file, or a change, gives"
                ) from None
        if in_list:
            items = self._at(steps[:in_list])
            _put(items, steps[in_list:], None, remove=True)
            source, core, removed = taken_out(
                self._source.changed(overrides({path_of(steps[:in_list]): items})), [], self._source
            )
        else:
            source, core, removed = taken_out(self._source.without([steps]), [steps] if isinstance(at, Mapping) else [], self._source)
        self._core, self._source = core, source
        paths = [path_of(steps) for steps in removed]
        if stacklevel:
            _warn_of(paths, stacklevel + 1)
        return paths

    def __contains__(self, path: object) -> bool:
        try:
            self[str(path)]
        except KeyError:
            return False
        return True

    def __iter__(self) -> Iterator[str]:
        """The keys and tables of the file."""
        return iter(self._tree())

    def with_(self, changes: Mapping[str, Any] | None = None, /, **more: Any) -> Experiment:
        """Another experiment, with these keys changed all at once: ``e.with_({"sphere.s": 8}, n=16)``."""
        changed, removed = self._changed({**_table_of(changes), **more})
        _warn_of(removed, 3)
        if "n" in more or "n" in (changes or {}):
            changed._warn_of_unused_n(3)
        return changed

    def _changed(self, changes: Mapping[str, Any]) -> tuple[Experiment, list[str]]:
        """With these changes, and what was removed because it named what is no longer there."""
        source, lost = self._source, []
        for path, value in changes.items():
            self._refuse_in_place_of_a_table(path, value)
            source, names = source.with_value(*self._whole_list(source, path, value))
            lost += names
        try:
            source, core, removed = taken_out(source, lost, self._source)
        except ValueError as error:
            kinds = [kind for kind, _ in mistakes_of(error)]
            if "unknown name" in kinds or "misspelt name" in kinds:
                near = [nearest_key(self._tree(), steps_of(path)[-1]) for path in changes]
                hint = f"did you mean {' or '.join(map(repr, filter(None, near)))}?" if any(near) else ""
                hint = "" if "misspelt name" in kinds else hint
            else:
                hint = resize_hint(self._tree(), source, kinds)
            raise (ValueError(f"{error}\n{hint}") if hint else error) from None
        return Experiment(core, self.samplers, source), [path_of(steps) for steps in removed]

    def _refuse_in_place_of_a_table(self, path: str, value: Any) -> None:
        """ValueError for a number, a text or a list where there is a table, and for a sampler in Python."""
        if isinstance(path, str) and path.partition(".")[0] == "samplers":
            raise ValueError(f"{path}: samplers in Python are no keys: expected e.samplers[NAME] = sampler")
        try:
            there = found(self._tree(), path)[1]
        except KeyError:
            return
        if isinstance(there, Mapping) and not isinstance(value, Mapping):
            if value is not None:
                toml(value)  # which says what is no value at all
            keys = ", ".join(f"{key!r}: ..." for key in list(there)[:2])
            more = "; e.remove(path) takes it out" if value is None else ""
            raise ValueError(f"{path} is {value!r}: expected a table, such as {{{keys}}}{more}")

    def _whole_list(self, source: Source, path: str, value: Any) -> tuple[str, Any]:
        """The change of an item of a list that the file does not give, as the change of the list."""
        try:
            found(source.tree(), path)
        except KeyError:
            try:
                steps = found(self._tree(), path)[0]
            except KeyError:
                return path, value
            for k in range(1, len(steps)):
                if isinstance(items := self._at(steps[:k]), list):
                    _put(items, steps[k:], value)
                    return path_of(steps[:k]), items
        return path, value

    def _with_overrides(self, changes: Sequence[str]) -> Experiment:
        """The same with PATH=VALUE each, as --set takes it."""
        source = self._source.changed(changes)
        return Experiment(source.core(), self.samplers, source)

    def resize(self, width: int, height: int) -> Experiment:
        """Changes the size of the picture, and with it the boxes of regions and the crops of plates, which show what
        they showed. Returns the experiment."""
        changes = resized(self._tree(), width, height)
        self._change(changes, stacklevel=4)
        return self

    def diff(self, other: Experiment) -> dict[str, tuple[Any, Any]]:
        """The keys whose values differ, by their paths: the value here and the value there, None where it has none."""
        if not isinstance(other, Experiment):
            raise TypeError(f"other is {other!r}: expected an experiment, such as crescent.load({str(other)!r})")
        here, there = (dict(_leaves({**e._tree(), "samplers": dict(e.samplers)})) for e in (self, other))
        paths = [*here, *(path for path in there if path not in here)]
        return {path: (here.get(path), there.get(path)) for path in paths if here.get(path) != there.get(path)}

    def _with_arms(self) -> Experiment:
        """With an arm for each of `samplers`, at its own sample counts or those of the other arms."""
        arms = self._tree()["arms"]
        for name in self.samplers:
            if name in arms:
                raise ValueError(f"samplers: the experiment has an arm '{name}': expected another name")
        if not self.samplers:
            return self
        counts = all_counts(arms.values())
        tables = {f"arms.{quoted(n)}": {**table_of(s), "n": counts_of(s, counts)} for n, s in self.samplers.items()}
        return Experiment(_crescent.with_arms(self._core, overrides(tables)))

    @property
    def text(self) -> str:
        """The experiment as a file: every key with its effective value."""
        return self._core.text

    @property
    def hash(self) -> str:
        """What identifies an experiment: every value but the number of seeds, and its samplers: their files, code,
        attributes, closures and the globals that they name."""
        core = str(self._with_arms()._core.hash)
        ids = _sampler_ids(self)
        return hashlib.sha256(repr([core, sorted(ids.items())]).encode()).hexdigest()[:16] if ids else core

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (self._source, dict(self.samplers))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Experiment) or self.samplers != other.samplers:
            return False
        return self.hash == other.hash and self["seeds"] == other["seeds"]

    def __repr__(self) -> str:
        return f"<Experiment {self._core.file} {self.hash}>"

    def _repr_html_(self) -> str:
        """The arms, lights, shapes and regions as a table."""
        from ._html import of_experiment

        return of_experiment(self)


def _sampler_ids(e: Experiment) -> dict[str, str]:
    """The identities of the samplers in Python and of the files that arms name, and what of them cannot be hashed."""
    from ._sweep.identity import file_ids, sampler_id, unhashable_of

    out = file_ids(e._tree()["arms"])
    for name, sampler in e.samplers.items():
        kinds = unhashable_of(sampler)
        out[name] = sampler_id(sampler) + (f" with {', '.join(kinds)}, {_saved.UNHASHABLE}" if kinds else "")
    return out


def _table_of(changes: Any) -> Mapping[str, Any]:
    if changes is not None and not isinstance(changes, Mapping):
        raise TypeError(f"changes is {changes!r}: expected paths with their values, such as {{'sphere.s': 8}}")
    return changes or {}


def _warn_of(removed: Sequence[str], stacklevel: int) -> None:
    """Lists what was removed with a name."""
    if removed:
        warnings.warn(f"also removed, because it names what was removed: {', '.join(removed)}", stacklevel=stacklevel)


def _put(at: Any, steps: Sequence[str], value: Any, remove: bool = False) -> None:
    """Sets or removes a value inside a list."""
    for step in steps[:-1]:
        at = inside(at, step)
    key: Any = int(steps[-1]) if isinstance(at, list) else steps[-1]
    if remove:
        del at[key]
    else:
        at[key] = value


def _leaves(tree: Mapping[str, Any], path: tuple[str, ...] = ()) -> Iterator[tuple[str, Any]]:
    """Every value that is not a table, with its path."""
    for key, value in tree.items():
        if isinstance(value, Mapping):
            yield from _leaves(value, (*path, key))
        else:
            yield path_of((*path, key)), value


def _restored(source: Source, samplers: Mapping[str, Any]) -> Experiment:
    """An experiment that was pickled or copied."""
    return Experiment(source.core(), samplers, source)


def load(path: str | PathLike[str], changes: Mapping[str, Any] | None = None) -> Experiment:
    """An experiment file, or an installed experiment by its name, such as "gallery"; ValueError names every mistake with
    line and column."""
    changes = _table_of(changes)
    if not isinstance(path, (str, PathLike)):
        raise TypeError(f"path is {path!r}: expected a file, or the name of an installed experiment, such as 'gallery'")
    name = experiment_file(path)
    if name != fspath(path):  # an installed one: messages and provenance have its name, not where it is
        source = Source(Path(name).read_text("utf-8"), f"{path}.toml", dirname(abspath(name)))
        installed = Experiment(source.core(), None, source)
        return installed.with_(changes) if changes else installed
    text = Path(name).read_bytes().decode("utf-8-sig") if Path(name).is_file() else ""
    if not changes:
        return Experiment(_crescent.load(name, []), None, Source(text, name, dirname(abspath(name))))
    if not any(isinstance(value, Mapping) for value in changes.values()):
        core = _crescent.load(name, overrides(changes))
        return Experiment(core, None, Source(text, name, dirname(abspath(name)), tuple(overrides(changes))))
    return load(path).with_(changes)


def parse(text: str, name: str = "text.toml") -> Experiment:
    """The same from text; `name` is the file's name in messages."""
    if not isinstance(text, str):
        kind = type(text).__name__
        raise TypeError(f"text is {kind}: expected the text of an experiment; crescent.load reads a file")
    return Experiment(_crescent.parse(text, name, []), None, Source(text, name, dirname(abspath(name))))


@dataclass(frozen=True, repr=False)
class Film:
    """Per-pixel statistics of n samples of one arm. Rows run bottom-up; radiance in W/(sr m^2), linear Rec. 709."""

    arm: str
    n: int
    s: float
    seed: int
    planes: Mapping[str, NDArray[Any]]  #: r, g, b, y, y2, var, largest, horizon, hits

    def __getattr__(self, name: str) -> NDArray[Any]:
        if name.startswith("_") or name == "planes":
            raise AttributeError(name)
        if name in self.planes:
            return self.planes[name]
        raise AttributeError(f"a film has no plane '{name}': expected one of {', '.join(self.planes)}, or rgb")

    def __repr__(self) -> str:
        height, width = self.planes["y"].shape
        return f"<Film {self.arm} n={self.n} s={self.s:g} seed={self.seed}: {width} x {height}>"

    def _repr_html_(self) -> str:
        """The picture, with its size."""
        from ._html import of_film

        return of_film(self)

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
            arms = list(dict.fromkeys(arm for arm, _, _ in self._films))
            arm = str(key[0] if isinstance(key, tuple) and key else key)
            near = "" if arm in arms else _crescent.nearest(arm, arms)
            hint = f"; did you mean '{near}'?" if near else ""
            raise KeyError(f"no film {key!r}, expected (arm, n) or (arm, n, s): there are {told or 'none'}{hint}")
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

    def __init__(self, core: _crescent.RunResult, samplers: Mapping[str, str] | None = None) -> None:
        self._core = core
        self.samplers: dict[str, str] = dict(samplers or {})  #: the identities of the samplers in Python and in files, by arm
        self._rows: list[dict[str, Any]] | None = None
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
        return Measured, (self._core, self.samplers)

    def records(self) -> list[dict[str, Any]]:
        """One row per number: arm, n, s, seed, `metric`, region, value; suitable for a data frame.

        Counts are int, other numbers float, None if there is none; region is "" for the whole frame. Each changed key
        has a column, whose values are those of the file.
        """
        if self._rows is None:
            rows = csv.DictReader(io.StringIO(self._core.csv, newline=""))
            self._rows = [{key: _field(key, text, row["metric"]) for key, text in row.items()} for row in rows]
        return [dict(row) for row in self._rows]

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

    @property
    def stages(self) -> dict[str, float]:
        """Seconds of wall-clock time of each stage: references, films, tails with furnaces and article checks, metrics.
        They vary between equal runs."""
        return dict(self._core.stages)

    @property
    def threads(self) -> int:
        """The number of threads with which :attr:`times` were measured; 0: unknown."""
        return int(self._core.threads)

    def metric(self, name: str, arm: str, n: int, region: str = "", s: float | None = None) -> Summary:
        """A metric of :meth:`records`, "tail_k", "bias2", "flip" (of the first `flip_seeds` seeds; of the frame of the
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
        against: Against = "n",
        budgets: Sequence[float] | None = None,
        arms: Sequence[str] | None = None,
        labels: Mapping[str, str] | None = None,
    ) -> str:
        """A metric as a LaTeX table (booktabs): a row an arm, in the order of `arms` and with the names of `labels`; a
        column a sample count, or with `against="time"` or "rays" a budget of `budgets`, in s or rays a pixel. Means over
        seeds with the half width of their 95 % intervals, rounded by these; `digits` of a mean with one seed.

        `bold="best"`: what is not significantly worse than the best is bold (paired t over seeds at 5 %, shared by the
        arms); with one seed, or a metric that has no order, nothing is ranked. None: nothing is bold. A dagger marks heavy
        tails. At equal time an arm is interpolated between sample counts, as in :func:`crescent.plot.bars`.
        """
        from ._tables import latex

        if bold not in ("best", None):
            raise ValueError(f"bold is {bold!r}: expected 'best' or None")
        at = self.s if s is None else s
        return latex(self, table, region, at, bold == "best", digits, against, budgets, arms, labels)

    @property
    def s(self) -> float:
        """The experiment's own Phong exponent."""
        return float(self._core.s)

    @property
    def provenance(self) -> str:
        """One line for an appendix: program, experiment, hash, seeds, compiler, samplers in Python."""
        p = self.metrics["provenance"]
        seeds = sorted({row["seed"] for row in self.records()} or {film.seed for film in self.films.values()})
        return (
            f"crescent {p['version']} ({p['commit']}, {p['compiler']}), experiment {p['experiment']['file']} "
            f"{p['experiment']['hash']}, {len(seeds)} seed{'s' * (len(seeds) != 1)} from {seeds[0]}"
            + "".join(f", sampler {name} {identity}" for name, identity in self.samplers.items())
        )

    def to_xarray(self) -> Any:
        """An xarray.Dataset: one variable per metric over (arm, n, s, seed), and region if it has one; NaN: not run."""
        import xarray

        rows = self.records()
        axes = {axis: sorted({r[axis] for r in rows}) for axis in ("n", "s", "seed")}
        axes = {"arm": list(dict.fromkeys(r["arm"] for r in rows)), **axes}
        regions = [r for r in dict.fromkeys(r["region"] for r in rows) if r]
        out: dict[str, Any] = {}
        for metric in dict.fromkeys(r["metric"] for r in rows):
            mine = [r for r in rows if r["metric"] == metric]
            coords = {**axes, "region": regions} if any(r["region"] for r in mine) else axes
            values = xarray.DataArray(np.full([len(c) for c in coords.values()], np.nan), coords, list(coords))
            for r in mine:
                values.loc[{axis: r[axis] for axis in coords}] = np.nan if r["value"] is None else r["value"]
            out[metric] = values
        return xarray.Dataset(out)

    def write(self, folder: str | PathLike[str]) -> None:
        """Writes metrics.json, metrics.csv, junit.xml, films/*.exr and arrays.npz, all at once, for :func:`open`; only the
        program draws plates."""
        self._core.write(fspath(folder), [(_saved.ARRAYS, _saved.arrays_of(self._core, self.samplers))])

    save = write

    def _repr_html_(self) -> str:
        """The films of every arm at its largest N, a table with intervals, and the assertions."""
        from ._html import of_measured

        return of_measured(self)

    def __repr__(self) -> str:
        return f"<Measured: {len(self.films)} films; assertions {'hold' if self.holds else 'fail'}>"


_COUNTS = frozenset(_crescent.counting_metrics())


def _field(column: str, text: str, metric: str) -> Any:
    """Reads a field of metrics.csv: a number by its column, None if there is none; a key's value as in the file."""
    if column in ("arm", "metric", "region"):
        return text
    if column in ("n", "seed") or (column == "value" and metric in _COUNTS):
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
    seeds: int | tuple[int, int] = (1, 0),
    threads: int = 0,
    isa: str = "",
    studies: bool = False,
    references: bool = True,
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

    `seeds`: the number of seeds, in place of the experiment's, as in :func:`sweep` and ``--seeds``; or the first and last
    of its series, from 1, as in ``--seed-range``; 0: to the end. `out`: a folder for metrics and films. Films have the
    same bits for any `threads` and `isa`.

    `studies`: beside the films and their metrics also tails, furnaces and article checks. The progress says their share
    of the samples. ``references=False``: the films of the first seed alone, without a reference and so without metrics;
    assertions are skipped. :attr:`Measured.stages` has the seconds of each.

    Each sampler of ``e.samplers`` is an arm of its name, at the sample counts of the other arms. What it raises is
    raised here. `code`: False refuses an experiment whose file names a plugin, a program or a Python file.
    """
    folder = None if out is None else abspath(_folder("out", out))
    if studies and not references:
        raise ValueError("studies=True, references=False: without references there are no metrics to study")
    e = experiment if isinstance(experiment, Experiment) else load(experiment)
    if not code:
        _crescent.refuse_code(e._core)
    if isinstance(seeds, (int, np.integer)):
        e = e.with_(seeds=whole("seeds", seeds, 1, 4096, "expected a number of seeds, 1 to 4096"))
        seeds = (1, 0)
    if len(np.shape(seeds)) != 1 or len(seeds) != 2:
        raise ValueError(
            f"seeds is {seeds!r}: expected a number of seeds, or the first and the last of the series, (1, 0) for all"
        )
    first, last = (whole("seeds", seed, 0, 4096, "expected whole numbers, 0 to 4096") for seed in seeds)
    threads = whole("threads", threads, 0, 1024, "expected a whole number, 0 for one a core")
    with_arms = e._with_arms()
    repeats = whole("repeats", repeats, 1, 1000, "expected how often each arm is run")
    kept: list[_crescent.RunResult] = []
    with bar(progress) as shown:
        try:
            core = _crescent.run(
                with_arms._core,
                first,
                last,
                threads=threads,
                isa=isa,
                studies=studies,
                references=references,
                progress=shown,
                callables=callable_arms(e.samplers, with_arms._tree()["arms"]),
                repeats=repeats,
                kept=kept,
            )
        except KeyboardInterrupt:
            part = Measured(kept[0], _sampler_ids(e)) if kept else None
            if part is not None and folder is not None:
                part.write(folder)
            raise RunInterrupted(part) from None
    measured = Measured(core, _sampler_ids(e))
    if folder is not None:
        measured.write(folder)
    return measured


def join(parts: Sequence[str | PathLike[str]], out: str | PathLike[str] | None = None) -> Measured:
    """Joins runs of parts of one experiment's seeds, as `crescent join` does.

    `parts`: folders of runs, or their metrics.json. `out`: a folder for the result. It has the times of all parts, and the
    films and references of those that :meth:`Measured.write` wrote.
    """
    folder = None if out is None else abspath(_folder("out", out))
    if isinstance(parts, (str, PathLike)) or not parts:
        raise ValueError(f"parts is {parts!r}: expected one or more folders of runs, such as ['part-1', 'part-2']")
    measured = Measured(*_saved.joined([fspath(part) for part in parts]))
    if folder is not None:
        measured.write(folder)
    return measured


def open(folder: str | PathLike[str]) -> Measured:
    """The result in a folder that :meth:`Measured.write`, ``run(out=...)`` or the program wrote: metrics, provenance and
    times, and films and references, which the program does not write for this."""
    return Measured(*_saved.opened(Path(_folder("folder", folder))))


def _folder(what: str, given: Any) -> str | PathLike[str]:
    """A folder, or a TypeError that names the argument."""
    if not isinstance(given, (str, PathLike)):
        raise TypeError(f"{what} is {given!r}: expected the path of a folder")
    return given
