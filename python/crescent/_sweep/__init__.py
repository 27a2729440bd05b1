"""Sweeps: an experiment over a grid of values, on one machine or many, by Dask (``pip install
'crescent-bench[sweep]'``)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any, Literal, overload

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


@overload
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
    check: Literal[False] = False,
) -> Sweep: ...


@overload
def sweep(
    experiment: Experiment | str | PathLike[str],
    *,
    check: Literal[True] | str | Sequence[str],
    over: Over | None = None,
    zip: bool = False,
    engine: str = "local",
    out: str | PathLike[str] = "out/sweep",
    resume: bool = True,
    dry_run: bool = False,
    workers: int | None = None,
    sampler_versions: Mapping[str, str] | None = None,
    progress: bool = False,
    pixels: int = 0,
    alpha: float = 1e-3,
    full: bool = False,
    seed: int = 1,
) -> CheckSweep: ...


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
    verify: float | str | None = None,
    workers: int | None = None,
    sampler_versions: Mapping[str, str] | None = None,
    progress: bool = False,
    check: bool | str | Sequence[str] = False,
    pixels: int | None = None,
    alpha: float | None = None,
    full: bool | None = None,
    seed: int | None = None,
) -> Sweep | CheckSweep:
    """Runs an experiment at every point of a grid, or checks its arms there, and computes only results that `out` does
    not have.

    `over`: a dictionary from paths, as for ``--set``, to lists of values or texts such as "log:0.05:0.8:9"; or texts
    "PATH=VALUES"; ``samplers.NAME.ATTRIBUTE`` is an attribute of a sampler in Python. All combinations are points; with
    `zip` the k-th values of all paths are one point. `seeds`: the number of seeds of each point; by default the
    experiment's. `engine`: "local", "dask://HOST:PORT", "slurm:PROFILE". `films`: keep the films of the first seed.
    `verify`: the share of tasks that a second worker repeats, to compare the bits; by default 1 %. `sampler_versions`:
    by arm, a version that identifies its sampler in place of the hash of its source.

    `check`: an arm, several, or True for all: nothing is run, but these are checked at every point with the materials
    and lights of the scene, as by ``crescent.check(e, sampler=NAME, pixels=K)``. `pixels`, `alpha` (0.001, shared by
    all tests of all points), `full` and `seed` are those of :func:`crescent.check`.

    A task that fails is listed in `failed` of the result; the next call computes it again.
    """
    require()
    from .sweep import experiment_of

    of_runs = {"seeds": seeds, "films": films or None, "verify": verify}
    of_checks: dict[str, Any] = {"pixels": pixels, "alpha": alpha, "full": full, "seed": seed}
    if given := [key for key, value in (of_runs if check else of_checks).items() if value is not None]:
        use = "runs, and check= is given" if check else "checks: expected check=ARM too"
        raise TypeError(f"{given[0]} is for {use}")
    e = experiment_of(experiment)
    shared: dict[str, Any] = {
        "over": over, "zip": zip, "engine": engine, "out": out, "workers": workers, "resume": resume, "dry_run": dry_run,
        "progress": progress,
    }  # fmt: skip
    if check is not False:
        from .check_sweep import CheckOptions, run_arm_sweep

        shared |= {key: value for key, value in of_checks.items() if key != "pixels" and value is not None}
        return run_arm_sweep(e, check, pixels or 0, sampler_versions or {}, CheckOptions(**shared))
    from .sweep import Options, run_sweep

    return run_sweep(e, Options(**shared, seeds=seeds, films=films, verify=verify, versions=sampler_versions or {}))


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
    resume: bool = True,
) -> CheckSweep:
    """Checks a sampler at every point of a grid; all tests of all points share one `alpha`. Arms of an experiment are
    checked by :func:`sweep` with `check`.

    `sampler`: "FILE.py:NAME" or a built-in sampler. A class or a function NAME is called with the values of a point as
    keywords; of a :class:`crescent.Sampler` they are attributes of the object whose methods it has, and the settings of
    its context; a built-in sampler gets them as `settings`.
    """
    require()
    from .check_sweep import CheckOptions, run_check_sweep

    options = CheckOptions(
        over=over, zip=zip, engine=engine, out=out, alpha=alpha, full=full, seed=seed, workers=workers, resume=resume,
        progress=progress, dry_run=dry_run,
    )  # fmt: skip
    return run_check_sweep(sampler, options)
