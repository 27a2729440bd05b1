"""How fast a NumPy sampler is as an arm of `crescent.run`, as a share of what its code reaches when it is called alone
on the same arrays.

    PYTHONPATH=build/python python bench/python_arm.py [--repeats 5] [--write docs/python.md]

Both rates are of wall-clock time, the best of the repeats. The arrays of the first calls of the run are kept and the
code is called on them again, so both see the same values in the same memory layout. The time of a run without the arm
(references, metrics, a built-in arm) is subtracted. With --write the table is put between the lines of
the file that say "measured by python_arm.py" and "end of python_arm.py".
"""
import argparse
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

import crescent
from measured_part import print_measured

ROOT = Path(__file__).resolve().parent.parent
SAMPLES = 256
KEPT = 16  # calls


def cosine(wo, u):
    r, phi = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1]
    z = np.sqrt(1 - u[:, 0])
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], -1), z / np.pi


def phong(wo, u, ctx):
    r = wo * [-1, -1, 1]
    helper = np.where(np.abs(r[:, :1]) < 0.9, [1.0, 0, 0], [0, 1.0, 0])
    t = np.cross(helper, r)
    t /= np.linalg.norm(t, axis=1, keepdims=True)
    b = np.cross(r, t)
    cos, phi = u[:, 0] ** (1 / (ctx.s + 1)), 2 * np.pi * u[:, 1]
    sin = np.sqrt(1 - cos * cos)
    wi = (sin * np.cos(phi))[:, None] * t + (sin * np.sin(phi))[:, None] * b + cos[:, None] * r
    return wi, (ctx.s + 1) / (2 * np.pi) * cos**ctx.s


SAMPLERS = {
    "cosine": crescent.Sampler(cosine, name="cosine"),
    "cos^s about the mirror direction, `uses=(\"s\",)`": crescent.Sampler(phong, name="phong", uses=("s",)),
}


def scene():
    """The small scene of the system tests, larger, with the cosine arm alone."""
    text = (ROOT / "tests/system/tiny.toml").read_text()
    e = crescent.parse(text[: text.index("[arms.uniform]")] + f"[arms.cosine]\nn = [{SAMPLES}]\n")
    return e.with_({"image.width": 320, "image.height": 180})


def best(repeats, work):
    """The least wall-clock time of `work()`, in s."""
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times)


def recorded(e, sampler):
    """The arguments of the calls of the sampler in a run: how many rows in all, and those of the first calls."""
    rows, kept = [0], []

    def sample(*given):
        if len(given[1]) > 8:  # not the look at the sampler before the run
            rows[0] += len(given[1])
            if len(kept) < KEPT:
                kept.append(given)
        return sampler.sample(*given)

    run(e, replace(sampler, sample=sample))
    return rows[0], kept


def run(e, sampler=None):
    e = e.with_({})
    if sampler:
        e.samplers["mine"] = sampler
    crescent.run(e, seeds=(1, 1))


def table(repeats):
    e = scene()
    without = best(repeats, lambda: run(e))
    lines = [
        f"| arm, {SAMPLES} samples per pixel | draws | alone, million draws per second | in a run | share |",
        "|---|---|---|---|---|",
    ]
    for name, sampler in SAMPLERS.items():
        rows, kept = recorded(e, sampler)
        alone = best(repeats, lambda: [sampler.sample(*given) for given in kept])
        alone = sum(len(given[1]) for given in kept) / alone
        arm = rows / (best(repeats, lambda: run(e, sampler)) - without)
        lines.append(f"| {name} | {rows:,} | {alone / 1e6:.1f} | {arm / 1e6:.1f} | {arm / alone:.0%} |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--write", metavar="FILE")
    args = parser.parse_args()
    text = table(args.repeats)
    print_measured(text, args.write, "python_arm.py")


if __name__ == "__main__":
    main()
