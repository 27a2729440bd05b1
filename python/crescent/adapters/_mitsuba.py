"""Mitsuba 3: its BSDFs and emitters. Any variant of three channels or one; llvm_ad_rgb if none is set.

Mitsuba's `wi` is the given direction and its `wo` the drawn one; its eval includes the cosine, its weight is f cos / p,
and the pdf of a delta part is the probability of its selection. Directions are local, n = +z, in single precision.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from .._arrays import Array
from .._sampler import Sampler


def _library() -> Any:
    import mitsuba as mi

    if not mi.variant():
        mi.set_variant("llvm_ad_rgb", "scalar_rgb")
    variant = str(mi.variant())
    if variant.startswith("scalar"):
        raise ValueError(f"the variant {variant} has no arrays: mi.set_variant('llvm_ad_rgb')")
    if "spectral" in variant or "polarized" in variant:
        raise ValueError(f"the variant {variant} has channels of its own: mi.set_variant('llvm_ad_rgb')")
    return mi


def _vector(mi: Any, a: Array) -> Any:
    """[n, 3] as a Vector3f."""
    return mi.Vector3f(*(mi.Float(np.ascontiguousarray(a[:, k], np.float32)) for k in range(3)))


def _rows(v: Any, n: int) -> Array:
    """Returns a Dr.Jit vector or colour as [n, channels]; a literal is repeated for every row."""
    parts = [np.broadcast_to(np.asarray(part, np.float64).ravel(), n) for part in v]
    return np.stack(parts, -1)


def _column(v: Any, n: int) -> Array:
    return np.broadcast_to(np.asarray(v, np.float64).ravel(), n)


_EMITTERS = ("Emitter", "Scene", "Shape")


def _is(mi: Any, it: Any, kinds: tuple[str, ...]) -> bool:
    return isinstance(it, tuple(getattr(mi, kind) for kind in kinds))


def _loaded(mi: Any, what: Any) -> Any:
    """Returns the object, or the object described by a dictionary or an XML text."""
    return mi.load_dict(what) if isinstance(what, dict) else mi.load_string(what) if isinstance(what, str) else what


class _Bsdf:
    """One BSDF at one point of a flat surface."""

    def __init__(self, mi: Any, bsdf: Any, uv: tuple[float, float], context: Any) -> None:
        self.mi, self.bsdf, self.uv, self.context = mi, bsdf, uv, context

    def at(self, wo: Array) -> Any:
        mi = self.mi
        si = mi.SurfaceInteraction3f()
        si.t = mi.Float(np.ones(len(wo), np.float32))
        si.p = mi.Point3f(0, 0, 0)
        si.n = mi.Normal3f(0, 0, 1)
        si.sh_frame = mi.Frame3f(mi.Vector3f(1, 0, 0), mi.Vector3f(0, 1, 0), mi.Vector3f(0, 0, 1))
        si.dp_du, si.dp_dv = mi.Vector3f(1, 0, 0), mi.Vector3f(0, 1, 0)
        si.uv = mi.Point2f(*self.uv)
        si.wi = _vector(mi, wo)
        return si

    def drawn(self, wo: Array, u: Array) -> Any:
        mi = self.mi
        numbers = [mi.Float(np.ascontiguousarray(u[:, k], np.float32)) for k in range(3)]
        return self.bsdf.sample(self.context, self.at(wo), numbers[2], mi.Point2f(numbers[0], numbers[1]), True)

    def sample(self, wo: Array, u: Array) -> tuple[Array, Array, Array, Array]:
        bs, weighs = self.drawn(wo, u)
        n = len(u)
        wi, p, weight = _rows(bs.wo, n), _column(bs.pdf, n).copy(), _rows(weighs, n)
        delta = (_column(bs.sampled_type, n).astype(np.int64) & int(self.mi.BSDFFlags.Delta)) != 0
        lost = np.flatnonzero((p != 0) & ~delta & (weight == 0).all(axis=1))
        if len(lost):  # a weight of 0 that pdf(w) and f contradict: Mitsuba uses it for draws that return no sample
            same = np.isclose(self.pdf(wo[lost], wi[lost]), p[lost], rtol=1e-2)
            p[lost] = np.where(same & (self.f(wo[lost], wi[lost]) == 0).all(axis=1), p[lost], 0)
        return wi, p, weight, delta

    def pdf(self, wo: Array, wi: Array) -> Array:
        return _column(self.bsdf.pdf(self.context, self.at(wo), _vector(self.mi, wi), True), len(wi))

    def f(self, wo: Array, wi: Array) -> Array:
        value = _rows(self.bsdf.eval(self.context, self.at(wo), _vector(self.mi, wi), True), len(wi))
        cosine = np.abs(np.asarray(wi[:, 2], np.float32).astype(np.float64))[:, None]
        return np.where(cosine > 0, value / np.where(cosine > 0, cosine, 1), 0)

    def eta(self) -> float | None:
        """Returns the index below over above, from a direction that was refracted downwards."""
        wo = np.tile([[0.3, 0.0, np.sqrt(1 - 0.09)]], (256, 1))
        k = np.arange(256)[:, None] + 0.5
        bs, _ = self.drawn(wo, (k * [0.7548776662466927, 0.5698402909980532, 0.6180339887498949]) % 1)
        down = (_rows(bs.wo, 256)[:, 2] < 0) & (_column(bs.pdf, 256) > 0)
        eta = _column(bs.eta, 256)[down]
        return float(eta[0]) if len(eta) and eta[0] != 1 else None


def mitsuba(bsdf: Any, *, uv: tuple[float, float] = (0.5, 0.5), context: Any = None, **known: Any) -> Sampler:
    """Any mi.BSDF: both sides if it supports them, colour, delta parts, its own weights; or any emitter that
    mitsuba_emitter takes.

    `bsdf`: a mi.BSDF, a dictionary or an XML text. `uv`: where its textures are read. `context`: a mi.BSDFContext, for
    a single component or for importance.
    """
    mi = _library()
    plugin = _loaded(mi, bsdf)
    if isinstance(bsdf, dict):
        known.setdefault("name", bsdf["type"])
    if _is(mi, plugin, _EMITTERS):
        return mitsuba_emitter(plugin, **known)
    if not _is(mi, plugin, ("BSDF",)):
        raise TypeError(f"{type(plugin).__name__} is neither a mi.BSDF nor an emitter")
    own = _Bsdf(mi, plugin, uv, context or mi.BSDFContext())
    flags = int(plugin.flags())
    known.setdefault("name", type(plugin).__name__)
    known.setdefault("wo", "both" if flags & int(mi.BSDFFlags.BackSide) else "upper")
    known.setdefault("delta", bool(flags & int(mi.BSDFFlags.Delta)))
    known.setdefault("eta", own.eta() if flags & int(mi.BSDFFlags.Transmission) else None)
    known.setdefault("importance", own.context.mode == mi.TransportMode.Importance)
    return Sampler(own.sample, own.pdf, own.f, u=3, channels=3, serial=True, **known)


class _Emitter:
    """Directions from one point towards the emitters of a scene."""

    def __init__(self, mi: Any, scene: Any, point: tuple[float, float, float]) -> None:
        self.mi, self.scene, self.point = mi, scene, point

    def at(self, n: int) -> Any:
        import drjit

        it = drjit.zeros(self.mi.SurfaceInteraction3f, n)
        it.p = self.mi.Point3f(*(self.mi.Float(np.full(n, v, np.float32)) for v in self.point))
        it.n = self.mi.Normal3f(0, 0, 1)
        return it

    def sample(self, u: Array) -> tuple[Array, Array]:
        numbers = [self.mi.Float(np.ascontiguousarray(u[:, k], np.float32)) for k in range(2)]
        with self.one_by_one():
            ds, weight = self.scene.sample_emitter_direction(self.at(len(u)), self.mi.Point2f(*numbers), True, True)
        lit = (_rows(weight, len(u)) != 0).any(axis=1)  # else hidden, or on a side that does not emit: nothing drawn
        return _rows(ds.d, len(u)), np.where(lit, _column(ds.pdf, len(u)), 0)

    def pdf(self, wi: Array) -> Array:
        it = self.at(len(wi))
        ray = it.spawn_ray(_vector(self.mi, wi))
        with self.one_by_one():
            met = self.scene.ray_intersect(ray)
            ds = self.mi.DirectionSample3f(self.scene, met, it)
            ds.d = ray.d
            lit = met.emitter(self.scene) != None  # noqa: E711 - an array of pointers, compared one by one
            return _column(self.scene.pdf_emitter_direction(it, ds, lit), len(wi))

    @staticmethod
    def one_by_one() -> Any:
        """Emitters are called with evaluated arrays: some, like timed_sunsky, read their entries."""
        import drjit

        return drjit.scoped_set_flag(drjit.JitFlag.SymbolicCalls, False)


def mitsuba_emitter(emitter: Any, *, point: tuple[float, float, float] = (0.0, 0.0, 0.0), **known: Any) -> Sampler:
    """Directions towards an emitter as a renderer samples them from `point`: a mi.Scene, a mi.Emitter, a mi.Shape that
    has one, or a dictionary or an XML text of these. Points and single directions of light have no density."""
    mi = _library()
    it = _loaded(mi, emitter)
    if not _is(mi, it, _EMITTERS):
        raise TypeError(f"{type(it).__name__} is no emitter: expected mi.Emitter, mi.Shape or mi.Scene, ...")
    if isinstance(emitter, dict):
        known.setdefault("name", emitter["type"])
    scene = it if isinstance(it, mi.Scene) else mi.load_dict({"type": "scene", "it": it})
    if not scene.emitters():
        raise ValueError(f"{known.get('name', type(it).__name__)}: there is no emitter in it")
    for light in scene.emitters():
        if light.flags() & (int(mi.EmitterFlags.DeltaPosition) | int(mi.EmitterFlags.DeltaDirection)):
            raise ValueError(f"{type(light).__name__} shines from one direction: there is no density to check")
    own = _Emitter(mi, scene, point)
    known.setdefault("name", "emitter")
    return Sampler(own.sample, own.pdf, wo="none", serial=True, **known)
