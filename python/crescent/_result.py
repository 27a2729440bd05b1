"""A result: nine verdicts for each direction w_o, in words, as data, and as files."""

from __future__ import annotations

import json as _json
from collections.abc import Iterator
from dataclasses import dataclass, field
from os import PathLike
from typing import Any, Literal, NoReturn

from . import _crescent

State = Literal["right", "wrong", "inconclusive", "skipped", "error"]
Path = str | PathLike[str]


@dataclass(frozen=True)
class Verdict:
    """One verdict on one sampler at one w_o."""

    sampler: str
    case: str  #: w_o and parameters: "w_o 60 deg az 250"
    name: str  #: valid, support, normalised, density, identity, physics, tail, mean or efficiency
    state: State
    message: str  #: what was found
    cause: str = ""  #: the cause, if one is found
    status: str = ""  #: the next step, if it is inconclusive
    expected: bool = True  #: False: another state was expected of a built-in sampler
    evidence: dict[str, Any] = field(default_factory=dict, repr=False)  #: the numbers of the test
    seconds: float = field(default=0.0, compare=False, repr=False)
    wo_deg: tuple[float, float] | None = field(default=None, repr=False)  #: angle from n and azimuth; None: no w_o
    sentences: tuple[tuple[str, str], ...] = field(default=(), repr=False)  #: of the message: what it states, its text

    def states(self, what: str) -> bool:
        """Whether a sentence of the message states this."""
        return any(stated == what for stated, _ in self.sentences)


def _verdict(raw: dict[str, Any]) -> Verdict:
    return Verdict(
        raw["arm"],
        raw["case"],
        raw["name"],
        raw["state"],
        raw["message"],
        raw["cause"],
        raw["status"],
        raw["expected"],
        _json.loads(raw["evidence"]),
        raw["seconds"],
        raw["wo_deg"],
        tuple(raw["sentences"]),
    )


@dataclass(frozen=True)
class _Kept:
    """A result as texts and numbers only, which can be passed between processes."""

    state: str
    as_expected: bool
    tests: int
    questions: int
    verdicts: list[dict[str, Any]]
    texts: dict[str, str]

    def text(self, all: bool = False) -> str:
        return self.texts["all" if all else "table"]

    def json(self) -> str:
        return self.texts["json"]

    def junit(self) -> str:
        return self.texts["junit"]

    def html(self) -> str:
        return self.texts["html"]


class CheckResult:
    """The result of :func:`crescent.check`. It has no truth value: use ``.state``."""

    def __init__(self, checked: _crescent.CheckRun | _Kept) -> None:
        self._run = checked
        self._verdicts = tuple(_verdict(raw) for raw in checked.verdicts)

    def __reduce__(self) -> tuple[Any, ...]:
        j = self._run
        texts = {"table": j.text(), "all": j.text(True), "json": j.json(), "junit": j.junit(), "html": j.html()}
        return CheckResult, (
            _Kept(self.state, self.as_expected, self.tests, self.questions, list(j.verdicts), texts),
        )

    @property
    def state(self) -> State:
        """The worst of all verdicts: wrong, error, inconclusive or right."""
        return self._run.state  # type: ignore[return-value]

    @property
    def as_expected(self) -> bool:
        """Whether every verdict is as expected by the list of built-in samplers; for a user's sampler: none is wrong.
        """
        return bool(self._run.as_expected)

    @property
    def verdicts(self) -> tuple[Verdict, ...]:
        """Every verdict, in the order of the list."""
        return self._verdicts

    @property
    def tests(self) -> int:
        """The number of statistical tests that shared alpha."""
        return int(self._run.tests)

    @property
    def questions(self) -> int:
        """The number of draws, densities and values of f that were evaluated; 0 for built-in samplers."""
        return int(self._run.questions)

    def of(self, name: str) -> tuple[Verdict, ...]:
        """The verdicts of one name over all w_o."""
        return tuple(v for v in self._verdicts if v.name == name)

    def wrong(self) -> tuple[Verdict, ...]:
        """The verdicts with the state "wrong"."""
        return tuple(v for v in self._verdicts if v.state == "wrong")

    def broken(self) -> tuple[str, ...]:
        """The names of the wrong verdicts, each once, in their order."""
        return tuple(dict.fromkeys(v.name for v in self.wrong()))

    def __iter__(self) -> Iterator[Verdict]:
        return iter(self._verdicts)

    def __bool__(self) -> NoReturn:
        raise TypeError("a result is right, wrong, inconclusive or an error: compare .state with one of them")

    def __repr__(self) -> str:
        broken = f": {', '.join(self.broken())}" if self.broken() else ""
        return f"<CheckResult {self.state}{broken}; {len(self._verdicts)} verdicts>"

    def __str__(self) -> str:
        return self._run.text()

    def text(self, all: bool = False) -> str:
        """The verdicts as on a terminal, at most 12 lines for one sampler; `all`: a table, then every verdict with its
        message."""
        return self._run.text(all)

    def json(self) -> str:
        """The text described by docs/check.schema.json: equal calls give equal bytes."""
        return self._run.json()

    def junit(self, path: Path) -> None:
        """Writes JUnit XML for a build server."""
        _write(path, self._run.junit())

    def html(self, path: Path) -> None:
        """Writes one page: the summary, a matrix of w_o and verdicts, maps, histograms and roses."""
        _write(path, self._run.html())

    def _repr_html_(self) -> str:
        """The report in a frame of a notebook's cell."""
        page = self._run.html().replace("&", "&amp;").replace('"', "&quot;")
        return f'<iframe srcdoc="{page}" style="width:100%;height:640px;border:0" title="result"></iframe>'


def _write(path: Path, text: str) -> None:
    _crescent.write_whole(str(path), text)
