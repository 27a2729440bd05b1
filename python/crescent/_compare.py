"""Renders compared by the program `crescent compare`: arrays, files or a suite.

    result = crescent.compare(before, after, smallest=0.02)   # arrays [render, row, column] or [..., channel]
    result = crescent.compare("old/*.exr", "new/*.exr")
    result = crescent.compare("suite.toml")
    print(result.state, result.views["view"].sentence)
"""

from __future__ import annotations

import glob
import json
import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from . import _arrays

#: The states of a view, the most severe first: a suite has the first of these that one of its views has.
STATES = ("unreadable", "changed", "noisier", "missing", "new", "too few renders", "improved", "same")

_ERRORS: dict[int, type[Exception]] = {2: ValueError, 3: OSError}


@dataclass(frozen=True)
class View:
    """The result for one view."""

    name: str
    state: str  #: one of STATES
    sentence: str
    notes: tuple[str, ...] = ()  #: copies, shared seeds, warnings about files
    numbers: Mapping[str, Any] = field(default_factory=dict, repr=False)  #: as in docs/suite.schema.json


@dataclass(frozen=True)
class Comparison:
    """The result for all views, as `crescent compare` writes it."""

    state: str  #: the first of STATES that a view has
    sentence: str
    views: Mapping[str, View]
    exit_code: int  #: of the program: 0, 1 (changed, noisier, missing or new), 2 (unreadable) or 4 (too few renders)
    _markdown: str = field(default="", repr=False)

    def to_markdown(self) -> str:
        """The table for a summary page."""
        return self._markdown

    def __str__(self) -> str:
        return "\n".join([*(f"{v.name}: {v.state}. {v.sentence}" for v in self.views.values()), self.sentence])


def program() -> str:
    """The program `crescent` of this package, or the one in PATH."""
    own = Path(__file__).parent / "bin" / "crescent"
    found = str(own) if os.access(own, os.X_OK) else shutil.which("crescent")
    if not found:
        raise OSError(f"no program crescent: neither {own} nor in PATH")
    return found


def run_compare(arguments: Sequence[str], result: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Runs `crescent compare`; ValueError for wrong input, OSError for outputs that cannot be written.

    With the file of a `result` that was written, views that cannot be read are part of the result.
    """
    done = subprocess.run([program(), "compare", *arguments], capture_output=True, text=True, check=False)
    if done.returncode in (0, 1, 4) or (done.returncode == 2 and result and result.exists()):
        return done
    if done.returncode == 130:
        raise KeyboardInterrupt
    raise _ERRORS.get(done.returncode, RuntimeError)(done.stderr.strip())


def _renders(side: Any, what: str) -> list[Any]:
    """The renders of one side of one view: arrays [row, column] or [row, column, channel], or paths."""
    if isinstance(side, (str, os.PathLike)):
        paths = sorted(glob.glob(os.fspath(side)))
        if not paths:
            raise ValueError(f"{what}: expected files that match '{os.fspath(side)}', found none")
        return [Path(p).absolute() for p in paths]
    if isinstance(side, (list, tuple)) and side and all(isinstance(p, (str, os.PathLike)) for p in side):
        return [Path(p).absolute() for p in side]
    if isinstance(side, (list, tuple)):
        arrays = [_arrays.numbers(a, f"{what}[{k}]") for k, a in enumerate(side)]
    else:
        whole = _arrays.numbers(side, what)
        if whole.ndim not in (3, 4):
            raise ValueError(
                f"{what}: shape {whole.shape}, expected [render, row, column] or [render, row, column, channel]"
            )
        arrays = list(whole)
    for k, a in enumerate(arrays):
        if a.ndim not in (2, 3) or (a.ndim == 3 and a.shape[2] not in (1, 3, 4)):
            raise ValueError(f"{what}[{k}]: shape {a.shape}, expected [row, column] or [row, column, 1, 3 or 4]")
    return arrays


def file_name(view: str) -> str:
    """A file name for a view: `%` and two hexadecimal digits replace characters that it cannot have."""
    if not view:
        raise ValueError("expected a name of a view, found an empty one")
    odd = '/\\*?"{}%'
    name = "".join(f"%{ord(c):02x}" if c in odd or ord(c) < 32 or (k == 0 and c == ".") else c for k, c in enumerate(view))
    if len(name.encode("utf-8", "surrogateescape")) > 200:
        raise ValueError(f"expected a name of a view of at most 200 bytes, found {view[:40]}...")
    return name


def escape_pattern(path: str) -> str:
    """The pattern of a suite that matches this path only."""
    return "".join(f"[{c}]" if c in "*?[%{" else c for c in path)


def write_renders(folder: Path, view: str, side: Any, what: str) -> None:
    """Writes the renders as FOLDER/VIEW/K.npy, or links to their files."""
    to = folder / file_name(view)
    to.mkdir(parents=True, exist_ok=True)
    for k, render in enumerate(_renders(side, what)):
        if isinstance(render, Path):
            (to / f"{k:04}{render.suffix}").symlink_to(render)
        else:
            np.save(to / f"{k:04}.npy", np.ascontiguousarray(render, render.dtype if render.dtype == "f2" else "f4"))


def suite_text(
    baseline: str, candidate: str, options: Mapping[str, Any], regions: Mapping[str, Mapping[str, Sequence[int]]]
) -> str:
    """The text of a suite file. JSON's text and numbers are also valid TOML."""
    lines = ["[suite]", f"baseline = {json.dumps(baseline)}", f"candidate = {json.dumps(candidate)}"]
    lines += [f"{key} = {json.dumps(value)}" for key, value in options.items() if value is not None]
    for view, boxes in regions.items():
        lines.append(f"[view.{json.dumps(file_name(view))}.regions]")
        lines += [f"{name} = {json.dumps([int(x) for x in box])}" for name, box in boxes.items()]
    return "\n".join(lines) + "\n"


def _read(json_file: Path, markdown_file: Path) -> Comparison:
    numbers = json.loads(json_file.read_text(encoding="utf-8"))
    views = {
        v["view"]: View(v["view"], v["state"], v["sentence"], tuple(v["notes"]), v) for v in numbers["views"]
    }
    state = next((s for s in STATES if any(v.state == s for v in views.values())), "same")
    return Comparison(state, numbers["sentence"], views, numbers["exit_code"], markdown_file.read_text(encoding="utf-8"))


def compare_suite(suite: os.PathLike[str] | str, *, out: os.PathLike[str] | str | None = None) -> Comparison:
    """Compares the views of a suite file; `out`: the folder for report.html."""
    with tempfile.TemporaryDirectory(prefix="crescent-") as work:
        json_file, markdown_file = Path(work) / "suite.json", Path(work) / "summary.md"
        outputs = ["--json", str(json_file), "--markdown", str(markdown_file), "--out", str(out or Path(work) / "out")]
        run_compare([os.fspath(suite), "--quiet", *outputs], json_file)
        return _read(json_file, markdown_file)


def compare(
    baseline: Any,
    candidate: Any = None,
    *,
    alpha: float | None = None,
    smallest: float | str | None = None,
    regions: Mapping[str, Sequence[int]] | None = None,
    brightest: float | None = None,
    layer: str | None = None,
    name: str = "view",
    out: os.PathLike[str] | str | None = None,
) -> Comparison:
    """Tests whether the renders of the candidate have the mean and the variance of the baseline's.

    Each side is an array ``[render, row, column]`` or ``[render, row, column, channel]`` with rows from the top, a list
    of arrays of single renders, a pattern or a list of files, or a mapping of views to these. With the path of a suite
    file alone, its views are compared.

    alpha: probability that unchanged views are reported (0.01). smallest: relative difference of the mean luminance
    that must be found, 0.02 or "2 %" (1 %). regions: boxes ``x0, y0, x1, y1`` in every view, both ends inclusive,
    origin bottom-left. brightest: largest possible luminance of a pixel of one render. out: folder for report.html.

    Raises ValueError for renders that do not fit each other and OSError for outputs that cannot be written.
    """
    if candidate is None:
        if not isinstance(baseline, (str, os.PathLike)):
            raise ValueError("candidate: expected renders, or a suite file as the only argument")
        return compare_suite(baseline, out=out)
    sides = {"baseline": baseline, "candidate": candidate}
    by_view = {
        side: dict(views) if isinstance(views, Mapping) else {name: views} for side, views in sides.items()
    }
    names: Iterable[str] = dict.fromkeys([*by_view["baseline"], *by_view["candidate"]])
    original = {file_name(view): view for view in names}
    options = {"alpha": alpha, "smallest": smallest, "brightest": brightest, "layer": layer}
    with tempfile.TemporaryDirectory(prefix="crescent-") as work:
        for side, views in by_view.items():
            for view, renders in views.items():
                write_renders(Path(work) / side, view, renders, f"{side} of {view}")
        boxes = {view: regions for view in names} if regions else {}
        suite = Path(work) / "suite.toml"
        suite.write_text(suite_text("baseline/{view}/*", "candidate/{view}/*", options, boxes), encoding="utf-8")
        result = compare_suite(suite, out=out)
    unreadable = [v.sentence for v in result.views.values() if v.state == "unreadable"]
    if unreadable:
        raise ValueError("\n".join(unreadable))
    views = {original[v.name]: replace(v, name=original[v.name]) for v in result.views.values()}
    return replace(result, views=views)
