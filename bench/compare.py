#!/usr/bin/env python3
"""Speed, in one run on one machine: crescent, a straightforward version of the same estimator, and Mitsuba 3.

    bench/compare.py [--experiment FILE] [--n N] [--write] [--no-mitsuba]

Builds crescent_bench, makes a virtual environment with Mitsuba under build/ where there is none, runs the three
after one another on an otherwise idle machine, and prints Msamples/s per arm with their ratios. Samples are counted
alike in all three: geometry pixels x N. --write puts the table, date, processor and command into docs/speed.md.
Exit 1 where an arm is less than ten times as fast as Mitsuba.
"""
import argparse
import datetime
import json
import pathlib
import platform
import shlex
import subprocess
import sys

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
    """The interpreter of a virtual environment that has Mitsuba, made where it is not there; None where that fails."""
    python = BUILD / "mitsuba" / "bin" / "python"
    if subprocess.run([str(python), "-c", "import mitsuba, numpy"], stderr=subprocess.DEVNULL).returncode == 0 if python.exists() else False:
        return python
    print("installing mitsuba from PyPI under build/mitsuba", file=sys.stderr)
    for command in ([sys.executable, "-m", "venv", BUILD / "mitsuba"], [python, "-m", "pip", "install", "-q", "mitsuba", "numpy"]):
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


def table(rows):
    out = ["| arm | crescent | straightforward | Mitsuba 3 | crescent / straightforward | crescent / Mitsuba |", "|---|---|---|---|---|---|"]
    for row in rows:
        mitsuba, ratio = ("-", "-") if row["mitsuba"] is None else (f"{row['mitsuba']:.1f}", f"{row['crescent'] / row['mitsuba']:.1f}")
        out.append(f"| {row['arm']} | {row['crescent']:.0f} | {row['straightforward']:.1f} | {mitsuba} | {row['crescent'] / row['straightforward']:.1f} | {ratio} |")
    return "\n".join(out)


def page(facts, rows, version, command):
    peer = "Mitsuba was not there." if version is None else (
        f"Mitsuba {version}: variant `llvm_ad_rgb`, integrator `direct` with `emitter_samples` 0 and `bsdf_samples` {facts['n']}, 1 spp, hidden emitters, "
        "the arms as a BSDF in Python; compiling is not counted. Its scene is the same but for two things that cost it nothing: there geometry also "
        "occludes the fill, so its means differ, and the canvas lies before the wall instead of in a recess."
    )
    return f"""# Speed

Msamples/s, one run on one machine. A sample is one draw of one geometry pixel, counted alike for all: {facts['geometry_pixels']} geometry pixels x N = {facts['n']}.

{table(rows)}

- {datetime.date.today().isoformat()}, {processor()}, {facts['threads']} threads, {facts['isa']}, {facts['compiler']}, crescent {facts['version']} ({facts['commit']})
- `{command}` writes this page.
- crescent: its films, shadow tests included, as a run makes them: primary rays are traced once a run; the best of 7.
- straightforward: `bench/straightforward.cpp`, the same estimator in double precision, one ray at a time, on as many threads; the best of 2.
- {peer}
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--experiment", default="experiments/gallery.toml")
    parser.add_argument("--n", type=int, default=64, help="samples per pixel (default 64)")
    parser.add_argument("--write", action="store_true", help="write docs/speed.md")
    parser.add_argument("--no-mitsuba", action="store_true")
    args = parser.parse_args()

    facts, *rows = lines([build(), args.experiment, args.n])
    python = None if args.no_mitsuba else mitsuba_python()
    peers = {} if python is None else {peer["arm"]: peer for peer in lines([python, "bench/mitsuba_arms.py", args.experiment, args.n])}
    version = next((peer["version"] for peer in peers.values()), None)
    samples = facts["geometry_pixels"] * facts["n"]
    for row in rows:
        peer = peers.get(row["arm"])
        row["mitsuba"] = samples / peer["seconds"] * 1e-6 if peer else None
    print(table(rows))
    if args.write:
        (ROOT / "docs" / "speed.md").write_text(page(facts, rows, version, shlex.join(["bench/compare.py", *sys.argv[1:]])))
    slow = [row["arm"] for row in rows if row["mitsuba"] and row["crescent"] < LEAST * row["mitsuba"]]
    if slow:
        print(f"less than {LEAST} times Mitsuba: {', '.join(slow)}", file=sys.stderr)
    return 1 if slow else 0


if __name__ == "__main__":
    sys.exit(main())
