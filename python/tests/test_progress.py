"""The bar of a run: tqdm's where it is installed and somebody watches."""

import pickle
import sys
import types

import numpy as np
import pytest
from tiny import TINY

import crescent
from crescent._progress import bar


class Bar:
    made: list["Bar"] = []

    def __init__(self, **options):
        self.total, self.n, self.texts, self.ends = options["total"], 0.0, [], []
        Bar.made.append(self)

    def __enter__(self):
        return self

    def __exit__(self, *error):
        return None

    def reset(self, total):
        self.ends.append(self.n)
        self.total, self.n = total, 0.0

    def set_description(self, text):
        self.texts.append(text)

    def refresh(self):
        pass


@pytest.fixture
def tqdm(monkeypatch):
    Bar.made = []
    module = types.ModuleType("tqdm.auto")
    module.tqdm = Bar
    monkeypatch.setitem(sys.modules, "tqdm", types.ModuleType("tqdm"))
    monkeypatch.setitem(sys.modules, "tqdm.auto", module)


def test_a_bar_follows_the_stages(tqdm):
    with bar(True) as show:
        show("references", 1, 4)
        show("films", 2, 8)
        show("films", 9, 8)
    made = Bar.made[0]
    assert made.texts == ["references", "films"] and made.total == 8 and made.n == 8
    assert made.ends == [0.0, 4]


def test_no_bar_is_shown_where_nobody_watches(tqdm, monkeypatch):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: False, raising=False)
    with bar(None) as show:
        assert show is None
    with bar(False) as show:
        assert show is None
    assert not Bar.made


def test_a_callable_is_called_and_ends_at_100_percent():
    calls = []
    with bar(lambda *call: calls.append(call)) as show:
        show("films", 1.0, 4.0)
    assert calls == [("films", 1.0, 4.0), ("films", 4.0, 4.0)]
    calls.clear()
    e = crescent.load("two-lamps").resize(160, 90)
    crescent.run(e, seeds=(1, 1), studies=True, progress=lambda *call: calls.append(call))
    last = {what: (done, total) for what, done, total in calls}
    assert len(last) >= 2 and all(done == total for done, total in last.values()), last
    with pytest.raises(TypeError, match="expected a callable"), bar("yes"):
        pass


def test_without_tqdm_a_bar_must_not_be_wanted(monkeypatch):
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    with pytest.raises(ImportError), bar(True):
        pass


def test_a_run_announces_what_it_computes_beside_the_films_and_states_its_time():
    e = crescent.parse(TINY)
    stages = []

    def noted(what, done, total):
        assert done <= total, (what, done, total)
        if not stages or stages[-1][0] != what:
            stages.append((what, 0.0))
        stages[-1] = (what, done / total if total else 1.0)

    measured = crescent.run(e, studies=True, progress=noted)
    assert stages[-1][0].startswith("tails, furnaces, article checks: ") and "% of all samples" in stages[-1][0]
    assert stages[-1][1] == 1.0
    assert list(measured.stages) == ["references", "films", "tails, furnaces and article checks", "metrics"]
    assert all(seconds >= 0 for seconds in measured.stages.values()) and measured.stages["films"] > 0
    assert list(crescent.run(e, seeds=1).stages) == ["references", "films", "metrics"]


def test_without_references_there_are_films_alone(tmp_path):
    e = crescent.parse(TINY)
    whole, films = crescent.run(e, seeds=1), crescent.run(e, references=False, out=tmp_path / "out")
    assert films.references == {} and films.records() == [] and films.holds
    assert {film.seed for film in films.films.values()} == {7}
    for key, film in whole.films.items():
        assert np.array_equal(film.y, films.films[key].y)
    with pytest.raises(KeyError, match="references=False"):
        films.metric("rmse", "cosine", 4, "ball")
    with pytest.raises(ValueError, match="without references"):
        crescent.run(e, references=False, studies=True)
    again = crescent.open(tmp_path / "out")
    assert set(again.films) == set(films.films)
    assert again.stages == films.stages == pickle.loads(pickle.dumps(films)).stages
