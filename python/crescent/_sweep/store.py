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

import json
import os
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any


def write_whole(path: Path, data: bytes | str) -> None:
    """Writes a file all at once."""
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(f".{path.name}.{os.getpid()}.partial")
    try:
        with open(partial, "wb") as file:
            file.write(data.encode() if isinstance(data, str) else data)
            file.flush()
            os.fsync(file.fileno())
        partial.replace(path)
    except BaseException:
        partial.unlink(missing_ok=True)
        raise


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

    # ---- results of arms

    def _folder(self, scene: str, arm: str) -> Path:
        return self.root / "results" / scene / arm

    def blocks(self, scene: str, arm: str) -> list[tuple[int, int]]:
        """The blocks of seeds that exist, ascending, without suspect ones."""
        out = []
        folder = self._folder(scene, arm)
        for name in os.listdir(folder) if folder.is_dir() else ():
            if (found := re.fullmatch(r"(\d+)-(\d+)\.json", name)) and self.key(
                scene, arm, name[:-5]
            ) not in self._suspect:
                out.append((int(found[1]), int(found[2])))
        return sorted(out)

    @staticmethod
    def key(scene: str, arm: str, block: str) -> str:
        """The name of a result."""
        return f"{scene}/{arm}/{block}"

    def add(self, scene: str, arm: str, first: int, last: int, result: dict[str, Any]) -> Path:
        """Writes a result."""
        path = self._folder(scene, arm) / f"{first}-{last}.json"
        write_whole(path, json.dumps(result))
        self._unsuspect(self.key(scene, arm, f"{first}-{last}"))
        return path

    def result(self, scene: str, arm: str, first: int, last: int) -> dict[str, Any] | None:
        """A result; None if it does not exist or cannot be read."""
        found = read_json(self._folder(scene, arm) / f"{first}-{last}.json")
        return found if isinstance(found, dict) else None

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
        """The references with this identity."""
        try:
            return self.reference_path(name).read_bytes()
        except OSError:
            return None

    def add_reference(self, name: str, data: bytes) -> None:
        """Stores references."""
        write_whole(self.reference_path(name), data)

    def studies(self, name: str) -> str | None:
        """The studies of an experiment, as the text of a metrics.json."""
        found = read_json(self.root / "studies" / f"{name}.json")
        return found["json"] if found else None

    def add_studies(self, name: str, result: dict[str, Any]) -> None:
        """Stores studies."""
        write_whole(self.root / "studies" / f"{name}.json", json.dumps(result))

    def check(self, name: str) -> dict[str, Any] | None:
        """The verdicts with this identity."""
        found = read_json(self.root / "checks" / f"{name}.json")
        return found if isinstance(found, dict) else None

    def add_check(self, name: str, result: dict[str, Any]) -> None:
        """Stores verdicts."""
        write_whole(self.root / "checks" / f"{name}.json", json.dumps(result))
