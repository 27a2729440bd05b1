"""Combinations of samplers: :func:`mis`, :func:`mixture` and :func:`ris`, as an experiment file declares them.

e.samplers["mine"] = crescent.Sampler(sample, pdf)
e.samplers["both"] = crescent.mis("mine", "light-area", heuristic="power")
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

Weight = float | str  #: a number, a formula such as "rho_s / (rho_s + rho_d)", or "rest" as the last


@dataclass(frozen=True)
class Combination:
    """A combination of samplers by their names: the keys of an arm with a kind (docs/samplers.md)."""

    kind: Literal["mis", "mixture", "ris"]
    of: tuple[str, ...]
    heuristic: str | None = None
    draw: str | None = None
    weights: tuple[Weight, ...] | None = None
    probabilities: tuple[Weight, ...] | None = None
    samples: int | tuple[int, ...] | None = None
    candidates: int | None = None
    target: str | None = None

    def table(self) -> dict[str, Any]:
        """The keys that are given."""
        return {key: value for key, value in vars(self).items() if value is not None}


def _names(of: Sequence[str]) -> tuple[str, ...]:
    for name in of:
        if not isinstance(name, str):
            raise TypeError(
                f"of has {type(name).__name__}: expected names of arms, of samplers of e.samplers, or of built-in ones"
            )
    return tuple(of)


def _weights(given: Sequence[Weight] | None) -> tuple[Weight, ...] | None:
    return None if given is None else tuple(given)


def mis(
    *of: str,
    heuristic: Literal["balance", "power"] | None = None,
    weights: Sequence[Weight] | None = None,
    draw: Literal["every", "one"] | None = None,
    samples: int | Sequence[int] | None = None,
    probabilities: Sequence[Weight] | None = None,
) -> Combination:
    """Multiple importance sampling of these samplers.

    `heuristic`: "balance" (default) or "power"; `weights` are the user's own in its place, numbers or formulas of the
    densities p1, p2, ... (1/sr), s, alpha, rho_d, rho_s, cos_o and cos_i, whose sum is one. `draw`: a sample is a
    direction of "every" sampler (`samples` of each), or of "one" that is chosen with `probabilities`.
    """
    count = tuple(samples) if isinstance(samples, Sequence) else samples
    return Combination("mis", _names(of), heuristic, draw, _weights(weights), _weights(probabilities), count)


def mixture(*of: str, weights: Sequence[Weight] | None = None) -> Combination:
    """One density, the sum of weight times density; `weights` are equal by default, numbers or formulas of s, alpha,
    rho_d, rho_s and cos_o, and their sum is one."""
    return Combination("mixture", _names(of), weights=_weights(weights))


def ris(*of: str, candidates: int, target: str | None = None) -> Combination:
    """Resampled importance sampling: of `candidates` directions, drawn from the samplers in turn, one is chosen by
    `target`: "product" (default; f L cos without shadows), "brdf" (f cos), or the name of a sampler whose density it
    is."""
    return Combination("ris", _names(of), candidates=candidates, target=target)
