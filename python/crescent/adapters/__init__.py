"""Samplers of other libraries, as :class:`crescent.Sampler`: ``crescent.check(crescent.adapters.mitsuba(bsdf))``.

mitsuba(bsdf)                             any mi.BSDF, or a dictionary or XML that mi.load_dict or load_string takes
mitsuba_emitter(emitter)                  directions towards an emitter, as they are sampled from a point
mitsuba.scene(scene, folder)              a Mitsuba scene as an experiment, with its meshes and its sky
numpy, torch, jax, drjit (sample, eval, pdf)   callables in the form used by renderers: eval includes the cosine
"""

from ._mitsuba import mitsuba, mitsuba_emitter
from ._mitsuba_scene import UnsupportedScene, mitsuba_scene
from ._triples import drjit, jax, numpy, torch

mitsuba.scene = mitsuba_scene  # type: ignore[attr-defined]

__all__ = ["UnsupportedScene", "drjit", "jax", "mitsuba", "mitsuba_emitter", "numpy", "torch"]
