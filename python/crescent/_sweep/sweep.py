"""Runs an experiment over a grid: plans the missing tasks, computes them on an engine, writes the outputs."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import shlex
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import Any

from .. import _crescent
from .._sampler import whole
from .._paths import steps_of
from ..experiments import Experiment, Measured, load
from .dataset import COLUMNS, Results, read, rows_of_part
from .engines import DaskEngine, EngineError, engine_of, execute, profile_of
from .grid import Axis, UsageError, axes_of, grid
from .identity import NUMERICS, digest
from .plan import Plan, Point, kept_points, points_of, studies_id
from .progress import Progress, quantity
from .runner import Runner
from .store import Store, locked, read_json, write_whole
from .tasks import Job, Result, host

Over = Mapping[str, Any] | Sequence[str] | str


@dataclass
class Sweep:
    """The result of :func:`crescent.sweep`: the computed tasks, the errors, and the dataset."""

    out: Path
    points: list[dict[str, Any]]
    computed: int  #: tasks computed by this call
    failed: dict[str, str]  #: by task or point, the error
    cost: dict[str, float] = field(default_factory=dict)  #: of the missing results: tasks, references, samples, bytes

    def to_arrow(self) -> Any:
        """The dataset as a pyarrow.Table."""
        return read(self.out)

    def to_pandas(self) -> Any:
        """The dataset as a pandas.DataFrame."""
        return self.to_arrow().to_pandas()

    def measured(self, **values: Any) -> Measured:
        """The run of all seeds at one finished point."""
        for point in self.points:
            if all(point["values"].get(path) == value for path, value in values.items()):
                return Measured(_crescent.join([str(self.out / "points" / point["folder"])]))
        raise KeyError(f"no point {values}")

    def summary(self, metric: str = "") -> str:
        """The table of a metric, with its intervals over seeds."""
        from .summary import summary

        return summary(self.out, metric)

    def __repr__(self) -> str:
        failed = f", {len(self.failed)} failed" if self.failed else ""
        return f"<Sweep {self.out}: {len(self.points)} points, {self.computed} tasks computed{failed}>"


def share_of(given: float | str) -> float:
    """A share of tasks: "1%", "0.01" or 0.01."""
    text = str(given).strip()
    try:
        value = float(text[:-1]) / 100 if text.endswith("%") else float(text)
    except ValueError:
        value = -1.0
    if not 0 <= value <= 1:
        raise UsageError(f"--verify {text}: expected a share of the tasks from 0 to 100%, as in 1%")
    return value


def folder_of(out: str | PathLike[str]) -> Path:
    """The folder of a sweep: a new or empty one, or one with a sweep."""
    path = Path(os.path.abspath(out))
    if path.is_file():
        raise UsageError(f"--out {out}: is a file; expected a folder")
    if path.is_dir() and any(path.iterdir()) and not (path / "store").is_dir():
        raise UsageError(f"--out {out}: has other files; expected a new folder, or one of an earlier sweep")
    return path


@dataclass(kw_only=True)
class Call:
    """The arguments of a call that runs or checks, which are checked here."""

    over: Any
    zip: bool
    engine: str
    out: str | PathLike[str]
    workers: int | None
    resume: bool
    dry_run: bool
    progress: bool
    say: Callable[[str], None] = lambda text: None

    def __post_init__(self) -> None:
        if self.workers is not None:
            self.workers = whole("workers", self.workers, 1, 4096, "expected a whole number, 1 to 4096")
            if engine_of(self.engine) != "local":
                raise UsageError(f"workers is {self.workers}: is of the engine 'local', and the engine is {self.engine!r}")
        if engine_of(self.engine).startswith("slurm:"):
            profile_of(self.engine.partition(":")[2])
        self.folder = folder_of(self.out)


@dataclass(kw_only=True)
class Options(Call):
    """The arguments of a call that runs."""

    seeds: int | None
    films: bool
    verify: float | str | None
    versions: Mapping[str, str]

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.seeds is not None:
            self.seeds = whole("seeds", self.seeds, 1, 4096, "expected a whole number, 1 to 4096")
        self.share = share_of("1%" if self.verify is None else self.verify)


_NO_AXES = {
    "n": "every result has the sample counts of its arms: expected a list of counts, --set arms.NAME.n=[4,16,64]",
    "seed": "every result has its seeds: expected --seeds K",
    "seeds": "every point has the same number of seeds: expected --seeds K",
}


def _check_axes(axes: Sequence[Axis]) -> None:
    """Refuses keys that a sweep gives its points itself."""
    for axis in axes:
        steps = steps_of(axis.path)
        if len(steps) == 1 and steps[0] in _NO_AXES:
            raise UsageError(f"--over {axis.path}: {_NO_AXES[steps[0]]}")
        if axis.path in COLUMNS:
            raise UsageError(f"--over {axis.path}: the dataset has a column of this name: expected a whole path")


def usable_points(points: list[Point], failed: dict[str, str]) -> tuple[list[Point], dict[str, str]]:
    """What points_of() returned; UsageError if no point is valid."""
    if not points:
        errors = list(dict.fromkeys(failed.values()))
        more = f" (and {len(errors) - 1} more)" if len(errors) > 1 else ""
        raise UsageError(f"--over: no point is valid: {errors[0]}{more}")
    return points, failed


def say_unhashable(points: Sequence[Point], say: Callable[[str], None]) -> None:
    """Says which samplers cannot be hashed."""
    for name, kinds in {n: arm.unhashable for p in points for n, arm in p.arms.items() if arm.unhashable}.items():
        say(f"{name}: {', '.join(kinds)} cannot be hashed: its results are never reused (--sampler-version {name}=V)")


class Run:
    """One call."""

    def __init__(self, base: Experiment, options: Options) -> None:
        self.options, self.base = options, base
        self.store = Store(options.folder)
        axes = axes_of(options.over)
        _check_axes(axes)
        self.seeds = base["seeds"] if options.seeds is None else options.seeds
        values = grid(axes, options.zip)
        self.points, self.failed = usable_points(*points_of(base, values, self.seeds, options.versions))
        older = kept_points(base, options.folder, self.seeds, options.versions, self.points)
        self.all_points = [*older, *self.points]
        self.axes: dict[str, list[Any]] = {axis.path: [] for axis in axes}
        for path in (read_json(options.folder / "sweep.json") or {}).get("axes", {}) if older else ():
            self.axes.setdefault(path, [])
        for point in (*self.points, *older):
            for path in self.axes:
                if path not in point.values:
                    point.values[path] = point.experiment[path]
                if point.values[path] not in self.axes[path]:
                    self.axes[path].append(point.values[path])
        self.results = Results(options.folder, self.axes)
        for point in self.points if not options.resume else ():
            for arm in point.arms.values():
                self.results.forget(point.scene, arm.id)
        self.computed = 0

    # ---- files

    def write_state(self) -> None:
        """sweep.json: the points and axes, for later calls and for the summary."""
        points = [
            {
                "values": p.values, "scene": p.key, "folder": p.folder, "experiment": p.hash,
                "arms": {name: arm.id for name, arm in p.arms.items()},
            }
            for p in self.all_points
        ]  # fmt: skip
        state = {
            "format": "crescent sweep 2", "file": self.base._core.file, "title": self.base["title"],
            "seeds": self.seeds,
            "axes": self.axes, "points": points, "numerics": NUMERICS, "failed": self.failed,
        }  # fmt: skip
        write_whole(self.options.folder / "sweep.json", json.dumps(state, indent=1))

    def sync(self) -> None:
        """Gives every point the rows of its results, also of those that it shares with other points."""
        wanted = {}
        for point in self.all_points:
            for name, arm in point.arms.items():
                for first, last in self.results.blocks(point.scene, arm.id, suspect=True):
                    wanted[f"{point.scene}-{arm.id}-{first}-{last}-{point.key}"] = point.row(name)
        self.results.sync(wanted)

    # ---- the bits

    def verify_job(self, job: Job, result: Result) -> Job | None:
        """The same task for another worker and instruction set, for a share of the tasks."""
        chance = int(hashlib.sha256(b"verify" + job.id.encode()).hexdigest()[:8], 16) / 2**32
        if not job.repeatable or chance >= self.options.share:
            return None
        task = {**job.task, "isa": f"not {result['isa']}", "films": False}
        label = f"{job.label}: bits"
        return Job(f"verify-{job.id}", task, label, {"first": result}, avoid=result["worker"])

    def compare(self, job: Job, second: Result) -> None:
        """Compares two computations of one task; if their bits differ, marks all results of both workers."""
        first = job.row["first"]
        texts = [result["json"].partition('"provenance"')[0] for result in (first, second)]
        if texts[0] != texts[1]:
            who = [f"{r['host']} ({r['worker']}, {r['isa']})" for r in (first, second)]
            self.failed[job.label] = (
                f"the films of {who[0]} and {who[1]} differ; rows of both workers are marked as suspect"
            )
            self.results.mark({first["worker"], second["worker"]})

    # ---- the call

    def execute(self, plan: Plan, cost: Mapping[str, float], engine: DaskEngine) -> None:
        """Computes the missing results."""
        bar = Progress(int(cost["tasks"]), cost["samples"], self.options.progress)
        plan.threads = max(1, engine.threads // max(1, int(cost["references"])))
        planned = plan.jobs()
        repetitions: list[Job] = []

        def next_job() -> Job | None:
            return repetitions.pop() if repetitions else next(planned, None)

        def take(job: Job, result: Result) -> None:
            if "first" in job.row:
                self.compare(job, result)
                return
            keep(self.store, self.results, job, result)
            self.computed += 1
            if (again := self.verify_job(job, result)) is not None:
                repetitions.append(again)
                bar.tasks += 1

        execute(engine, next_job, take, self.failed, bar, lambda name: self.store.read("references", name))

    def join(self) -> int:
        """Writes the run of all seeds of each finished point. Returns how many points have failing assertions."""
        joined = read_json(self.store.root / "joined.json") or {}
        failing = 0
        for point in self.points:
            blocks = [
                (arm.id, *block) for arm in point.arms.values()
                for block in self.results.blocks(point.scene, arm.id) if block[0] <= self.seeds
            ]  # fmt: skip
            seeds = [(arm, seed) for arm, first, last in blocks for seed in range(first, last + 1)]
            studies = self.store.read("studies", studies_id(point))
            if studies is None or seeds != [(a.id, k) for a in point.arms.values() for k in range(1, self.seeds + 1)]:
                continue
            folder = self.options.folder / "points" / point.folder
            identity = digest(point.hash, self.seeds, blocks)
            if joined.get(point.folder, [""])[0] == identity and joined[point.folder][2:] == [_digest_of_run(folder)]:
                failing += joined[point.folder][1]
                continue
            parts = [self.results.text(point.scene, *block) for block in blocks]
            core = _crescent.parse(point.experiment.text, point.experiment._core.file, point.changes)
            run = _crescent.assemble(core, 1, self.seeds, parts, studies.decode())
            for name, text in zip(RUN_FILES, (run.json, run.csv, run.junit), strict=True):
                write_whole(folder / name, text)
            joined[point.folder] = [identity, int(not run.holds), _digest_of_run(folder)]
            failing += not run.holds
        write_whole(self.store.root / "joined.json", json.dumps(joined))
        return failing


RUN_FILES = ("metrics.json", "metrics.csv", "junit.xml")


def _digest_of_run(folder: Path) -> str:
    """Of the files of a finished point; "" if one is missing."""
    try:
        return digest(*((folder / name).read_bytes().hex() for name in RUN_FILES))
    except OSError:
        return ""


def keep(store: Store, results: Results, job: Job, result: Result) -> None:
    """Stores the result of a task."""
    kind = job.task["kind"]
    if kind == "reference":
        store.add("references", job.id, result["reference"])
    elif kind == "studies":
        store.add("studies", job.id, result["json"].encode())
    else:
        provenance = {"version": NUMERICS, **{key: result[key] for key in ("worker", "host", "isa")}}
        rows = rows_of_part(result["csv"], result["times"])
        name = f"{job.id}-{job.row['point']}"
        results.add(name, rows, {**job.row, **provenance}, {"json": result["json"], **provenance})
        for name, data in result["films"].items():
            write_whole(store.out / "points" / job.folder / "films" / name, data)


def _is_there(store: Store, results: Results, job: Job) -> bool:
    """Whether the result of a task is stored."""
    kind = job.task["kind"]
    if kind == "part":
        scene, arm, first, last = job.id.split("-")
        return (int(first), int(last)) in results.blocks(scene, arm)
    return store.has("references" if kind == "reference" else "studies", job.id)


def _estimate(run: Run, cost: Mapping[str, float]) -> str:
    """The missing results, in words."""
    head = f"{len(run.points)} points, {run.seeds} seeds, {len(run.points[0].arms)} samplers: {int(cost['tasks'])} tasks"
    if not cost["tasks"]:
        return f"{head}; every result is there"
    return f"{head}, {quantity(cost['samples'])}samples, {quantity(cost['bytes'])}byte on disk"


def _commands(run: Run, plan: Plan) -> Iterator[str]:
    """A shell command for each task, which does nothing if its result is there. References come first."""
    import pickle

    references = {point.reference: plan.reference(point) for point in run.points}
    for job in sorted(plan.jobs(), key=lambda job: job.task["kind"] != "reference"):
        path = run.store.root / "tasks" / f"{job.id}.task"
        write_whole(path, pickle.dumps((job, references.get(job.reference))))
        yield f"{shlex.quote(sys.executable)} -m crescent._sweep task {shlex.quote(str(path))}  # {job.label}"


def run_task(path: Path) -> int:
    """Computes the task of a file of `commands`; nothing is done if its result is there. Returns an exit code."""
    import pickle

    store = Store(path.parent.parent.parent)
    job, reference = pickle.loads(path.read_bytes())
    axes = (read_json(store.out / "sweep.json") or {}).get("axes", {})
    results = Results(store.out, axes, pattern=f"{job.id}-*")
    if _is_there(store, results, job):
        return 0
    runner = Runner()
    try:
        for part in (reference, job):
            if part is None or _is_there(store, results, part):
                continue
            data = store.read("references", part.reference) if part.reference else None
            result = runner.compute(part.task, data, lambda: False)
            if "error" in result:
                raise EngineError(f"{part.label}: {result['error']}")
            keep(store, results, part, {**result, "worker": f"{host()}:{os.getpid()}", "host": host()})
    finally:
        runner.stop()
    return 0


def run_sweep(base: Experiment, options: Options) -> Sweep:
    """Runs a sweep; see :func:`crescent.sweep`."""
    with contextlib.nullcontext() if options.dry_run else locked(options.folder):
        return _run_sweep(base, options)


def _run_sweep(base: Experiment, options: Options) -> Sweep:
    say = options.say
    run = Run(base, options)
    plan = Plan(run.points, run.store, run.results, run.seeds, options.films)
    cost = plan.cost()
    if options.engine != "commands" or options.dry_run:
        say(_estimate(run, cost))
    if options.dry_run:
        for place, error in run.failed.items():
            say(f"failed: {place}: {error}")
        return Sweep(options.folder, [], 0, run.failed, cost)
    say_unhashable(run.points, say)
    run.write_state()
    run.sync()
    if options.engine == "commands":
        for line in _commands(run, plan):
            print(line)
    elif cost["tasks"]:
        with DaskEngine(options.engine, options.workers, say) as engine:
            try:
                run.execute(plan, cost, engine)
            finally:
                run.write_state()
    failing = run.join()
    run.sync()
    run.write_state()
    if failing:
        say(f"assertions of the experiment fail at {failing} of {len(run.points)} points (points/*/junit.xml)")
    state = read_json(options.folder / "sweep.json") or {}
    return Sweep(options.folder, state.get("points", []), run.computed, run.failed, cost)


def experiment_of(given: Experiment | str | PathLike[str]) -> Experiment:
    """An experiment, the file of one, or the name of an installed one."""
    if isinstance(given, Experiment):
        return given
    return load(given)


def with_settings(e: Experiment, settings: Sequence[str]) -> Experiment:
    """An experiment with keys changed as by --set of `crescent run`: PATH=VALUE each."""
    return e._with_overrides(list(settings)) if settings else e
