"""Nothing that is assigned to an experiment is ignored: each way of setting and deleting a key does what it says, or
raises with the way to say it."""

import copy
import json
import pickle
import re
import warnings
from pathlib import Path

import numpy as np
import pytest
from test_settings import RICH
from tiny import TINY

import crescent
from crescent import _installed
from crescent._paths import path_of, steps_of

SHIPPED = list(_installed.experiments())


def leaves(tree, steps=()):
    """Every value with its steps, those of lists included."""
    for key, value in tree.items() if isinstance(tree, dict) else enumerate(tree):
        if isinstance(value, (dict, list)):
            yield from leaves(value, (*steps, key))
        yield (*steps, key), value


def container(e, steps):
    """The table or list that has the last of these steps, as it is read step by step."""
    at = e[path_of([steps[0]])] if len(steps) > 1 else e
    for step in steps[1:-1]:
        at = at[step]
    return at


def text_after(change, e):
    """The experiment after a change of a copy; the error if it is refused."""
    e = copy.copy(e)
    before = e.text
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            change(e)
    except (ValueError, KeyError) as error:
        assert e.text == before, "what is refused changes nothing"
        return type(error).__name__
    return e.text


def test_an_installed_experiment_has_a_name(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert crescent.load("gallery") == crescent.load(_installed.experiments()["gallery"])
    for wrong in ("galery", "nowhere/galery.toml"):
        with pytest.raises(ValueError, match="cousins.*gallery.*two-lamps; did you mean 'gallery'"):
            crescent.load(wrong)


@pytest.mark.parametrize("text", [TINY, RICH], ids=["tiny", "rich"])
def test_every_key_is_set_the_same_in_each_way(text):
    e = crescent.parse(text)
    for steps, value in leaves(e._tree()):
        if any(isinstance(step, int) for step in steps[:-1]):
            continue  # as a path has them: camera.eye[1], below
        path = path_of([str(step) for step in steps])
        other = 0.375 if isinstance(value, float) else 48 if isinstance(value, int) else copy.deepcopy(value)
        by_path = text_after(lambda e: e.__setitem__(path, other), e)
        by_steps = text_after(lambda e: container(e, steps).__setitem__(steps[-1], other), e)
        assert by_path == by_steps == text_after(lambda e: e.with_({path: other}) and e.__setitem__(path, other), e), (
            path
        )
        if isinstance(container(e, steps), dict):
            assert by_path == text_after(lambda e: container(e, steps).update({steps[-1]: other}), e), path


@pytest.mark.parametrize("name", SHIPPED)
def test_every_key_is_deleted_the_same_in_each_way(name):
    e = crescent.load(name)
    for steps, _ in leaves(e._source.tree()):
        if any(isinstance(step, int) for step in steps):
            continue
        path = path_of(steps)
        by_path = text_after(lambda e: e.__delitem__(path), e)
        assert by_path == text_after(lambda e: e.remove(path), e), path
        if len(steps) > 1:
            assert by_path == text_after(lambda e: container(e, steps).pop(steps[-1]), e), path
            assert by_path == text_after(lambda e: container(e, steps).__delitem__(steps[-1]), e), path


@pytest.mark.parametrize("name", SHIPPED)
def test_every_arm_can_be_taken_out_with_what_names_it(name):
    loaded = crescent.load(name)
    for arm in loaded["arms"]:
        e = copy.copy(loaded)
        if len(e["arms"]) == 1:
            continue
        removed = e.remove(f"arms.{arm}")
        assert arm not in e["arms"]
        for path in removed:
            assert path not in e and path in loaded
        left = [other for other in loaded._source.tree() if other in e._source.tree()]
        for family in ("shapes", "regions", "plates", "assertions"):
            if family in left:
                gone = set(loaded[family]) - set(e._tree().get(family, {}))
                assert {path_of([family, one]) for one in gone} <= set(removed)
        again = crescent.parse(e.text, str(_installed.experiments()[name]))
        assert again.text == e.text


def test_what_goes_with_a_name_is_listed():
    e = crescent.load("gallery")
    with pytest.warns(UserWarning, match="plates.three-up, assertions.*uniform has no bad sample") as told:
        del e["arms.uniform"]
    assert Path(told[0].filename) == Path(__file__)
    with pytest.warns(UserWarning, match="furnaces.phong_lobe") as told:
        assert e["arms"].pop("phong") == {"sampler": "phong", "n": [4, 16, 64, 256]}
    assert Path(told[0].filename) == Path(__file__) and list(e["arms"]) == ["cosine"]
    e = crescent.load("gallery")
    with pytest.warns(UserWarning, match="plates.three-up") as told:
        e["arms"] = {"cosine": {"n": [4, 16]}, "phong": {"n": 16}}
    assert Path(told[0].filename) == Path(__file__)
    assert e["arms"] == {"cosine": {"sampler": "cosine", "n": [4, 16]}, "phong": {"sampler": "phong", "n": [16]}}


def test_lists_and_tables_change_as_those_of_python():
    e = crescent.parse(TINY)
    e["key.radiance"][0] = 2
    assert e["key.radiance"] == [2, 90, 90]
    counts = e["cosine.n"]
    counts.append(64)
    counts.insert(1, 8)
    assert counts == e["cosine.n"] == [4, 8, 16, 64]
    counts.remove(64)
    del counts[0]
    counts[:] = [2, 4]
    assert counts == e["cosine.n"] == [2, 4] and counts.pop() == 4 and e["cosine.n"] == [2]
    with pytest.raises(ValueError, match="expected"):
        counts.clear()
    assert counts == [2]
    arms = e["arms"]
    arms |= {"uniform": {"n": 4}, "blinn": {"n": 4}}
    assert list(e["arms"]) == ["cosine", "phong", "uniform", "blinn"] and arms.popitem()[0] == "blinn"
    assert arms.setdefault("uniform", {"n": 9})["n"] == [4] and "blinn" not in e["arms"] and arms.pop("none", 3) == 3
    for plain in (copy.deepcopy(arms), pickle.loads(pickle.dumps(arms)), json.loads(json.dumps(arms)), arms.copy()):
        plain["cosine"]["n"] = [1]
        assert e["cosine.n"] == [2]


def test_attributes_are_not_keys():
    e = crescent.parse(TINY)
    for name in ("n", "seed", "width"):
        with pytest.raises(AttributeError, match=f"expected e\\['{name}'\\] = 16"):
            setattr(e, name, 16)
        with pytest.raises(AttributeError, match=f"expected e\\['{name}'\\]"):
            getattr(e, name)
    with pytest.raises(AttributeError, match="cannot be set"):
        e.hash = "0"
    e.samplers = {"mine": lambda wo, u: None}
    with pytest.raises(TypeError, match="expected a crescent.Sampler"):
        e.samplers = {"mine": 3}
    with pytest.raises(TypeError, match="e.samplers"):
        e["arms.mine"] = crescent.mis("cosine", "phong")


@pytest.mark.parametrize("name", SHIPPED)
def test_attributes_of_tables_and_lists_are_not_keys(name):
    e = crescent.load(name)
    before = e.text
    tables = [(steps, value) for steps, value in leaves(e._tree()) if isinstance(value, (dict, list))]
    for steps, value in tables:
        if any(isinstance(step, int) for step in steps):
            continue
        part, path = e[path_of(steps)], path_of(steps)
        for attribute in ("width", "n", "phong"):
            said = re.escape(f"expected e['{path}.{attribute}'] = 16" if isinstance(value, dict) else "expected an index")
            if '"' in path:
                said = "expected"
            with pytest.raises(AttributeError, match=said):
                setattr(part, attribute, 16)
            with pytest.raises(AttributeError, match="expected"):
                getattr(part, attribute)
    assert e.text == before and len(tables) > 20


def test_what_is_refused_leaves_the_samplers_as_they_were():
    def sample(wo, u):
        return wo, u[:, 0]

    e = crescent.parse(TINY)
    with pytest.raises(TypeError, match=r"samplers\['wrong'\] is int: expected a crescent.Sampler"):
        e.samplers |= {"right": sample, "wrong": 3}
    with pytest.raises(TypeError, match="expected a crescent.Sampler"):
        e.samplers.setdefault("wrong", 3)
    with pytest.raises(AttributeError, match=r"expected e.samplers\['mine'\] = sampler"):
        e.samplers.mine = sample
    with pytest.raises(AttributeError, match="cannot be deleted"):
        del e.samplers
    assert e.samplers == {}
    assert isinstance(e.samplers.setdefault("mine", sample), crescent.Sampler)
    e.samplers |= {"other": sample}
    for change in (lambda: e.samplers.pop("mien"), lambda: e.samplers.__delitem__("mien")):
        with pytest.raises(KeyError, match="did you mean 'mine'"):
            change()
    assert list(e.samplers) == ["mine", "other"] and e.samplers.pop("none", None) is None
    assert list(pickle.loads(pickle.dumps(crescent.parse(TINY).samplers))) == []


def test_an_n_that_no_arm_takes_is_said(recwarn):
    e = crescent.load("cousins")
    with pytest.warns(UserWarning, match=r"no arm takes n = 16, each has its own: e\['arms.uniform.n'\], e\['arms.cos") as told:
        e["n"] = 16
    assert Path(told[0].filename) == Path(__file__)
    with pytest.warns(UserWarning, match="no arm takes n = 4") as told:
        e.with_(n=4)
    assert Path(told[0].filename) == Path(__file__)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        crescent.load("gallery")["n"] = 16
        e["arms.phong.n"] = 16


def test_values_of_other_types_are_those_of_python():
    e = crescent.parse(TINY)
    e["title"] = "\u00e9 \U0001f600 \x7f"[:4]
    assert e["title"] == "\u00e9 \U0001f600 "
    e["seeds"], e["key.radius"], e["camera.vfov_deg"] = np.int8(3), np.array(0.25), np.float32(20.5)
    assert (e["seeds"], e["key.radius"], e["camera.vfov_deg"]) == (3, 0.25, 20.5)
    e["note_evidence"] = np.bool_(True)
    assert e["note_evidence"] is True
    e["arms.mine"] = {"python": Path("mine.py"), "n": np.arange(1, 3)}
    assert e["arms.mine.n"] == [1, 2] and e["arms.mine.python"].endswith("mine.py")


def test_resize_scales_what_is_in_pixels():
    e = crescent.load("gallery").resize(320, 180)
    assert (e["image.width"], e["image.height"]) == (320, 180)
    assert e["regions.H.box"] == [167, 130, 184, 143] and e["plates.surround.crop"] == [116, 26, 181, 106]
    back = e.resize(960, 540)["regions.H.box"]
    assert max(abs(a - b) for a, b in zip(back, [502, 391, 555, 432])) <= 1
    wide = crescent.load("gallery").resize(1200, 540)
    assert wide["regions.H.box"] == [502 + 120, 391, 555 + 120, 432], "the field of view is vertical"
    with pytest.raises(ValueError, match="regions.H.* is outside a picture of 40 x 540"):
        crescent.load("gallery").resize(40, 540)
    with pytest.raises(ValueError, match=r"e.resize\(320, 540\)"):
        crescent.load("gallery")["image"]["width"] = 320


def test_two_experiments_differ_in_their_keys():
    e = crescent.parse(TINY)
    other = e.with_({"ball.s": 8}, seed=3)
    assert e.diff(other) == {"seed": (7, 3), "shapes.ball.s": (32, 8)} and e.diff(e) == {}
    other["arms.uniform"] = {"n": 4}
    assert e.diff(other)["arms.uniform.n"] == (None, [4])


def test_an_arm_of_python_has_its_own_sample_counts():
    e = crescent.parse(TINY)
    e.samplers["few"] = crescent.mis("cosine", "phong", n=[2, 8])
    e.samplers["one"] = crescent.mixture("cosine", "phong", n=2)
    e.samplers["others"] = crescent.ris("cosine", candidates=2)
    films = crescent.run(e, seeds=(1, 1)).films
    assert [[n for arm, n, _ in films if arm == name] for name in e.samplers] == [[2, 8], [2], [4, 16]]
    with pytest.raises(ValueError, match="n is 0: expected a sample count"):
        crescent.mis("cosine", "phong", n=[0])


def test_paths_are_read_as_they_are_written():
    for steps in (["arms", "a b"], ["arms", "o'brien", "n"], ["x", 'say "it"'], ["x", "a.b[1]"], ["x", "ä"]):
        assert steps_of(path_of(steps)) == steps


@pytest.mark.parametrize(
    ("use", "said"),
    [
        (lambda e: e["arms"].pop("phnog"), "did you mean 'phong'"),
        (lambda e: e["image"]["widht"], "did you mean 'width'"),
        (lambda e: e["widht"], "did you mean 'image.width'"),
        (lambda e: e.with_(widht=3), "did you mean 'image.width'"),
        (lambda e: e.with_({"camera": 3}), r"^camera is 3: expected a table, such as \{'eye': ..., 'target': ...\}"),
        (lambda e: e.with_({"arms": ["phong"]}), r"^arms is \['phong'\]: expected a table, such as \{'cosine': ..."),
        (lambda e: e.with_({"arms.phong": None}), r"^arms.phong is None: expected a table.*e\.remove\(path\) takes it out"),
        (lambda e: e.with_({"arms.phong": crescent.mis("cosine")}), r"e\.samplers\[NAME\] = sampler"),
        (lambda e: e.with_(samplers={"x": len}), r"^samplers: .* expected e\.samplers\[NAME\] = sampler"),
        (lambda e: e.with_(title="\ud800"), "half of a surrogate pair"),
        (lambda e: e.with_({"arms": {}}), r"^--set arms=\{\}: arms: expected one or more tables"),
        (lambda e: e["arms"].clear(), r"^--set arms=\{\}: arms: expected one or more tables"),
        (lambda e: e["image", "width"], "is no path: expected a text such as"),
        (lambda e: e.with_({"image.width": None}), r"e\.remove\(path\)"),
        (lambda e: e.with_(["n=3"]), "expected paths with their values"),
        (lambda e: e.diff("gallery"), r"crescent\.load\('gallery'\)"),
        (lambda e: e.samplers["mien"], "did you mean 'mine'"),
        (lambda e: e["arms"].pop("mine"), r"expected e\.samplers\['mine'\]"),
        (lambda e: e.keys(), r"expected list\(e\)"),
        (lambda e: e.save("x.toml"), r"expected Path\(file\)\.write_text\(e\.text\)"),
        (lambda e: crescent.load(3), "the name of an installed experiment"),
        (lambda e: crescent.load("gallery", "n=3"), "expected paths with their values"),
        (lambda e: crescent.parse(None), "crescent.load reads a file"),
        (lambda e: crescent.join([]), "expected one or more folders of runs"),
        (lambda e: crescent.join("part-1"), "expected one or more folders of runs"),
    ],
)
def test_what_a_stranger_tries_is_answered_by_the_way_to_say_it(use, said):
    e = crescent.parse(TINY)
    e.samplers["mine"] = lambda wo, u: None
    before = e.text
    with pytest.raises((KeyError, ValueError, TypeError, AttributeError)) as raised:
        use(e)
    message = raised.value.args[0]
    assert re.search(said, message), message
    assert e.text == before and len(message.splitlines()) <= 3


def test_a_table_that_was_removed_is_not_added_by_an_older_reading_of_it():
    e = crescent.parse(TINY)
    phong = e["arms"]["phong"]
    e.remove("arms.phong")
    with pytest.raises(KeyError, match=r"arms.phong: was removed.*e\['arms.phong'\] = "):
        phong["n"] = [4]
    assert list(e["arms"]) == ["cosine"]


@pytest.mark.parametrize("name", SHIPPED)
def test_every_arm_and_light_of_a_shipped_experiment_can_be_removed(name):
    whole = crescent.load(name)
    for arm in whole["arms"]:
        e = crescent.load(name)
        removed = e.remove(f"arms.{arm}")
        assert f"arms.{arm}" not in e and not any(path in e for path in removed)
        e.resize(96, 54)
    assert crescent.load(name).diff(pickle.loads(pickle.dumps(whole))) == {}
