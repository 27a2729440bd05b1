"""The rate at which `crescent.check` calls NumPy callables: draws per second by the calls alone, and in a whole check.

    PYTHONPATH=build/python python bench/python_draws.py [--repeats 20] [--write docs/python.md]

Processor time is that of the whole process over all its threads, the best of the repeats. With --write the table is put
between the lines of the file that say "measured by python_draws.py" and "end of python_draws.py".
"""
import argparse
import statistics
import time

import numpy as np

import crescent
from crescent import _check, _crescent
from measured_part import print_measured

BATCHES = 64  # of 32768


def sample(wo, u):
    r, phi = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1]
    z = np.sqrt(1 - u[:, 0])
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], -1), z / np.pi


def pdf(wo, wi):
    return np.maximum(wi[:, 2], 0) / np.pi


def f(wo, wi):
    return np.where(wi[:, 2] > 0, 1 / np.pi, 0)


def best(repeats, work):
    """Returns the smallest processor time of `work()`, in s."""
    times = []
    for _ in range(repeats):
        start = time.process_time()
        work()
        times.append(time.process_time() - start)
    return min(times)


def numpy_alone():
    rng = np.random.default_rng(1)
    wo = np.tile([0.0, 0.0, 1.0], (32768, 1))
    u = np.asfortranarray(rng.random((32768, 2)))
    return lambda: [sample(wo, u) for _ in range(BATCHES)]


def asked():
    """Returns the rows that one check evaluates with sample, pdf and f."""
    rows = {"sample": 0, "pdf": 0, "f": 0}

    def counted(call):
        def count(*at):
            rows[call.__name__] += len(at[-1])
            return call(*at)

        return count

    crescent.check(*map(counted, (sample, pdf, f)), name="cosine")
    return rows


def spent_in_callables():
    """Returns the part of a check's processor time that the callables themselves take."""
    spent = [0.0]

    def timed(call):
        def time_it(*at):
            start = time.thread_time()
            out = call(*at)
            spent[0] += time.thread_time() - start
            return out

        return time_it

    start = time.process_time()
    crescent.check(*map(timed, (sample, pdf, f)), name="cosine")
    return spent[0] / (time.process_time() - start)


def table(repeats):
    cases = _check._cases(crescent.Sampler(sample, pdf, f), False, [])
    rows = asked()
    lines = [
        "| | draws | million draws per second of processor time | time relative to `sample` |",
        "|---|---|---|---|",
    ]
    alone = None  # s of processor time per draw
    for what, draws, work in (
        ("`sample` alone, in NumPy", BATCHES * 32768, numpy_alone()),
        ("drawn by crescent and discarded", BATCHES * 32768, lambda: _crescent.draw(cases, BATCHES)),
        ("a complete check, nine verdicts at 8 w_o", rows["sample"], lambda: crescent.check(sample, pdf, f)),
    ):
        cpu = best(repeats, work)
        alone = alone or cpu / draws
        lines.append(f"| {what} | {draws:,} | {draws / cpu / 1e6:.1f} | {cpu / draws / alone:.1f} x |")
    whole = best(repeats, lambda: crescent.check(sample, pdf, f))
    inside = statistics.median(spent_in_callables() for _ in range(repeats))
    return "\n".join(lines) + (
        f"\n\nA check evaluates {rows['pdf']:,} rows of pdf and {rows['f']:,} of f in addition to its draws: "
        f"{sum(rows.values()) / whole / 1e6:.1f} million rows in all per second of processor time. {inside:.0%} of "
        "that time is spent in the callables, the rest in the tests."
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeats", type=int, default=20)
    parser.add_argument("--write", metavar="FILE")
    args = parser.parse_args()
    text = table(args.repeats)
    print_measured(text, args.write, "python_draws.py")


if __name__ == "__main__":
    main()
