"""The folder of a sweep.

    data/SCENE-ARM-FIRST-LAST-POINT-CHECKSUM.parquet   one arm, a block of seeds (dataset.py)
    data/ID-CHECKSUM.parquet                           verdicts at one point
    store/results/                                     such files of other points
    store/references/ID                                references of a scene
    store/studies/ID                                   furnaces and checks of one experiment, as a metrics.json
    store/tasks/ID.task                                tasks of --engine commands
    points/LABEL/                                      metrics.json, metrics.csv of a finished point; films/ on request

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


def read_json(path: Path) -> Any:
    """The value of a JSON file; None if there is none that can be read."""
    try:
        return json.loads(path.read_bytes())
    except (OSError, ValueError):
        return None


class Store:
    """References and studies by identity, each after its checksum."""

    def __init__(self, out: Path) -> None:
        self.out = out
        self.root = out / "store"
        self._whole: dict[Path, tuple[int, int]] = {}  # files whose checksum was right, by time and size

    def read(self, kind: str, name: str) -> bytes | None:
        """What is stored; None if it is missing, incomplete or changed."""
        try:
            data = (self.root / kind / name).read_bytes()
        except OSError:
            return None
        return data[32:] if _sum(data[32:]) == data[:32] else None

    def has(self, kind: str, name: str) -> bool:
        """Whether there is such a file as it was written; it is read again if it has changed."""
        path = self.root / kind / name
        try:
            found = path.stat()
        except OSError:
            return False
        seen = (found.st_mtime_ns, found.st_size)
        if self._whole.get(path) != seen and self.read(kind, name) is None:
            return False
        self._whole[path] = seen
        return True

    def add(self, kind: str, name: str, data: bytes) -> None:
        """Stores data of the kinds "references" and "studies"."""
        write_whole(self.root / kind / name, _sum(data) + data)
