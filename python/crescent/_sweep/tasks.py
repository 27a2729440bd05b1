"""The tasks of a sweep as plain data, and their computation in this process.

A task has a kind: ``reference`` (of one scene), ``part`` (an arm and some seeds of one point), ``studies`` (furnaces and
checks of the article's claims of one point), ``check`` (a sampler or an arm at one point), ``sleep`` (waits, to
measure the overhead of a task). Its result is plain data too; references are bytes.
"""

from __future__ import annotations

import base64
import hashlib
import os
import pickle
import socket
import tempfile
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .. import _crescent
from .._callable_arms import callable_arm, callable_arms
from .._check import check, run_checks
from .._context import DEFAULTS
from .._files import as_sampler, sampler_at
from .attributes import with_attribute
from .identity import NUMERICS

Task = dict[str, Any]
Result = dict[str, Any]


@dataclass
class Job:
    """A task, and what its result is stored with."""

    id: str  #: of a part SCENE-ARM-FIRST-LAST
    task: Task
    label: str = ""  #: in messages
    row: dict[str, Any] = field(default_factory=dict)  #: of a part: its swept values and constant columns
    folder: str = ""  #: of its point, for films
    repeatable: bool = False  #: whether another worker must compute the same bits
    samples: float = 0.0
    bytes: float = 0.0  #: of its result on disk
    avoid: str = ""  #: the address of a worker that must not compute it

    @property
    def reference(self) -> str:
        """The identity of the references that it needs; "" if it needs none."""
        return str(self.task.get("reference", ""))


def host() -> str:
    """The name of this machine."""
    return socket.gethostname()


def _code_folder(files: Mapping[str, str]) -> Path:
    """The folder of these files on this machine, named by the hash of their contents."""
    name = hashlib.sha256(repr(sorted(files.items())).encode()).hexdigest()[:24]
    folder = Path(tempfile.gettempdir()) / f"crescent-sweep-{os.getuid()}" / name
    folder.parent.mkdir(exist_ok=True, mode=0o700)
    if folder.parent.stat().st_uid != os.getuid():
        raise ValueError(f"{folder.parent} is another user's folder")
    folder.mkdir(exist_ok=True)
    for file, text in files.items():
        data = base64.b64decode(text)
        if not (folder / file).is_file() or (folder / file).read_bytes() != data:
            (folder / file).parent.mkdir(parents=True, exist_ok=True)
            partial = (folder / file).with_name(f".{Path(file).name}.{os.getpid()}")
            partial.write_bytes(data)
            partial.replace(folder / file)
    return folder


def _sampler(code: Mapping[str, Any]) -> Any:
    """The Python sampler that was sent with a task."""
    if code.get("pickle"):
        return pickle.loads(base64.b64decode(code["pickle"]))
    return sampler_at(str(_code_folder(code["files"]) / code["at"]))


def experiment_of(task: Task) -> Any:
    """The experiment of a task, with the paths of its plugins on this machine."""
    changes = list(task["changes"])
    for name, arm in task.get("arms", {}).items():
        if arm["kind"] == "plugin":
            file = _code_folder(arm["code"]["files"]) / arm["code"]["at"]
            changes.append(f'arms."{name}".plugin="{file}"')
    return _crescent.parse(task["text"], task["file"], changes)


def _callables(task: Task) -> list[Any]:
    """The Python arms of a task."""
    out = []
    for name, arm in task.get("arms", {}).items():
        if arm["kind"] in ("python", "callable"):
            out.append(callable_arm(name, _sampler(arm["code"]) if arm["code"] else sampler_at(arm["sampler"])))
        elif arm["kind"] == "weights_python":
            file = _code_folder(arm["code"]["files"]) / arm["code"]["at"] if arm["code"] else arm["sampler"]
            out.extend(callable_arms({}, {name: {"weights_python": str(file)}}))
    return out


def _part(task: Task, references: Any) -> Result:
    """Runs one arm by itself, so that its result does not depend on the others."""
    isa = _instruction_set(task)
    name = task["arm"]
    start = time.perf_counter()
    run = _crescent.run_part(
        experiment_of(task), task["first"], task["last"], [name], references, 1, isa, None, _callables(task)
    )
    part = {"json": run.json, "csv": run.csv, "seconds": time.perf_counter() - start, "times": [list(t) for t in run.times]}
    return {**part, "films": _films(run) if task["films"] else {}, "isa": isa}


def _instruction_set(task: Task) -> str:
    """The best instruction set of this machine; for "not NAME" the best other one."""
    sets = _crescent.instruction_sets()
    unwanted = task.get("isa", "").removeprefix("not ")
    return next((name for name in reversed(sets) if name != unwanted), sets[-1])


def _films(run: Any) -> dict[str, bytes]:
    """The EXR files of a run."""
    with tempfile.TemporaryDirectory() as folder:
        run.write(os.path.join(folder, "run"))
        return {path.name: path.read_bytes() for path in sorted(Path(folder, "run", "films").glob("*.exr"))}


def _checked(task: Task) -> Result:
    """Checks one sampler with the values of one point, or one arm of an experiment there."""
    settings_of_check = {"alpha": task["alpha"], "seed": task["seed"], "full": task["full"], "threads": 1}
    if "arm" in task:
        cases = _crescent.cases_of_experiment(
            experiment_of(task), task["arm"], task["pixels"], task["full"], _callables(task), [], "check"
        )
        result = run_checks(cases, f"crescent.check({task['file']!r}, sampler={task['arm']!r})", **settings_of_check)
    else:
        sampler, settings = task["sampler"], task["values"]
        if task["code"]:
            sampler, settings = _sampler_with(task["code"], task["values"])
        result = check(sampler, settings=settings, **settings_of_check)
    rows = [
        {"case": v.case, "verdict": v.name, "state": v.state, "message": v.message, "cause": v.cause}
        for v in result.verdicts
    ]
    return {"state": result.state, "tests": result.tests, "verdicts": rows, "json": result.json()}


def _sampler_with(code: Mapping[str, Any], values: Mapping[str, Any]) -> tuple[Any, dict[str, Any] | None]:
    """The sampler of a file, and its settings: a class or function of it is called with the values of the point as
    keywords; of a sampler that is there already they are the settings of its context, or attributes."""
    from .._files import _module_in
    from .._sampler import Sampler

    at = str(_code_folder(code["files"]) / code["at"])
    file, colon, inside = at.rpartition(":") if not at.endswith(".py") else (at, "", "")
    found = getattr(_module_in(Path(file)), inside) if colon else None
    if found is not None and not isinstance(found, Sampler) and callable(found):
        sampler, rest = as_sampler(found(**values), at, inside), {}
    else:
        sampler, rest = sampler_at(at), dict(values)
    settings = {key: value for key, value in values.items() if key in DEFAULTS} if sampler.uses else {}
    for key in set(rest) - set(settings):
        changed: Any = with_attribute(sampler, key, rest[key], key)
        sampler = changed
    return sampler, settings or None


def error_text(error: BaseException) -> str:
    """An error in one line."""
    text = " ".join(str(error).split())
    return text if isinstance(error, ValueError) and text else f"{type(error).__name__}: {text}"


def compute(task: Task, reference: Any = None) -> Result:
    """Computes a task in this process."""
    start = time.perf_counter()
    if task["numerics"] != NUMERICS:
        raise ValueError(f"{host()} has crescent {NUMERICS}, and the sweep was started by {task['numerics']}")
    kind = task["kind"]
    out: Result
    if kind == "reference":
        references = _crescent.references(experiment_of(task), task.get("threads", 1), "", None)
        out = {"reference": pickle.dumps(references, protocol=5), "id": task["id"]}
    elif kind == "part":
        out = _part(task, reference)
    elif kind == "studies":
        run = _crescent.studies(experiment_of(task), task.get("threads", 1), "", None, _callables(task))
        out = {"json": run.json}
    elif kind == "check":
        out = _checked(task)
    elif kind == "sleep":
        time.sleep(task["seconds"])
        out = {}
    else:
        raise ValueError(f"no kind of task '{kind}'")
    return {"isa": _crescent.instruction_sets()[-1], **out, "seconds": time.perf_counter() - start}
