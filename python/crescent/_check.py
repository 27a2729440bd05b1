"""Is this sampler wrong, right but heavy-tailed, or right and good? One call: :func:`check`."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from . import _arrays, _crescent
from ._judgement import Judgement
from ._libraries import Library, library_wanted

Progress = Callable[[str, float, float], None]
Domain = Literal["sphere", "hemisphere"]
Asked = Literal["upper", "both", "none"]


@dataclass(frozen=True)
class Sampler:
    """A sampler's callables with what is known of it.

    Local frame, n = +z; wo is given, wi drawn, both leave the surface; pdf in 1/sr; f in 1/sr without the cosine.
    """

    sample: Callable[..., Any]  #: sample(wo[n,3], u[n,k]) -> (wi[n,3], pdf[n][, weight[n,c][, delta[n]]])
    pdf: Callable[..., Any] | None = None  #: pdf(wo[n,3], wi[n,3]) -> [n]
    f: Callable[..., Any] | None = None  #: f(wo[n,3], wi[n,3]) -> [n] or [n,3]
    name: str = ""
    u: int = 2  #: random numbers a sample takes, 1 to 8
    domain: Domain = "sphere"  #: "hemisphere": pdf and f are 0 under the surface whatever the callables say there
    wo: Asked = "upper"  #: the w_o that it answers for; "none": sample(u) and pdf(wi), as of an environment light
    channels: int | None = None  #: 1 or 3; None: as f and the weights have
    delta: bool | None = None  #: some draws are of delta parts; None: where sample gives four parts
    eta: float | Sequence[float] | None = None  #: index of refraction below over above
    importance: bool = False  #: f is scaled as importance is, not as radiance
    reciprocal: bool = True  #: False: f is known not to be reciprocal
    serial: bool = False  #: its callables want one thread, the caller's own
    #: whose arrays the callables take: "torch", "jax" or a module with asarray; None: those that they answer with
    array_module: Any = None
    device: Any = None  #: where these arrays lie, as that library says it

    def __post_init__(self) -> None:
        if not callable(self.sample):
            raise TypeError(f"sample is {type(self.sample).__name__}: expected a callable sample(wo, u)")
        if not 1 <= self.u <= 8:
            raise ValueError(f"u is {self.u}: a sample takes 1 to 8 random numbers")
        if self.channels not in (None, 1, 3):
            raise ValueError(f"channels is {self.channels}: expected 1 or 3")
        if self.domain not in ("sphere", "hemisphere"):
            raise ValueError(f"domain is {self.domain!r}: expected 'sphere' or 'hemisphere'")

    def title(self) -> str:
        """Its name, or that of the function which draws."""
        return self.name or getattr(self.sample, "__name__", type(self.sample).__name__)


Grid = Iterable[float | tuple[float, float]]


def _grid(wo_deg: Grid | None) -> list[tuple[float, float]]:
    """(theta, azimuth) in degrees; a bare theta is at azimuth 0."""
    out = []
    for at in wo_deg or ():
        theta, azimuth = (float(at), 0.0) if isinstance(at, (int, float)) else (float(at[0]), float(at[1]))
        if not 0 <= theta <= 180 or theta == 90:
            raise ValueError(f"wo_deg has theta {theta:g}: expected 0 to 180 degrees from the normal, and not 90")
        out.append((theta, azimuth))
    return out


def _asked(n: int, numbers: int) -> tuple[_arrays.Array, _arrays.Array]:
    """A few rows to look at a sampler with: w_o and u."""
    wo = np.tile([[0.5, 0.0, np.sqrt(0.75)]], (n, 1))
    return wo, (np.arange(n)[:, None] + 0.5) / n * np.ones((1, numbers)) * np.linspace(1, 0.6, numbers)


def _of_library(s: Sampler) -> Sampler:
    """The sampler with callables that take NumPy's arrays, whatever its own take."""
    wanted = s.array_module
    if wanted is None:
        rows = _asked(8, s.u)
        wanted = library_wanted(s.sample, *(rows if s.wo != "none" else rows[1:]))
    if wanted is None or wanted is np or wanted == "numpy":
        return s
    library = Library(wanted, s.device)
    return replace(
        s,
        sample=library.samples(s.sample, s.title()),
        pdf=s.pdf and library.asks(s.pdf),
        f=s.f and library.asks(s.f),
        name=s.title(),
        serial=s.serial or library.name == "torch",  # it has threads of its own
        array_module=np,
    )


def _look(s: Sampler) -> tuple[int, bool, bool]:
    """Channels, whether it gives weights, whether it gives delta parts: seen from a few answers."""
    n, takes_wo = 8, s.wo != "none"
    wo, u = _asked(n, s.u)
    wi, _, weight, delta = _arrays.asks_sample(s.sample, s.title(), takes_wo)(wo, u)
    up = np.where(np.all(np.isfinite(wi), axis=1, keepdims=True), wi, [[0.0, 0.0, 1.0]])
    if s.pdf is not None:
        _arrays.asks_pdf(s.pdf, s.title(), takes_wo)(wo, up)
    counts = [weight.shape[1]] if weight is not None else []
    if s.f is not None:
        counts.append(_arrays.channels(s.f(wo, up), n, f"{s.title()}: f").shape[1])
    return max(counts, default=1), weight is not None, delta is not None


def _trials(s: Sampler, full: bool, grid: list[tuple[float, float]]) -> _crescent.Trials:
    s = _of_library(s)
    channels, weighs, delta = _look(s)
    count = s.channels or channels
    takes_wo = s.wo != "none"
    eta = None if s.eta is None else [float(v) for v in np.atleast_1d(s.eta)]
    return _crescent.trials_of_callables(
        sample=_arrays.asks_sample(s.sample, s.title(), takes_wo),
        pdf=None if s.pdf is None else _arrays.asks_pdf(s.pdf, s.title(), takes_wo),
        f=None if s.f is None else _arrays.asks_f(s.f, s.title(), count),
        name=s.title(),
        numbers=s.u,
        channels=count,
        wo=s.wo,
        delta=delta if s.delta is None else s.delta,
        weighs=weighs,
        upper_only=s.domain == "hemisphere",
        serial=s.serial,
        reciprocal=s.reciprocal,
        eta=eta,
        importance=s.importance,
        full=full,
        grid=grid,
    )


def _judge(
    trials: _crescent.Trials,
    command: str,
    *,
    alpha: float = 1e-3,
    seed: int = 1,
    full: bool = False,
    accept_few: bool = False,
    threads: int = 0,
    other: _crescent.Trials | None = None,
    expect_same: bool = False,
    progress: Progress | None = None,
) -> Judgement:
    judged = _crescent.judge(
        trials,
        other,
        alpha=alpha,
        seed=seed,
        full=full,
        accept_few=accept_few,
        expect_same=expect_same,
        threads=threads,
        command=command,
        progress=progress,
    )
    return Judgement(judged)


def check(
    sample: Callable[..., Any] | Sampler | str,
    pdf: Callable[..., Any] | None = None,
    f: Callable[..., Any] | None = None,
    *,
    wo_deg: Grid | None = None,
    alpha: float = 1e-3,
    seed: int = 1,
    full: bool = False,
    against: Sampler | str | None = None,
    expect_same: bool = False,
    settings: Mapping[str, float] | None = None,
    threads: int = 0,
    progress: Progress | None = None,
    **known: Any,
) -> Judgement:
    """Judges a sampler over a grid of w_o.

    `sample`, `pdf` and `f` are vectorised callables (see :class:`Sampler`), or `sample` is a :class:`Sampler`, or the
    name of a built-in arm, whose parameters `settings` gives: ``check("phong", settings={"s": 32})``. What is known
    of a sampler of callables is given by the fields of :class:`Sampler` as keywords: name, u, domain, wo, channels,
    delta, eta, ...

    `wo_deg`: angles from the normal, or (angle, azimuth), in degrees, in place of the grid. `alpha`: how often a right
    sampler may be called wrong, over everything in the call. `against`: a second sampler, compared with the first.
    `progress(what, done, total)` is called some times a second.
    """
    grid = _grid(wo_deg)
    if isinstance(sample, str):
        if pdf is not None or f is not None or known:
            raise TypeError(f"the built-in arm '{sample}' has its own pdf and f; its parameters go into settings")
        trials, title = _crescent.trials_of_arm(sample, dict(settings or {}), full, grid), sample
    else:
        if settings:
            raise TypeError("settings are of a built-in arm; a sampler of one's own has its parameters in itself")
        sampler = replace(sample, **known) if isinstance(sample, Sampler) else Sampler(sample, pdf, f, **known)
        trials, title = _trials(sampler, full, grid), sampler.title()
    other = None
    if isinstance(against, str):
        other = _crescent.arm_beside(against, trials)
    elif against is not None:
        other = _trials(against, full, grid)
    return _judge(
        trials,
        f"crescent.check({title!r})",
        alpha=alpha,
        seed=seed,
        full=full,
        threads=threads,
        other=other,
        expect_same=expect_same,
        progress=progress,
    )
