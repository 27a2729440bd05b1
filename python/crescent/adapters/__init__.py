"""Samplers of other libraries, as :class:`crescent.Sampler`: ``crescent.check(crescent.adapters.mitsuba(bsdf))``.

mitsuba(bsdf)                             any mi.BSDF, or a dictionary or XML that mi.load_dict or load_string takes
mitsuba_emitter(emitter)                  directions towards an emitter, as they are sampled from a point
numpy, torch, jax, drjit (sample, eval, pdf)   callables in the form used by renderers: eval includes the cosine
"""

from ._mitsuba import mitsuba, mitsuba_emitter
from ._triples import drjit, jax, numpy, torch

__all__ = ["drjit", "jax", "mitsuba", "mitsuba_emitter", "numpy", "torch"]
