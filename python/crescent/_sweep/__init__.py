"""Sweeps: an experiment over a grid of values, on one machine or many, by Dask (``pip install
'crescent-bench[sweep]'``)."""

from __future__ import annotations

from collections.abc import Mapping
from os import PathLike
from typing import TYPE_CHECKING

from ..experiments import Experiment

if TYPE_CHECKING:
    from .check_sweep import CheckSweep
    from .sweep import Over, Sweep

NEEDED = ("dask", "distributed", "pyarrow")


def require() -> None:
    """Raises ImportError, in one line, if the packages of the extra are not installed."""
    import importlib.util

    def there(name: str) -> bool:
        try:
            return importlib.util.find_spec(name) is not None
        except ImportError:
            return False

    absent = [name for name in NEEDED if not there(name)]
    if absent:
        raise ImportError(f"crescent sweep needs {', '.join(absent)}: pip install 'crescent-bench[sweep]'")


def sweep(
    experiment: Experiment | str | PathLike[str],
    *,
    over: Over | None = None,
    zip: bool = False,
    seeds: int | None = None,
    engine: str = "local",
    out: str | PathLike[str] = "out/sweep",
    films: bool = False,
    resume: bool = True,
    dry_run: bool = False,
    verify: float | str = 0.01,
    workers: int | None = None,
    sampler_versions: Mapping[str, str] | None = None,
    progress: bool = False,
) -> Sweep:
    """Runs an experiment at every point of a grid, and computes only results that `out` does not have.

    `over`: a dictionary from paths, as for ``--set``, to lists of values or texts such as "log:0.05:0.8:9"; or texts
    "PATH=VALUES". All combinations are points; with `zip` the k-th values of all paths are one point. `seeds`: the
    number of seeds of each point; by default the experiment's. `engine`: "local", "dask://HOST:PORT", "slurm:PROFILE".
    `films`: keep the films of the first seed. `verify`: the share of tasks that a second worker repeats, to compare the
    bits. `sampler_versions`: by arm, a version that identifies its sampler in place of the hash of its source.

    A task that fails is listed in `failed` of the result; the next call computes it again.
    """
    require()
    from .report import write_report
    from .sweep import experiment_of, run_sweep, settled_options

    options = settled_options(
        over=over, zip=zip, seeds=seeds, engine=engine, out=out, films=films, resume=resume, verify=verify,
        workers=workers, sampler_versions=sampler_versions, progress=progress, say=_silent,
    )  # fmt: skip
    result = run_sweep(experiment_of(experiment), options, dry_run)
    if result.points:
        write_report(options.out)
    return result


def sweep_check(
    sampler: str,
    *,
    over: Over,
    zip: bool = False,
    engine: str = "local",
    out: str | PathLike[str] = "out/sweep-check",
    alpha: float = 1e-3,
    full: bool = False,
    seed: int = 1,
    workers: int | None = None,
    progress: bool = False,
    dry_run: bool = False,
) -> CheckSweep:
    """Checks a sampler at every point of a grid; all tests of all points share one `alpha`.

    `sampler`: "FILE.py:NAME" or a built-in sampler. A class or a function NAME is called with the values of a point as
    keywords; a :class:`crescent.Sampler` that uses a context, and a built-in sampler, get them as `settings`.
    """
    require()
    from .check_sweep import run_check_sweep

    return run_check_sweep(
        sampler, over=over, zip=zip, engine=engine, out=out, alpha=alpha, full=full, seed=seed, workers=workers,
        progress=progress, dry_run=dry_run, say=_silent,
    )  # fmt: skip


def _silent(text: str) -> None:
    """Prints nothing."""
