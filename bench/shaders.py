#!/usr/bin/env python3
"""The rates of GGX by visible normals in a shader, beside the same code as a plugin in C.

    bench/shaders.py [--crescent PROGRAM] [--rounds 5] [--device NAME] [--write docs/speed.md]

The shader answers as in a check: blocks of rows over the pipes of its process, from WGSL. The plugin's functions are
called in this process on the same rows, by a thread for each core. Then both are checked. They alternate; figures are
medians, the ratio is the median of those of one round. Needs NumPy, wgpu, a driver and cc. With --write the table is put between the lines of
the file that say "measured by shaders.py" and "end of shaders.py".
"""
import argparse
import ctypes
import fcntl
import os
import statistics
import struct
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
from measured_part import print_measured

ROOT = Path(__file__).resolve().parent.parent
ROWS, BLOCKS = 32768, 64  # as long as those of crescent
ALPHA = 0.3
PLUGIN = """
#include <math.h>
#include "check/sampler_plugin.h"
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


class Shader:
    """The process that a check starts."""

    def __init__(self, device: str | None) -> None:
        self.words = [LOBES, *SNIPPETS, *(["--device", device] if device else [])]
        command = [sys.executable, "-m", "crescent_shader", *self.words]
        self.process = subprocess.Popen(command, env=environment_of_shaders(), stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        bufsize=0)  # fmt: skip
        for pipe in (self.process.stdin, self.process.stdout):
            fcntl.fcntl(pipe, fcntl.F_SETPIPE_SZ, 1 << 20)
        self.process.stdin.write(b"hello 2\n")
        self.process.stdin.flush()
        handshake = b""
        while not handshake.endswith(b"\n"):
            handshake += self.process.stdout.read(1) or sys.exit("no handshake")
        handshake = handshake.decode()
        if not handshake.startswith("hello"):
            sys.exit(handshake)

    def answer(self, kind: str, wo: np.ndarray, given: np.ndarray) -> np.ndarray:
        """The densities of all rows, of draws by `given` numbers or of `given` directions."""
        columns = 4 if kind == "sample" else 1
        rows = np.hstack([wo, given]).astype(np.float32)
        request = {"sample": b"smpl", "pdf": b"pdf_"}[kind] + struct.pack("<I", len(rows)) + rows.tobytes()

        def ask() -> None:  # as crescent does: the next block while the last one is evaluated
            for _ in range(BLOCKS):
                left = memoryview(request)
                while left:
                    left = left[self.process.stdin.write(left) :]

        answer = np.empty((len(rows), columns), np.float32)
        with ThreadPoolExecutor(1) as pool:
            asked = pool.submit(ask)
            for _ in range(BLOCKS):
                if struct.unpack("<I", self.process.stdout.read(4)) != (len(rows),):
                    sys.exit("expected an answer to each row")
                left = answer.data.cast("B")
                while left:
                    left = left[self.process.stdout.readinto(left) :]
            asked.result()
        return answer[:, -1]


class Plugin:
    """Its functions on the same rows, the blocks shared by a thread for each core."""

    def __init__(self, folder: str) -> None:
        source, library = Path(folder, "ggx.c"), str(Path(folder, "libggx.so"))
        source.write_text(PLUGIN % ALPHA)
        subprocess.run(["cc", "-O2", "-shared", "-fPIC", f"-I{ROOT}/src", source, "-o", library, "-lm"], check=True)
        self.library = ctypes.CDLL(library)
        self.words = ["--plugin", library]

    def draw(self, wo: np.ndarray, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        wi, pdf = np.empty((len(wo), 3)), np.empty(len(wo))
        data = [ctypes.c_void_p(a.ctypes.data) for a in (wo, u)]
        out = [ctypes.c_void_p(a.ctypes.data) for a in (wi, pdf)]
        self.library.crescent_sampler_sample(ctypes.c_size_t(len(wo)), *data, None, *out)
        return wi, pdf

    def density(self, wo: np.ndarray, wi: np.ndarray) -> np.ndarray:
        pdf = np.empty(len(wo))
        wo_data, wi_data, out = (ctypes.c_void_p(a.ctypes.data) for a in (wo, wi, pdf))
        self.library.crescent_sampler_pdf(ctypes.c_size_t(len(wo)), wo_data, wi_data, None, out)
        return pdf

    def answer(self, kind: str, wo: np.ndarray, given: np.ndarray) -> np.ndarray:
        call = (lambda: self.draw(wo, given)[1]) if kind == "sample" else (lambda: self.density(wo, given))
        with ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
            return [task.result() for task in [pool.submit(call) for _ in range(BLOCKS)]][-1]


def table(crescent: str, rounds: int, device: str | None) -> str:
    wo = np.tile([np.sin(0.7), 0, np.cos(0.7)], (ROWS, 1))
    u = np.random.default_rng(1).random((ROWS, 2))
    ratios: dict[str, list[float]] = {}
    shown: dict[str, dict[str, list[float]]] = {}
    with tempfile.TemporaryDirectory() as folder:
        sides = {"shader": Shader(device), "plugin": Plugin(folder)}
        wi = sides["plugin"].draw(wo, u)[0]
        wi[:, 2] = np.abs(wi[:, 2])  # a check asks for no density below the surface
        given = {"sample": u, "pdf": wi}
        for round_number in range(rounds + 1):  # the first one warms up
            seconds: dict[str, dict[str, float]] = {"sample": {}, "pdf": {}, "check": {}}
            for kind in ("sample", "pdf"):
                answers = {}
                for name, side in sides.items():
                    start = time.perf_counter()
                    answers[name] = side.answer(kind, wo, given[kind])
                    seconds[kind][name] = time.perf_counter() - start
                if not np.allclose(*answers.values(), rtol=1e-2, atol=1e-4):
                    sys.exit(f"{kind}: the shader and the plugin differ")
            for name, side in sides.items():
                start = time.perf_counter()
                subprocess.run([crescent, "check", *side.words, "--wo", "40", "--quiet"], check=True,
                               env=environment_of_shaders(), capture_output=True)  # fmt: skip
                seconds["check"][name] = time.perf_counter() - start
            for kind, of_kind in seconds.items() if round_number > 0 else ():
                ratios.setdefault(kind, []).append(of_kind["plugin"] / of_kind["shader"])
                for name, value in of_kind.items():
                    shown.setdefault(kind, {}).setdefault(name, []).append(value)
        sides["shader"].process.stdin.close()
    lines = ["| GGX by visible normals | shader | plugin in C | shader / plugin, speed |", "|---|--:|--:|--:|"]
    millions = ROWS * BLOCKS / 1e6
    for kind, what in (("sample", "draws"), ("pdf", "densities")):
        rates = [millions / statistics.median(shown[kind][name]) for name in ("shader", "plugin")]
        lines.append(f"| {what} | {rates[0]:.0f} M/s | {rates[1]:.0f} M/s | {statistics.median(ratios[kind]):.2f} |")
    times = [statistics.median(shown["check"][name]) for name in ("shader", "plugin")]
    lines.append(f"| a quick check at one w_o | {times[0]:.1f} s | {times[1]:.1f} s | {statistics.median(ratios['check']):.2f} |")
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--crescent", default=str(ROOT / "build/crescent"))
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--device")
    parser.add_argument("--write", metavar="FILE")
    args = parser.parse_args()
    text = table(os.path.abspath(args.crescent), args.rounds, args.device)
    print_measured(text, args.write, "shaders.py")


if __name__ == "__main__":
    main()
