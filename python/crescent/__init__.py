"""crescent: a bench for importance samplers in rendering.

    import crescent
    judgement = crescent.check(sample, pdf, f, name="mine")
    print(judgement)

``sample(wo[n,3], u[n,2]) -> (wi[n,3], pdf[n])``; local frame, n = +z; both directions leave the surface; pdf in 1/sr;
f in 1/sr without the cosine.
"""

from ._check import Sampler, check
from ._crescent import __version__, commit
from ._judgement import Judgement, Verdict

__all__ = ["Judgement", "Sampler", "Verdict", "__version__", "check", "commit"]
