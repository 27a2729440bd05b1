"""Samplers in Python as arms of a run, and combinations: those of ``e.samplers``, and those that an experiment names by ``python``."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from . import _arrays
from ._arrays import Array, Parts
from ._check import _of_library
from ._context import ContextCalls, arrays_of
from ._files import names_a_file, sampler_at
from ._sampler import Sampler
from .combinations import Combination

#: As _crescent.run takes an arm: its name, draw, pdf, random numbers, what it uses, whether it wants one thread.
CallableArm = tuple[str, Callable[..., Any], Callable[..., Any] | None, int, list[str], bool]


class Samplers(dict[str, Sampler | Combination]):
    """Samplers by the name of their arm. A callable, or the text "FILE.py:NAME", becomes a :class:`crescent.Sampler`;
    :func:`crescent.mis`, :func:`crescent.mixture` and :func:`crescent.ris` combine samplers by their names."""

    def __setitem__(self, name: str, sampler: Any) -> None:
        super().__setitem__(name, _sampler_of(name, sampler))

    def update(self, *given: Any, **named: Any) -> None:
        """As dict.update, with the checks of an assignment."""
        for name, sampler in dict(*given, **named).items():
            self[name] = sampler


def _sampler_of(name: Any, sampler: Any) -> Sampler | Combination:
    if not isinstance(name, str) or not name:
        raise TypeError(f"samplers: {name!r} is no name of an arm: expected a text")
    if isinstance(sampler, str) and names_a_file(sampler):
        return sampler_at(sampler)
    if isinstance(sampler, (Sampler, Combination)):
        return sampler
    if callable(sampler) and not isinstance(sampler, type):
        return Sampler(sampler)
    raise TypeError(
        f"samplers[{name!r}] is {type(sampler).__name__}: expected a crescent.Sampler, a callable sample(wo, u), "
        "a combination (crescent.mis, mixture, ris), or the text 'FILE.py:NAME'"
    )


def source_of(sampler: Sampler) -> str:
    """ "FILE.py:NAME" of the callable that draws; its module if it was not read from a file."""
    call = inspect.unwrap(sampler.sample)
    name = getattr(call, "__qualname__", type(call).__qualname__)
    try:
        file = inspect.getsourcefile(call if inspect.isroutine(call) else type(call))
    except TypeError:
        file = None
    if file and file.endswith(".py") and Path(file).is_file():
        return f"{Path(file).resolve()}:{name}"
    return f"{getattr(call, '__module__', None) or '__main__'}:{name}"


def _without_delta(parts: Parts, name: str) -> Parts:
    if parts[3] is not None and (parts[3] > 0).any():
        row = int((parts[3] > 0).argmax())
        raise ValueError(f"{name}: row {row} is a draw of a delta part, which has no pdf to divide by")
    return parts


def _arm(name: str, sampler: Sampler) -> CallableArm:
    title = sampler.title()
    if not sampler.uses:
        s = _of_library(sampler)
        ask = _arrays.asks_sample(s.sample, title, s.wo != "none")
        pdf = None if s.pdf is None else _arrays.asks_pdf(s.pdf, title, s.wo != "none")
        return (
            name,
            lambda wo, u, context: _without_delta(ask(wo, u), title),
            None if pdf is None else lambda wo, wi, context: pdf(wo, wi),
            s.u,
            [],
            s.serial,
        )
    calls = ContextCalls(sampler)

    def draw(wo: Array, u: Array, context: Mapping[str, Any]) -> Parts:
        kinds = tuple(context.get("kind", ()))
        arrays = arrays_of(sampler.uses, context, len(u))
        return _without_delta(_arrays.draws(calls.sample(wo, u, kinds, arrays), len(u), title), title)

    def density(wo: Array, wi: Array, context: Mapping[str, Any]) -> Array:
        kinds = tuple(context.get("kind", ()))
        arrays = arrays_of(sampler.uses, context, len(wi))
        return _arrays.column(calls.value(sampler.pdf, wo, wi, kinds, arrays), len(wi), f"{title}: pdf")  # type: ignore[arg-type]

    return name, draw, None if sampler.pdf is None else density, sampler.u, list(sampler.uses), calls.serial


def all_counts(arms: Iterable[Mapping[str, Any]]) -> list[int]:
    """The sample counts of any of these arms, ascending."""
    return sorted({n for arm in arms for n in arm["n"]})


def table_of(sampler: Sampler | Combination) -> dict[str, Any]:
    """The keys of a sampler's arm, without its sample counts."""
    return sampler.table() if isinstance(sampler, Combination) else {"python": source_of(sampler)}


def callable_arms(samplers: Mapping[str, Sampler | Combination], arms: Mapping[str, Mapping[str, Any]]) -> list[CallableArm]:
    """The arms of `samplers`, and those of an experiment's arms that name a sampler in Python."""
    named = {name: sampler_at(arm["python"]) for name, arm in arms.items() if "python" in arm and name not in samplers}
    callables = {name: sampler for name, sampler in samplers.items() if isinstance(sampler, Sampler)}
    return [_arm(name, sampler) for name, sampler in {**callables, **named}.items()]
