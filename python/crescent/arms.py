"""The built-in samplers and BRDFs as vectorised functions, and the tail index of samples.

phong = crescent.arm("phong", brdf="phong", s=32)
wi, p = phong.sample(wo, u)
crescent.tail(phong.f(wo, wi) * wi[:, 2] / p)
f = crescent.brdf("ggx", alpha=0.2)
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _arrays, _crescent
from ._arrays import Array
from ._sampler import Sampler


def arm_names() -> list[str]:
    """The built-in samplers."""
    return list(_crescent.sampler_names())


def brdf_names() -> list[str]:
    """The built-in lobes; a surface is rho_d / pi + rho_s * lobe."""
    return list(_crescent.brdf_names())


def _core(name: str, lobe: str, s: float, alpha: float, rho_d: float, rho_s: float) -> _crescent.ListedArm:
    """ValueError names an unknown parameter."""
    for what, value, most in (("s", s, 1e6), ("alpha", alpha, 1)):
        if not 0 < value <= most:
            raise ValueError(f"{what} is {value:g}: expected a number above 0, up to {most:g}")
    for what, value in (("rho_d", rho_d), ("rho_s", rho_s)):
        if not 0 <= value <= 1:
            raise ValueError(f"{what} is {value:g}: expected a number from 0 to 1")
    return _crescent.ListedArm(name, lobe, s, alpha, rho_d, rho_s if lobe else 0.0)


def arm(
    name: str, *, brdf: str = "", s: float = 32, alpha: float = 0.3, rho_d: float = 0.5, rho_s: float = 0.4
) -> Sampler:
    """A built-in sampler on a surface: its sample, pdf and f take directions as one row or as many, [n, 3].

    Draws and densities have single precision, as in renders. Samplers that aim at lights are not available.
    """
    core = _core(name, brdf, s, alpha, rho_d, rho_s)
    return Sampler(
        lambda wo, u: core.sample(*_rows(wo, u, "u", 2)),
        lambda wo, wi: core.pdf(*_rows(wo, wi, "wi", 3)),
        lambda wo, wi: core.f(*_rows(wo, wi, "wi", 3)),
        name=name,
    )


def brdf(
    name: str = "", *, s: float = 32, alpha: float = 0.3, rho_d: float = 0.5, rho_s: float = 0.4
) -> Callable[[ArrayLike, ArrayLike], Array]:
    """A built-in BRDF, rho_d / pi + rho_s * lobe, as f(wo, wi) -> [n] in 1/sr, without the cosine; "": Lambert's."""
    core = _core("cosine", name, s, alpha, rho_d, rho_s)
    return lambda wo, wi: core.f(*_rows(wo, wi, "wi", 3))


def _finite(a: ArrayLike, what: str, columns: int) -> Array:
    """Converts to rows of this many numbers; ValueError names the first that is not finite."""
    rows = np.atleast_2d(_arrays.numbers(a, what)).astype(np.float64)
    if rows.ndim != 2 or rows.shape[1] != columns:
        raise ValueError(f"{what}: shape {np.shape(a)}, expected (n, {columns}) or ({columns},)")
    if not np.isfinite(rows).all():
        bad = int(np.argmin(np.isfinite(rows).all(axis=1)))
        raise ValueError(f"{what}: row {bad} is {rows[bad]}, which is not finite")
    return rows


def _rows(wo: ArrayLike, beside: ArrayLike, what: str, columns: int) -> tuple[Array, Array]:
    """Returns both with equal numbers of rows."""
    x, y = _finite(wo, "wo", 3), _finite(beside, what, columns)
    n = max(len(x), len(y)) if len(x) and len(y) else 0
    if not {len(x), len(y)} <= {1, n}:
        raise ValueError(f"{len(x)} rows beside {len(y)}: expected as many, or one")
    if what == "u" and not ((y >= 0) & (y <= 1)).all():
        bad = int(np.argmin(((y >= 0) & (y <= 1)).all(axis=1)))
        raise ValueError(f"u: row {bad} is {y[bad]}: expected numbers from 0 to 1")
    return np.broadcast_to(x, (n, 3)), np.broadcast_to(y, (n, columns))


@dataclass(frozen=True)
class Tail:
    """Pareto shape of the largest weights: from 1/2 on the variance is infinite, from 1 on the mean."""

    k: float
    se: float  #: standard error of k
    exceedances: int  #: number of the largest weights that were fitted

    @property
    def heavy(self) -> bool:
        return self.k >= 0.5


def tail(weights: ArrayLike) -> Tail | None:
    """k-hat of weights f cos / p (Zhang & Stephens 2009, Vehtari et al. 2024); None if they do not vary."""
    values = np.ascontiguousarray(weights, np.float64).ravel()
    if not np.isfinite(values).all():
        raise ValueError(f"weights: row {int(np.argmin(np.isfinite(values)))} is not finite")
    found = _crescent.tail_of(values)
    return Tail(*found) if found else None


def pdf_of(
    sample: Callable[..., Any] | Sampler, *, step: float = 1e-4
) -> Callable[[Array | None, Array], tuple[Array, Array]]:
    """The density of a warp of two numbers, by finite differences: density(wo, u) -> (wi, 1 / |dw/du1 x dw/du2|).

    Valid if `sample` is smooth and one-to-one about u; for testing a formula of the pdf. Its error is of order step^2
    plus that of the rounding over step, and of order step within a step of 0 and 1. A :class:`Sampler` without w_o is
    called with None: density(None, u).
    """
    warp = sample.sample if isinstance(sample, Sampler) else sample
    if not callable(warp):
        raise TypeError(f"sample is {type(sample).__name__}: expected a callable sample(wo, u)")
    takes_wo = not (isinstance(sample, Sampler) and sample.wo == "none")

    def drawn(wo: Array | None, u: Array) -> Array:
        return np.asarray((warp(wo, u) if takes_wo else warp(u))[0], np.float64)

    def density(wo: Array | None, u: Array) -> tuple[Array, Array]:
        at = _finite(u, "u", 2)

        def along(column: int) -> Array:
            ends = [at.copy(), at.copy()]
            ends[0][:, column] = np.maximum(at[:, column] - step, 0)
            ends[1][:, column] = np.minimum(at[:, column] + step, 1)
            below, above = (drawn(wo, end) for end in ends)
            return (above - below) / (ends[1] - ends[0])[:, column, None]

        with np.errstate(divide="ignore"):  # at a pole the warp is not one-to-one
            p = 1 / np.linalg.norm(np.cross(along(0), along(1)), axis=1)
        return drawn(wo, at), p

    return density
