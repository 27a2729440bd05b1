"""The bar of a run: tqdm's where it is installed and somebody watches."""

import sys
import types

import pytest

from crescent._progress import bar


class Bar:
    made: list["Bar"] = []

    def __init__(self, **options):
        self.total, self.n, self.texts = options["total"], 0.0, []
        Bar.made.append(self)

    def __enter__(self):
        return self

    def __exit__(self, *error):
        return None

    def reset(self, total):
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
    with pytest.raises(TypeError, match="expected a callable"), bar("yes"):
        pass


def test_without_tqdm_a_bar_must_not_be_wanted(monkeypatch):
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    with pytest.raises(ImportError), bar(True):
        pass
