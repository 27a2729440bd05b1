"""Results as they are stored: what was checked and how, nine verdicts, the sizes that would have been found, and what
was found. Their code is not stored."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from .. import _crescent

VERDICTS = ("valid", "support", "normalised", "density", "identity", "physics", "tail", "mean", "efficiency")
_WORST = ("right", "skipped", "inconclusive", "error", "wrong")

#: The sizes of a verdict's evidence, and how they are said; another one by its name.
SIZES = {
    "constant": "factor {} %",
    "leak": "uniform {} %",
    "cap": "gap {} %",
    "gap": "gap {} %",
    "parameter": "exponent {} %",
    "rotation": "turn {} rad",
}


@dataclass
class Finding:
    """Verdicts that are not right and have one explanation."""

    verdicts: list[str]
    at: str  #: w_o
    message: str
    cause: str = ""  #: as the check says it
    kind: str = "open"  #: "bug", "corner", "the model", ...
    because: str = ""  #: the explanation, checked against the source
    script: str = ""  #: shows it without crescent
    output: str = ""  #: of the script
    report: str = ""  #: draft of a report to the project


@dataclass
class Result:
    """One implementation of a sampler."""

    project: str
    what: str
    revision: str = ""
    repository: str = ""
    file: str = ""
    language: str = ""
    connection: str = ""  #: the call: snippets or adapter
    stubs: str = ""  #: what replaces code that was left out
    state: str = ""
    verdicts: dict[str, str] = field(default_factory=dict)
    sizes: dict[str, float] = field(default_factory=dict)
    findings: list[Finding] = field(default_factory=list)


def worst(states: Iterable[str]) -> str:
    """The state of a verdict over all w_o; skipped only if it is so at each."""
    given = [s for s in states if s != "skipped"]
    return max(given, key=_WORST.index) if given else "skipped"


def summary(verdicts: Iterable[Mapping[str, Any]]) -> tuple[dict[str, str], dict[str, float]]:
    """(state by name, largest size by name) of the verdicts of `crescent check --json`."""
    states: dict[str, list[str]] = {}
    sizes: dict[str, float] = {}
    for v in verdicts:
        states.setdefault(v["name"], []).append(v["state"])
        for name, size in v.get("evidence", {}).get("would_have_found", {}).items():
            if isinstance(size, (int, float)):
                sizes[name] = max(sizes.get(name, 0.0), float(f"{size:.3g}"))
    return {name: worst(states.get(name, [])) for name in VERDICTS}, sizes


def load(file: Path) -> list[Result]:
    """Returns the results of a file."""
    return [Result(**{**r, "findings": [Finding(**f) for f in r["findings"]]}) for r in json.loads(file.read_text())]


def store(file: Path, results: Iterable[Result]) -> None:
    """Writes a file of results: equal results give equal bytes."""
    rows = []
    for result in results:
        row = {k: v for k, v in asdict(result).items() if v}
        row["findings"] = [{k: v for k, v in asdict(f).items() if v} for f in result.findings]
        rows.append(row)
    _crescent.write_whole(str(file), json.dumps(rows, indent=1, ensure_ascii=False) + "\n")
