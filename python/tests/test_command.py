"""The command of the wheel: what it checks, and its exit codes."""

import json
import sys

import pytest

from crescent.__main__ import main

MINE = """
import numpy as np
import crescent

def sample(wo, u):
    r, phi = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1]
    z = np.sqrt(1 - u[:, 0])
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], -1), z / np.pi

def pdf(wo, wi):
    return np.maximum(wi[:, 2], 0) / np.pi

off = crescent.Sampler(sample, lambda wo, wi: 1.1 * pdf(wo, wi))
"""


@pytest.fixture
def mine(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", list(sys.path))
    monkeypatch.delitem(sys.modules, "mine", raising=False)
    (tmp_path / "mine.py").write_text(MINE)
    return tmp_path


def test_a_file_or_a_sampler_in_it_is_judged(mine, capsys):
    assert main(["check", "mine.py", "--wo", "30", "--junit", "j.xml", "--html", "j.html"]) == 0
    assert main(["check", "mine.py:off", "--wo", "30", "--json", "j.json"]) == 1
    assert "normalised" in capsys.readouterr().out
    assert json.loads((mine / "j.json").read_text())["state"] == "wrong"
    assert (mine / "j.xml").stat().st_size and (mine / "j.html").stat().st_size
    assert main(["check", "cosine", "--wo", "30,120", "--json", "no such folder/j.json"]) == 3


@pytest.mark.parametrize(
    "words, said",
    [
        (["mine.py:nope"], "no 'nope'"),
        (["nofile.py"], "no such file"),
        (["cosin"], "did you mean 'cosine'"),
        (["phong", "--set", "s=x"], "--set s=x: expected a number"),
        (["phong", "--set", "s"], "expected KEY=VALUE"),
        (["--wo", "x"], "--wo x: expected a number"),
        (["mine.py", "--set", "s=3"], "--set is of a built-in arm"),
        (["mine.py", "--exec", "./mine"], "SAMPLER excludes --exec"),
        (["mine.py", "--seed", "-1"], "seed is -1"),
        (["mine.py", "--wo", "120"], "under the surface"),
    ],
)
def test_bad_input_is_told_and_is_2(mine, capsys, words, said):
    assert main(["check", *words]) == 2
    assert said in capsys.readouterr().err
