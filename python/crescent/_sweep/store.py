"""The folder of a sweep: results by their identity, and the files derived from them.

    store/results/SCENE/ARM/FIRST-LAST.json   one arm, a block of seeds: metrics.json as text, and who computed it
    store/references/ID                       references of a scene
    store/studies/HASH.json                   furnaces and checks of one experiment
    store/checks/ID.json                      verdicts at one point
    data/*.parquet                            the dataset, a file for each result
    points/LABEL/                             metrics.json, metrics.csv of a finished point; films/ on request

Every file is written under another name and renamed, so it is complete or does not exist.
"""

from __future__ import annotations

import contextlib
import fcntl
import hashlib
import json
import os
import re
import socket
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any


def write_whole(path: Path, data: bytes | str) -> None:
    """Writes a file all at once."""
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(f".{path.name}.{socket.gethostname()}-{os.getpid()}.partial")
    try:
        with open(partial, "wb") as file:
            file.write(data.encode() if isinstance(data, str) else data)
            file.flush()
            os.fsync(file.fileno())
        partial.replace(path)
    except BaseException:
        partial.unlink(missing_ok=True)
        raise


_OLD_S = 86400.0  #: no file takes a day to write


def _left_behind(partial: Path) -> bool:
    """Whether no one writes this file any more: its process on this machine is gone, or it is a day old."""
    found = re.fullmatch(r".*\.(.+)-(\d+)\.partial", partial.name)
    if found and found[1] == socket.gethostname():
        try:
            os.kill(int(found[2]), 0)
        except ProcessLookupError:
            return True
        except (PermissionError, OverflowError):
            pass
    try:
        return time.time() - partial.stat().st_mtime > _OLD_S
    except OSError:
        return False


@contextlib.contextmanager
def locked(out: Path) -> Iterator[None]:
    """Holds the folder of a sweep, and removes what a killed process left unfinished. BlockingIOError: another sweep
    writes into it."""
    (out / "store").mkdir(parents=True, exist_ok=True)
    with open(out / "store" / "lock", "w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise BlockingIOError(None, "another sweep writes into this folder", str(out)) from None
        for partial in out.rglob(".*.partial"):
            if _left_behind(partial):
                partial.unlink(missing_ok=True)
        try:
            yield
        finally:
            with contextlib.suppress(OSError):  # of a call that wrote nothing no folder stays
                if sorted(path.name for path in out.rglob("*")) == ["lock", "store"]:
                    (out / "store" / "lock").unlink()
                    (out / "store").rmdir()
                    out.rmdir()


def _sum(data: bytes) -> bytes:
    return hashlib.sha256(data).digest()


def _checked_text(value: dict[str, Any]) -> str:
    """A result as JSON, with the checksum of its other values."""
    text = json.dumps({key: value[key] for key in value if key != "checksum"}, sort_keys=True)
    return json.dumps({**value, "checksum": _sum(text.encode()).hex()})


def _checked_json(path: Path) -> dict[str, Any] | None:
    """The value of _checked_text(); None if the file is missing, incomplete or was changed."""
    value = read_json(path)
    if not isinstance(value, dict):
        return None
    text = json.dumps({key: value[key] for key in value if key != "checksum"}, sort_keys=True)
    return value if value.get("checksum") == _sum(text.encode()).hex() else None


def read_json(path: Path) -> Any:
    """The value of a JSON file; None if there is none that can be read."""
    try:
        return json.loads(path.read_bytes())
    except (OSError, ValueError):
        return None


class Store:
    """Results by identity."""

    def __init__(self, out: Path) -> None:
        self.out = out
        self.root = out / "store"
        self._suspect: set[str] = set(read_json(self.root / "suspect.json") or [])
        self._good: dict[Path, tuple[int, int]] = {}  # files whose checksum was right, by time and size

    # ---- results of arms

    def _folder(self, scene: str, arm: str) -> Path:
        return self.root / "results" / scene / arm

    def blocks(self, scene: str, arm: str) -> list[tuple[int, int]]:
        """The blocks of seeds that exist, ascending, without suspect ones and incomplete or changed files."""
        out = []
        folder = self._folder(scene, arm)
        for name in os.listdir(folder) if folder.is_dir() else ():
            found = re.fullmatch(r"(\d+)-(\d+)\.json", name)
            if not found or self.key(scene, arm, name[:-5]) in self._suspect:
                continue
            if self._is_good(folder / name):
                out.append((int(found[1]), int(found[2])))
        return sorted(out)

    def _is_good(self, path: Path) -> bool:
        """Whether a result is as it was written; the file is read again if it has changed."""
        try:
            about = path.stat()
        except OSError:
            return False
        seen = (about.st_mtime_ns, about.st_size)
        if self._good.get(path) != seen and _checked_json(path) is None:
            return False
        self._good[path] = seen
        return True

    @staticmethod
    def key(scene: str, arm: str, block: str) -> str:
        """The name of a result."""
        return f"{scene}/{arm}/{block}"

    def add(self, scene: str, arm: str, first: int, last: int, result: dict[str, Any]) -> Path:
        """Writes a result."""
        path = self._folder(scene, arm) / f"{first}-{last}.json"
        write_whole(path, _checked_text(result))
        self._unsuspect(self.key(scene, arm, f"{first}-{last}"))
        return path

    def result(self, scene: str, arm: str, first: int, last: int) -> dict[str, Any] | None:
        """A result; None if it does not exist, or is incomplete or changed."""
        return _checked_json(self._folder(scene, arm) / f"{first}-{last}.json")

    def all_results(self) -> Iterator[tuple[str, str, int, int]]:
        """Every result: scene, arm, first and last seed; suspect ones too."""
        for path in sorted((self.root / "results").glob("*/*/*-*.json")):
            if found := re.fullmatch(r"(\d+)-(\d+)", path.stem):
                yield path.parent.parent.name, path.parent.name, int(found[1]), int(found[2])

    # ---- suspects

    def suspect(self) -> set[str]:
        """The names of results for which two workers computed different bits."""
        return set(self._suspect)

    def mark(self, keys: set[str]) -> None:
        """Marks results as suspect: the next call computes them again."""
        self._suspect |= keys
        write_whole(self.root / "suspect.json", json.dumps(sorted(self._suspect)))

    def _unsuspect(self, key: str) -> None:
        if key in self._suspect:
            self._suspect.discard(key)
            write_whole(self.root / "suspect.json", json.dumps(sorted(self._suspect)))

    # ---- references, studies, checks

    def reference_path(self, name: str) -> Path:
        """The path of the references with this identity."""
        return self.root / "references" / name

    def reference(self, name: str) -> bytes | None:
        """The references with this identity; None if they are missing, incomplete or changed."""
        try:
            data = self.reference_path(name).read_bytes()
        except OSError:
            return None
        return data[32:] if _sum(data[32:]) == data[:32] else None

    def has_reference(self, name: str) -> bool:
        """Whether there are references with this identity."""
        path = self.reference_path(name)
        try:
            about = path.stat()
        except OSError:
            return False
        seen = (about.st_mtime_ns, about.st_size)
        if self._good.get(path) != seen and self.reference(name) is None:
            return False
        self._good[path] = seen
        return True

    def add_reference(self, name: str, data: bytes) -> None:
        """Stores references, after their checksum."""
        write_whole(self.reference_path(name), _sum(data) + data)

    def studies(self, name: str) -> str | None:
        """The studies of an experiment, as the text of a metrics.json."""
        found = _checked_json(self.root / "studies" / f"{name}.json")
        return found["json"] if found else None

    def add_studies(self, name: str, result: dict[str, Any]) -> None:
        """Stores studies."""
        write_whole(self.root / "studies" / f"{name}.json", _checked_text(result))

    def check(self, name: str) -> dict[str, Any] | None:
        """The verdicts with this identity."""
        return _checked_json(self.root / "checks" / f"{name}.json")

    def add_check(self, name: str, result: dict[str, Any]) -> None:
        """Stores verdicts."""
        write_whole(self.root / "checks" / f"{name}.json", _checked_text(result))
