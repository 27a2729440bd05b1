"""Samplers in Python as arms of a run, and combinations: those of ``e.samplers``, and those that an experiment names by ``python``."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from . import _arrays, _crescent
from ._arrays import Array, Parts
from ._check import _of_library
from ._context import Context, ContextCalls, arrays_of
from ._files import names_a_file, object_at, sampler_at
from ._sampler import Sampler
from .combinations import Combination

#: As _crescent.run takes an arm: its name, draw, pdf, weights, random numbers, what it uses, whether it wants one
#: thread. A combination has weights alone.
CallableArm = tuple[
    str, Callable[..., Any] | None, Callable[..., Any] | None, Callable[..., Any] | None, int, list[str], bool
]


class Samplers(dict[str, Sampler | Combination]):
    """Samplers by the name of their arm. A callable, or the text "FILE.py:NAME", becomes a :class:`crescent.Sampler`;
    :func:`crescent.mis`, :func:`crescent.mixture` and :func:`crescent.ris` combine samplers by their names."""

    def __missing__(self, name: Any) -> Any:
        """KeyError names those that there are, and the nearest."""
        near = _crescent.nearest(str(name), list(self))
        hint = f"; did you mean '{near}'?" if near else ""
        raise KeyError(f"no sampler {name!r}: there are {', '.join(self) or 'none'}{hint}")

    def __setitem__(self, name: str, sampler: Any) -> None:
        super().__setitem__(name, _sampler_of(name, sampler))

    def update(self, *given: Any, **named: Any) -> None:
        """As dict.update, with the checks of an assignment, which are made before any change."""
        super().update({name: _sampler_of(name, sampler) for name, sampler in dict(*given, **named).items()})

    def __ior__(self, other: Any) -> Samplers:  # type: ignore[override,misc]
        self.update(other)
        return self

    def setdefault(self, name: str, sampler: Any = None) -> Any:
        """The sampler of a name, which is added if there is none."""
        if name not in self:
            self[name] = sampler
        return self[name]

    def __delitem__(self, name: str) -> None:
        if name not in self:
            self.__missing__(name)
        super().__delitem__(name)

    def pop(self, name: str, *default: Any) -> Any:
        """Takes a sampler out and returns it."""
        if name not in self and not default:
            self.__missing__(name)
        return super().pop(name, *default)

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError(f"samplers have no attribute '{name}': expected e.samplers[{name!r}] = sampler")

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        raise AttributeError(f"samplers have no attribute '{name}': expected e.samplers[{name!r}]")


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


def source_of(given: Callable[..., Any]) -> str:
    """ "FILE.py:NAME" of a callable; its module if it was not read from a file."""
    call = inspect.unwrap(given)
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


def callable_arm(name: str, sampler: Sampler | Combination) -> CallableArm:
    """A sampler, or a combination whose weights are a function, as an arm of this name."""
    if isinstance(sampler, Combination):
        if not callable(sampler.weights):
            raise TypeError(f"{name}: expected a function for the weights")
        return _weighing(name, sampler.weights, sampler.uses)
    title = sampler.title()
    if not sampler.of_directions() or sampler.weight:
        drawn = f"{sampler.domain!r}" if not sampler.of_directions() else "directions with weight='reciprocal'"
        raise ValueError(f"samplers[{name!r}] draws {drawn}: an arm draws directions with their pdf")
    if not sampler.uses:
        s = _of_library(sampler)
        ask = _arrays.asks_sample(s.sample, title, s.wo != "none")
        pdf = None if s.pdf is None else _arrays.asks_pdf(s.pdf, title, s.wo != "none")
        return (
            name,
            lambda wo, u, context: _without_delta(ask(wo, u), title),
            None if pdf is None else lambda wo, wi, context: pdf(wo, wi),
            None,
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

    return name, draw, None if sampler.pdf is None else density, None, sampler.u, list(sampler.uses), calls.serial


def _weighing(name: str, call: Callable[..., Any], uses: Sequence[str]) -> CallableArm:
    """A function for the weights of a combination, whose rows are tested."""

    def weights(wo: Array, wi: Array, context: Mapping[str, Any]) -> Array:
        p = context["p"]
        more = [Context(uses, tuple(context.get("kind", ())), arrays_of(uses, context, len(wi)))] if uses else []
        w = _arrays.numbers(call(wo, wi, p, *more), f"{name}: weights")
        if w.shape != p.shape:
            raise ValueError(f"{name}: weights: shape {w.shape}, expected {p.shape}, a column for each sampler")
        w = np.asarray(w, np.float64)
        wrong = ~((np.abs(w.sum(axis=1) - 1) <= 1e-6) & (w >= 0).all(axis=1))
        if wrong.any():
            k = int(wrong.argmax())
            raise ValueError(
                f"{name}: weights: row {k} is {w[k].tolist()}, whose sum is {w[k].sum():.9g}: expected weights of 0 or "
                f"more whose sum is one; there wo = {wo[k].tolist()}, wi = {wi[k].tolist()}, p = {p[k].tolist()}"
            )
        return w

    return name, None, None, weights, 2, list(uses), False


def all_counts(arms: Iterable[Mapping[str, Any]]) -> list[int]:
    """The sample counts of any of these arms, ascending."""
    return sorted({n for arm in arms for n in arm["n"]})


def counts_of(sampler: Sampler | Combination, others: Sequence[int]) -> list[int]:
    """The sample counts of a sampler's arm: its own, or those of the others."""
    return list(others) if sampler.n is None else list(np.atleast_1d(sampler.n).tolist())


def table_of(sampler: Sampler | Combination) -> dict[str, Any]:
    """The keys of a sampler's arm, without its sample counts."""
    if isinstance(sampler, Sampler):
        return {"python": source_of(sampler.sample)}
    weights = {"weights_python": source_of(sampler.weights)} if callable(sampler.weights) else {}
    return {**sampler.table(), **weights}


def callable_arms(samplers: Mapping[str, Sampler | Combination], arms: Mapping[str, Mapping[str, Any]]) -> list[CallableArm]:
    """The arms of `samplers`, and those of an experiment's arms that name a sampler or weights in Python."""
    out = [callable_arm(name, s) for name, s in samplers.items() if isinstance(s, Sampler) or callable(s.weights)]
    for name, arm in arms.items():
        if name in samplers:
            continue
        if "python" in arm:
            out.append(callable_arm(name, sampler_at(arm["python"])))
        if "weights_python" in arm:
            out.append(_weighing(name, object_at(arm["weights_python"]), ()))
    return out
