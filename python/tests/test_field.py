"""Faults of public projects: each is detected by the stated verdicts, and its fixed version passes."""

import os
from pathlib import Path

import pytest

from crescent.field import faults_in
from crescent.field.__main__ import REPLAYS, main
from crescent.field._replays import load_replays
from crescent.field._results import VERDICTS, load, summary

FOLDER = Path(os.environ.get("CRESCENT_FIELD", Path(__file__).resolve().parents[2] / "tests" / "field"))
FAULTS = faults_in(FOLDER) if FOLDER.is_dir() else []


def test_there_are_forty_at_least_each_with_its_source():
    if not FAULTS:
        pytest.skip("the repository's tests/field is not here")
    assert len(FAULTS) >= 40 and len({f.name for f in FAULTS}) == len(FAULTS)
    assert all(f.source.startswith("https://") and f.caught_by for f in FAULTS)


@pytest.mark.parametrize("fault", FAULTS, ids=lambda f: f.name)
def test_a_fault_is_caught_and_mended_it_is_right(fault):
    try:
        broken = fault.checked().broken()
    except RuntimeError as missing:  # a driver or a compiler of shaders
        pytest.skip(str(missing))
    assert set(fault.caught_by) <= set(broken), broken
    assert fault.checked(fixed=True).state == "right", str(fault.checked(fixed=True))


def test_every_bsdf_and_emitter_that_ships_is_judged_or_left_out_with_a_reason():
    mi = pytest.importorskip("mitsuba")
    from crescent.field._page import LEFT_OUT
    from crescent.field._shipped import bsdfs, emitters

    stored = FOLDER / "results" / "mitsuba.json"
    if not stored.is_file() or load(stored)[0].revision != mi.__version__:
        pytest.skip(f"the stored results are not of Mitsuba {mi.__version__}")
    mi.set_variant("llvm_ad_rgb")
    manager = mi.PluginManager.instance()
    names = sorted(p.name.partition(".")[0] for p in (Path(mi.__file__).parent / "plugins").glob("*.so"))
    shipped = {n for n in names if manager.plugin_type(n) in (mi.ObjectType.BSDF, mi.ObjectType.Emitter)}
    checked = {
        part["type"] for it in bsdfs() + emitters() for part in (it.plugin, *it.plugin.values()) if type(part) is dict
    }
    left_out = {
        name for names in LEFT_OUT if names.startswith("Mitsuba 3: ") for name in names.partition(": ")[2].split(", ")
    }
    assert len(shipped) > 30 and shipped <= checked | left_out, shipped - checked - left_out
    assert not left_out & checked


def test_the_page_is_made_from_the_stored_results(tmp_path):
    if not (FOLDER / "results").is_dir():
        pytest.skip("the repository's tests/field/results is not here")
    assert main(["--faults", str(FOLDER), "--out", str(tmp_path / "field.md")]) == 0
    assert (tmp_path / "field.md").read_text() == (FOLDER.parents[1] / "docs" / "field.md").read_text()


def test_thirty_implementations_are_stored_and_every_fault_was_replayed():
    if not (FOLDER / "results").is_dir():
        pytest.skip("the repository's tests/field/results is not here")
    stored = [r for file in (FOLDER / "results").glob("*.json") if file.name != REPLAYS for r in load(file)]
    assert len(stored) >= 30 and len({r.project for r in stored}) >= 5
    assert all(set(r.verdicts) == set(VERDICTS) and r.revision and r.connection for r in stored)
    shaders = {(r.project, r.file) for r in stored if r.language in ("GLSL", "HLSL", "WGSL", "Slang")}
    assert len(shaders) >= 10
    bugs = [f for r in stored for f in r.findings if f.kind == "bug"]
    shown = {f.because for f in bugs if f.script and f.output and f.report}  # once, where it was first found
    assert bugs and all(f.because in shown for f in bugs)
    assert [r.name for r in load_replays(FOLDER / "results" / REPLAYS)] == [f.name for f in FAULTS]


def test_a_verdict_of_several_wo_is_the_worst_and_a_size_the_largest():
    found = {"would_have_found": {"constant": 0.25}}
    states, sizes = summary(
        [
            {"name": "mean", "state": "right", "evidence": found},
            {"name": "mean", "state": "wrong", "evidence": {"would_have_found": {"constant": 0.5}}},
            {"name": "tail", "state": "skipped", "evidence": {}},
        ]
    )
    assert (states["mean"], states["tail"], sizes) == ("wrong", "skipped", {"constant": 0.5})


def test_the_program_tells_before_the_work_what_it_cannot_do_and_checks_one_plugin(tmp_path, monkeypatch, capsys):
    pytest.importorskip("mitsuba")
    monkeypatch.chdir(tmp_path)
    Path("own/results").mkdir(parents=True)
    for words, said in (
        (["--faults", "own", "--out", "field.md", "--mitsuba", "difuse"], "did you mean 'diffuse'?"),
        (["--faults", "own", "--out", "none/field.md"], "there is no folder none"),
        (["--faults", "none"], "there is no folder none"),
    ):
        assert main(words) == 2
        assert said in capsys.readouterr().err
    assert main(["--faults", "own", "--out", "field.md", "--mitsuba", "diffuse"]) == 0
    assert "| diffuse: reflectance = rgb | ✓ |" in Path("field.md").read_text()
