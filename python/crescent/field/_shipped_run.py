"""The plugins of Mitsuba 3, checked, as results."""

from __future__ import annotations

import sys
from collections.abc import Iterator

import numpy as np

import crescent
from crescent.adapters import mitsuba, mitsuba_emitter

from ._notes import Note, note_on
from ._results import Finding, Result, summary
from ._scripts import output_of, script_for
from ._shipped import ABOVE, BELOW, Shipped, bsdfs, emitters

OPEN = ("wrong", "inconclusive", "error")


def checked(it: Shipped) -> crescent.CheckResult:
    """Checks one plugin over the field's w_o."""
    if it.kind == "emitter":
        return crescent.check(mitsuba_emitter(it.built(), **it.known))
    sampler = mitsuba(it.built(), **it.known)
    return crescent.check(sampler, wo_deg=ABOVE + (BELOW if sampler.wo == "both" else []))


def _wo_of(verdict: crescent.Verdict) -> tuple[float, float, float]:
    theta, azimuth = np.radians(verdict.wo_deg or (0.0, 0.0))
    return float(np.sin(theta) * np.cos(azimuth)), float(np.sin(theta) * np.sin(azimuth)), float(np.cos(theta))


def _corner(verdict: crescent.Verdict) -> tuple[float, float, float] | None:
    numbers = verdict.evidence.get("first_u", [])
    return (numbers[0], numbers[1], numbers[2]) if len(numbers) == 3 else None


def _findings(it: Shipped, result: crescent.CheckResult, shown: set[str]) -> Iterator[Finding]:
    """One finding for each explanation; a script where it was not shown before."""
    groups: dict[str, list[crescent.Verdict]] = {}
    notes: dict[str, Note | None] = {}
    for v in result:
        if v.state in OPEN and v.name != "efficiency":
            note = note_on(it.title(), v)
            key = note.because if note else v.name
            groups.setdefault(key, []).append(v)
            notes[key] = note
    for key, verdicts in groups.items():
        # A verdict that a script shows comes first.
        first = sorted(verdicts, key=lambda v: v.name == "identity")[0]
        note = notes[key]
        finding = Finding(
            list(dict.fromkeys(v.name for v in verdicts)),
            ", ".join(dict.fromkeys(v.case for v in verdicts)),
            first.message,
            first.cause,
            note.kind if note else "open",
            note.because if note else "",
            report=note.report if note else "",
        )
        own = note.script if note else ""
        if key not in shown and (own or (it.kind == "bsdf" and first.name != "identity")):
            corner = _corner(first) if first.name == "valid" else None
            finding.script = own or script_for(it, first.name, _wo_of(first), corner)
            finding.output = output_of(finding.script)
        shown.add(key)
        yield finding


def shipped(only: list[str]) -> Iterator[Result]:
    """Checks every plugin, or these."""
    import mitsuba as mi

    mi.set_variant("llvm_ad_rgb")
    shown: set[str] = set()
    for it in bsdfs() + emitters():
        if only and it.plugin["type"] not in only:
            continue
        result = checked(it)
        print(f"{it.title()}: {result.state} {result.broken()}", file=sys.stderr, flush=True)
        verdicts, sizes = summary([{"name": v.name, "state": v.state, "evidence": v.evidence} for v in result])
        yield Result(
            "Mitsuba 3",
            it.title(),
            str(mi.__version__),
            "mitsuba-renderer/mitsuba3",
            f"src/{'bsdfs' if it.kind == 'bsdf' else 'emitters'}/{it.plugin['type']}",
            "Python",
            "crescent.adapters.mitsuba" + ("_emitter" if it.kind == "emitter" else ""),
            state=result.state,
            verdicts=verdicts,
            sizes=sizes,
            findings=list(_findings(it, result, shown)),
        )
