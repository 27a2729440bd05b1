"""From a grid to tasks: which results are missing, and how many seeds a task has.

A task has as many seeds as last about `TASK_S` seconds by a measurement of the samples per second of each sampler,
which runs once and is stored.
"""

from __future__ import annotations

import functools
import json
import uuid
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .._paths import found as found_at
from .._paths import lines, overrides
from ..experiments import Experiment, parse
from .attributes import of_samplers, with_attributes
from .engines import InProcess, Job
from .grid import label
from .identity import NOT_OF_THE_SCENE, NUMERICS, Arm, arms_of, digest, reference_id, scene_id
from .store import Store, read_json, write_whole
from .tasks import error_text

TASK_S = 12.0  #: length of a task; results of 5 to 30 s keep both the overhead and the loss of a failure small
_LONGEST_S = 30.0
_SHORTEST_S = 5.0
_CALIBRATION_PIXELS = 160 * 90


@dataclass
class Point:
    """One point of the grid."""

    values: dict[str, Any]
    experiment: Experiment
    changes: list[str]
    scene: str
    reference: str
    arms: dict[str, Arm]

    @functools.cached_property
    def tree(self) -> dict[str, Any]:
        """Every value of the experiment."""
        return self.experiment._tree()

    @functools.cached_property
    def key(self) -> str:
        """What tells the point from others: its scene, and swept keys that are not of the scene, such as arms.x.n."""
        steps = {path: families_of(self.tree, path) for path in self.values}
        other = {path: value for path, value in self.values.items() if steps[path] in NOT_OF_THE_SCENE}
        return digest(self.scene, other) if other else self.scene

    @property
    def label(self) -> str:
        """The point in one line."""
        return label(self.values)

    @property
    def folder(self) -> str:
        """The name of its folder below points/."""
        safe = "".join(c if c.isalnum() or c in "=.,-+_" else "_" for c in self.label.replace(" ", ""))
        return safe if len(safe) <= 120 else f"{safe[:100]}-{self.scene}"

    def task(self, kind: str, arms: Sequence[str] = (), **more: Any) -> dict[str, Any]:
        """A task of this point, with the arms of the combinations among these."""
        named = {
            name: {
                "kind": arm.kind, "code": arm.code, "sampler": arm.sampler, "most": arm.most,
                "of": arm.of, "run": name in arms,
            }  # fmt: skip
            for name, arm in self.arms.items()
            if name in arms or any(name in self.arms[other].of for other in arms)
        }
        return {
            "kind": kind, "numerics": NUMERICS, "text": more.pop("text", self.experiment.text),
            "file": self.experiment._core.file, "changes": more.pop("changes", self.changes), "arms": named,
            "code_id": digest(codes) if any(codes := [arm["code"] for arm in named.values()]) else "",
            **more,
        }  # fmt: skip


def families_of(tree: Mapping[str, Any], path: str) -> str:
    """The table of a path, which may begin at a name: "arms" of "phong.n"."""
    try:
        return found_at(tree, path)[0][0]
    except KeyError:
        return path.partition(".")[0]


def points_of(
    base: Experiment, values: Sequence[Mapping[str, Any]], seeds: int, versions: Mapping[str, str]
) -> tuple[list[Point], dict[str, str]]:
    """The points of these values, and the errors of those that are not valid."""
    call = uuid.uuid4().hex
    good: list[Point] = []
    bad: dict[str, str] = {}
    for at in values:
        try:
            attributes = of_samplers(at)
            keys = {path: value for path, value in at.items() if path not in attributes} | {"seeds": seeds}
            e = with_attributes(base.with_(keys), attributes)
            with_arms = e._with_arms()
            changes = overrides(keys)
            point = Point(
                dict(at), with_arms, changes, scene_id(with_arms), reference_id(with_arms), arms_of(e, versions, call)
            )
        except (ValueError, TypeError, OSError) as error:
            bad[label(at)] = error_text(error) if not isinstance(error, OSError) else str(error)
            continue
        good.append(point)
    return good, bad


def missing(blocks: Sequence[tuple[int, int]], seeds: int) -> list[tuple[int, int]]:
    """The ranges of 1 to `seeds` that are in no block."""
    out, at = [], 1
    for first, last in sorted(blocks):
        if first > at:
            out.append((at, min(first - 1, seeds)))
        at = max(at, last + 1)
    if at <= seeds:
        out.append((at, seeds))
    return [r for r in out if r[0] <= r[1]]


# ---- calibration


def _small(base: Experiment) -> tuple[Experiment, int]:
    """The scene in a small picture, with the arms and nothing else; and its pixels."""
    import tomllib

    whole = tomllib.loads(base._with_arms()._core.text)
    kept = {
        k: v
        for k, v in whole.items()
        if k not in ("plates", "assertions", "furnaces", "exponent", "regions", "published")
    }
    kept["note_evidence"] = False
    width, height = whole["image"]["width"], whole["image"]["height"]
    scale = min(1.0, (_CALIBRATION_PIXELS / (width * height)) ** 0.5)
    kept["image"] = {**whole["image"], "width": max(int(width * scale), 16), "height": max(int(height * scale), 16)}
    kept["seeds"] = 80
    small = parse("\n".join(lines(kept)), base._core.file)
    return small, kept["image"]["width"] * kept["image"]["height"]


def calibrate(point: Point, store: Store) -> dict[str, Any]:
    """Samples per second of each arm and seconds per pixel of the reference, on one core of this machine."""
    path = store.root / "calibration.json"
    known = read_json(path) or {}
    wanted = {name: arm for name, arm in point.arms.items() if arm.id not in known.get("arms", {})}
    if wanted or "reference_s" not in known:
        small, pixels = _small(point.experiment)
        with InProcess() as engine:
            task = point.task("rates", list(wanted), text=small.text, changes=[], pixels=pixels)
            found = engine.compute(task)
        if "error" in found:
            found = {"arms": {}, "reference_s": 1e-5, "seen": 1.0}
        rates = {point.arms[name].id: rate for name, rate in found["arms"].items()}
        known = {
            "arms": {**known.get("arms", {}), **rates},
            "reference_s": found["reference_s"],
            "seen": found["seen"] if found["arms"] else known.get("seen", 1.0),
            "host": found.get("host", ""),
        }
        write_whole(path, json.dumps(known))
    return dict(known)


class Costs:
    """Seconds and samples of the tasks of a point, from the calibration."""

    def __init__(self, calibration: Mapping[str, Any]) -> None:
        self._rates, self._known = calibration["arms"], calibration

    def _pixels(self, point: Point) -> int:
        return int(point.tree["image"]["width"]) * int(point.tree["image"]["height"])

    def samples(self, point: Point, name: str) -> float:
        """Samples of one seed of an arm; misses are not counted."""
        arm = point.arms[name]
        counts: list[int] = [arm.most]
        control = point.tree.get("exponent")
        if control and control["arm"] == name:
            counts += [control["n"]] * len(control["s"])
        pixels = float(self._known["seen"]) * self._pixels(point)
        return pixels * sum(counts)

    def seconds(self, point: Point, name: str) -> float:
        """Seconds of one seed of an arm."""
        slow = min(self._rates.values(), default=5e6)
        return self.samples(point, name) / float(self._rates.get(point.arms[name].id, slow))

    def reference(self, point: Point) -> float:
        """Seconds of the references."""
        control = point.tree.get("exponent")
        count = len(control["s"]) if control else 1
        return float(self._known["reference_s"]) * self._pixels(point) * count


# ---- the tasks


class Plan:
    """The tasks that are missing, in the order in which they are computed."""

    def __init__(self, points: Sequence[Point], store: Store, seeds: int, costs: Costs, films: bool) -> None:
        self._points, self._store, self._seeds, self._costs, self._films = points, store, seeds, costs, films
        self.slots = 1
        self.references = len({p.reference for p in points if self._parts(p) and not self._has_reference(p)})

    def _has_reference(self, point: Point) -> bool:
        return self._store.has_reference(point.reference)

    def studies_name(self, point: Point) -> str:
        """The identity of the studies of a point."""
        return digest(NUMERICS, point.experiment.hash, [arm.id for arm in point.arms.values()])

    def _wanted(self, point: Point) -> dict[tuple[tuple[tuple[int, int], ...], str], list[str]]:
        """Arms by the ranges of seeds that they lack; an arm that is not built in is by itself."""
        out: dict[tuple[tuple[tuple[int, int], ...], str], list[str]] = {}
        for name, arm in point.arms.items():
            ranges = tuple(missing(self._store.blocks(point.scene, arm.id), self._seeds))
            if ranges:
                out.setdefault((ranges, "" if arm.built_in else name), []).append(name)
        return out

    def _groups(self, point: Point, names: list[str]) -> Iterator[list[str]]:
        """Splits arms of which one seed lasts too long together."""
        group: list[str] = []
        total = 0.0
        for name in names:
            seconds = self._costs.seconds(point, name)
            if group and total + seconds > _LONGEST_S:
                yield group
                group, total = [], 0.0
            group.append(name)
            total += seconds
        yield group

    def _parts(self, point: Point) -> list[tuple[list[str], int, int, float, float]]:
        """(arms, first seed, last seed, seconds, samples) of each missing task of a point."""
        out = []
        for (ranges, _), names in self._wanted(point).items():
            for group in self._groups(point, names):
                seconds = sum(self._costs.seconds(point, name) for name in group)
                samples = sum(self._costs.samples(point, name) for name in group)
                block = max(1, round(TASK_S / max(seconds, 1e-9)))
                for first, last in ranges:
                    for start in range(first, last + 1, block):
                        end = min(start + block - 1, last)
                        count = end - start + 1
                        out.append((group, start, end, seconds * count, samples * count))
        return out

    def cost(self) -> dict[str, float]:
        """Tasks, samples, seconds on one core and bytes of the missing results."""
        total = {"tasks": 0.0, "samples": 0.0, "seconds": 0.0, "bytes": 0.0}
        seen: set[str] = set()
        for point in self._points:
            parts = self._parts(point)
            if parts and not self._has_reference(point) and point.reference not in seen:
                seen.add(point.reference)
                pixels = self._costs._pixels(point)
                control = point.tree.get("exponent")
                films = (len(control["s"]) if control else 1) * (1 + bool(point.tree["reference"].get("monte_carlo")))
                total["tasks"] += 1
                total["seconds"] += self._costs.reference(point)
                total["bytes"] += 20.0 * pixels * films
            if parts and self._store.studies(self.studies_name(point)) is None:
                total["tasks"] += 1
            regions = len(point.tree.get("regions", {}))
            for arms, first, last, seconds, samples in parts:
                total["tasks"] += 1
                total["seconds"] += seconds
                total["samples"] += samples
                counts = sum(len(point.tree["arms"][name]["n"]) for name in arms)
                total["bytes"] += 12_000 * len(arms) + (last - first + 1) * counts * (1_400 + 900 * regions)
                if self._films and first == 1:
                    total["bytes"] += 36.0 * self._costs._pixels(point) * counts
        return total

    def jobs(self) -> Iterator[Job]:
        """The missing tasks."""
        made: set[str] = set()
        spread = max(1, self.slots // max(self.references, 1))
        for point in self._points:
            parts = self._parts(point)
            if parts and not self._has_reference(point) and point.reference not in made:
                made.add(point.reference)
                yield Job(
                    point.reference, point.task("reference", threads=spread, id=point.reference), ("reference", point)
                )
            for arms, first, last, _, samples in parts:
                task = point.task("part", arms, first=first, last=last, reference=point.reference, films=self._films)
                name = digest(point.scene, [point.arms[a].id for a in arms], first, last)
                yield Job(name, task, ("part", point, arms, first, last), needs=point.reference, weight=samples)
            name = self.studies_name(point)
            if name not in made and self._store.studies(name) is None:
                made.add(name)
                yield Job(name, point.task("studies", list(point.arms)), ("studies", point))


def kept_points(
    base: Experiment, out: Path, seeds: int, versions: Mapping[str, str], new: Sequence[Point]
) -> list[Point]:
    """The points of earlier calls that are points of this experiment still, without those of `new`."""
    known = read_json(out / "sweep.json") or {}
    keys = {point.key for point in new}
    old = [p for p in known.get("points", []) if p["scene"] not in keys]
    same = []
    for at in old:
        found, _ = points_of(base, [at["values"]], seeds, versions)
        if found and found[0].key == at["scene"]:
            same += found
    return same
