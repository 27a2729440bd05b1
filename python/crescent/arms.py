"""The built-in arms and BRDFs as vectorised functions, and numbers about samples.

phong = crescent.arm("phong", brdf="phong", s=32)
wi, p = phong.sample(wo, u)
crescent.tail(phong.f(wo, wi) * wi[:, 2] / p)
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _crescent
from ._arrays import Array
from ._sampler import Sampler


def arm_names() -> list[str]:
    """The arms of the list."""
    return list(_crescent.sampler_names())


def brdf_names() -> list[str]:
    """The lobes of the list; a surface is rho_d / pi + rho_s * lobe."""
    return list(_crescent.brdf_names())


def arm(
    name: str, *, brdf: str = "", s: float = 32, alpha: float = 0.3, rho_d: float = 0.5, rho_s: float = 0.4
) -> Sampler:
    """A built-in arm on a surface: its sample, pdf and f take directions as one row or as many, [n, 3].

    Draws and densities are of single precision, as they render. Arms that aim at lamps are none of these.
    """
    core = _crescent.ListedArm(name, brdf, s, alpha, rho_d, rho_s if brdf else 0.0)
    return Sampler(
        lambda wo, u: core.sample(*_rows(wo, u)),
        lambda wo, wi: core.pdf(*_rows(wo, wi)),
        lambda wo, wi: core.f(*_rows(wo, wi)),
        name=name,
    )


def _rows(a: ArrayLike, b: ArrayLike) -> tuple[Array, Array]:
    """Both as rows, as many of one as of the other."""
    x, y = np.atleast_2d(np.asarray(a, np.float64)), np.atleast_2d(np.asarray(b, np.float64))
    n = max(len(x), len(y))
    if not {len(x), len(y)} <= {1, n}:
        raise ValueError(f"{len(x)} rows beside {len(y)}: expected as many, or one")
    return np.broadcast_to(x, (n, x.shape[1])), np.broadcast_to(y, (n, y.shape[1]))


@dataclass(frozen=True)
class Tail:
    """Pareto shape of the largest weights: from 1/2 on the variance is infinite, from 1 on the mean."""

    k: float
    se: float  #: standard error of k
    exceedances: int  #: how many of the largest it was fitted to

    @property
    def heavy(self) -> bool:
        return self.k >= 0.5


def tail(weights: ArrayLike) -> Tail | None:
    """k-hat of weights f cos / p (Zhang & Stephens 2009, Vehtari et al. 2024); None where they do not spread."""
    values = np.ascontiguousarray(weights, np.float64).ravel()
    if not np.isfinite(values).all():
        raise ValueError(f"weights: row {int(np.argmin(np.isfinite(values)))} is not finite")
    found = _crescent.tail_of(values)
    return Tail(*found) if found else None


def pdf_of(sample: Callable[..., Any], *, step: float = 1e-4) -> Callable[[Array, Array], tuple[Array, Array]]:
    """The density that a warp of two numbers has, by differences: density(wo, u) -> (wi, 1 / |dw/du1 x dw/du2|).

    True where `sample` is smooth and one-to-one about u: what to hold a formula for the pdf against. Its error is of
    order step^2 beside that of the rounding over step.
    """

    def density(wo: Array, u: Array) -> tuple[Array, Array]:
        def drawn(shift: ArrayLike) -> Array:
            return np.asarray(sample(wo, u + np.asarray(shift))[0], np.float64)

        along = [(drawn(h) - drawn(-np.asarray(h))) / (2 * step) for h in ([step, 0.0], [0.0, step])]
        return np.asarray(sample(wo, u)[0], np.float64), 1 / np.linalg.norm(np.cross(along[0], along[1]), axis=1)

    return density
