"""Checks a sampler over a grid of its parameters, or arms over a grid of their experiment: a map of where they are
wrong, heavy-tailed or inconclusive.

All tests of all points share one alpha. Call k of a sweep (k = 1, 2, ...) spends alpha / 2^k, in equal shares of its
new points, so that points can be added without checking the finished ones again: the sum over all calls is below alpha.
"""

from __future__ import annotations

import ast
import contextlib
import functools
import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from .. import _crescent, arms as built_in
from .._sampler import whole
from ..experiments import Experiment
from .dataset import Results
from .engines import DaskEngine, execute
from .grid import UsageError, axes_of, grid, hint, label, short
from .identity import NUMERICS, _of_python, arms_of, digest, scene_id
from .plan import points_of
from .progress import Progress
from .store import locked, read_json, write_whole
from .tasks import Job, Result
from .sweep import Call, say_unhashable, usable_points

_COLUMNS = {
    "kind": "string", "case": "string", "verdict": "string", "state": "string", "message": "string", "cause": "string",
    "alpha": "double", "sampler_id": "string", "version": "string", "worker": "string", "host": "string",
}  # fmt: skip
KINDS = ("right", "heavy-tailed", "inconclusive", "wrong", "error")


@dataclass
class CheckSweep:
    """The verdicts over a grid."""

    out: Path
    points: list[dict[str, Any]]  #: "values", "kind" of KINDS, "alpha", "verdicts"
    computed: int
    failed: dict[str, str]

    @property
    def kinds(self) -> dict[str, int]:
        """The number of points of each kind."""
        return {kind: sum(p["kind"] == kind for p in self.points) for kind in KINDS}

    def summary(self) -> str:
        """The map and the first message of each kind."""
        return summary_of_checks(self.out)


def kind_of(result: Mapping[str, Any]) -> str:
    """The kind of a point from its verdicts."""
    if result["state"] in ("wrong", "error"):
        return str(result["state"])
    if any(v["verdict"] == "tail" and v["state"] == "inconclusive" for v in result["verdicts"]):
        return "heavy-tailed"
    return "right" if result["state"] == "right" else "inconclusive"


def _parameters(node: ast.AST) -> list[str] | None:
    """The keywords of a class or function; None if it accepts any, or if they are not in this file."""
    if isinstance(node, ast.ClassDef):
        if any(isinstance(d, (ast.Name, ast.Attribute, ast.Call)) for d in node.decorator_list):  # a dataclass
            return [a.target.id for a in node.body if isinstance(a, ast.AnnAssign) and isinstance(a.target, ast.Name)]
        init = next((f for f in node.body if isinstance(f, ast.FunctionDef) and f.name == "__init__"), None)
        if init is None:
            return [] if not node.bases else None
        node = init
    if not isinstance(node, ast.FunctionDef):
        return None
    if node.args.kwarg:
        return None
    return [a.arg for a in (*node.args.args, *node.args.kwonlyargs) if a.arg != "self"]


def _identify(sampler: str, paths: Sequence[str]) -> tuple[Any, Any]:
    """Identity and code of a sampler. UsageError if there is none, or if it lacks these parameters."""
    if ":" not in sampler and not sampler.endswith(".py"):
        names = built_in.arm_names()
        if sampler not in names:
            near = _crescent.nearest(sampler, list(names))
            raise UsageError(f"--check {sampler}: expected FILE.py:NAME or one of {', '.join(names)}" + hint(near))
        return ["built in", sampler], None
    name, colon, inside = sampler.rpartition(":") if not sampler.endswith(".py") else (sampler, "", "")
    path = Path(name)
    if not path.is_file():
        near = _crescent.nearest(path.name, [file.name for file in path.parent.glob("*.py")])
        raise UsageError(
            f"--check {name}: no such file" + (f"; did you mean '{path.with_name(near)}'?" if near else "")
        )
    try:
        tree = ast.parse(path.read_text(encoding="utf-8"))
    except SyntaxError as error:
        raise UsageError(f"{name}:{error.lineno}: {error.msg}") from None
    nodes: dict[str, ast.AST] = {}
    for node in tree.body:
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
            nodes[node.name] = node
        elif isinstance(node, (ast.Assign, ast.AnnAssign)):
            for target in node.targets if isinstance(node, ast.Assign) else [node.target]:
                if isinstance(target, ast.Name):
                    nodes[target.id] = node
        elif isinstance(node, (ast.Import, ast.ImportFrom)):
            nodes |= {alias.asname or alias.name: node for alias in node.names}
    if colon and inside not in nodes:
        near = _crescent.nearest(inside, list(nodes))
        raise UsageError(f"--check {sampler}: {name} has no '{inside}'" + hint(near))
    known = _parameters(nodes[inside]) if colon else None
    for parameter in paths:
        if known is not None and parameter not in known:
            near = _crescent.nearest(parameter, known)
            choice = f"expected {', '.join(known)}" if known else "it takes none"
            raise UsageError(f"--over {parameter}: {inside} has no parameter '{parameter}': {choice}" + hint(near))
    return _of_python(str(path.resolve()) + colon + inside)


@dataclass(kw_only=True)
class CheckOptions(Call):
    """The arguments of a call that checks."""

    alpha: float = 1e-3
    full: bool = False
    seed: int = 1

    def __post_init__(self) -> None:
        super().__post_init__()
        if not 0 < self.alpha < 1:
            raise UsageError(f"--alpha {self.alpha:g}: expected a probability between 0 and 1")
        if self.engine == "commands":
            raise UsageError("--check: expected --engine local, dask://HOST:PORT or slurm:PROFILE")


Checks = tuple[list[Job], dict[str, str]]  #: and by point the errors of those that are not valid


def run_check_sweep(sampler: str, options: CheckOptions) -> CheckSweep:
    """Checks a sampler of a file, or a built-in one, at the missing points and writes the map."""
    return _run(sampler, options, functools.partial(_of_sampler, sampler, options))


def run_arm_sweep(
    base: Experiment, arms: bool | str | Sequence[str], pixels: int, versions: Mapping[str, str], options: CheckOptions
) -> CheckSweep:
    """Checks arms of an experiment at the missing points and writes the map."""
    pixels = whole("pixels", pixels, 0, 4096, "expected a number of pixels, 0 for the grid of w_o")
    names = _names_of_arms(base, arms)
    title = f"{', '.join(names)} of {base['title'] or base._core.file}"
    return _run(title, options, functools.partial(_of_arms, base, names, pixels, versions, options))


def _run(title: str, options: CheckOptions, checks_at: Callable[[list[dict[str, Any]]], Checks]) -> CheckSweep:
    axes = axes_of(options.over)
    if not axes:
        raise UsageError("--check: expected at least one --over PATH=VALUES")
    checks, failed = checks_at(grid(axes, options.zip))
    with contextlib.nullcontext() if options.dry_run else locked(options.folder):
        return _check_points(title, {check.id: check for check in checks}, failed, options)


def _of_sampler(sampler: str, options: CheckOptions, values: list[dict[str, Any]]) -> Checks:
    identity, code = _identify(sampler, list(values[0]))
    task = {
        "kind": "check", "numerics": NUMERICS, "sampler": sampler, "code": code, "seed": options.seed,
        "full": options.full, "code_id": digest(code) if code else "", "sampler_id": digest(identity),
    }  # fmt: skip
    return [
        Job(digest(NUMERICS, identity, v, options.seed, options.full), {**task, "values": v}, label(v), v) for v in values
    ], {}


def _names_of_arms(base: Experiment, given: bool | str | Sequence[str]) -> list[str]:
    """The arms to check: all, or these, which may be built-in samplers too."""
    arms = list(base._with_arms()._tree()["arms"])
    names = arms if given is True else [given] if isinstance(given, str) else list(given or ())
    choices = list(dict.fromkeys([*arms, *built_in.arm_names()]))
    for name in names:
        if name not in choices:
            near = _crescent.nearest(str(name), choices)
            expected = f"expected one of {', '.join(choices)}" + hint(near)
            raise UsageError(f"--check {name}: no arm or sampler '{name}': {expected}")
    if not names:
        raise UsageError("--check: expected at least one arm")
    return names


def _of_arms(
    base: Experiment, names: list[str], pixels: int, versions: Mapping[str, str], options: CheckOptions,
    values: list[dict[str, Any]],
) -> Checks:  # fmt: skip
    if clash := {"arm", "arms"} & set(values[0]):
        raise UsageError(f"--over {clash.pop()}: the map has an axis of this name: expected a whole path")
    if unused := {"n", "seed", "seeds"} & set(values[0]):
        raise UsageError(f"--over {unused.pop()}: a check of an arm does not depend on it")
    points, failed = usable_points(*points_of(base, values, int(base["seeds"]), versions))
    say_unhashable(points, options.say)
    scene, arms = scene_id(base._with_arms()), arms_of(base, versions)
    out = []
    for point in points:
        for name in names:
            arm = point.arms[name].id if name in point.arms else ["built in", name]
            arm_of_base = arms[name].id if name in arms else ["built in", name]
            task = point.task(
                "check", [name] if name in point.arms else [], arm=name, pixels=pixels, seed=options.seed,
                full=options.full, sampler_id=digest(scene, arm_of_base, pixels),
            )  # fmt: skip
            row = {"arm": name, **point.values}
            out.append(Job(digest(NUMERICS, point.key, arm, pixels, options.seed, options.full), task, label(row), row))
    return out, failed


def _check_points(title: str, checks: dict[str, Job], failed: dict[str, str], options: CheckOptions) -> CheckSweep:
    folder, alpha = options.folder, options.alpha
    state = read_json(folder / "sweep.json") or {"kind": "check", "calls": 0, "points": [], "alpha": alpha}
    if state.get("kind") != "check":
        raise UsageError(f"--out {options.out}: has a sweep of runs; expected another folder for checks")
    if state["alpha"] != alpha:
        raise UsageError(f"--alpha {alpha:g}: the sweep in {folder} has alpha {state['alpha']:g}; expected the same")
    samplers = {check.task["sampler_id"] for check in checks.values()}
    paths = set(next(iter(checks.values())).row)
    points = [
        point for point in state["points"]
        if point["id"] not in checks and point["sampler"] in samplers and set(point["values"]) == paths
    ]  # fmt: skip
    points += [{"id": c.id, "values": c.row, "sampler": c.task["sampler_id"]} for c in checks.values()]
    axes: dict[str, list[Any]] = {}
    for point in points:
        for path, value in point["values"].items():
            if value not in axes.setdefault(path, []):
                axes[path].append(value)
    results = Results(folder, axes, _COLUMNS)
    new = [check for name, check in checks.items() if not options.resume or results.find(name) is None]
    options.say(f"{len(checks)} points: {len(new)} to check, {len(checks) - len(new)} there")
    if options.dry_run:
        return CheckSweep(folder, [], 0, failed)
    share = alpha / 2 ** (state["calls"] + 1) / max(len(new), 1)
    computed = 0

    def write_state() -> None:
        state_now = {
            "format": "crescent sweep 2", "kind": "check", "title": title, "alpha": alpha, "axes": axes,
            "calls": state["calls"] + bool(new), "points": points, "numerics": NUMERICS, "failed": failed,
        }  # fmt: skip
        write_whole(folder / "sweep.json", json.dumps(state_now, indent=1))

    def take(job: Job, result: Result) -> None:
        nonlocal computed
        kept = {**result, "alpha": share, "version": NUMERICS}
        columns = {key: kept[key] for key in ("alpha", "version", "worker", "host")}
        columns |= {"kind": kind_of(result), "sampler_id": job.task["sampler_id"]}
        results.add(job.id, [{**verdict, **columns} for verdict in result["verdicts"]], job.row, kept)
        computed += 1

    write_state()
    results.sync({point["id"]: point["values"] for point in points if results.find(point["id"])})
    if new:
        jobs = (replace(check, task={**check.task, "alpha": share}) for check in new)
        with DaskEngine(options.engine, options.workers, options.say) as engine:
            execute(engine, lambda: next(jobs, None), take, failed, Progress(len(new), 0, options.progress))
    write_state()
    return CheckSweep(folder, _checked(points, results), computed, failed)


def found_checks(out: str | PathLike[str]) -> list[dict[str, Any]]:
    """The points of a folder that were checked, with their verdicts."""
    state = read_json(Path(out) / "sweep.json") or {"points": [], "axes": {}}
    return _checked(state["points"], Results(Path(out), state["axes"], _COLUMNS))


def _checked(points: Sequence[Mapping[str, Any]], results: Results) -> list[dict[str, Any]]:
    entries = ((point, results.find(point["id"])) for point in points)
    found = [(point, results.about(entry)) for point, entry in entries if entry is not None]
    return [{**point, **result, "kind": kind_of(result)} for point, result in found]


def _sorted(values: list[Any]) -> list[Any]:
    """Numbers by size, others by their text."""
    return sorted(values, key=str if any(isinstance(v, str) for v in values) else None)


def map_of_kinds(points: list[dict[str, Any]], axes: Mapping[str, list[Any]]) -> tuple[list[str], list[Any], list[Any], Any]:
    """The first two axes, and the worst kind at each pair of values; a missing one is -1."""
    paths = sorted(axes, key=lambda path: -len(axes[path]))[:2]
    across = _sorted(axes[paths[0]])
    up: list[Any] = _sorted(axes[paths[1]]) if len(paths) > 1 else [""]
    out = np.full((len(up), len(across)), -1)
    for point in points:
        cell = up.index(point["values"][paths[1]]) if len(paths) > 1 else 0, across.index(point["values"][paths[0]])
        out[cell] = max(out[cell], KINDS.index(point["kind"]))
    return paths, across, up, out


def summary_of_checks(out: str | PathLike[str]) -> str:
    """The map as text, the counts, and the first message of each kind that is not right."""
    state = read_json(Path(out) / "sweep.json")
    points = found_checks(out)
    lines = [f"{state['title']}: {len(points)} points, alpha {state['alpha']:g} over all"]
    if points:
        paths, across, up, kinds = map_of_kinds(points, state["axes"])
        letters = {-1: " ", **{k: name[0].upper() if name != "right" else "." for k, name in enumerate(KINDS)}}
        width = max(len(short(v)) for v in across)
        margin = max((len(short(v)) for v in up), default=0)
        for y in reversed(range(len(up))):
            row = "  ".join(letters[int(kinds[y, x])].rjust(width) for x in range(len(across)))
            lines.append(f"{short(up[y]).rjust(margin)}  {row}")
        lines.append(f"{' ' * margin}  " + "  ".join(short(v).rjust(width) for v in across))
        lines.append(f"across: {paths[0]}" + (f"; up: {paths[1]}" if len(paths) > 1 else ""))
        lines.append(". right, H heavy-tailed, I inconclusive, W wrong, E error")
    for kind in KINDS:
        of_kind = [p for p in points if p["kind"] == kind]
        if not of_kind:
            continue
        lines.append(f"{kind}: {len(of_kind)} of {len(points)}")
        verdict = _first(of_kind[0], kind)
        if verdict is not None:
            lines.append(f"  {label(of_kind[0]['values'])}, {verdict['case']}, {verdict['verdict']}: {verdict['message']}")
    lines += [f"failed: {place}: {error}" for place, error in state.get("failed", {}).items()]
    return "\n".join(lines)


def _first(point: Mapping[str, Any], kind: str) -> Mapping[str, Any] | None:
    """The verdict that determines the kind of a point."""
    state = {"wrong": "wrong", "error": "error"}.get(kind, "inconclusive")
    for v in point["verdicts"]:
        if kind != "right" and v["state"] == state and (kind != "heavy-tailed" or v["verdict"] == "tail"):
            return dict(v)
    return None
