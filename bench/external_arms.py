#!/usr/bin/env python3
"""The rates of samplers from outside as arms of a run, as a share of what their own code reaches alone.

    bench/external_arms.py [--crescent PROGRAM] [--samples 1024] [--repeats 3] [--write docs/plugins.md]

One cosine sampler in four forms: examples/plugin/cosine.c as a library, examples/pipe_samplers/cosine_block.c and
cosine.c as programs that answer in blocks and in lines, and NumPy in a file. Alone is the library's function, called
on 8192 rows at a time by one thread; for NumPy the function alone, on 65536 rows. A run uses all cores; its rate is
that of timing.json: drawing, passing rows between processes and estimating. The best of the repeats. With --write
the table is put between the lines of the file that say "measured by external_arms.py" and "end of
external_arms.py".
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from measured_part import print_measured

ROOT = Path(__file__).resolve().parent.parent
ALONE = """
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include "crescent/plugin.h"
int main(void) {
    enum { rows = 8192, rounds = 400 };
    double *wo = calloc(3 * rows, 8), *u = malloc(16 * rows), *wi = malloc(24 * rows), *pdf = malloc(8 * rows);
    struct timespec a, b;
    for (int k = 0; k < 2 * rows; ++k) u[k] = (k * 7919 % 65536) / 65536.0;
    clock_gettime(CLOCK_MONOTONIC, &a);
    for (int k = 0; k < rounds; ++k) crescent_sampler_sample(rows, wo, u, 0, wi, pdf);
    clock_gettime(CLOCK_MONOTONIC, &b);
    printf("%g %g\\n", (double)rows * rounds / (b.tv_sec - a.tv_sec + 1e-9 * (b.tv_nsec - a.tv_nsec)), wi[rows / 2]);
    return 0;
}
"""
NUMPY = """
import numpy as np

def sample(wo, u):
    r, phi, z = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1], np.sqrt(1 - u[:, 0])
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], -1), z / np.pi

def pdf(wo, wi):
    return np.maximum(wi[:, 2], 0) / np.pi
"""
NUMPY_ALONE = """
import time, numpy as np, mine
wo, u = np.zeros((65536, 3)), np.random.default_rng(1).random((65536, 2))
start = time.perf_counter()
for _ in range(40): mine.sample(wo, u)
print(40 * 65536 / (time.perf_counter() - start))
"""
ARMS = {
    "library": 'plugin = "libcosine.so"',
    "program, blocks": 'exec = "./cosine_block"',
    "program, lines": 'exec = "./cosine"',
    "Python file, NumPy": 'python = "mine.py"',
}


def scene(arm: str, samples: int) -> str:
    text = (ROOT / "tests/system/tiny.toml").read_text()
    head, _, arms = text.partition("[arms.uniform]")
    region = arms.partition("[regions.ball]")[2].partition("[plates")[0]
    head = head.replace("width = 96", "width = 320").replace("height = 54", "height = 180")
    return f"{head}[arms.mine]\n{arm}\nn = [{samples}]\n[regions.ball]{region}"


def in_a_run(crescent: str, folder: str) -> float:
    environment = {**os.environ, "CRESCENT_PYTHON": sys.executable}
    command = [crescent, "run", "scene.toml", "--only", "metrics", "--quiet"]
    subprocess.run(command, cwd=folder, env=environment, check=True, stdout=subprocess.DEVNULL)
    return json.loads(Path(folder, "out/scene/timing.json").read_text())["arms"][0]["msamples_per_s"]


def alone(command: list[str], folder: str) -> float:
    """Million draws per second."""
    return float(subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True).stdout.split()[0]) / 1e6


def table(crescent: str, samples: int, repeats: int) -> str:
    lines = [
        f"| sampler | alone, million draws per second | in a run, {len(os.sched_getaffinity(0))} cores | share |",
        "|---|---|---|---|",
    ]
    with tempfile.TemporaryDirectory() as folder:
        cc = ["cc", "-O3", f"-I{ROOT}/include", f"-I{ROOT}/src"]
        plugin, pipes = ROOT / "examples/plugin/cosine.c", ROOT / "examples/pipe_samplers"
        Path(folder, "alone.c").write_text(ALONE)
        Path(folder, "mine.py").write_text(NUMPY)
        for words in (["-shared", "-fPIC", plugin, "-o", f"{folder}/libcosine.so"],
                      [f"{folder}/alone.c", plugin, "-o", f"{folder}/alone"],
                      [pipes / "cosine.c", "-o", f"{folder}/cosine"],
                      [pipes / "cosine_block.c", "-o", f"{folder}/cosine_block"]):
            subprocess.run([*cc, *words, "-lm"], check=True)
        in_c = max(alone(["./alone"], folder) for _ in range(repeats))
        in_numpy = max(alone([sys.executable, "-c", NUMPY_ALONE], folder) for _ in range(repeats))
        for name, arm in ARMS.items():
            Path(folder, "scene.toml").write_text(scene(arm, samples // 16 if "lines" in name else samples))
            rate = max(in_a_run(crescent, folder) for _ in range(repeats))
            own = in_numpy if "NumPy" in name else in_c
            lines.append(f"| {name} | {own:.1f} | {rate:.1f} | {rate / own:.0%} |")
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--crescent", default=str(ROOT / "build/crescent"))
    parser.add_argument("--samples", type=int, default=1024)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--write", metavar="FILE")
    args = parser.parse_args()
    text = table(os.path.abspath(args.crescent), args.samples, args.repeats)
    print_measured(text, args.write, "external_arms.py")


if __name__ == "__main__":
    main()
