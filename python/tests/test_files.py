"""Samplers in files: such a file may import what pytest's import mode "prepend" allows a test."""

import sys

import pytest
from test_testing import LOAD

import crescent
from crescent.testing import Session, assert_sampler, begin_session

pytest_plugins = ["pytester"]
HELPER = """
import numpy as np

def cosine(wo, u):
    r, phi = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1]
    z = np.sqrt(1 - u[:, 0])
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], -1), z / np.pi
"""
SAMPLER = """
import numpy as np
from {helper} import cosine as sample

def pdf(wo, wi):
    return np.maximum(wi[:, 2], 0) / np.pi

class Off:
    sample = staticmethod(sample)
    pdf = staticmethod(lambda wo, wi: 1.05 * pdf(wo, wi))
"""


@pytest.fixture
def own_path(monkeypatch):
    """Restores the path and the modules after the test."""
    monkeypatch.setattr(sys, "path", list(sys.path))
    before = set(sys.modules)
    yield
    for name in set(sys.modules) - before:
        if name.partition(".")[0] in ("beside", "own", "package"):
            del sys.modules[name]


def test_a_file_imports_what_lies_beside_it(tmp_path, own_path):
    (tmp_path / "beside.py").write_text(HELPER)
    (tmp_path / "own.py").write_text(SAMPLER.format(helper="beside"))
    at = tmp_path / "own.py"
    right = crescent.check(f"{at}", wo_deg=[30])
    assert right.state == "right" and right.verdicts[0].sampler == "own"
    assert "normalised" in crescent.check(f"{at}:Off", wo_deg=[30]).broken()
    assert sys.path[0] == str(tmp_path) and sys.modules["own"].__file__ == str(at)
    for where, said in ((f"{at}:Of", "did you mean 'Off'"), (f"{tmp_path}/onw.py", "did you mean .*own.py")):
        with pytest.raises(ValueError, match=said):
            crescent.check(where)


def test_a_file_in_a_package_is_imported_from_above_it(tmp_path, own_path):
    inside = tmp_path / "package" / "samplers"
    inside.mkdir(parents=True)
    for folder in (inside, inside.parent):
        (folder / "__init__.py").write_text("")
    (inside.parent / "helper.py").write_text(HELPER)
    (inside / "own.py").write_text(SAMPLER.format(helper="..helper"))
    assert crescent.check(str(inside / "own.py"), wo_deg=[30]).state == "right"
    assert sys.path[0] == str(tmp_path) and "package.samplers.own" in sys.modules


def test_two_files_of_one_module_name_are_an_error(tmp_path, own_path):
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "beside.py").write_text(HELPER)
        (tmp_path / folder / "own.py").write_text(SAMPLER.format(helper="beside"))
    assert crescent.check(str(tmp_path / "a" / "own.py"), wo_deg=[30]).state == "right"
    with pytest.raises(ValueError, match="the module 'own' is .*a.own.py already"):
        crescent.check(str(tmp_path / "b" / "own.py"))


def test_assert_sampler_looks_for_files_from_the_root_of_the_session(tmp_path, own_path):
    (tmp_path / "beside.py").write_text(HELPER)
    (tmp_path / "own.py").write_text(SAMPLER.format(helper="beside"))
    begin_session(Session(root=tmp_path))
    try:
        assert assert_sampler("own.py", wo_deg=[30]).state == "right"
        with pytest.raises(AssertionError, match="not right"):
            assert_sampler("own.py:Off", wo_deg=[30])
    finally:
        begin_session(None)


def test_pytest_and_the_plugin_share_one_module_of_a_file(pytester):
    """A conftest at the root, a sampler's folder that is not a package, and a test elsewhere that imports it."""
    pytester.makeconftest("import pytest\n\n@pytest.fixture\ndef directions():\n    return [30]\n")
    samplers = pytester.mkdir("samplers")
    (samplers / "beside.py").write_text(HELPER)
    (samplers / "own.py").write_text(SAMPLER.format(helper="beside"))
    tests = pytester.mkdir("tests")
    (tests / "test_own.py").write_text("""
import sys

def test_by_its_file(assert_sampler, directions):
    assert_sampler("samplers/own.py", wo_deg=directions)

def test_by_its_module(assert_sampler, directions):
    import own
    assert own is sys.modules["own"]
    assert_sampler(own.sample, own.pdf, wo_deg=directions)
""")
    result = pytester.runpytest_subprocess(*LOAD, "tests")
    result.assert_outcomes(passed=2)
    pytester.chdir()
    (pytester.path / "tests" / "test_own.py").unlink()
    (samplers / "test_beside.py").write_text("""
import own

def test_beside_it(assert_sampler, directions):
    assert_sampler(own.sample, own.pdf, wo_deg=directions)
    assert_sampler("samplers/own.py:Off", wo_deg=directions)
""")
    pytester.runpytest_subprocess(*LOAD).assert_outcomes(failed=1)
