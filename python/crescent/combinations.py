"""Combinations of samplers: :func:`mis`, :func:`mixture` and :func:`ris`, as an experiment file declares them.

e.samplers["mine"] = crescent.Sampler(sample, pdf)
e.samplers["both"] = crescent.mis("mine", "light-area", heuristic="power")
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from ._context import ARRAYS
from ._sampler import counts

#: weights(wo, wi, p) -> w, all of n rows: p[n, K] and w[n, K] have a column for each sampler
WeightFunction = Callable[..., Any]
Weight = float | str  #: a number, a formula such as "rho_s / (rho_s + rho_d)", or "rest" as the last


@dataclass(frozen=True)
class Combination:
    """A combination of samplers by their names: the keys of an arm with a kind (docs/samplers.md)."""

    kind: Literal["mis", "mixture", "ris"]
    of: tuple[str, ...]
    heuristic: str | None = None
    draw: str | None = None
    weights: tuple[Weight, ...] | WeightFunction | None = None
    probabilities: tuple[Weight, ...] | None = None
    samples: int | tuple[int, ...] | None = None
    candidates: int | None = None
    target: str | None = None
    uses: tuple[str, ...] = ()  #: what a function for the weights uses, as of a Sampler
    n: tuple[int, ...] | None = None  #: its sample counts in a run; None: those of the other arms

    def table(self) -> dict[str, Any]:
        """The keys that are given, without a function for the weights."""
        own = {key: value for key, value in vars(self).items() if key not in ("uses", "n") and value is not None}
        return {key: value for key, value in own.items() if not callable(value)}


def _names(of: Sequence[str]) -> tuple[str, ...]:
    for name in of:
        if not isinstance(name, str):
            raise TypeError(
                f"of has {type(name).__name__}: expected names of arms, of samplers of e.samplers, or of built-in ones"
            )
    return tuple(of)


def _weights(given: Sequence[Weight] | None) -> tuple[Weight, ...] | None:
    if callable(given):
        raise TypeError("weights is a function: expected numbers or formulas; functions weight mis alone")
    return None if given is None else tuple(given)


def mis(
    *of: str,
    heuristic: Literal["balance", "power"] | None = None,
    weights: Sequence[Weight] | WeightFunction | None = None,
    draw: Literal["every", "one"] | None = None,
    samples: int | Sequence[int] | None = None,
    probabilities: Sequence[Weight] | None = None,
    uses: Sequence[str] = (),
    n: int | Sequence[int] | None = None,
) -> Combination:
    """Multiple importance sampling of these samplers.

    `heuristic`: "balance" (default) or "power"; `weights` are the user's own in its place, numbers or formulas of the
    densities p1, p2, ... (1/sr), s, alpha, rho_d, rho_s, cos_o and cos_i, whose sum is one; or a function
    ``weights(wo[n, 3], wi[n, 3], p[n, K]) -> w[n, K]`` of NumPy arrays, with the densities of all K samplers at each
    direction, whose rows sum to one. It takes a fourth argument with the surface and the lights if `uses` names any,
    as the callables of a :class:`Sampler` do. `draw`: a sample is a
    direction of "every" sampler (`samples` of each), or of "one" that is chosen with `probabilities`. `n`: the sample
    counts of its arm, by default those of the other arms.
    """
    count = tuple(samples) if isinstance(samples, Sequence) else samples
    own = weights if callable(weights) else _weights(weights)
    if own is None or not callable(own):
        if uses:
            raise TypeError("uses is of a function for the weights: expected weights=function")
    elif heuristic is not None:
        raise TypeError("weights and heuristic are given: expected one of them")
    for name in uses:
        if name not in ARRAYS:
            raise ValueError(f"uses has {name!r}: expected one of {', '.join(ARRAYS)}")
    return Combination("mis", _names(of), heuristic, draw, own, _weights(probabilities), count, uses=tuple(uses), n=counts(n))


def mixture(
    *of: str, weights: Sequence[Weight] | None = None, n: int | Sequence[int] | None = None
) -> Combination:
    """One density, the sum of weight times density; `weights` are equal by default, numbers or formulas of s, alpha,
    rho_d, rho_s and cos_o, and their sum is one."""
    return Combination("mixture", _names(of), weights=_weights(weights), n=counts(n))


def ris(
    *of: str, candidates: int, target: str | None = None, n: int | Sequence[int] | None = None
) -> Combination:
    """Resampled importance sampling: of `candidates` directions, drawn from the samplers in turn, one is chosen by
    `target`: "product" (default; f L cos without shadows), "brdf" (f cos), or the name of a sampler whose density it
    is."""
    return Combination("ris", _names(of), candidates=candidates, target=target, n=counts(n))
