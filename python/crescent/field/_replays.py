"""Public reports of faults, replayed before and after their fix, as results that are stored."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

from .. import _crescent
from ._faults import Fault


@dataclass
class Replay:
    """A fault, what the check says of it, and of its fix."""

    name: str
    project: str
    source: str
    says: str
    found_by: list[str]
    message: str  #: of the first verdict that is said to find it
    cause: str
    corrected: str  #: the state of the fixed sampler


def replayed(faults: Iterable[Fault]) -> Iterator[Replay]:
    """Checks each fault and its fix."""
    for fault in faults:
        result = fault.checked()
        found = [v for v in result.wrong() if v.name in fault.caught_by]
        first = next((v for v in found if v.cause), found[0] if found else None)
        yield Replay(
            fault.name,
            fault.project,
            fault.source,
            fault.says,
            list(result.broken()),
            first.message if first else "",
            first.cause if first else "",
            fault.checked(fixed=True).state,
        )
        print(f"{fault.name}: {', '.join(result.broken())}", file=sys.stderr, flush=True)


def load_replays(file: Path) -> list[Replay]:
    """Returns the replays of a file."""
    return [Replay(**r) for r in json.loads(file.read_text())]


def store_replays(file: Path, replays: Iterable[Replay]) -> None:
    """Writes the replays."""
    text = json.dumps([asdict(r) for r in replays], indent=1, ensure_ascii=False)
    _crescent.write_whole(str(file), text + "\n")
