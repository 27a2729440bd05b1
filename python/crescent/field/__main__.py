"""``python -m crescent.field``: checks the plugins of Mitsuba 3 and the faults of tests/field, and writes
docs/field.md.

    python -m crescent.field [--faults FOLDER] [--out FILE] [--only PLUGIN ...]

Needs mitsuba from PyPI. Equal versions give equal texts.
"""

from __future__ import annotations

import argparse
import difflib
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import crescent
from crescent.adapters import mitsuba, mitsuba_emitter

from ._faults import Fault, faults_in
from ._notes import Note, note_on
from ._scripts import output_of, script_for
from ._shipped import ABOVE, BELOW, LEFT_OUT, Shipped, bsdfs, emitters

OPEN = ("wrong", "inconclusive", "error")


@dataclass(frozen=True)
class Finding:
    """The verdicts of one name on one plugin that have one explanation."""

    it: Shipped
    verdicts: tuple[crescent.Verdict, ...]
    note: Note | None

    def kind(self) -> str:
        return self.note.kind if self.note else "open"


def checked(it: Shipped) -> crescent.CheckResult:
    """Checks one plugin over the field's w_o."""
    if it.kind == "emitter":
        return crescent.check(mitsuba_emitter(it.built(), **it.known))
    sampler = mitsuba(it.built(), **it.known)
    return crescent.check(sampler, wo_deg=ABOVE + (BELOW if sampler.wo == "both" else []))


def findings(it: Shipped, result: crescent.CheckResult) -> list[Finding]:
    """Returns the failures, by verdict and explanation; the first verdict of each is the worst w_o's or the first."""
    groups: dict[tuple[str, str], list[crescent.Verdict]] = {}
    notes: dict[tuple[str, str], Note | None] = {}
    for v in result:
        if v.state in OPEN and v.name != "efficiency":
            note = note_on(it.title(), v)
            key = (v.name, note.because if note else "")
            groups.setdefault(key, []).append(v)
            notes[key] = note
    return [Finding(it, tuple(vs), notes[key]) for key, vs in groups.items()]


def _wo_of(case: str) -> tuple[float, float, float]:
    found = re.match(r"w_o ([\d.]+) deg(?: az ([\d.]+))?", case)
    theta, azimuth = (np.radians(float(v or 0)) for v in found.groups()) if found else (0.0, 0.0)
    return float(np.sin(theta) * np.cos(azimuth)), float(np.sin(theta) * np.sin(azimuth)), float(np.cos(theta))


def _corner(say: str) -> tuple[float, float, float] | None:
    found = re.search(r"at u = \(([^)]*)\)", say)
    numbers = [float(v) for v in found.group(1).split(",")] if found else []
    return (numbers[0], numbers[1], numbers[2]) if len(numbers) == 3 else None


def _section(finding: Finding) -> Iterator[str]:
    first = finding.verdicts[0]
    cases = ", ".join(v.case for v in finding.verdicts)
    yield f"### `{finding.it.title()}`: {first.name}, {finding.kind()}"
    yield f"At {cases}. {first.say}"
    if finding.note:
        yield finding.note.because
    own = finding.note.script if finding.note else ""
    if own or (finding.it.kind == "bsdf" and first.name != "identity"):
        corner = _corner(first.say) if first.name == "valid" else None
        script = own or script_for(finding.it, first.name, _wo_of(first.case), corner)
        yield f"```python\n{script}\n```\n```text\n{output_of(script)}\n```"


def _shipped_text(only: list[str]) -> Iterator[str]:
    import mitsuba as mi

    mi.set_variant("llvm_ad_rgb")
    table = ["| plugin | state | faults found |", "|---|---|---|"]
    sections: dict[str, Finding] = {}
    for it in bsdfs() + emitters():
        if only and it.plugin["type"] not in only:
            continue
        result = checked(it)
        found = findings(it, result)
        print(f"{it.title()}: {result.state} {result.broken()}", file=sys.stderr, flush=True)
        told = "; ".join(f"{f.verdicts[0].name}: {f.kind()}" for f in found)
        table.append(f"| `{it.title()}` | {result.state} | {told or '-'} |")
        # One section per explanation, at the plugin where it is first found, by a verdict that a script shows; one per
        # bug.
        for f in sorted(found, key=lambda f: f.verdicts[0].name == "identity"):
            sections.setdefault(f.note.because if f.note else f"{it.title()} {f.verdicts[0].name}", f)
    yield f"## What ships in Mitsuba {mi.__version__}"
    yield "\n".join(table)
    yield "Not checked: " + "; ".join(f"{names} ({why})" for names, why in LEFT_OUT.items()) + "."
    yield "## Explanations"
    for finding in sections.values():
        yield from _section(finding)


def _faults_text(faults: list[Fault]) -> Iterator[str]:
    yield "## Faults of public projects, reimplemented"
    yield (
        "Each is a sampler of a few lines in `tests/field/`, written from the public description behind its link, "
        "together with the corrected sampler. The tests check that the named verdicts find the fault and that the "
        "corrected sampler is right."
    )
    rows = ["| fault | project | found by | corrected |", "|---|---|---|---|"]
    for fault in faults:
        caught, fixed = ", ".join(fault.checked().broken()), fault.checked(fixed=True).state
        rows.append(f"| {fault.name}: {fault.says} | [{fault.project}]({fault.source}) | {caught} | {fixed} |")
        print(f"{fault.name}: {caught}", file=sys.stderr, flush=True)
    yield "\n".join(rows)


def _before_the_work(out: Path, only: list[str]) -> None:
    """Raises early the ImportError or ValueError that would otherwise come after minutes."""
    try:
        import mitsuba as mi
    except ImportError:
        raise ImportError("mitsuba is not here: pip install 'crescent[mitsuba]'") from None
    mi.set_variant("llvm_ad_rgb")
    if not out.parent.is_dir():
        raise ValueError(f"--out {out}: there is no folder {out.parent}")
    checked = {it.plugin["type"] for it in bsdfs() + emitters()}
    for word in only:
        if word not in checked:
            near = difflib.get_close_matches(word, checked, 1)
            raise ValueError(f"--only {word}: no such plugin" + (f"; did you mean '{near[0]}'?" if near else ""))


def main(argv: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser("python -m crescent.field", description=(__doc__ or "").partition("\n\n")[0])
    parser.add_argument("--faults", metavar="FOLDER", help="tests/field where it is there")
    parser.add_argument("--out", metavar="FILE", help="docs/field.md, or field.md where there is no docs")
    parser.add_argument("--only", nargs="*", default=[], metavar="PLUGIN", help="these plugins alone")
    args = parser.parse_args(argv)
    out = Path(args.out or ("docs/field.md" if Path("docs").is_dir() else "field.md"))
    faults = args.faults or ("tests/field" if Path("tests/field").is_dir() else None)
    try:
        _before_the_work(out, args.only)
        known = faults_in(faults) if faults else []
    except (ValueError, ImportError) as e:
        print(e, file=sys.stderr)
        return 2
    parts = [
        "# Survey of public samplers",
        "Checks every BSDF and emitter that ships in Mitsuba 3, and reimplementations of faults of public projects. "
        "Written by",
        "```sh\npython -m crescent.field      # after pip install '.[mitsuba]'\n```",
        "Not run in the tests: needs Mitsuba and several minutes.",
        "Verdicts are those of [check.md](check.md) at four w_o above the surface and three below; levels are shared "
        "within a plugin at alpha = 0.001. A draw of weight 0 is taken as no draw, unless its pdf agrees with pdf(w) "
        "and eval is 0 there. Kinds of faults: *bug*; *no picture changes*: sample and pdf differ where eval is 0; "
        "*corner*: at random numbers that occur very rarely; *approximation*: the code uses a fit with a stated "
        "error; *single precision*; *the model*: the model defines it so; *open*: not decided.",
        *_shipped_text(args.only),
        *(_faults_text(known) if known else []),
    ]
    crescent._crescent.write_whole(str(out), "\n\n".join(parts) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
