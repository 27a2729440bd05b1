"""crescent: a bench for importance samplers in rendering.

    import crescent
    judgement = crescent.check(sample, pdf, f, name="mine")
    print(judgement)

``sample(wo[n,3], u[n,2]) -> (wi[n,3], pdf[n])``; local frame, n = +z; both directions leave the surface; pdf in 1/sr;
f in 1/sr without the cosine.
"""

from ._check import check
from ._crescent import commit
from ._crescent import version as __version__
from ._judgement import Judgement, Verdict
from ._sampler import Sampler
from .arms import Tail, arm, arm_names, brdf, brdf_names, pdf_of, tail
from .experiments import Experiment, Film, Measured, join, load, parse, run

__all__ = [
    "Experiment",
    "Film",
    "Judgement",
    "Measured",
    "Sampler",
    "Tail",
    "Verdict",
    "__version__",
    "arm",
    "arm_names",
    "brdf",
    "brdf_names",
    "check",
    "commit",
    "join",
    "load",
    "parse",
    "pdf_of",
    "run",
    "tail",
]
