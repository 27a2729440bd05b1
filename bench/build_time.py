#!/usr/bin/env python3
"""Where the time of a build and of the tests goes, as tables of docs/speed.md.

    bench/build_time.py build              the steps of the last build, by part: build/.ninja_log
    bench/build_time.py build --tests LOG  the tests, by kind: a log of ctest, such as build/log/release-tests.log

A build is measured from nothing (CCACHE_DISABLE=1, an empty folder, a quiet machine). With as many jobs as cores the
seconds of a step are nearly its processor seconds.
"""

from __future__ import annotations

import argparse
import collections
import re
from pathlib import Path

#: What a step belongs to, by its output; the first that matches counts.
PARTS = (
    ("kernels", r"/kernels/|kernel_scalar"),
    ("precompiled headers", r"\.pch$"),
    ("film", r"apps/explainer/"),
    ("GL instrument", r"src/gl/"),
    ("importer of models", r"apps/import/"),
    ("Python module", r"python/"),
    ("unit tests", r"tests/CMakeFiles/crescent_\w+_tests\.dir|_tests$"),
    ("conformance tests", r"crescent_conformance"),
    ("planted and known samplers", r"crescent_(planted|known_samplers)"),
    ("command line", r"apps/cli/|^crescent$"),
    ("src/{0}", r"crescent_(\w+)\.dir|libcrescent_(\w+)\.a"),
)


def part_of(output: str) -> str:
    for name, pattern in PARTS:
        if found := re.search(pattern, output):
            return name.format(*(group for group in found.groups() if group)) if "{0}" in name else name
    return "other"


def build_steps(build: Path) -> dict[str, float]:
    """Returns the seconds of the last run of each step, by part."""
    steps = {}
    for line in (build / ".ninja_log").read_text(encoding="utf-8").splitlines()[1:]:
        begin, end, _, output, _ = line.split("\t")
        steps[output] = (int(begin), int(end))
    # A step of several outputs has a line for each.
    seconds = {(begin, end): output for output, (begin, end) in steps.items()}
    totals: dict[str, float] = collections.defaultdict(float)
    for (begin, end), output in seconds.items():
        totals[part_of(output)] += (end - begin) / 1000
    return totals


def test_seconds(log: Path) -> dict[str, float]:
    totals: dict[str, float] = collections.defaultdict(float)
    for name, spent in re.findall(r"Test +#\d+: (\S+) .* ([\d.]+) sec", log.read_text(encoding="utf-8")):
        kind = re.match(r"unit|conformance", name)
        totals[f"{kind[0]} tests" if kind else name] += float(spent)
    return totals


def table(head: str, totals: dict[str, float]) -> str:
    whole = sum(totals.values())
    rows = [f"| {name} | {spent:.0f} | {spent / whole:.0%} |" for name, spent in sorted(totals.items(), key=lambda x: -x[1])
            if spent >= 0.005 * whole]
    return "\n".join([f"| {head} | s | share |", "|---|--:|--:|", *rows, f"| all | {whole:.0f} | |"])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=Path)
    parser.add_argument("--tests", type=Path, metavar="LOG")
    args = parser.parse_args()
    if args.tests:
        print(table("test", test_seconds(args.tests)))
    else:
        print(table("part", build_steps(args.build)))


if __name__ == "__main__":
    main()
