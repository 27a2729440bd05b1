"""Samplers in a test suite: `assert_sampler` fails if a sampler is not right; `mutants` tests the suite itself.

Under pytest the plugin of this package (`crescent.pytest_plugin`, loaded automatically) shares one alpha over all tests
of a session: a suite of correct samplers fails by chance with that probability, for any number of samplers.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from . import _arrays
from ._check import _of_library, check
from ._files import names_a_file, sampler_at
from ._result import CheckResult
from ._sampler import Sampler

ALPHA = 1e-3  #: for a whole session


@dataclass
class Session:
    """One alpha for many calls: `tests` tests have equal shares, and the k-th call in a test 6/(pi k)^2 of its own."""

    alpha: float = ALPHA
    tests: int = 1
    checked: int = 0
    spent: float = 0.0  #: share of alpha used so far
    calls: dict[str, int] = field(default_factory=dict)
    test: str = ""  #: that is running
    root: Path | None = None  #: where files of samplers are searched; None: the current folder

    def share(self) -> float:
        """Returns the alpha of the next call; the shares of all calls sum to at most `alpha` (Sidak over tests)."""
        k = self.calls[self.test] = self.calls.get(self.test, 0) + 1
        of_test = -np.expm1(np.log1p(-self.alpha) / max(self.tests, 1))
        share = float(of_test * 6 / (np.pi * k) ** 2)
        self.checked += 1
        self.spent += share
        return share


_session: Session | None = None


def begin_session(session: Session | None) -> None:
    """From here on assert_sampler takes its alpha from `session`; None: ALPHA per call."""
    global _session
    _session = session


def assert_sampler(
    sample: Callable[..., Any] | Sampler | str,
    pdf: Callable[..., Any] | None = None,
    f: Callable[..., Any] | None = None,
    *,
    alpha: float | None = None,
    allow: Iterable[str] = (),
    **known: Any,
) -> CheckResult:
    """Raises AssertionError unless the sampler is right; the arguments are those of :func:`crescent.check`.

    A file, "mine.py:sampler", is searched from pytest's rootdir. `allow`: names of verdicts that may be inconclusive,
    such as ("tail", "mean") for a sampler known to be heavy-tailed.
    """
    share = alpha if alpha is not None else _session.share() if _session else ALPHA
    if isinstance(sample, str) and names_a_file(sample):
        sample = sampler_at(sample, _session.root if _session else None)
    result = check(sample, pdf, f, alpha=share, **known)
    allowed = set(allow)
    bad = [
        v for v in result if v.state in ("wrong", "error") or (v.state == "inconclusive" and v.name not in allowed)
    ]
    if bad:
        raise AssertionError(f"the sampler is not right\n{result}")
    return result


@dataclass(frozen=True)
class Mutant:
    """A sampler with one fault planted."""

    name: str
    sampler: Sampler


def _bent(s: Sampler, *, u: Any = None, draw: Any = None, pdf: Any = None, f: Any = None) -> Sampler:
    """`s` with its numbers, draws, densities or f changed: u(u), draw(wo, parts), pdf(wo, wi, p), f(wo, wi, f)."""
    takes_wo = s.wo != "none"
    ask = _arrays.asks_sample(s.sample, s.title(), takes_wo)

    def sample(*at: Any) -> Any:
        wo, numbers = at if takes_wo else (None, *at)
        parts = ask(wo, u(numbers) if u else numbers)
        if draw:
            parts = draw(wo, parts)
        return parts if parts[3] is not None else parts[:3] if parts[2] is not None else parts[:2]

    def bent_pdf(*at: Any) -> Any:
        wo, wi = at if takes_wo else (None, *at)
        return pdf(wo, wi, _arrays.column(s.pdf(*at), len(wi), "pdf"))  # type: ignore[misc]

    def bent_f(wo: Any, wi: Any) -> Any:
        return f(wo, wi, _arrays.channels(s.f(wo, wi), len(wi), "f"))  # type: ignore[misc]

    return replace(
        s, sample=sample, pdf=bent_pdf if pdf and s.pdf else s.pdf, f=bent_f if f and s.f else s.f, name=s.title()
    )


def _scaled(parts: Any, factor: Any) -> Any:
    wi, p, weight, delta = parts
    return wi, p * factor, weight, delta


def _moved(parts: Any, move: Callable[[Any], Any]) -> Any:
    return (move(parts[0].copy()), *parts[1:])


def _leant(wi: Any) -> Any:
    """Rotated by 5 degrees about x."""
    c, s = np.cos(np.radians(5)), np.sin(np.radians(5))
    return wi @ np.array([[1.0, 0.0, 0.0], [0.0, c, s], [0.0, -s, c]])


def _with_nan(wi: Any) -> Any:
    """Every hundredth row is NaN."""
    return np.where(np.arange(len(wi))[:, None] % 100, wi, np.nan)


def mutants(sampler: Sampler) -> Iterator[Mutant]:
    """Returns the sampler with one typical fault at a time, which a test suite should detect."""
    s = _of_library(sampler)

    def of(name: str, **bends: Any) -> Mutant:
        return Mutant(name, _bent(s, **bends))

    yield of(
        "half of the first random number's range is never used", u=lambda u: u * np.where(np.arange(s.u) == 0, 0.5, 1)
    )
    yield of("the first random number is squared", u=lambda u: np.where(np.arange(s.u) == 0, u**2, u))
    yield of("directions lean by 5 degrees", draw=lambda wo, d: _moved(d, _leant))
    yield of("a direction in 100 is no number", draw=lambda wo, d: _moved(d, _with_nan))
    yield of("directions are not of unit length", draw=lambda wo, d: _moved(d, lambda w: w * 1.01))
    yield of("the density that comes with a draw is 3 % too large", draw=lambda wo, d: _scaled(d, 1.03))
    if s.pdf:
        yield of(
            "both densities are 3 % too large", draw=lambda wo, d: _scaled(d, 1.03), pdf=lambda wo, wi, p: p * 1.03
        )
        yield of("a cosine is forgotten in the pdf", pdf=lambda wo, wi, p: p / np.maximum(np.abs(wi[:, 2]), 1e-9))
        yield of(
            "the pdf is 0 below 20 degrees of elevation", pdf=lambda wo, wi, p: np.where(np.abs(wi[:, 2]) < 0.342, 0, p)
        )
        if s.wo != "none":
            sampled_pdf = s.pdf
            swapped = replace(s, pdf=lambda wo, wi: sampled_pdf(wi, wo), name=s.title())
            yield Mutant("w_o and w_i are exchanged in the pdf", swapped)
    if s.f:
        yield of("f holds the cosine", f=lambda wo, wi, f: f * np.abs(wi[:, 2:3]))
        yield of("f is 5 times too large", f=lambda wo, wi, f: f * 5)
        yield of("f is not reciprocal", f=lambda wo, wi, f: f * (1 + 0.2 * np.abs(wi[:, 2:3])))


@dataclass(frozen=True)
class Noticed:
    """Which tests detected which planted fault."""

    tests: tuple[str, ...]
    by: dict[str, tuple[str, ...]]  #: fault -> the tests that failed

    def missed(self) -> tuple[str, ...]:
        """The faults that no test detected."""
        return tuple(fault for fault, tests in self.by.items() if not tests)

    def __str__(self) -> str:
        lines = [f"{fault}: {', '.join(tests) if tests else 'no test notices'}" for fault, tests in self.by.items()]
        return "\n".join([*lines, f"{len(self.by) - len(self.missed())} of {len(self.by)} planted faults are noticed"])


def who_notices(sampler: Sampler, tests: Iterable[Callable[[Sampler], Any]]) -> Noticed:
    """Runs tests that take a sampler on every mutant of it: a test detects a mutant by raising, or by returning a false
    value other than None."""
    tests = tuple(tests)
    names = tuple(getattr(t, "__name__", str(t)) for t in tests)
    for test, name in zip(tests, names):
        if not _passes(test, sampler):
            raise ValueError(f"{name} fails with the sampler as it is: what it says of mutants means nothing")
    by = {m.name: tuple(n for t, n in zip(tests, names) if not _passes(t, m.sampler)) for m in mutants(sampler)}
    return Noticed(names, by)


def _passes(test: Callable[[Sampler], Any], sampler: Sampler) -> bool:
    try:
        result = test(sampler)
    except Exception:
        return False
    return result is None or bool(result)
