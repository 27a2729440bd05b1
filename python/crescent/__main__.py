"""The command `crescent` of the wheel: `crescent check`, samplers checked by themselves.

    crescent check                        every built-in arm
    crescent check phong --set s=32       one of them
    crescent check mine.py:sampler        a Sampler, or a module or class with sample, pdf and f
    crescent check --exec ./mine          a program, over its stdin and stdout
    crescent check --plugin ./libmine.so  a shared library

Exit codes: 0 right, 1 wrong, 2 bad input, 3 error, 4 inconclusive, 130 interrupted.
"""

from __future__ import annotations

import argparse
import sys

from . import CheckResult, __version__, _crescent, commit
from ._check import _grid, _run_checks, _cases
from ._files import names_a_file, sampler_at

EXIT = {"right": 0, "wrong": 1, "error": 3, "inconclusive": 4}


def _number(flag: str, word: str) -> float:
    try:
        return float(word)
    except ValueError:
        raise ValueError(f"{flag}: expected a number, not '{word}'") from None


def _settings(words: list[str]) -> dict[str, float]:
    """KEY=VALUE of --set."""
    out = {}
    for word in words:
        key, equals, value = word.partition("=")
        if not equals:
            raise ValueError(f"--set {word}: expected KEY=VALUE")
        out[key] = _number(f"--set {word}", value)
    return out


def _one_subject(args: argparse.Namespace, own: bool) -> None:
    """ValueError where two samplers are given, or settings of an arm beside one that is none."""
    given = [
        word for word, there in (("SAMPLER", args.sampler), ("--exec", args.exec), ("--plugin", args.plugin)) if there
    ]
    if len(given) > 1:
        raise ValueError(f"{given[0]} excludes {given[1]}")
    if args.set and own:
        raise ValueError(f"--set is of a built-in arm: {given[0]} has its parameters in itself")


def _cases_of(args: argparse.Namespace) -> tuple[_crescent.CheckCases, bool]:
    """The cases, and whether they are of the whole list of arms."""
    at = [(word, *word.partition(",")[::2]) for word in args.wo]
    wo = [(_number(f"--wo {w}", theta), _number(f"--wo {w}", azimuth or "0")) for w, theta, azimuth in at] or None
    grid = _grid(wo)
    arm = args.sampler or ""
    of_python = names_a_file(arm)
    _one_subject(args, bool(of_python or args.exec or args.plugin))
    if args.exec:
        return _crescent.cases_of_program(args.exec, args.patience, args.full, grid), False
    if args.plugin:
        return _crescent.cases_of_plugin(args.plugin, args.full, grid), False
    if of_python:
        return _cases(sampler_at(arm), args.full, wo), False
    return _crescent.cases_of_arm(arm, _settings(args.set), args.full, grid), not arm


def _parser() -> argparse.ArgumentParser:
    about, _, _ = (__doc__ or "").partition("\n\n")
    parser = argparse.ArgumentParser(
        "crescent",
        description=about,
        epilog=(__doc__ or "").partition("\n\n")[2],
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"crescent {__version__} ({commit})")
    check = parser.add_subparsers(dest="command", required=True).add_parser("check", help="check a sampler")
    check.add_argument("sampler", nargs="?", help="an arm of the list, FILE.py:NAME or module:NAME")
    check.add_argument("--exec", metavar="COMMAND", help="a program to check")
    check.add_argument("--plugin", metavar="FILE", help="a shared library to check")
    check.add_argument("--set", metavar="KEY=VALUE", action="append", default=[], help="a parameter of an arm")
    check.add_argument("--wo", metavar="THETA[,AZIMUTH]", action="append", default=[], help="w_o, in degrees")
    check.add_argument("--alpha", type=float, default=1e-3, help="how often a right sampler may be called wrong")
    check.add_argument("--seed", type=int, default=1)
    check.add_argument("--full", action="store_true", help="look harder, for minutes")
    check.add_argument("--patience", type=float, default=0, metavar="S", help="seconds that a program has in all")
    check.add_argument("--json", metavar="FILE")
    check.add_argument("--junit", metavar="FILE")
    check.add_argument("--html", metavar="FILE")
    return parser


def _write(result: CheckResult, args: argparse.Namespace) -> None:
    if args.json:
        _crescent.write_whole(args.json, result.json())
    if args.junit:
        result.junit(args.junit)
    if args.html:
        result.html(args.html)


def main(argv: list[str] | None = None) -> int:
    """Runs the command; returns its exit code."""
    args = _parser().parse_args(argv)
    try:
        cases, whole_list = _cases_of(args)
        command = "crescent " + " ".join(argv if argv is not None else sys.argv[1:])
        result = _run_checks(cases, command, alpha=args.alpha, seed=args.seed, full=args.full)
        print(result)
        _write(result, args)
    except KeyboardInterrupt:
        return 130
    except (ValueError, ImportError) as e:
        print(e, file=sys.stderr)
        return 2
    except (OSError, RuntimeError) as e:
        print(e, file=sys.stderr)
        return 3
    if whole_list:
        return 0 if result.as_expected else 1
    return EXIT[result.state]


if __name__ == "__main__":
    sys.exit(main())
