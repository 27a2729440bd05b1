"""From a grid to tasks: which results are missing, and how many seeds a task has.

A task is one arm at one point with as many seeds as have about a given number of samples.
"""

from __future__ import annotations

import functools
import uuid
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .._paths import found as found_at
from .._paths import overrides
from ..experiments import Experiment
from .attributes import of_samplers, with_attributes
from .dataset import Results
from .grid import label
from .identity import NOT_OF_THE_SCENE, NUMERICS, Arm, arms_of, digest, reference_id, scene_id
from .store import Store, read_json
from .tasks import Job, error_text

#: Of built-in samplers, which draw 20 to 300 million samples a second on a core, and of others, which draw 3 to 6 million in
#: NumPy: a task lasts 2 to 25 s, so that both its overhead (2 ms) and what is lost with a worker are small.
SAMPLES_PER_TASK = 5e8
SAMPLES_PER_TASK_OF_OTHERS = 4e7


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
    def hash(self) -> str:
        """The hash of its experiment, which reads the files of samplers."""
        return self.experiment.hash

    @property
    def pixels(self) -> int:
        """The pixels of a film."""
        return int(self.tree["image"]["width"]) * int(self.tree["image"]["height"])

    def samples(self, name: str) -> float:
        """Samples of one seed of an arm, if every pixel sees geometry."""
        control = self.tree.get("exponent")
        of_control = control["n"] * len(control["s"]) if control and control["arm"] == name else 0
        return float(self.pixels * (self.arms[name].most + of_control))

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

    def row(self, name: str) -> dict[str, Any]:
        """The columns of an arm at this point."""
        arm = self.arms[name]
        return {**self.values, "point": self.key, "sampler": arm.sampler, "sampler_id": arm.id}

    def task(self, kind: str, arms: Sequence[str] = (), **more: Any) -> dict[str, Any]:
        """A task of this point, with the arms of the combinations among these."""
        named = {
            name: {
                "kind": arm.kind, "code": arm.code, "sampler": arm.sampler, "of": arm.of,
            }  # fmt: skip
            for name, arm in self.arms.items()
            if name in arms or any(name in self.arms[other].of for other in arms)
        }
        return {
            "kind": kind, "numerics": NUMERICS, "text": self.experiment.text,
            "file": self.experiment._core.file, "changes": self.changes, "arms": named,
            "code_id": digest(codes) if any(codes := [arm["code"] for arm in named.values()]) else "",
            **more,
        }  # fmt: skip


def families_of(tree: Mapping[str, Any], path: str) -> str:
    """The table of a path, which may begin at a name: "arms" of "phong.n"."""
    try:
        return found_at(tree, path)[0][0]
    except KeyError:
        return path.partition(".")[0]


def studies_id(point: Point) -> str:
    """The identity of the studies of a point."""
    return digest(NUMERICS, point.hash, [arm.id for arm in point.arms.values()])


def points_of(
    base: Experiment, values: Sequence[Mapping[str, Any]], seeds: int, versions: Mapping[str, str]
) -> tuple[list[Point], dict[str, str]]:
    """The points of these values, and the errors of those that are not valid."""
    call = uuid.uuid4().hex
    points: list[Point] = []
    errors: dict[str, str] = {}
    for point_values in values:
        try:
            attributes = of_samplers(point_values)
            keys = {path: value for path, value in point_values.items() if path not in attributes} | {"seeds": seeds}
            e = with_attributes(base.with_(keys), attributes)
            with_arms = e._with_arms()
            arms = arms_of(e, versions, call)
            identities = scene_id(with_arms), reference_id(with_arms)
            points.append(Point(dict(point_values), with_arms, overrides(keys), *identities, arms))
        except (ValueError, TypeError, OSError) as error:
            errors[label(point_values)] = error_text(error) if not isinstance(error, OSError) else str(error)
    return points, errors


def missing(blocks: Sequence[tuple[int, int]], seeds: int) -> list[tuple[int, int]]:
    """The ranges of 1 to `seeds` that are in no block."""
    out: list[tuple[int, int]] = []
    seed = 1
    for first, last in [*sorted(blocks), (seeds + 1, seeds + 1)]:
        if seed < min(first, seeds + 1):
            out.append((seed, min(first - 1, seeds)))
        seed = max(seed, last + 1)
    return out


class Plan:
    """The tasks that are missing, in the order in which they are computed."""

    def __init__(self, points: Sequence[Point], store: Store, results: Results, seeds: int, films: bool) -> None:
        self._points, self._store, self._results, self._seeds, self._films = points, store, results, seeds, films
        self.threads = 1  #: of the task of a reference

    def cost(self) -> dict[str, float]:
        """Tasks, those of references, samples and bytes of the missing results."""
        total = {"tasks": 0.0, "references": 0.0, "samples": 0.0, "bytes": 0.0}
        for job in self.jobs():
            total["tasks"] += 1
            total["references"] += job.task["kind"] == "reference"
            total["samples"] += job.samples
            total["bytes"] += job.bytes
        return total

    def jobs(self) -> Iterator[Job]:
        """The missing tasks. Points that differ in one arm share the results of the others."""
        planned: set[str] = set()
        for point in self._points:
            parts = [job for job in self._parts(point) if job.id not in planned]
            if parts and point.reference not in planned and not self._store.has("references", point.reference):
                planned.add(point.reference)
                yield self.reference(point)
            yield from parts
            planned.update(job.id for job in parts)
            name = studies_id(point)
            if name not in planned and not self._store.has("studies", name):
                planned.add(name)
                yield Job(name, point.task("studies", list(point.arms)), f"{point.label}, studies")

    def reference(self, point: Point) -> Job:
        """The task of the references of a point."""
        task = point.task("reference", threads=self.threads, id=point.reference)
        control = point.tree.get("exponent")
        films = (len(control["s"]) if control else 1) * (1 + bool(point.tree["reference"].get("monte_carlo")))
        return Job(point.reference, task, f"{point.label}, reference", bytes=20.0 * point.pixels * films)

    def _parts(self, point: Point) -> Iterator[Job]:
        for name, arm in point.arms.items():
            samples = point.samples(name)
            block = max(1, round((SAMPLES_PER_TASK if arm.built_in else SAMPLES_PER_TASK_OF_OTHERS) / samples))
            counts = len(point.tree["arms"][name]["n"])
            seed_bytes = counts * (1_800.0 + 1_100 * len(point.tree.get("regions", {})))  # in data and points
            row = {**point.row(name), "experiment": point.hash}
            for first, last in missing(self._results.blocks(point.scene, arm.id), self._seeds):
                for start in range(first, last + 1, block):
                    end = min(start + block - 1, last)
                    films = self._films and start == 1
                    count = end - start + 1
                    task = point.task(
                        "part", [name], arm=name, first=start, last=end, reference=point.reference, films=films
                    )
                    yield Job(
                        f"{point.scene}-{arm.id}-{start}-{end}", task, f"{point.label}, {name}, seeds {start} to {end}",
                        row=row, folder=point.folder, repeatable=arm.built_in, samples=samples * count,
                        bytes=12_000 + seed_bytes * count + 36.0 * point.pixels * counts * films,
                    )  # fmt: skip


def kept_points(
    base: Experiment, out: Path, seeds: int, versions: Mapping[str, str], new: Sequence[Point]
) -> list[Point]:
    """The points of earlier calls that are points of this experiment still, without those of `new`."""
    keys = {point.key for point in new}
    older: list[Point] = []
    for old in (read_json(out / "sweep.json") or {}).get("points", []):
        found = [] if old["scene"] in keys else points_of(base, [old["values"]], seeds, versions)[0]
        older += [point for point in found if point.key == old["scene"]]
    return older
