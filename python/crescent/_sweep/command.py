"""The command line of ``crescent sweep``. Exit codes are those of the program: 0 done, 1 wrong (--check), 2 wrong call,
3 tasks failed or the engine was lost, 4 inconclusive (--check), 70 a bug, 130 interrupted."""

from __future__ import annotations

import argparse
import os
import signal
import sys
import traceback
from collections.abc import Callable, Sequence
from typing import Any, NoReturn

from .. import _crescent
from . import require
from .grid import UsageError, axis_of, hint

_USAGE = """\
crescent sweep FILE.toml --over PATH=VALUES [--over ...] [--zip] [--seeds K] [--out DIR] [--engine ENGINE]
crescent sweep FILE.toml --check [ARM] --over PATH=VALUES [--over ...] [--pixels K] [--out DIR]
crescent sweep --check FILE.py:NAME --over PARAMETER=VALUES [--over ...] [--out DIR]
crescent sweep summary DIR [--metric NAME]"""
_FOOTER = """\
VALUES: 8,32,128 or log:0.05:0.8:9 or lin:0:1:5. ENGINE: local (default), dask://HOST:PORT, slurm:PROFILE, commands.
The same command finishes an interrupted sweep; more values, seeds or samplers compute only what is new.
Exit codes: 0 done; 1 wrong (--check); 2 wrong call; 3 tasks failed, or the engine was lost; 4 inconclusive (--check);
70 a bug in crescent; 130 interrupted."""


class _Parser(argparse.ArgumentParser):
    """Errors in the form of the program: what was expected, the nearest word, exit code 2."""

    def error(self, message: str) -> NoReturn:
        raise UsageError(message.removeprefix("argument "))


def _whole(most: int) -> Callable[[str], int]:
    """Reads a whole number from 1 to `most`."""

    def read(text: str) -> int:
        if not text.isdecimal() or not 1 <= int(text) <= most:
            raise argparse.ArgumentTypeError(f"expected a whole number, 1 to {most}, not '{text}'")
        return int(text)

    return read


def _probability(text: str) -> float:
    """Reads a number between 0 and 1."""
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0 < value < 1:
        raise argparse.ArgumentTypeError(f"expected a probability between 0 and 1, not '{text}'")
    return value


def _parser() -> _Parser:
    parser = _Parser(
        prog="crescent sweep", usage=_USAGE, epilog=_FOOTER, allow_abbrev=False,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Runs an experiment, or checks a sampler, at every point of a grid.",
    )  # fmt: skip
    add = parser.add_argument
    add("file", nargs="?", metavar="FILE", help="the experiment, a TOML file or the name of an installed one")
    add("--over", action="append", default=[], metavar="PATH=VALUES", help="a key, as for --set, and its values")
    add("--set", action="append", default=[], metavar="PATH=VALUE", help="another value for a key, at every point")
    add("--zip", action="store_true", help="the k-th values of all keys are one point; default: all combinations")
    add("--seeds", type=_whole(4096), metavar="K", help="seeds of each point; default: the experiment's")
    add("--out", metavar="DIR", help="the folder of the sweep; default: out/ and FILE's name and -sweep")
    add("--engine", default="local", metavar="ENGINE", help="where tasks run; default: local, all usable cores")
    add(
        "--workers",
        type=_whole(4096),
        metavar="N",
        help="worker processes of the engine local; default: one a usable core",
    )
    add("--films", action="store_true", help="keep the films of the first seed of each point")
    add("--resume", action="store_true", default=True, help="compute only what is missing (default)")
    add("--no-resume", dest="resume", action="store_false", help="compute every point of this call again")
    add("--dry-run", action="store_true", help="print tasks, samples and disk; compute nothing")
    add("--verify", metavar="SHARE", help="share of tasks that another worker repeats; default 1%%")
    add("--sampler-version", action="append", default=[], metavar="ARM=VERSION",
        help="identifies a sampler in place of the hash of its source")  # fmt: skip
    add("--metric", metavar="NAME", help="of the summary, such as rmse.H")
    add("--check", nargs="?", const=True, metavar="SAMPLER",
        help="check an arm of FILE, or all; without FILE a sampler FILE.py:NAME or a built-in one")  # fmt: skip
    add("--pixels", type=_whole(4096), metavar="K",
        help="with FILE --check: at K pixels in view; default: over the grid of w_o on each material")  # fmt: skip
    add("--alpha", type=_probability, metavar="P", help="with --check: shared by all points; default 0.001")
    add("--full", action="store_true", help="with --check: sixteen times as many draws")
    add("--seed", type=_whole(2**32 - 1), metavar="S", help="with --check: of its random numbers; default 1")
    add("--quiet", action="store_true", help="no progress")
    return parser


def _flags(parser: argparse.ArgumentParser) -> list[str]:
    return [text for action in parser._actions for text in action.option_strings]


def _parsed(words: Sequence[str]) -> argparse.Namespace:
    parser = _parser()
    given, rest = parser.parse_known_args(list(words))
    if rest:
        word = rest[0].partition("=")[0]
        near = _crescent.nearest(word, _flags(parser)) if word.startswith("-") else ""
        what = f"no flag '{word}'" if word.startswith("-") else f"takes one FILE, and '{rest[0]}' is a second one"
        raise UsageError(what + hint(near))
    return given


def _say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def _list_failures(failed: dict[str, str]) -> None:
    if failed:
        _say(f"{len(failed)} failed; the same command computes only these again:")
    for place, error in list(failed.items())[:50]:
        _say(f"  {place}: {error}")
    if len(failed) > 50:
        _say(f"  and {len(failed) - 50} more: DIR/sweep.json lists all")


def _one_value(setting: str) -> str:
    """--set of a check: a parameter that has the same value at every point."""
    if len(axis_of(setting).values) != 1:
        raise UsageError(f"--set {setting}: expected one value; --over takes several")
    return setting


_OF_RUNS = ("seeds", "films", "verify", "metric")
_OF_CHECKS = ("pixels", "alpha", "full", "seed")


def _refuse(given: argparse.Namespace, names: Sequence[str], why: str) -> None:
    """Refuses flags that have no effect."""
    for name in names:
        if getattr(given, name) not in (None, False):
            raise UsageError(f"--{name}: {why}")


def _refuse_of_summary(given: argparse.Namespace) -> None:
    """Refuses all flags but --metric."""
    defaults = vars(_parser().parse_args([]))
    for name, value in vars(given).items():
        if name not in ("file", "metric") and value != defaults[name]:
            flag = "no-resume" if name == "resume" else name.replace("_", "-")
            raise UsageError(f"--{flag}: a summary computes nothing: expected --metric alone")


def _versions(given: argparse.Namespace) -> dict[str, str]:
    versions = {}
    for text in given.sampler_version:
        arm, equals, version = text.partition("=")
        if not equals or not arm or not version:
            raise UsageError(f"--sampler-version {text}: expected ARM=VERSION")
        versions[arm] = version
    return versions


def _shared(given: argparse.Namespace, over: Sequence[str], out: str) -> dict[str, Any]:
    """The arguments of runs and checks."""
    same = {name: getattr(given, name) for name in ("zip", "engine", "workers", "resume", "dry_run")}
    return {**same, "over": over, "out": out, "progress": not given.quiet, "say": _say}


def _check(given: argparse.Namespace) -> int:
    from .check_sweep import CheckOptions, run_arm_sweep, run_check_sweep
    from .sweep import experiment_of, with_settings

    _refuse(given, _OF_RUNS, "is of a run, which --check does not make")
    if not given.file and isinstance(given.check, str) and given.check.endswith(".toml"):
        given.file, given.check = given.check, True
    if given.check is True and not given.file:
        raise UsageError("--check: expected FILE.toml, a sampler FILE.py:NAME or a built-in sampler")
    if not given.file and given.pixels:
        raise UsageError("--pixels: is of an experiment: expected FILE.toml --check")
    if not given.file and given.sampler_version:
        raise UsageError("--sampler-version: is of an experiment: expected FILE.toml --check")
    name = os.path.basename(given.file or given.check.partition(":")[0]).removesuffix(".py").removesuffix(".toml")
    out = given.out or f"out/{name}-check"
    over = given.over if given.file else [*given.over, *map(_one_value, given.set)]
    options = CheckOptions(
        **_shared(given, over, out), alpha=given.alpha or 1e-3, full=given.full, seed=given.seed or 1
    )
    if given.file:
        e = with_settings(experiment_of(given.file), given.set)
        result = run_arm_sweep(e, given.check, given.pixels or 0, _versions(given), options)
    else:
        result = run_check_sweep(given.check, options)
    if given.dry_run:
        return 0
    print(result.summary())
    _list_failures(result.failed)
    kinds = result.kinds
    if result.failed or kinds["error"]:
        return 3
    if kinds["wrong"]:
        return 1
    return 4 if kinds["inconclusive"] or kinds["heavy-tailed"] else 0


def _run(given: argparse.Namespace) -> int:
    from .sweep import Options, experiment_of, run_sweep, with_settings

    if not given.file:
        raise UsageError("expected FILE, an experiment, or --check SAMPLER, or summary DIR")
    _refuse(given, _OF_CHECKS, "is of a check: expected --check too")
    stem = os.path.basename(given.file).removesuffix(".toml")
    out = given.out or f"out/{stem}-sweep"
    options = Options(
        **_shared(given, given.over, out), seeds=given.seeds, films=given.films, verify=given.verify,
        versions=_versions(given),
    )  # fmt: skip
    result = run_sweep(with_settings(experiment_of(given.file), given.set), options)
    if given.dry_run:
        return 3 if result.failed else 0
    if given.engine != "commands":
        there = any((result.out / "data").glob("*.parquet"))
        print(result.summary(given.metric or "") if there else "no results")
        if there:
            print(f"{out}/data (Parquet), {out}/points")
    _list_failures(result.failed)
    return 3 if result.failed else 0


def _dispatch(words: list[str]) -> int:
    if words[:1] == ["task"]:
        from pathlib import Path

        from .sweep import run_task

        if len(words) != 2:
            raise UsageError("task: expected one file of store/tasks")
        return run_task(Path(words[1]))
    if words[:1] == ["summary"]:
        from .summary import summary

        given = _parsed(words[1:])
        if not given.file:
            raise UsageError("summary: expected DIR, the folder of a sweep")
        _refuse_of_summary(given)
        print(summary(given.file, given.metric or ""))
        return 0
    given = _parsed(words)
    return _check(given) if given.check else _run(given)


def main(words: Sequence[str] | None = None) -> int:
    """Runs the command and returns its exit code."""
    from .engines import EngineError, interrupted

    def stop(*_: object) -> None:
        interrupted.set()
        raise KeyboardInterrupt

    def report(lost: sys.UnraisableHookArgs) -> None:
        if not isinstance(lost.exc_value, KeyboardInterrupt):  # which `interrupted` keeps
            sys.__unraisablehook__(lost)

    interrupted.clear()
    if words is None:
        sys.unraisablehook = report
    signal.signal(signal.SIGINT, stop)
    signal.signal(signal.SIGTERM, stop)
    code: Any
    try:
        require()
        code = _dispatch(list(sys.argv[1:] if words is None else words))
    except SystemExit as e:  # --help
        return int(e.code or 0)
    except ImportError as e:
        code = _ended(3, str(e))
    except KeyboardInterrupt:
        code = _ended(130, "crescent sweep: interrupted; finished results are kept, and the same command goes on")
    except (EngineError, OSError) as e:
        text = f"{e.filename}: {e.strerror}" if isinstance(e, OSError) and e.filename else str(e)
        code = _ended(3, f"crescent sweep: {text}; finished results are kept, and the same command goes on")
    except (ValueError, TypeError, KeyError) as e:
        text = str(e.args[0]) if isinstance(e, KeyError) and e.args else str(e)
        code = _ended(2, f"crescent sweep: {text}\n`crescent sweep --help` lists its flags")
    except Exception:  # noqa: BLE001: a fault of the program, which must not end as "wrong"
        traceback.print_exc()
        code = _ended(70, "crescent sweep: this is a bug in crescent; finished results are kept")
    sys.stdout.flush()
    sys.stderr.flush()
    if words is None:
        os._exit(code)  # threads of Dask would delay the end
    return int(code)


def _ended(code: int, text: str) -> int:
    _say(text)
    return code


if __name__ == "__main__":
    sys.exit(main())
