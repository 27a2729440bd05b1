"""Results in folders: metrics as the program writes them, and ``arrays.npz`` with the films, references and times."""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from . import _crescent

ARRAYS = "arrays.npz"


def core_of(state: Sequence[Any]) -> _crescent.RunResult:
    """The result with this state: s, holds, json, csv, junit, attributes, boxes, films, references, times, threads,
    stages."""
    core = _crescent.RunResult.__new__(_crescent.RunResult)
    core.__setstate__(tuple(state))
    return core


def arrays_of(core: _crescent.RunResult, samplers: Mapping[str, str]) -> bytes:
    """The contents of arrays.npz: planes, and an index in JSON."""
    state: Any = core.__getstate__()
    s, holds, _, _, _, attributes, boxes, films, references, times, threads, stages = state
    index = {
        "s": s,
        "holds": holds,
        "attributes": attributes,
        "boxes": boxes,
        "films": [film[:4] for film in films],
        "references": [s for s, _ in references],
        "times": times,
        "threads": threads,
        "stages": stages,
        "samplers": dict(samplers),
    }
    planes = {f"film/{k}/{name}": plane for k, film in enumerate(films) for name, plane in film[4].items()}
    planes |= {f"reference/{k}/{name}": plane for k, (_, of) in enumerate(references) for name, plane in of.items()}
    out = io.BytesIO()
    np.savez(out, index=np.frombuffer(json.dumps(index).encode(), np.uint8), **planes)
    return out.getvalue()


def _planes(arrays: Any, kind: str, k: int) -> dict[str, Any]:
    start = f"{kind}/{k}/"
    return {name.removeprefix(start): arrays[name] for name in arrays.files if name.startswith(start)}


def arrays_in(folder: Path) -> dict[str, Any] | None:
    """The index of a folder's arrays.npz, with the planes in its films and references; None if there is no such file."""
    path = folder / ARRAYS
    if not path.is_file():
        return None
    try:
        with np.load(path, allow_pickle=False) as arrays:
            index: dict[str, Any] = json.loads(arrays["index"].tobytes())
            index["films"] = [(*film, _planes(arrays, "film", k)) for k, film in enumerate(index["films"])]
            index["references"] = [(s, _planes(arrays, "reference", k)) for k, s in enumerate(index["references"])]
    except (ValueError, KeyError, EOFError, zipfile.BadZipFile) as error:
        raise ValueError(f"{path}: is damaged: expected the arrays that Measured.write wrote ({error})") from None
    index["boxes"] = [tuple(box) for box in index["boxes"]]
    index["times"] = [tuple(row) for row in index["times"]]
    index["stages"] = [tuple(row) for row in index.get("stages", [])]
    index["attributes"] = [tuple(pair) for pair in index["attributes"]]
    return index


def _text(path: Path) -> str:
    return path.read_bytes().decode()


def opened(folder: Path) -> tuple[_crescent.RunResult, dict[str, str]]:
    """The result in a folder, and the identities of its samplers; of a run of the program, which has no arrays.npz,
    without films and references."""
    if not (folder / "metrics.json").is_file():
        raise ValueError(f"{folder}: expected a folder of a result, with metrics.json")
    index = arrays_in(folder)
    texts = [
        _text(folder / name) if (folder / name).is_file() else ""
        for name in ("metrics.json", "metrics.csv", "junit.xml")
    ]
    if index is None:
        joined = list(_crescent.join([str(folder)]).__getstate__())
        joined[2:5] = [text or other for text, other in zip(texts, joined[2:5], strict=True)]
        joined[9:12] = _timing(folder)
        return core_of(joined), {}
    rest = ("attributes", "boxes", "films", "references", "times", "threads", "stages")
    return core_of([index["s"], index["holds"], *texts, *(index[name] for name in rest)]), index["samplers"]


def _timing(folder: Path) -> tuple[list[Any], int, list[Any]]:
    """The times, threads and stages of timing.json."""
    path = folder / "timing.json"
    try:
        timing = json.loads(_text(path)) if path.is_file() else {}
        rows = [(a["arm"], a["n"], a["s"], a["samples"], a["seconds"]) for a in timing.get("arms", [])]
        stages = [(stage["name"], stage["seconds"]) for stage in timing.get("stages", [])]
        return rows, int(timing.get("threads", 0)), stages
    except KeyError as error:
        raise ValueError(f"{path}: expected the timing.json of a run: an entry has no {error}") from None
    except (ValueError, TypeError, AttributeError) as error:
        raise ValueError(f"{path}: expected the timing.json of a run: {error}") from None


UNHASHABLE = "which cannot be hashed"  #: the end of an identity that says what of a sampler is not in it


def _same_samplers(parts: Sequence[tuple[Path, Mapping[str, Any]]]) -> None:
    """ValueError if a sampler of the same name is another one in another part."""
    first: dict[str, tuple[Path, str]] = {}
    for folder, index in parts:
        for name, identity in index["samplers"].items():
            at, known = first.setdefault(name, (folder, identity))
            if identity != known and not identity.endswith(UNHASHABLE) and not known.endswith(UNHASHABLE):
                raise ValueError(
                    f"{folder}: cannot be joined with {at}: the sampler '{name}' is {known} there and {identity} here; "
                    "expected parts of one experiment"
                )


def joined(parts: Sequence[str]) -> tuple[_crescent.RunResult, dict[str, str]]:
    """The result of parts of the seeds: the films of the first seed that has any, all times, and the references."""
    state = list(_crescent.join(list(parts)).__getstate__())
    folders = [path.parent if path.is_file() else path for path in map(Path, parts)]
    parts_with_arrays = [(folder, index) for folder in folders if (index := arrays_in(folder)) is not None]
    _same_samplers(parts_with_arrays)
    found = [index for _, index in parts_with_arrays]
    order = [row.split(",")[3] for row in str(state[3]).splitlines()[1:]]
    rank = {seed: k for k, seed in reversed(list(enumerate(order)))}
    films = sorted((film for index in found for film in index["films"]), key=lambda film: rank.get(str(film[3]), 0))
    first = {film[:3]: film for film in reversed(films)}
    state[7] = [film for film in films if first[film[:3]] is film]
    state[8] = list({s: (s, of) for index in found for s, of in index["references"]}.values())
    timed = [
        _timing(folder)
        if (index := arrays_in(folder)) is None
        else (index["times"], index["threads"], index["stages"])
        for folder in folders
    ]
    state[9] = [row for rows, _, _ in timed for row in rows]
    state[10] = max((threads for _, threads, _ in timed), default=0)
    seconds: dict[str, float] = {}
    for name, more in (stage for _, _, stages in timed for stage in stages):
        seconds[name] = seconds.get(name, 0.0) + more
    state[11] = list(seconds.items())
    return core_of(state), {name: identity for index in found for name, identity in index["samplers"].items()}
