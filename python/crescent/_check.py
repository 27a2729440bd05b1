"""Checks samplers: :func:`check` finds errors, heavy tails and inefficiency."""

from __future__ import annotations

import difflib
import inspect
import json
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from os import PathLike, fspath
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np

from . import _arrays, _crescent
from ._context import on_one_surface
from ._domains import as_weights, charted, with_weights
from ._files import names_a_file, sampler_at
from ._result import CheckResult
from ._libraries import is_compiled, library_named, library_wanted
from ._sampler import Known, Sampler, rows_to_look_with, whole

if TYPE_CHECKING:
    from .experiments import Experiment

Progress = Callable[[str, float, float], None]


@dataclass(frozen=True)
class Description:
    """The distribution of draws: ``print`` shows it; `cases` has the numbers, each with its 95 % interval."""

    text: str
    cases: list[dict[str, Any]]

    def __str__(self) -> str:
        return self.text


def _must_be_known(known: Mapping[str, Any]) -> None:
    for word in known:
        if word not in Known.__annotations__:
            near = difflib.get_close_matches(word, _KEYWORDS, 1)
            raise TypeError(f"check has no keyword '{word}'" + (f": did you mean '{near[0]}'?" if near else ""))


Grid = float | Iterable[float | tuple[float, float]]


def _has_parts(at: Any) -> bool:
    return isinstance(at, Iterable) and not isinstance(at, str)


def _grid(wo_deg: Grid | None, wo: str = "both") -> list[tuple[float, float]]:
    """(theta, azimuth) in degrees; a bare theta is at azimuth 0."""
    if wo_deg is not None and wo == "none":
        raise ValueError("wo_deg is given, and the sampler takes no w_o: wo='none'")
    out = []
    for at in () if wo_deg is None else wo_deg if _has_parts(wo_deg) else [wo_deg]:  # type: ignore[union-attr]
        try:
            theta, azimuth = map(float, at) if _has_parts(at) else (float(at), 0.0)  # type: ignore[arg-type]
        except (TypeError, ValueError):
            raise ValueError(f"wo_deg has {at!r}: expected theta, or (theta, azimuth), in degrees") from None
        if not 0 <= theta <= 180 or theta == 90:
            raise ValueError(f"wo_deg has theta {theta:g}: expected 0 to 180 degrees from the normal, and not 90")
        if not math.isfinite(azimuth):
            raise ValueError(f"wo_deg has azimuth {azimuth:g}: expected degrees")
        if theta > 90 and wo == "upper":
            raise ValueError(f"wo_deg has theta {theta:g}, under the surface: wo='both' if the sampler answers there")
        out.append((theta, azimuth))
    return out


def _numbers(settings: Mapping[str, float]) -> dict[str, float]:
    for key, value in settings.items():
        if not isinstance(value, (int, float, np.number)) or not math.isfinite(value):
            raise ValueError(f"settings: {key} is {value!r}: expected a number")
    return {key: float(value) for key, value in settings.items()}


def _of_library(s: Sampler) -> Sampler:
    """Returns the sampler with callables that take NumPy's arrays, for any library of its own."""
    if s.array_module is np or s.array_module == "numpy" or s.merge:  # neighbours are NumPy's arrays
        return s
    rows = rows_to_look_with(8, s.u) if s.wo != "none" else rows_to_look_with(8, s.u)[1:]
    if s.array_module is None:
        library = library_wanted(s.sample, *rows)
    else:
        library = library_named(s.array_module, s.device, s.sample, rows)
    if library is None:
        return replace(s, serial=True) if is_compiled(s.sample) else s
    return replace(
        s,
        sample=library.samples(s.sample, s.title()),
        pdf=s.pdf and library.asks(s.pdf),
        f=s.f and library.asks(s.f),
        name=s.title(),
        serial=s.serial or library.name in ("torch", "drjit"),  # which have threads of their own
        array_module=np,
    )


def _look(s: Sampler) -> tuple[int, bool, bool]:
    """Returns channels, whether it returns weights, and whether it returns delta parts, from a few results."""
    n, takes_wo = 8, s.wo != "none"
    wo, u = rows_to_look_with(n, s.u)
    wi, _, weight, delta = _arrays.asks_sample(s.sample, s.title(), takes_wo)(wo, u)
    up = np.where(np.all(np.isfinite(wi), axis=1, keepdims=True), wi, [[0.0, 0.0, 1.0]])
    if s.pdf is not None:
        _arrays.asks_pdf(s.pdf, s.title(), takes_wo)(wo, up)
    counts = [weight.shape[1]] if weight is not None else []
    if s.f is not None:
        counts.append(_arrays.channels(s.f(wo, up), n, f"{s.title()}: f").shape[1])
    return max(counts, default=1), weight is not None, delta is not None


def _cases(s: Sampler, full: bool, wo_deg: Grid | None) -> _crescent.CheckCases:
    wo = s.wo or "upper"
    grid = _grid(wo_deg, wo)
    try:
        s = _of_library(s)
        chart = None
        number, reciprocal = s.is_number(), s.weight is not None
        neighbours = s.neighbours if s.merge else 0
        if reciprocal:
            s = with_weights(s)
        if number:
            s = as_weights(s)
        elif not s.of_directions():
            s, chart = charted(s)
        channels, weighs, delta = _look(s)
    except IndexError as e:
        e.add_note(f"{s.title()} was given {s.u} random numbers a sample: u=K says that it takes K of them")
        raise
    count = s.channels or channels
    takes_wo = s.wo != "none"
    eta = None if s.eta is None else [float(v) for v in np.atleast_1d(s.eta)]
    return _crescent.cases_of_callables(
        sample=_arrays.asks_sample(s.sample, s.title(), takes_wo),
        pdf=None if s.pdf is None else _arrays.asks_pdf(s.pdf, s.title(), takes_wo),
        f=None if s.f is None else _arrays.asks_f(s.f, s.title(), count),
        name=s.title(),
        numbers=s.u,
        u_bits=s.u_bits,
        channels=count,
        wo=wo,
        delta=delta if s.delta is None else s.delta,
        weighs=weighs,
        upper_only=s.domain == "hemisphere",
        serial=s.serial,
        reciprocal=s.reciprocal,
        own_random=s.own_random,
        eta=eta,
        importance=s.importance,
        full=full,
        grid=grid,
        domain=chart,
        number=number,
        reciprocal_weight=reciprocal,
        neighbours=neighbours,
        evaluator=s.evaluator or ("", "", ""),
    )


def run_checks(
    cases: _crescent.CheckCases,
    command: str,
    *,
    alpha: float = 1e-3,
    seed: int = 1,
    full: bool = False,
    accept_few: bool = False,
    threads: int = 0,
    other: _crescent.CheckCases | None = None,
    expect_same: bool = False,
    progress: Progress | None = None,
    estimates: list[float] | None = None,
) -> CheckResult:
    """Checks these cases; the keywords are those of :func:`check`."""
    if progress is not None and not callable(progress):
        raise TypeError(f"progress is {type(progress).__name__}: expected a callable progress(what, done, total)")
    seed = whole("seed", seed, 0, 2**32 - 1, "expected a whole number, 0 to 4294967295")
    threads = whole("threads", threads, 0, 1024, "expected a whole number, 0 for one a core")
    checked = _crescent.run_checks(
        cases,
        other,
        alpha=alpha,
        seed=seed,
        full=full,
        accept_few=accept_few,
        expect_same=expect_same,
        threads=threads,
        command=command,
        progress=progress,
        estimates=estimates,
    )
    return CheckResult(checked)


def _sampler_of(sample: Any, pdf: Any, f: Any, known: Known) -> Sampler:
    if not isinstance(sample, Sampler):
        return Sampler(sample, pdf, f, **known)
    if pdf is not None or f is not None:
        raise TypeError("a Sampler holds its own pdf and f: dataclasses.replace(sampler, pdf=pdf) has another")
    return replace(sample, **known)


def _cases_and_title(
    sample: Any,
    pdf: Any,
    f: Any,
    known: Known,
    settings: Mapping[str, float] | None,
    full: bool,
    wo_deg: Grid | None,
) -> tuple[_crescent.CheckCases, str]:
    """Returns the cases of `check` and `describe` over the w_o, and the sampler's name."""
    _must_be_known(known)
    if isinstance(sample, str) and names_a_file(sample):
        sample = sampler_at(sample)
    if isinstance(sample, str):
        if pdf is not None or f is not None or known:
            raise TypeError(f"the built-in arm '{sample}' has its own pdf and f; its parameters go into settings")
        return _crescent.cases_of_arm(sample, _numbers(settings or {}), full, _grid(wo_deg, "upper")), sample
    sampler = _sampler_of(sample, pdf, f, known)
    if settings and not sampler.uses:
        raise TypeError("settings are of a built-in arm, or of a sampler that uses a context: uses=('alpha',)")
    if sampler.uses:
        sampler = on_one_surface(sampler, settings or {})
    return _cases(sampler, full, wo_deg), sampler.title()


def _is_experiment(sample: Any) -> bool:
    from .experiments import Experiment

    return isinstance(sample, Experiment) or (isinstance(sample, (str, PathLike)) and fspath(sample).endswith(".toml"))


def _cases_of_experiment(
    given: Any, sampler: Any, pixels: int, full: bool, wo_deg: Grid | None, keyword: str = "sampler"
) -> tuple[_crescent.CheckCases, str]:
    """Returns the cases of an arm at pixels of its scene, and its name."""
    from ._callable_arms import callable_arms
    from .experiments import Experiment, load

    if not _is_experiment(given):
        raise TypeError(f"sampler is given beside {type(given).__name__}: expected an experiment, or the name of its file")
    if not isinstance(sampler, str):
        raise TypeError(f"{keyword} is {sampler!r}: expected the name of an arm, of one of e.samplers or a built-in sampler")
    pixels = whole("pixels", pixels, 0, 4096, "expected a number of pixels, 0 for the grid of w_o")
    e = given if isinstance(given, Experiment) else load(given)
    with_arms = e._with_arms()
    callables = callable_arms(e.samplers, with_arms._tree()["arms"])
    grid = _grid(wo_deg, "upper")
    return _crescent.cases_of_experiment(with_arms._core, sampler, pixels, full, callables, grid, keyword), sampler


def describe(
    sample: Callable[..., Any] | Sampler | str,
    pdf: Callable[..., Any] | None = None,
    f: Callable[..., Any] | None = None,
    *,
    wo_deg: Grid | None = None,
    seed: int = 1,
    full: bool = False,
    settings: Mapping[str, float] | None = None,
    threads: int = 0,
    progress: Progress | None = None,
    **known: Unpack[Known],
) -> Description:
    """Describes the distribution of a sampler's draws at each w_o; the arguments are those of :func:`check`.

    Nothing is checked, and pdf and f are evaluated only to learn their shapes. `full` makes sixteen times as many
    draws.
    """
    cases, _ = _cases_and_title(sample, pdf, f, known, settings, full, wo_deg)
    seed = whole("seed", seed, 0, 2**32 - 1, "expected a whole number, 0 to 4294967295")
    threads = whole("threads", threads, 0, 1024, "expected a whole number, 0 for one a core")
    text, numbers = _crescent.describe(cases, seed=seed, full=full, threads=threads, progress=progress)
    return Description(text, json.loads(numbers))


def check(
    sample: Callable[..., Any] | Sampler | Experiment | str,
    pdf: Callable[..., Any] | None = None,
    f: Callable[..., Any] | None = None,
    *,
    sampler: str | None = None,
    pixels: int = 0,
    wo_deg: Grid | None = None,
    alpha: float = 1e-3,
    seed: int = 1,
    full: bool = False,
    against: Sampler | str | None = None,
    expect_same: bool = False,
    estimates: float | Sequence[float] | None = None,
    settings: Mapping[str, float] | None = None,
    threads: int = 0,
    progress: Progress | None = None,
    **known: Unpack[Known],
) -> CheckResult:
    """Checks a sampler over a grid of w_o.

    `sample`, `pdf` and `f` are vectorised callables (see :class:`Sampler`); or `sample` is a :class:`Sampler`, or the
    place of one, "mine.py:sampler", whose folder is added to the path as pytest adds that of a test; or it is the name
    of a built-in sampler, whose parameters `settings` gives: ``check("phong", settings={"s": 32})``. Properties of a
    sampler of callables are given by the fields of :class:`Sampler` as keywords: name, u, domain, wo, channels, delta,
    eta, ...

    `sample` may also be an experiment, or its file: ``check(e, sampler="mine", pixels=64)`` checks that arm, one of
    ``e.samplers`` or a built-in sampler with the materials and lights of the scene, at so many pixels in view, or with
    ``pixels=0`` over the grid of w_o on each material. `wo_deg` is then at these pixels or on each material, and
    `against` another arm of the experiment.

    `wo_deg`: angles from the normal, or (angle, azimuth), in degrees, instead of the grid. `alpha`: the probability
    that a correct sampler is reported as wrong, over everything in the call. `against`: a second sampler, compared with
    the first. `estimates`: the expected value of a sampler with ``domain="number"``, whose draws are values, or one for
    each of three channels; or `against` is another estimator of the same number. `progress(what, done, total)` is called several times a second.
    """
    of_experiment = sampler is not None or _is_experiment(sample)
    if of_experiment:
        cases, title = _cases_of_experiment(sample, sampler, pixels, full, wo_deg)
        given = {"pdf": pdf, "f": f, "settings": settings, **known}
        for what, value in given.items():
            if value is not None:
                raise TypeError(f"{what} is not for an arm of an experiment")
    elif pixels:
        raise TypeError("pixels are of an experiment: crescent.check(e, sampler=NAME, pixels=64)")
    else:
        cases, title = _cases_and_title(sample, pdf, f, known, settings, full, wo_deg)
    other = None
    if of_experiment and against is not None:
        other, _ = _cases_of_experiment(sample, against, pixels, full, wo_deg, "against")
    elif isinstance(against, str):
        other = _crescent.baseline_of(against, cases)
    elif isinstance(against, Sampler):
        against = on_one_surface(against, settings or {}) if against.uses else against
        other = _cases(against, full, wo_deg)
    elif against is not None:
        raise TypeError(
            f"against is {type(against).__name__}: expected a crescent.Sampler(sample, pdf, f), or the name of an arm"
        )
    is_number = not of_experiment and cases.number
    if (estimates is None) == (against is None) and is_number:
        raise TypeError(f"{title} draws values: expected either estimates=VALUE, their mean, or against=another estimator")
    if estimates is not None and not is_number:
        raise TypeError("estimates is for a sampler whose draws are values: domain='number'")
    return run_checks(
        cases,
        f"crescent.check({title!r})",
        estimates=None if estimates is None else [float(v) for v in np.atleast_1d(estimates)],
        alpha=alpha,
        seed=seed,
        full=full,
        threads=threads,
        other=other,
        expect_same=expect_same,
        progress=progress,
    )


def _spelled_out() -> inspect.Signature:
    """Returns check's parameters with the fields of Sampler one by one, for help() and notebooks."""
    given = inspect.signature(check)
    keyword = inspect.Parameter.KEYWORD_ONLY
    known = [
        inspect.Parameter(at.name, keyword, default=at.default, annotation=at.type)
        for at in fields(Sampler)
        if at.name in Known.__annotations__
    ]
    own = [p for p in given.parameters.values() if p.kind != inspect.Parameter.VAR_KEYWORD]
    first = [p for p in own if p.kind != keyword]
    return given.replace(parameters=[*first, *known, *(p for p in own if p.kind == keyword)])


check.__signature__ = _spelled_out()  # type: ignore[attr-defined]
_KEYWORDS = list(inspect.signature(check).parameters)
