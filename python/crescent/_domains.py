"""Samplers of points of other domains than directions, as the samplers of directions that the core checks.

A point is ``x[n]`` where one number describes it, or ``x[n, d]``; entries of a set are integers. Densities are those of
docs/domains.md: per length, area or volume, or probabilities.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from . import _arrays, _crescent
from ._arrays import Array
from ._sampler import Sampler

Points = tuple[Array, Array, Array | None]


def points(answer: Any, n: int, name: str, coordinates: int) -> Points:
    """Returns (x[n, d], pdf[n], weight or None) from the result of `sample`."""
    if isinstance(answer, Mapping):
        if set(answer) - {"x", "pdf", "weight"} or not {"x", "pdf"} <= set(answer):
            raise ValueError(f"{name}: sample gave the keys {sorted(answer)}, expected x and pdf, weight")
        answer = tuple(answer.get(key) for key in ("x", "pdf", "weight"))
    if not isinstance(answer, (tuple, list)) or not 2 <= len(answer) <= 3:
        got = f"{len(answer)} values" if isinstance(answer, (tuple, list)) else type(answer).__name__
        raise ValueError(f"{name}: sample gave {got}, expected (x, pdf) or (x, pdf, weight)")
    x, pdf, weight = (*answer, None)[:3]
    told = f"{name}: sample's "
    at = _arrays.numbers(x, told + "x")
    if at.ndim < 2 and coordinates == 1:
        at = _arrays.column(at, n, told + "x")[:, None]
    if at.ndim != 2 or at.shape != (n, coordinates):
        expected = f"({n},)" if coordinates == 1 else f"({n}, {coordinates})"
        raise ValueError(f"{told}x: shape {at.shape}, expected {expected}")
    return (
        np.ascontiguousarray(at, np.float64),
        _arrays.column(pdf, n, told + "pdf"),
        None if weight is None else _arrays.channels(weight, n, told + "weight"),
    )


def values(answer: Any, n: int, name: str) -> Array:
    """Returns values[n, c] from the result of `sample` of an estimator of a number."""
    return _arrays.channels(answer, n, f"{name}: sample's values")


def as_weights(s: Sampler) -> Sampler:
    """Returns an estimator of a number as a sampler whose weights are its values."""
    name = s.title()

    def sample(u: Array) -> tuple[Array, Array, Array]:
        n = len(u)
        return np.broadcast_to([0.0, 0.0, 1.0], (n, 3)), np.ones(n), values(s.sample(u), n, name)

    return replace(s, sample=sample, name=name, numbers=None, domain="sphere")


NEIGHBOUR_COLUMNS = 7  # w_o, n, light


def weighted(answer: Any, n: int, name: str) -> tuple[Any, Array, Array]:
    """Returns w_i, 1 or 0 for a draw or none, and W."""
    if not isinstance(answer, (tuple, list)) or len(answer) != 2:
        raise ValueError(f"{name}: sample gave {type(answer).__name__}, expected (wi, W)")
    weight = _arrays.column(answer[1], n, f"{name}: sample's W")
    return answer[0], (weight != 0).astype(np.float64), weight[:, None]


def _neighbours(wo: Array, count: int) -> Array:
    """Returns the neighbours of each w_o, [n, K, 7]."""
    each, index = np.unique(wo, axis=0, return_inverse=True)
    return np.array([_crescent.neighbours_of(x, y, z, count) for x, y, z in each.tolist()])[index.reshape(-1)]


def with_weights(s: Sampler) -> Sampler:
    """Returns a sampler of (w_i, W) as one without pdf whose weights are W, and whose f is the target."""
    name, takes_wo = s.title(), s.wo != "none"

    def sample(*given: Array) -> tuple[Any, Array, Array]:
        more = (_neighbours(given[0], s.neighbours),) if s.merge else ()
        return weighted(s.sample(*given, *more), len(given[-1]), name)

    target = s.target
    assert target is not None
    f = target if takes_wo or not s.of_directions() else lambda wo, wi: target(wi)
    return replace(s, sample=sample, f=f, name=name, weight=None, target=None, merge=False)


def as_given(x: Array, chart: Any) -> Array:
    """Returns points as the callables take them."""
    if x.shape[1] == 1:
        x = x[:, 0]
    return x.astype(np.int64) if chart.discrete else x


def charted(s: Sampler) -> tuple[Sampler, Any]:
    """Returns the sampler of directions that the points of this one are, and the chart of its domain."""
    chart = _crescent.domain_chart(s.domain)
    name, takes_wo, own = s.title(), s.wo != "none", s.u

    def draw(wo: Array, u: Array) -> Points:
        return points(s.sample(wo, u) if takes_wo else s.sample(u), len(u), name, chart.coordinates)

    if chart.infinite:
        n = _crescent.draws_of_chart
        rng = np.random.default_rng(0x6C696E65)
        tilt = np.radians(15 + 15 * (np.arange(n) % 5))
        wo = np.column_stack([np.sin(tilt), np.zeros(n), np.cos(tilt)])
        x, pdf, _ = draw(wo, rng.random((n, own)))
        chart.fit(np.ascontiguousarray(x[pdf > 0]))

    def sample(wo: Array, u: Array) -> tuple[Array, Array, Array | None, None]:
        x, pdf, weight = draw(wo, np.asfortranarray(u[:, :own]))
        w, factor = chart.directions(x, np.ascontiguousarray(u[:, own:]))
        return w, pdf * factor, weight, None

    def over_directions(call: Callable[..., Any], what: str) -> Callable[..., Any]:
        def ask(wo: Array, w: Array) -> Array:
            x, factor = chart.points(np.ascontiguousarray(w))
            inside = factor > 0
            at = as_given(x[inside], chart)
            answer = call(wo[inside], at) if takes_wo else call(at)
            values = _arrays.channels(answer, len(at), f"{name}: {what}")
            out = np.zeros((len(w), values.shape[1]))
            out[inside] = values * factor[inside, None]
            return out

        return ask

    def without_wo(call: Callable[..., Any]) -> Callable[..., Any]:
        return call if takes_wo else lambda at: call(np.empty((len(at), 0)), at)

    def column(call: Callable[..., Any]) -> Callable[..., Any]:
        return lambda *at: call(*at)[:, 0]

    return (
        replace(
            s,
            sample=without_wo(sample),
            pdf=s.pdf and column(without_wo(over_directions(s.pdf, "pdf"))),
            f=s.f and over_directions(s.f, "f"),
            name=name,
            u=own + chart.spreads,
            numbers=None,
            domain="sphere",
        ),
        chart,
    )
