#!/usr/bin/env python3
"""Speed, in one run on one machine: crescent, a straightforward version of the same estimator, and Mitsuba 3.

    bench/compare.py [--experiment FILE] [--n N] [--rounds K] [--write] [--no-mitsuba]

Builds crescent_bench, makes a virtual environment with Mitsuba under build/ where there is none, and lets the three
take turns, K rounds (default 7) on an otherwise idle machine: in each round every program makes each arm's film three
times and gives the best. Prints Msamples/s per arm (the median over rounds) and the median, least and largest ratio of
one round's times. A sample is one draw of one geometry pixel, for all three alike: geometry pixels x N; pixels that see
nothing cost all three a primary ray and no sample. --write puts the table, date, processor and command into
docs/speed.md. Exit 1 where an arm's median is less than ten times as fast as Mitsuba.
"""
import argparse
import datetime
import json
import pathlib
import platform
import shlex
import statistics
import subprocess
import sys

from measured_part import print_measured

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / "build"
LEAST = 10  # times Mitsuba


def lines(command):
    done = subprocess.run([str(word) for word in command], cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True)
    return [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]


def build():
    subprocess.run(["cmake", "--preset", "bench"], cwd=ROOT, stdout=subprocess.DEVNULL, check=True)
    subprocess.run(["ninja", "-C", str(BUILD), "crescent_bench"], cwd=ROOT, stdout=subprocess.DEVNULL, check=True)
    return next(BUILD.rglob("crescent_bench"))


def mitsuba_python():
    """Returns the interpreter of a virtual environment that has Mitsuba, creating it if needed; None if that fails."""
    python = BUILD / "mitsuba" / "bin" / "python"
    imports = [str(python), "-c", "import mitsuba, numpy"]
    if python.exists() and subprocess.run(imports, stderr=subprocess.DEVNULL).returncode == 0:
        return python
    print("installing mitsuba from PyPI under build/mitsuba", file=sys.stderr)
    for command in ([sys.executable, "-m", "venv", BUILD / "mitsuba"],
                    [python, "-m", "pip", "install", "-q", "mitsuba", "numpy"]):
        if subprocess.run([str(word) for word in command]).returncode != 0:
            print("no mitsuba: its column stays empty", file=sys.stderr)
            return None
    return python


def processor():
    try:
        with open("/proc/cpuinfo") as file:
            return next(line.split(":", 1)[1].strip() for line in file if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.processor()


def turn(bench, python, args):
    """Runs one round and returns its facts, and each arm's seconds by program."""
    facts, *rows = lines([bench, args.experiment, args.n])
    seconds = {row["arm"]: {"crescent": row["crescent"], "straightforward": row["straightforward"]} for row in rows}
    if python:
        for peer in lines([python, "bench/mitsuba_arms.py", args.experiment, args.n]):
            facts["mitsuba"] = peer["version"]
            if peer["arm"] in seconds:
                seconds[peer["arm"]]["mitsuba"] = peer["seconds"]
    return facts, seconds


def summary(turns, arm, samples):
    """Returns rates by program and, by peer, the ratios of crescent to it in each round."""
    peers = [peer for peer in ("straightforward", "mitsuba") if all(peer in one[arm] for one in turns)]
    rate = lambda who: samples / statistics.median(one[arm][who] for one in turns) * 1e-6
    return {"arm": arm, "rates": {who: rate(who) for who in ("crescent", *peers)},
            "ratios": {peer: sorted(one[arm][peer] / one[arm]["crescent"] for one in turns) for peer in peers}}


def table(rows):
    out = ["| sampler | crescent | straightforward | Mitsuba 3 | crescent / straightforward | crescent / Mitsuba |",
           "|---|---|---|---|---|---|"]
    for row in rows:
        rates, cells = row["rates"], []
        for who in ("crescent", "straightforward", "mitsuba"):
            cells.append(f"{rates[who]:.{0 if who == 'crescent' else 1}f}" if who in rates else "-")
        for peer in ("straightforward", "mitsuba"):
            ratios = row["ratios"].get(peer)
            cells.append(f"{statistics.median(ratios):.1f} ({ratios[0]:.1f} to {ratios[-1]:.1f})" if ratios else "-")
        out.append(f"| {row['arm']} | " + " | ".join(cells) + " |")
    return "\n".join(out)


def measured(facts, rows, rounds, command):
    """Returns the part of docs/speed.md: the table, and how it was measured."""
    peer = f"Mitsuba {facts['mitsuba']}" if facts.get("mitsuba") else "Mitsuba was not installed"
    return f"""{table(rows)}

By `{command}`, the median of {rounds} rounds, {facts['geometry_pixels']} geometry pixels x N = {facts['n']}, on
{datetime.date.today().isoformat()}: {processor()}, {facts['threads']} threads, {facts['isa']}, {facts['compiler']},
crescent {facts['version']} ({facts['commit']}). {peer}."""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--experiment", default="experiments/gallery.toml")
    parser.add_argument("--n", type=int, default=64, help="samples per pixel (default 64)")
    parser.add_argument("--rounds", type=int, default=7, help="turns each program takes (default 7)")
    parser.add_argument("--write", action="store_true", help="write the part of docs/speed.md")
    parser.add_argument("--no-mitsuba", action="store_true")
    args = parser.parse_args()

    bench, python = build(), None if args.no_mitsuba else mitsuba_python()
    turns = []
    for k in range(args.rounds):
        print(f"round {k + 1} of {args.rounds}", file=sys.stderr)
        facts, seconds = turn(bench, python, args)
        turns.append(seconds)
    rows = [summary(turns, arm, facts["geometry_pixels"] * facts["n"]) for arm in turns[0]]
    command = shlex.join(["bench/compare.py", *sys.argv[1:]])
    page = ROOT / "docs" / "speed.md" if args.write else None
    print_measured(measured(facts, rows, args.rounds, command), page, "compare.py")
    against_mitsuba = [(row["arm"], row["ratios"]["mitsuba"]) for row in rows if "mitsuba" in row["ratios"]]
    slow = [arm for arm, ratios in against_mitsuba if statistics.median(ratios) < LEAST]
    if slow:
        print(f"less than {LEAST} times Mitsuba: {', '.join(slow)}", file=sys.stderr)
    return 1 if slow else 0


if __name__ == "__main__":
    sys.exit(main())
