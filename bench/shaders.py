#!/usr/bin/env python3
"""The rates of GGX by visible normals in a shader, beside the same code as a plugin in C.

    bench/shaders.py [--build build] [--rounds 5] [--device NAME] [--write docs/speed.md]

Both, the shader in WGSL, answer through crescent in memory that is shared, from a process for each core
(bench/adapters.cpp). Then both are checked. They alternate; figures are medians,
the ratio is the median of those of one round. Needs a build with the preset `bench`, NumPy, wgpu, a driver and cc. With
--write the table is put between the lines of the file that say "measured by shaders.py" and "end of shaders.py".
"""
import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from measured_part import print_measured

ROOT = Path(__file__).resolve().parent.parent
ALPHA = 0.3
PLUGIN = """
#include <math.h>
#include "crescent/plugin.h"
static const double pi = 3.14159265358979323846, alpha = %g;
static double larger(double a, double b) { return a > b ? a : b; }
/* as tests/known_samplers/shaders/lobes.wgsl */
static double density(const double* o, const double* i) {
    double m[3] = {o[0] + i[0], o[1] + i[1], o[2] + i[2]};
    double k = 1 / sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
    for (int c = 0; c < 3; ++c) m[c] *= k;
    double t = alpha * alpha * m[2] * m[2] + m[0] * m[0] + m[1] * m[1], d = alpha * alpha / (pi * t * t);
    double tan2 = (o[0] * o[0] + o[1] * o[1]) / (o[2] * o[2]);
    return i[2] > 0 ? 2 / (1 + sqrt(1 + alpha * alpha * tan2)) * d / (4 * o[2]) : 0;
}
unsigned crescent_sampler_abi(void) { return CRESCENT_SAMPLER_ABI; }
const char* crescent_sampler_name(void) { return "GGX in C"; }
int crescent_sampler_pdf(size_t count, const double* wo, const double* wi, const double* surface, double* pdf) {
    (void)surface;
    for (size_t n = 0; n < count; ++n) pdf[n] = density(wo + 3 * n, wi + 3 * n);
    return 0;
}
int crescent_sampler_sample(
    size_t count, const double* wo, const double* u, const double* surface, double* wi, double* pdf) {
    (void)surface;
    for (size_t n = 0; n < count; ++n, wo += 3, u += 2, wi += 3) {
        double v[3] = {alpha * wo[0], alpha * wo[1], wo[2]};
        double k = 1 / sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        for (int c = 0; c < 3; ++c) v[c] *= k;
        double z = (1 - u[0]) * (1 + v[2]) - v[2], r = sqrt(larger(0, 1 - z * z)), phi = 2 * pi * u[1];
        double m[3] = {alpha * (r * cos(phi) + v[0]), alpha * (r * sin(phi) + v[1]), z + v[2]};
        k = 1 / sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
        for (int c = 0; c < 3; ++c) m[c] *= k;
        double twice = 2 * (wo[0] * m[0] + wo[1] * m[1] + wo[2] * m[2]);
        for (int c = 0; c < 3; ++c) wi[c] = twice * m[c] - wo[c];
        pdf[n] = density(wo, wi);
    }
    return 0;
}
"""
SNIPPETS = ["--sample", "wi = ggx_sample(wo, u, alpha)", "--pdf", "ggx_pdf(wo, wi, alpha)", "--set", f"alpha={ALPHA}"]
LOBES = str(ROOT / "tests/known_samplers/shaders/lobes.wgsl")


def environment_of_shaders() -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": str(ROOT / "python"), "CRESCENT_PYTHON": sys.executable}


def plugin_in(folder: str) -> str:
    source, library = Path(folder, "ggx.c"), str(Path(folder, "libggx.so"))
    source.write_text(PLUGIN % ALPHA)
    subprocess.run(["cc", "-O2", "-shared", "-fPIC", f"-I{ROOT}/include", f"-I{ROOT}/src", source, "-o", library, "-lm"], check=True)
    return library


def table(build: Path, rounds: int, device: str | None) -> str:
    shader = [*SNIPPETS, *(["--device", device] if device else [])]
    rates: dict[str, dict[str, list[float]]] = {"draws": {}, "densities": {}, "check": {}}
    with tempfile.TemporaryDirectory() as folder:
        plugin = plugin_in(folder)
        for round_number in range(rounds + 1):  # the first one warms up
            measured: list[tuple[str, str, float]] = []
            command = [build / "bench/crescent_adapters", plugin, LOBES, *shader]
            done = subprocess.run(command, check=True, env=environment_of_shaders(), stdout=subprocess.PIPE, text=True)
            for line in done.stdout.splitlines():
                name, kind, rate = line.split()
                measured.append((name, kind, float(rate)))
            for name, words in (("shader", [LOBES, *shader]), ("plugin", ["--plugin", plugin])):
                start = time.perf_counter()
                subprocess.run([build / "crescent", "check", *words, "--wo", "40", "--quiet"], check=True,
                               env=environment_of_shaders(), capture_output=True)  # fmt: skip
                measured.append((name, "check", 1 / (time.perf_counter() - start)))
            for name, kind, rate in measured if round_number > 0 else ():
                rates[kind].setdefault(name, []).append(rate)
    lines = ["| GGX by visible normals | shader | plugin in C | shader / plugin, speed |", "|---|--:|--:|--:|"]
    for kind, of_kind in rates.items():
        ratio = statistics.median(s / p for s, p in zip(of_kind["shader"], of_kind["plugin"], strict=True))
        values = [statistics.median(of_kind[name]) for name in ("shader", "plugin")]
        what = "a quick check at one w_o" if kind == "check" else kind
        shown = [f"{1 / v:.1f} s" if kind == "check" else f"{v:.0f} M/s" for v in values]
        lines.append(f"| {what} | {shown[0]} | {shown[1]} | {ratio:.2f} |")
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=ROOT / "build")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--device")
    parser.add_argument("--write", metavar="FILE")
    args = parser.parse_args()
    text = table(args.build.resolve(), args.rounds, args.device)
    print_measured(text, args.write, "shaders.py")


if __name__ == "__main__":
    main()
