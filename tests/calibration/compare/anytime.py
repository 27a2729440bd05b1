#!/usr/bin/env python3
"""Compares the bounds of `crescent compare --until` with other implementations, and measures their coverage.

    python3 -m venv v && v/bin/pip install numpy scipy pybind11 scikit-build cmake ninja 'setuptools<70' wheel
    v/bin/pip install --no-build-isolation confseq
    v/bin/python tests/calibration/compare/anytime.py build/tests/calibration/crescent_until --seed 1

1. For many degrees of freedom: the normal mixture of Howard, Ramdas, McAuliffe & Sekhon 2021, equation (14), by their
   package `confseq` (left out if it is missing, as it builds from C++).
2. For few: the Bayes factor as the integral over the effect of SciPy's noncentral t over its central one, with a normal
   prior of the effect.
3. Coverage on fresh seeds: whether the true mean, or difference of two means, is ever outside of the interval in 4 to 400
   renders; two sides as renders are added to both, or to one while the other has 12; the t of Welch and its degrees
   of freedom as in `compare`; normal and skewed noise, equal and unequal spread.

Prints the tables of docs/error-rates.md; the exit code is 1 if a bound deviates, or a coverage under normal noise of equal
spread is significantly too low, 77 if NumPy or SciPy is missing."""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile

try:
    import numpy as np
    from scipy import integrate, stats
except ImportError as missing:
    print(f"skipped: {missing}; pip install numpy scipy")
    sys.exit(77)
try:
    from confseq import boundaries
except ImportError:
    boundaries = None

EFFECT = 8.0  # anytime.cpp: the variance of the effect, in variances of one render


def bounds(program: str, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """|t| of crescent for rows of p, df and information, and p of these |t|."""
    with tempfile.NamedTemporaryFile("w", suffix=".txt") as file:
        np.savetxt(file, rows, "%.17g")
        file.flush()
        text = subprocess.run([program, "--bounds", file.name], check=True, capture_output=True, text=True).stdout
    t, p = np.array([[float(word) for word in line.split()] for line in text.splitlines()]).T
    return t, p


def normal_mixture(alpha: float, n: float) -> float:
    """confseq's bound of a sum of n normal numbers of variance 1, over its standard deviation."""
    rho = 1 / EFFECT
    # confseq takes the v at which its bound is about best, from which it derives rho.
    optimum = rho * (2 * np.log(1 / alpha) + np.log(1 + 2 * np.log(1 / alpha)))
    bound = boundaries.normal_mixture_bound(n, alpha=alpha, v_opt=optimum, alpha_opt=alpha, is_one_sided=False)
    return float(bound) / np.sqrt(n)


def bayes_factor(t: float, df: float, information: float) -> float:
    """Density of t with a normal effect over that without one, by quadrature."""
    root = np.sqrt(EFFECT * information)
    value, _ = integrate.quad(lambda z: stats.nct.pdf(t, df, root * z) * stats.norm.pdf(z), -9, 9, limit=400, epsabs=0, epsrel=1e-9, points=(t / root, -t / root, 0))
    return value / stats.t.pdf(t, df)


def compare_with_confseq(program: str) -> float:
    alphas = [0.2, 0.05, 0.01, 1e-3, 1e-5]
    rows = np.array([(a, 1e9, n) for a in alphas for n in (2, 4, 10, 30, 100, 1000, 30000)])
    t, _ = bounds(program, rows)
    return max(abs(own / normal_mixture(a, n) - 1) for own, (a, _, n) in zip(t, rows))


def compare_with_quadrature(program: str) -> tuple[float, int]:
    rows = np.array([(a, df, n) for a in (0.2, 0.05, 0.01, 1e-3) for df in (2, 3, 7, 20, 60) for n in (1.5, 4, 12, 40)])
    t, p = bounds(program, rows)
    worst, count = 0.0, 0
    for own, again, (a, df, n) in zip(t, p, rows):
        if not np.isfinite(own):  # no |t| has this p: the factor at infinity is below 1 / p
            largest = bayes_factor(300, df, n)
            worst = max(worst, largest * a - 1)
            continue
        worst = max(worst, abs(bayes_factor(own, df, n) * a - 1), abs(again / a - 1))
        count += 1
    return worst, count


def welch(a: np.ndarray, b: np.ndarray, counts: tuple[np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """|t| and degrees of freedom of the difference of the first `counts` numbers of each side."""
    parts = []
    for x, n in zip((a, b), counts):
        sums, squares = np.cumsum(x, 1)[:, n - 1], np.cumsum(x * x, 1)[:, n - 1]
        parts.append((sums / n, (squares - sums**2 / n) / (n - 1) / n))
    (ma, va), (mb, vb) = parts
    df = (va + vb) ** 2 / (va**2 / (counts[0] - 1) + vb**2 / (counts[1] - 1))
    return np.abs(ma - mb) / np.sqrt(va + vb), df


def noise(rng: np.random.Generator, kind: str, shape: tuple[int, int]) -> np.ndarray:
    """Numbers of mean 0; "gamma": the mean of a region whose renders have a skewness of 1."""
    return rng.normal(size=shape) if kind == "normal" else rng.gamma(4, 0.5, shape) - 2


def coverage(program: str, design: str, kind: str, ratio: float, alpha: float, runs: int, seed: int) -> tuple[int, int]:
    """How often the truth is ever outside, of `runs`: with the bound, and with repeated tests at the same level."""
    rng = np.random.default_rng([seed, len(design), len(kind), int(ratio * 16), int(alpha * 1e6)])
    most, first = 400, 4
    looks = np.unique(np.concatenate([np.arange(first, 40), np.geomspace(40, most, 40).astype(int)]))
    if design == "one side":
        x = noise(rng, kind, (runs, most))
        sums, squares = np.cumsum(x, 1)[:, looks - 1], np.cumsum(x * x, 1)[:, looks - 1]
        t = np.abs(sums / looks) / np.sqrt((squares - sums**2 / looks) / (looks - 1) / looks)
        df, information = np.broadcast_to(looks - 1.0, t.shape), looks.astype(float)
    else:
        fixed = np.full_like(looks, 12) if design == "baseline of 12" else looks
        a, b = noise(rng, kind, (runs, most)), ratio * noise(rng, kind, (runs, most))
        t, df = welch(a, b, (fixed, looks))
        information = fixed * looks / (fixed + looks)
    # |t| at the level, interpolated over the degrees of freedom at each look; they are at least 3.
    grid = np.concatenate([np.linspace(2, 12, 41), np.geomspace(12.5, 2 * most, 80)])
    table, _ = bounds(program, np.array([(alpha, d, i) for i in information for d in grid]))
    limits = np.stack([np.interp(df[:, k], grid, row) for k, row in enumerate(table.reshape(len(looks), -1))], 1)
    repeated = stats.t.isf(alpha / 2, df)
    return int((t > limits).any(1).sum()), int((t > repeated).any(1).sum())


def main() -> int:
    parser = argparse.ArgumentParser(description="Checks bounds that may be read at any time.")
    parser.add_argument("program", help="crescent_until")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--runs", type=int, default=20000)
    arguments = parser.parse_args()
    failed = False
    if boundaries is None:
        print("`confseq` is not installed: its bounds are not compared.")
    else:
        worst = compare_with_confseq(arguments.program)
        print(f"Known variance, 35 bounds of `confseq`: largest relative deviation {worst:.1e}.")
        failed |= worst > 1e-6  # 1e9 degrees of freedom stand for infinitely many
    worst, count = compare_with_quadrature(arguments.program)
    print(f"Unknown variance, {count} Bayes factors by quadrature: largest relative deviation {worst:.1e}.\n")
    failed |= worst > 1e-5
    print("| design | noise | spread of B over A | alpha | ever outside | repeated t tests |\n|---|---|---|---|---|---|")
    for design, ratio in (("one side", 1.0), ("two sides", 1.0), ("baseline of 12", 1.0), ("two sides", 3.0),
                          ("baseline of 12", 3.0), ("baseline of 12", 1 / 3)):
        for kind in ("normal", "gamma"):
            for alpha in (0.05, 0.01):
                out, repeated = coverage(
                    arguments.program, design, kind, ratio, alpha, arguments.runs, arguments.seed)
                share, low = out / arguments.runs, stats.beta.ppf(0.001, out, arguments.runs - out + 1) if out else 0
                print(f"| {design} | {kind} | {ratio:.3g} | {alpha:g} | {100 * share:.2f} % | "
                      f"{100 * repeated / arguments.runs:.1f} % |", flush=True)
                failed |= kind == "normal" and ratio == 1 and low > alpha
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
