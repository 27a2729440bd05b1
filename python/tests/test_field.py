"""Faults of public projects: each is detected by the stated verdicts, and its fixed version passes."""

import os
from pathlib import Path

import pytest

from crescent.field import faults_in

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
    from crescent.field._shipped import LEFT_OUT, bsdfs, emitters

    page = FOLDER.parents[1] / "docs" / "field.md"
    if not page.is_file() or f"## What ships in Mitsuba {mi.__version__}\n" not in page.read_text():
        pytest.skip(f"docs/field.md was not written with Mitsuba {mi.__version__}")
    mi.set_variant("llvm_ad_rgb")
    manager = mi.PluginManager.instance()
    names = sorted(p.name.partition(".")[0] for p in (Path(mi.__file__).parent / "plugins").glob("*.so"))
    shipped = {n for n in names if manager.plugin_type(n) in (mi.ObjectType.BSDF, mi.ObjectType.Emitter)}
    checked = {
        part["type"] for it in bsdfs() + emitters() for part in (it.plugin, *it.plugin.values()) if type(part) is dict
    }
    left_out = {name for names in LEFT_OUT for name in names.split(", ")}
    assert len(shipped) > 30 and shipped <= checked | left_out, shipped - checked - left_out
    assert not left_out & checked


def test_the_program_tells_before_the_work_what_it_cannot_do_and_judges_one_plugin(tmp_path, monkeypatch, capsys):
    pytest.importorskip("mitsuba")
    from crescent.field.__main__ import main

    monkeypatch.chdir(tmp_path)
    for words, said in (
        (["--only", "difuse"], "did you mean 'diffuse'?"),
        (["--out", "none/field.md"], "there is no folder none"),
        (["--faults", "none"], "none: no such folder"),
    ):
        assert main(words) == 2
        assert said in capsys.readouterr().err
    assert main(["--only", "diffuse"]) == 0
    assert "| `diffuse: reflectance = rgb` | right | - |" in (tmp_path / "field.md").read_text()
