"""What a sampler may use of a surface point: its material and the lights, one row a row of u.

A :class:`crescent.Sampler` names what it uses, ``uses=("alpha", "lights")``, and its callables take a third argument:
``sample(wo, u, ctx)``, ``pdf(wo, wi, ctx)``, ``f(wo, wi, ctx)``. Directions and positions are in the local frame of the
point, n = +z, lengths in m.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ._arrays import Array
from ._libraries import Library, library_named, library_wanted
from ._sampler import Sampler, rows_to_look_with

#: The arrays of each quantity that can be used, in the order in which they are passed.
ARRAYS = {
    "s": ("s",),
    "alpha": ("alpha",),
    "rho_d": ("rho_d",),
    "rho_s": ("rho_s",),
    "side": ("side",),
    "eta": ("eta",),
    "lights": ("position", "normal", "edge_u", "edge_v", "shines", "radius", "radiance"),
}

#: The kinds of light by the number that a program receives.
KINDS = ("disk", "sphere", "rectangle")

#: The surface on which `crescent.check` tests a sampler that uses one, where `settings` gives no other.
DEFAULTS = {"s": 32.0, "alpha": 0.24253562503633297, "rho_d": 0.5, "rho_s": 0.5}


class _Lights:
    """The lights of the scene, n rows of K lights; occlusion is ignored."""

    kind: tuple[str, ...]  #: K texts: "disk", "sphere", "rectangle"
    position: Any  #: [n, K, 3], of the centre, m
    normal: Any  #: [n, K, 3], unit; 0 for a sphere
    edge_u: Any  #: [n, K, 3], from the centre of a rectangle to the middle of an edge, m; else 0
    edge_v: Any  #: [n, K, 3]
    shines: Any  #: [n, K], True where the light faces the point
    radius: Any  #: [n, K], m; of a rectangle that of the circle through its corners
    radiance: Any  #: [n, K, 3], W/(sr m^2)

    def __len__(self) -> int:
        return len(self.kind)


class Context:
    """The third argument of a sampler's callables; it has what the sampler says that it uses."""

    s: Any  #: [n], exponent of a Phong or Blinn lobe
    alpha: Any  #: [n], roughness of a GGX or Beckmann lobe
    rho_d: Any  #: [n, 3], diffuse albedo
    rho_s: Any  #: [n], albedo of the lobe
    side: Any  #: [n], 1: w_o is on the side of the normal; scenes have no other
    eta: Any  #: [n], index below over above; 1: scenes are opaque
    lights: _Lights

    def __init__(self, uses: Sequence[str], kinds: tuple[str, ...], arrays: Sequence[Any]) -> None:
        self._uses = tuple(uses)
        left = iter(arrays)
        for name in self._uses:
            if name != "lights":
                setattr(self, name, next(left))
                continue
            self.lights = _Lights()
            self.lights.kind = kinds
            for part in ARRAYS["lights"]:
                setattr(self.lights, part, next(left))

    def __getattr__(self, name: str) -> Any:
        if name in ARRAYS:
            raise AttributeError(f"the sampler does not use '{name}': expected uses={(*self._uses, name)!r}")
        raise AttributeError(f"a context has no '{name}': expected one of {', '.join(ARRAYS)}")


def arrays_of(uses: Sequence[str], given: Mapping[str, Any], n: int) -> list[Any]:
    """The arrays of `uses` in their order; constants of the lights are repeated over the rows without a copy."""
    out = []
    for name in (part for use in uses for part in ARRAYS[use]):
        array = given[name]
        if name in ("radius", "radiance"):
            array = np.broadcast_to(array, (n, *np.shape(array)))
        out.append(array != 0 if name == "shines" else array)
    return out


#: Columns of one light in a program's rows, in their order: its kind, then the parts of ARRAYS["lights"].
_LIGHT = {"radius": 1, "radiance": 3, "position": 3, "normal": 3, "edge_u": 3, "edge_v": 3, "shines": 1}


def columns_of(uses: Sequence[str], lights: int) -> int:
    """Columns of a context in a program's rows, as src/samplers/surface_context.h has them."""
    widths = {"rho_d": 3, "lights": 1 + lights * (1 + sum(_LIGHT.values()))}
    return sum(widths.get(name, 1) for name in uses)


def decoded(uses: Sequence[str], rows: Array) -> tuple[tuple[str, ...], list[Any]]:
    """The kinds of the lights and the arrays of `uses` from these columns."""
    kinds: tuple[str, ...] = ()
    given: dict[str, Any] = {}
    at = 0
    for name in uses:
        if name == "lights":
            lights = int(rows[0, at])
            width = 1 + sum(_LIGHT.values())
            table = rows[:, at + 1 : at + 1 + lights * width].reshape(len(rows), lights, width)
            kinds = tuple(KINDS[k] if k < len(KINDS) else str(k) for k in table[0, :, 0].astype(int))
            first = 1
            for part, size in _LIGHT.items():
                given[part] = table[:, :, first : first + size] if size > 1 else table[:, :, first]
                first += size
            given["radius"], given["radiance"] = given["radius"][0], given["radiance"][0]
            at += 1 + lights * width
        else:
            width = 3 if name == "rho_d" else 1
            given[name] = rows[:, at : at + width] if width > 1 else rows[:, at]
            at += width
    return kinds, arrays_of(uses, given, len(rows))


class ContextCalls:
    """The callables of a sampler that uses a context, with arrays of its own library in the place of NumPy's."""

    def __init__(self, s: Sampler) -> None:
        self._s = s
        self._library: Library | None = None
        if s.array_module is np or s.array_module == "numpy":
            return
        wo, u = rows_to_look_with(8, s.u)
        kinds, arrays = example(s.uses, {}, 8)
        call, rows = self._with(s.sample, kinds), self._rows(wo, u, arrays)
        if s.array_module is None:
            self._library = library_wanted(call, *rows)
        else:
            self._library = library_named(s.array_module, s.device, call, rows)

    @property
    def serial(self) -> bool:
        """Whether the callables want one thread; PyTorch and Dr.Jit have threads of their own."""
        return self._s.serial or (self._library is not None and self._library.name in ("torch", "drjit"))

    def _rows(self, wo: Array, at: Array, arrays: list[Any]) -> tuple[Any, ...]:
        return (at, *arrays) if self._s.wo == "none" else (wo, at, *arrays)

    def _with(self, call: Callable[..., Any], kinds: tuple[str, ...]) -> Callable[..., Any]:
        first = 1 if self._s.wo == "none" else 2
        return lambda *rows: call(*rows[:first], Context(self._s.uses, kinds, rows[first:]))

    def sample(self, wo: Array, u: Array, kinds: tuple[str, ...], arrays: list[Any]) -> Any:
        """What `sample` returns."""
        call = self._with(self._s.sample, kinds)
        if self._library is not None:
            call = self._library.samples(call, self._s.title())
        return call(*self._rows(wo, u, arrays))

    def value(self, call: Callable[..., Any], wo: Array, wi: Array, kinds: tuple[str, ...], arrays: list[Any]) -> Any:
        """What `pdf` or `f` returns."""
        call = self._with(call, kinds)
        if self._library is not None:
            call = self._library.asks(call)
        return call(*self._rows(wo, wi, arrays))


def example(uses: Sequence[str], settings: Mapping[str, float], n: int) -> tuple[tuple[str, ...], list[Any]]:
    """The kinds of lights and the arrays of `uses` on one surface below one disk light."""
    surface = {**DEFAULTS, **settings}
    given: dict[str, Any] = {name: np.full(n, surface[name]) for name in ("s", "alpha", "rho_s")}
    given["rho_d"] = np.full((n, 3), surface["rho_d"])
    given["side"] = given["eta"] = np.ones(n)
    position = np.array([0.6, 0.3, 1.8])
    given["position"] = np.broadcast_to(position, (n, 1, 3)).copy()
    given["normal"] = given["position"] / -np.linalg.norm(position)
    given["edge_u"] = given["edge_v"] = np.zeros((n, 1, 3))
    given["shines"] = np.ones((n, 1))
    given["radius"] = np.array([0.4])
    given["radiance"] = np.full((1, 3), 10.0)
    return ("disk",) if "lights" in uses else (), arrays_of(uses, given, n)


def on_one_surface(s: Sampler, settings: Mapping[str, float]) -> Sampler:
    """The sampler without its context: on the surface that `settings` describes, with NumPy's arrays."""
    for key, value in settings.items():
        if key not in DEFAULTS:
            raise ValueError(f"settings: no '{key}', expected one of {', '.join(DEFAULTS)}")
        if not isinstance(value, (int, float, np.number)) or not math.isfinite(value):
            raise ValueError(f"settings: {key} is {value!r}: expected a number")
    calls = ContextCalls(s)

    def sample(*rows: Array) -> Any:
        return calls.sample(rows[0], rows[-1], *example(s.uses, settings, len(rows[-1])))

    def bound(call: Callable[..., Any]) -> Callable[..., Any]:
        return lambda *rows: calls.value(call, rows[0], rows[-1], *example(s.uses, settings, len(rows[-1])))

    return replace(
        s,
        sample=sample,
        pdf=s.pdf and bound(s.pdf),
        f=s.f and bound(s.f),
        name=s.title(),
        uses=(),
        serial=calls.serial,
        array_module=np,
    )
