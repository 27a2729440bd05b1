"""Keys that are set after loading: the effect of --set, key by key and one after another."""

import copy
import os
import pickle

import numpy as np
import pytest
from tiny import TINY

import crescent

# Values that depend on other keys: n and s of arms and shapes, the reference, roughness, sample counts of plates.
RICH = TINY.replace("seeds = 2", "seeds = 2\nn = 16") + """
[shapes.floor]
kind = "plane"
point = [0, 0, 0]
normal = [0, 1, 0]
rho_d = [0.1, 0.08, 0.06]
[arms.uniform]
[arms.both]
kind = "mis"
of = ["cosine", "phong"]
[lights.bulb]
kind = "sphere"
center = [0, 3, 0]
radius = 0.1
radiance = [9, 9, 9]
[exponent]
arm = "uniform"
s = [8, 64]
shape = "ball"
[furnaces.ball]
arm = "cosine"
shape = "ball"
n = 16
[plates.hero]
kind = "hero"
runs = [{arm = "uniform"}]
[assertions."no bad samples"]
check = "bad(uniform) == 0"
"""


def leaves(tree, path=""):
    """Every key of a tree with its value; names with blanks are quoted."""
    for key, value in tree.items():
        here = f'{path}"{key}"' if " " in key else f"{path}{key}"
        if isinstance(value, dict):
            yield from leaves(value, here + ".")
        elif not (isinstance(value, list) and value and isinstance(value[0], dict)):
            yield here, value


def others(value):
    """The value itself, and values near it."""
    if isinstance(value, bool):
        return [value, not value]
    if isinstance(value, (int, float)):
        return [value, value + 1, value * 0.5, 64]
    if isinstance(value, str):
        return [value, value + "x", "cosine", "paired", "ggx"]
    return [value, value[:-1], [v * 0.5 if isinstance(v, (int, float)) else v for v in value]]


def outcome(call):
    try:
        e = call()
    except ValueError as error:
        return "ValueError", str(error)
    return e.text, e.hash


def experiment(tmp_path):
    path = tmp_path / "rich.toml"
    path.write_text(RICH)
    return path


def test_every_key_has_the_effect_of_set(tmp_path):
    path = experiment(tmp_path)
    keys = list(leaves(crescent.load(path)._tree()))
    assert len(keys) > 60
    for key, value in keys:
        for other in others(value):
            loaded = crescent.load(path)
            assert outcome(lambda: loaded.with_({key: other})) == outcome(lambda: crescent.load(path, {key: other})), (key, other)


def test_keys_that_are_set_one_after_another_are_set_together(tmp_path):
    path = experiment(tmp_path)
    changes = {"n": 64, "ball.s": 16, "arms.cosine.n": [4, 8], "floor.rho_d": [0.2, 0.1, 0.1], "fill.radiance": [1, 2, 3]}
    for order in (list(changes), list(reversed(changes))):
        e = crescent.load(path)
        for key in order:
            e[key] = changes[key]
        together = crescent.load(path, changes)
        assert (e.text, e.hash) == (together.text, together.hash)
        assert pickle.loads(pickle.dumps(e)).text == copy.deepcopy(e).text == e.text


def test_n_is_that_of_the_arms_that_take_it():
    e = crescent.parse(RICH)
    e["n"] = 64
    assert e["arms.uniform.n"] == [64] and e["exponent.n"] == 64
    e["n"] = 4
    e["seeds"] = 1
    result = crescent.run(e)
    assert {row["n"] for row in result.records() if row["arm"] == "uniform"} == {4}
    assert {row["set.n"] for row in result.records()} == {4}


def test_a_table_that_is_removed_leaves_the_rest_as_it_was(tmp_path):
    e = crescent.load(experiment(tmp_path))
    e["n"] = 8
    del e["shapes.floor"]
    e["ball.s"] = 8
    assert e["arms.uniform.n"] == [8] and "shapes.floor" not in e
    with pytest.raises(KeyError, match="default"):
        del e["firefly_k"]


def test_files_are_found_from_another_folder(tmp_path, monkeypatch):
    (tmp_path / "there").mkdir()
    experiment(tmp_path / "there")
    crescent.scenes.write_sky(tmp_path / "there" / "sky.exr", np.full((4, 8, 3), 2.0))
    text = RICH.replace("[exponent]", '[sky]\nfile = "sky.exr"\n[exponent]')
    (tmp_path / "there" / "rich.toml").write_text(text)
    monkeypatch.chdir(tmp_path)
    e = crescent.load("there/rich.toml")
    monkeypatch.chdir(os.sep)
    e["n"] = 4
    assert e["arms.uniform.n"] == [4]
    e.samplers["mine"] = lambda wo, u: None
    assert e.hash
