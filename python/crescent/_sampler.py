"""A user's sampler: its callables and properties, validated when it is created."""

from __future__ import annotations

import difflib
import operator
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypedDict

import numpy as np

from . import _crescent
from ._arrays import Array

Asked = Literal["upper", "both", "none"]
Use = Literal["s", "alpha", "rho_d", "rho_s", "side", "eta", "lights"]


#: Domains of directions; docs/domains.md has the others.
DIRECTIONS = ("sphere", "hemisphere")
_SIDES = ("upper", "both", "none")
_USES = ("s", "alpha", "rho_d", "rho_s", "side", "eta", "lights")


def whole(what: str, value: Any, least: int, most: int, expected: str) -> int:
    """Returns an integer in a range; else raises TypeError or ValueError."""
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{what} is {value!r}: {expected}") from None
    if not least <= number <= most:
        raise ValueError(f"{what} is {number}: {expected}")
    return number


def counts(n: int | Sequence[int] | None) -> tuple[int, ...] | None:
    """Sample counts of an arm."""
    if n is None:
        return None
    expected = "expected a sample count, 1 to 16777216, or several, such as [4, 16]"
    given = list(n) if isinstance(n, Iterable) and not isinstance(n, str) else [n]
    if not given:
        raise ValueError(f"n is {n!r}: {expected}")
    return tuple(sorted({whole("n", k, 1, 1 << 24, expected) for k in given}))


def _uses(given: Any) -> tuple[str, ...]:
    """The names of a sequence, each once."""
    if isinstance(given, str) or not isinstance(given, Iterable):
        raise TypeError(f"uses is {given!r}: expected a sequence of {', '.join(_USES)}")
    for name in (names := tuple(dict.fromkeys(given))):
        if name not in _USES:
            near = difflib.get_close_matches(str(name), _USES, 1)
            hint = f"; did you mean '{near[0]}'?" if near else ""
            raise ValueError(f"uses has {name!r}: expected {', '.join(_USES)}{hint}")
    return names


@dataclass(frozen=True)
class _Radiance:
    """The radiance of a light in the place of f: their integrals have the same form."""

    of: Callable[..., Any]

    def __call__(self, *at: Any) -> Any:
        """at: w_o and w_i, or w_i alone."""
        return self.of(at[-1])


@dataclass(frozen=True)
class Sampler:
    """A sampler's callables and properties.

    Local frame, n = +z; wo is given, wi drawn, both leave the surface; pdf in 1/sr; f in 1/sr without the cosine.
    """

    sample: Callable[..., Any]  #: sample(wo[n,3], u[n,k]) -> (wi[n,3], pdf[n][, weight[n,c][, delta[n]]])
    pdf: Callable[..., Any] | None = None  #: pdf(wo[n,3], wi[n,3]) -> [n]
    f: Callable[..., Any] | None = None  #: f(wo[n,3], wi[n,3]) -> [n] or [n,3]
    name: str = ""
    u: int = 2  #: random numbers per sample, 1 to 8
    numbers: int | None = None  #: another name of u
    u_bits: int = 24  #: their resolution in a check: 24 bits, as in a run, or 53
    #: what it draws: directions of the "sphere" or "hemisphere", where pdf and f are 0 below the surface for any result
    #: of the callables there; or points, "disk", "square", "cube", "triangle", "line:A,B", "set:N" or a product such as
    #: "sphere x line:0,inf": sample(u) -> (x, pdf[, weight]), pdf(x), f(x); or "number": sample(u) -> values[n]
    domain: str = "sphere"
    #: the w_o that it supports; "none": sample(u) and pdf(wi), as for an environment light. None: "upper", and "none" for
    #: points
    wo: Asked | None = None
    channels: int | None = None  #: 1 or 3; None: the number of f and the weights
    delta: bool | None = None  #: some draws are delta parts; None: if sample returns four parts
    eta: float | Sequence[float] | None = None  #: index of refraction below over above
    importance: bool = False  #: f is scaled for importance, not for radiance
    reciprocal: bool = True  #: False: f is known not to be reciprocal
    own_random: bool = False  #: it draws random numbers of its own: the same u may give another answer
    serial: bool = False  #: its callables want one thread, the caller's own
    #: what the callables use of the surface point, by a third argument: sample(wo, u, ctx), pdf(wo, wi, ctx)
    uses: Sequence[Use] = ()
    #: whose arrays the callables take: "torch", "jax" or a module with asarray; None: those that they answer with
    array_module: Any = None
    device: Any = None  #: the device of these arrays, in that library's notation
    #: of a light, radiance(wi[n,3]) -> [n] or [n,3], W/(sr m^2): wo is "none", and `check` compares the estimate of the
    #: irradiance with its quadrature
    radiance: Callable[..., Any] | None = None
    #: "reciprocal": sample(wo, u) -> (wi, W), where W is random and estimates 1/p, as that of a reservoir does
    weight: Literal["reciprocal"] | None = None
    merge: bool = False  #: sample(wo, u, neighbours[n,K,7]): it merges their reservoirs, see docs/domains.md
    neighbours: int = 8  #: K, from 1 to 64, in crescent.check; a file is given those of --neighbours
    n: int | Sequence[int] | None = None  #: the sample counts of its arm in a run; None: those of the other arms
    target: Callable[..., Any] | None = None  #: target(wo[n,3], wi[n,3]) -> [n], on whose support E[h W] is the integral of h
    #: what evaluates the callables, for reports: the names of a device and its driver, and "single" or "double"
    evaluator: tuple[str, str, str] | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "n", counts(self.n))
        if self.radiance is not None:
            if not callable(self.radiance):
                raise TypeError(f"radiance is {type(self.radiance).__name__}: expected a callable radiance(wi)")
            if self.f is not None and not isinstance(self.f, _Radiance):
                raise TypeError("f and radiance are given: a light has its radiance alone")
            object.__setattr__(self, "f", _Radiance(self.radiance))
            object.__setattr__(self, "wo", "none")
        for what, taken in (("sample", "wo, u"), ("pdf", "wo, wi"), ("f", "wo, wi")):
            call = getattr(self, what)
            if not callable(call) and (call is not None or what == "sample"):
                raise TypeError(f"{what} is {type(call).__name__}: expected a callable {what}({taken})")
        if not isinstance(self.name, str):
            raise TypeError(f"name is {type(self.name).__name__}: expected a text")
        if self.numbers is not None:
            object.__setattr__(self, "u", self.numbers)
        object.__setattr__(self, "u", whole("u", self.u, 1, 8, "a sample takes 1 to 8 random numbers"))
        if self.wo is None:
            object.__setattr__(self, "wo", "upper" if self.of_directions() else "none")
        for what, words in (("channels", (None, 1, 3)), ("wo", _SIDES), ("u_bits", (24, 53))):
            if getattr(self, what) not in words:
                expected = " or ".join(repr(w) for w in words if w is not None)
                raise ValueError(f"{what} is {getattr(self, what)!r}: expected {expected}")
        object.__setattr__(self, "uses", _uses(self.uses))
        if self.eta is not None:
            eta = np.atleast_1d(np.asarray(self.eta, np.float64))
            if eta.shape not in ((1,), (3,)) or not (np.isfinite(eta) & (eta > 0)).all():
                raise ValueError(f"eta is {self.eta!r}: expected a number above 0, or three of them")

        if self.evaluator is not None and (len(self.evaluator) != 3 or self.evaluator[2] not in ("single", "double")):
            raise ValueError(f"evaluator is {self.evaluator!r}: expected (device, driver, 'single' or 'double')")
        if not isinstance(self.domain, str):
            raise TypeError(f"domain is {self.domain!r}: expected a text")
        if not self.of_directions():
            self._check_points()
        if self.weight not in (None, "reciprocal"):
            raise ValueError(f"weight is {self.weight!r}: expected None or 'reciprocal'")
        if (self.weight is None) != (self.target is None):
            raise TypeError("weight='reciprocal' and target(wo, wi) go together: samples are (wi, W), and W estimates 1/p")
        object.__setattr__(
            self, "neighbours", whole("neighbours", self.neighbours, 1, 64, "expected 1 to 64 neighbours")
        )
        if self.merge and (self.weight is None or not self.of_directions() or self.wo == "none"):
            raise ValueError("merge is given: it is for directions with a w_o and weight='reciprocal'")
        if self.merge and getattr(self.array_module, "__name__", self.array_module) not in (None, "numpy"):
            raise ValueError("merge is given: its neighbours are arrays of NumPy; expected array_module=None")
        if self.weight and (self.pdf is not None or self.f is not None or self.delta):
            raise ValueError("pdf, f or delta is given: a sampler with weight='reciprocal' has sample and target alone")

    def of_directions(self) -> bool:
        """Whether it draws directions, and not points of another domain."""
        return self.domain in DIRECTIONS

    def is_number(self) -> bool:
        """Whether its draws are values, estimates of a number."""
        return self.domain == "number"

    def _check_points(self) -> None:
        if self.is_number():
            for what in ("pdf", "f", "delta", "eta", "uses", "radiance"):
                if getattr(self, what):
                    raise ValueError(f"{what} is given: an estimator of a number has sample(u) -> values alone")
            object.__setattr__(self, "wo", "none")
            return
        chart = _crescent.domain_chart(self.domain)
        most = chart.most_numbers
        if self.u > most:
            raise ValueError(f"u is {self.u}: over the domain {self.domain!r} a sample takes at most {most}")
        for what in ("delta", "eta", "uses", "radiance"):
            if getattr(self, what):
                raise ValueError(f"{what} is given: it is for samplers of directions, and the domain is {self.domain!r}")

    def title(self) -> str:
        """Its name, or that of the function that draws."""
        return self.name or getattr(self.sample, "__name__", type(self.sample).__name__)


class Known(TypedDict, total=False):
    """The keywords of check for a sampler of callables: the fields of Sampler."""

    name: str
    u: int
    numbers: int | None
    u_bits: int
    domain: str
    wo: Asked | None
    channels: int | None
    delta: bool | None
    eta: float | Sequence[float] | None
    importance: bool
    reciprocal: bool
    own_random: bool
    serial: bool
    uses: Sequence[Use]
    array_module: Any
    device: Any
    radiance: Callable[..., Any] | None
    weight: Literal["reciprocal"] | None
    target: Callable[..., Any] | None
    merge: bool
    neighbours: int
    evaluator: tuple[str, str, str] | None


def rows_to_look_with(n: int, numbers: int) -> tuple[Array, Array]:
    """Returns a few rows for testing a sampler's form: w_o and u."""
    wo = np.tile([[0.5, 0.0, np.sqrt(0.75)]], (n, 1))
    return wo, (np.arange(n)[:, None] + 0.5) / n * np.ones((1, numbers)) * np.linspace(1, 0.6, numbers)
