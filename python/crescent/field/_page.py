"""docs/field.md, from stored results."""

from __future__ import annotations

from collections.abc import Iterator

from ._replays import Replay
from ._results import SIZES, VERDICTS, Finding, Result

MARKS = {"right": "✓", "wrong": "✗", "inconclusive": "?", "error": "!", "skipped": "-"}

#: What could not be connected, and why.
LEFT_OUT = {
    "Mitsuba 3: measured, measured_polarized": "need a file of measurements, which the package does not include",
    "Mitsuba 3: point, spot, directional, directionalarea, projector": "emit from one direction: there is no density",
    "nvpro_core2: bsdfSample and bsdfEvaluate of dielectrics": "bsdfEvaluate chooses one lobe by a random number of its "
    "own, so that pdf and f of two directions are random; its simple model is checked instead",
    "Bevy: evaluate_and_sample_brdf": "reads a table of albedos from a texture",
    "GLSL-PathTracer: envmap.glsl": "reads its table of cumulative sums from a texture",
    "Capsaicin: sampleBRDF": "HLSL templates, which glslangValidator does not know",
    "Falcor: StandardBSDF, HairChiang16, ClothBRDF": "not tried: they import the scene's shading data",
    "Falcor and RTXPT: light trees, emissive lights": "not tried: they read buffers of the scene",
    "LuisaRender, lajolla, SmallVCM's Bsdf": "not tried: classes over the types of the renderer",
    "pbrt-v4, Nori, OpenPBR": "connected by the C++ adapters at an earlier time, see [python.md](python.md)",
    "yocto-gl": "its repository was too large to fetch here",
}


def _percent(name: str, size: float) -> str:
    return SIZES.get(name, name + " {} %").format(f"{size if name == 'rotation' else 100 * size:.2g}")


def _row(r: Result) -> str:
    marks = " | ".join(MARKS[r.verdicts.get(name, "skipped")] for name in VERDICTS)
    sizes = ", ".join(_percent(name, r.sizes[name]) for name in dict.fromkeys((*SIZES, *r.sizes)) if name in r.sizes)
    return f"| {r.what} | {marks} | {sizes or '-'} |"


def _table(results: list[Result]) -> str:
    head = "| what | " + " | ".join(VERDICTS) + " | would have been found |"
    return "\n".join([head, "|---" * (len(VERDICTS) + 2) + "|", *(_row(r) for r in results)])


def _finding(r: Result, f: Finding) -> Iterator[str]:
    yield f"#### {r.project}, `{r.what}`: {', '.join(f.verdicts)}"
    yield f"*{f.kind}*. At {f.at}. {f.message}" + (f"\n\nCause, as the check says it: {f.cause}" if f.cause else "")
    if f.because:
        yield f.because
    if f.script:
        yield f"```python\n{f.script}\n```\n```text\n{f.output}\n```"
    if f.report:
        yield f"> Draft of a report to {r.repository or r.project}. {f.report}"


def _connections(results: list[Result]) -> str:
    """How each was connected, and what replaces code that was left out, once each."""
    lines = []
    told = ""
    for r in results:
        stubs = "" if r.stubs == told else f" Stubs: {r.stubs}."
        told = r.stubs
        lines.append(f"* `{r.file}`, {r.what}: `{r.connection}`.{stubs}")
    return "<details><summary>How they were connected</summary>\n\n" + "\n".join(lines) + "\n\n</details>"


def _replayed(replays: list[Replay]) -> str:
    rows = ["| fault | project | found by | what the check says | corrected |", "|---|---|---|---|---|"]
    for r in replays:
        says = f"{r.message} *{r.cause}*" if r.cause else r.message
        rows.append(
            f"| {r.name}: {r.says} | [{r.project}]({r.source}) | {', '.join(r.found_by)} | {says} | {r.corrected} |"
        )
    return "\n".join(rows)


def page(results: list[Result], replays: list[Replay]) -> Iterator[str]:
    """Returns the paragraphs of the page."""
    projects: dict[str, list[Result]] = {}
    for r in results:
        projects.setdefault(r.project, []).append(r)
    right = sum(r.state == "right" for r in results)
    bugs = {f.because for r in results for f in r.findings if f.kind == "bug"}
    shaders = [r for r in results if r.language in ("GLSL", "HLSL", "WGSL", "Slang")]
    yield "# The state of the field"
    yield (
        f"{len(results)} implementations of samplers in {len(projects)} public projects, checked by nine verdicts: "
        f"{right} are right, {len(bugs)} bugs were found. {len(shaders)} are functions in "
        f"{len({(r.project, r.file) for r in shaders})} shader files, checked as they are. And {len(replays)} public "
        "reports of faults, replayed before and after their fix."
    )
    yield "The page is made from the results in `tests/field/results`:"
    yield "```sh\npython -m crescent.field\n```"
    yield "Not run in the tests: writes into the repository."
    yield (
        "`--mitsuba` checks the plugins of Mitsuba again and stores what was found, `--replay` the public reports. The "
        "others were fetched, read, checked outside the repository by `crescent check`, and their results stored; their "
        "code is not here. Verdicts are those of [check.md](check.md), with alpha = 0.001 for each row: ✓ right, ✗ "
        "wrong, ? inconclusive, - not examined, since f or a weight is not there. The last column says what would have "
        "been found with a probability of 90 %: a constant factor of p, a share of uniform draws, a gap in the draws, "
        "another exponent, a turn."
    )
    yield (
        "Kinds of findings: *bug*; *known upstream*; *no picture changes*: sample and pdf differ where f is 0; "
        "*corner*: at random numbers or directions that occur very rarely; *approximation*: the code uses a simpler "
        "formula or a fit; *single precision*; *the model*: the model defines it so; *open*: not decided."
    )
    rows = ["| project | revision | language | implementations | right | findings |", "|---|---|---|---|---|---|"]
    for name, mine in projects.items():
        kinds: dict[str, int] = {}
        for r in mine:
            for kind in {f.kind for f in r.findings}:
                kinds[kind] = kinds.get(kind, 0) + 1
        told = ", ".join(f"{kind} ({n})" for kind, n in sorted(kinds.items()))
        one = mine[0]
        project = f"[{name}](https://github.com/{one.repository})" if one.repository else name
        revision = one.revision[:12] if len(one.revision) == 40 else one.revision
        rows.append(
            f"| {project} | {revision} | {one.language} | {len(mine)} | {sum(r.state == 'right' for r in mine)} "
            f"| {told or '-'} |"
        )
    yield "\n".join(rows)
    yield "## What was found"
    yield "Each explanation once, where it was first found; bugs first."
    told_before: set[str] = set()
    found = [(r, f) for r in results for f in r.findings]
    for r, f in sorted(found, key=lambda pair: pair[1].kind != "bug"):
        key = f.because or f"{r.project} {r.what} {f.verdicts}"
        if key not in told_before:
            yield from _finding(r, f)
            told_before.add(key)
    yield "## Every verdict"
    for name, mine in projects.items():
        yield f"### {name}"
        yield _table(mine)
        if name != "Mitsuba 3":
            yield _connections(mine)
    yield "## Not connected"
    yield "\n".join(["| what | why |", "|---|---|", *(f"| {what} | {why} |" for what, why in LEFT_OUT.items())])
    yield "## Faults of public projects, reimplemented"
    yield (
        "Each is a sampler of a few lines in `tests/field/`, written from the public description behind its link, "
        "together with the corrected sampler. The tests check that the named verdicts find the fault and that the "
        "corrected sampler is right."
    )
    yield _replayed(replays)
