"""crescent: a bench for importance samplers in rendering.

    import crescent
    result = crescent.check(sample, pdf, f, name="mine")
    print(result)

``sample(wo[n,3], u[n,2]) -> (wi[n,3], pdf[n])``; local frame, n = +z; both directions leave the surface; pdf in 1/sr;
f in 1/sr without the cosine.
"""

import importlib
from typing import TYPE_CHECKING, Any

from ._check import Description, check, describe
from ._compare import Comparison, View, compare
from ._crescent import commit
from ._crescent import version as __version__
from ._result import CheckResult, Verdict
from ._sampler import Sampler
from ._shader import shader
from .arms import Tail, arm, arm_names, brdf, brdf_names, pdf_of, tail
from ._sweep import sweep, sweep_check
from .combinations import Combination, mis, mixture, ris
from ._summaries import Summary
from .experiments import Experiment, Film, Measured, RunInterrupted, join, load, open, parse, run

if TYPE_CHECKING:
    from . import adapters, plot, scenes, testing

__all__ = [
    "Combination",
    "Comparison",
    "Description",
    "Experiment",
    "Film",
    "CheckResult",
    "Measured",
    "RunInterrupted",
    "Sampler",
    "Summary",
    "Tail",
    "Verdict",
    "View",
    "__version__",
    "adapters",
    "arm",
    "arm_names",
    "brdf",
    "brdf_names",
    "check",
    "commit",
    "compare",
    "describe",
    "join",
    "load",
    "mis",
    "mixture",
    "open",
    "parse",
    "pdf_of",
    "plot",
    "ris",
    "run",
    "scenes",
    "shader",
    "sweep",
    "sweep_check",
    "tail",
    "testing",
]


def __getattr__(name: str) -> Any:
    """Loads a module of the package on first use."""
    if name in ("adapters", "plot", "scenes", "testing"):
        return importlib.import_module(f".{name}", __name__)
    raise AttributeError(f"module '{__name__}' has no attribute '{name}'")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
