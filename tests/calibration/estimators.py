"""Measures `crescent.check` over estimators of a number and over reservoirs.

Random numbers are the samplers' own. Each case has random parameters, a function of the seed and its number. Needs
crescent and SciPy.

    python estimators.py numbers --seed 77 --cases 0:220 --out numbers.jsonl
    python estimators.py reservoirs --seed 77 --cases 0:150 --wrong --out reservoirs.jsonl
"""

from __future__ import annotations

import argparse
import json
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import crescent
import numpy as np
from domains import Array, bounds, direction, log_uniform
from scipy import integrate

Draw = Callable[[np.random.Generator, int], Array]
Estimator = tuple[Draw, float]  # of values by their number, and their mean without a bias

# ---- Estimators of a number. A bias multiplies what each of them estimates, or a part of it.


def medium(rng: np.random.Generator) -> tuple[Callable[[Array], Array], float, float, float, float]:
    """Extinction along a ray, its minorant and majorant, the ray's length and its optical depth."""
    low, more, phase, length = (
        log_uniform(rng, 0.1, 2),
        log_uniform(rng, 0.1, 2),
        rng.uniform(0, 6),
        log_uniform(rng, 0.3, 3),
    )
    extinction = lambda t: low + more * (1 + np.sin(phase + 3 * t)) / 2  # noqa: E731
    return extinction, low, low + more, length, integrate.quad(extinction, 0, length)[0]


def collisions(
    rng: np.random.Generator, n: int, rate: float, length: float, each: Callable[[Array, Array], None]
) -> None:
    """Calls each(distances, whether they are still on the ray) for tentative collisions at a constant rate."""
    t = np.zeros(n)
    while True:
        t = t - np.log1p(-rng.random(n)) / rate
        inside = t < length
        if not inside.any():
            return
        each(t, inside)


def by_ratio(rng: np.random.Generator, bias: float, with_control: bool) -> Estimator:
    """Transmittance by ratio tracking, besides a constant control that is known (Novak et al. 2014)."""
    extinction, minorant, majorant, length, depth = medium(rng)
    control = minorant if with_control else 0

    def draw(generator: np.random.Generator, n: int) -> Array:
        w = np.full(n, np.exp(-control * length))

        def each(t: Array, inside: Array) -> None:
            w[inside] *= 1 - (extinction(t[inside]) - control) * (1 + bias) / (majorant - control)

        collisions(generator, n, majorant - control, length, each)
        return w

    return draw, float(np.exp(-depth))


def ratio(rng: np.random.Generator, bias: float) -> Estimator:
    """Transmittance by ratio tracking."""
    return by_ratio(rng, bias, False)


def residual(rng: np.random.Generator, bias: float) -> Estimator:
    """Transmittance by residual ratio tracking."""
    return by_ratio(rng, bias, True)


def delta(rng: np.random.Generator, bias: float) -> Estimator:
    """Transmittance by delta tracking: 0 or 1."""
    extinction, _, majorant, length, depth = medium(rng)

    def draw(generator: np.random.Generator, n: int) -> Array:
        alive = np.ones(n)

        def each(t: Array, inside: Array) -> None:
            alive[inside & (generator.random(n) < extinction(t) * (1 + bias) / majorant)] = 0

        collisions(generator, n, majorant, length, each)
        return alive

    return draw, float(np.exp(-depth))


def series(rng: np.random.Generator, bias: float) -> Estimator:
    """exp(-x) of a noisy x by its power series with roulette."""
    x, noise, go_on = log_uniform(rng, 0.1, 1.5), rng.uniform(0.05, 0.5), 0.7

    def draw(generator: np.random.Generator, n: int) -> Array:
        out, term, alive = np.ones(n), np.ones(n), np.ones(n, bool)
        for k in range(1, 60):
            alive &= generator.random(n) < go_on
            factor = x * (1 + bias) * (1 + noise * generator.standard_normal(n))
            term = np.where(alive, -term * factor / (k * go_on), 0)
            out += term
        return out

    return draw, float(np.exp(-x))


def inverse(rng: np.random.Generator, bias: float) -> Estimator:
    """1/m of a noisy m by a geometric number of factors (Booth 2007)."""
    m, go_on = rng.uniform(0.3, 0.95), 0.85

    def draw(generator: np.random.Generator, n: int) -> Array:
        out, term, alive = np.ones(n), np.ones(n), np.ones(n, bool)
        while alive.any():
            alive &= generator.random(n) < go_on
            term = np.where(alive, term * (1 - generator.beta(4 * m, 4 * (1 - m), n) * (1 + bias)) / go_on, 0)
            out += term
        return out

    return draw, 1 / m


def roulette(rng: np.random.Generator, bias: float) -> Estimator:
    """An integral with Russian roulette."""
    survive, c = log_uniform(rng, 0.05, 0.9), rng.uniform(0.2, 3)

    def draw(generator: np.random.Generator, n: int) -> Array:
        return np.where(generator.random(n) < survive, np.exp(-c * generator.random(n)) / survive * (1 + bias), 0)

    return draw, float(-np.expm1(-c) / c)


def splitting(rng: np.random.Generator, bias: float) -> Estimator:
    """A double integral, the inner one by 2 to 8 values."""
    k, c = int(rng.integers(2, 9)), rng.uniform(0.2, 3)

    def draw(generator: np.random.Generator, n: int) -> Array:
        return np.exp(-c * generator.random((n, 1)) * generator.random((n, k))).mean(1) * (1 + bias)

    return draw, integrate.quad(lambda b: -np.expm1(-c * b) / (c * b), 0, 1)[0]


def power(rng: np.random.Generator, bias: float) -> Estimator:
    """Values without a variance."""
    a = rng.uniform(1.2, 1.9)
    return lambda generator, n: generator.random(n) ** (-1 / a) * (1 + bias), a / (a - 1)


def lognormal(rng: np.random.Generator, bias: float) -> Estimator:
    """Log-normal values."""
    s = rng.uniform(0.5, 1.6)
    return lambda generator, n: np.exp(s * generator.standard_normal(n) - s * s / 2) * (1 + bias), 1.0


def constant(rng: np.random.Generator, bias: float) -> Estimator:
    """The same value at each draw."""
    c = log_uniform(rng, 1e-6, 1e6)
    return lambda generator, n: np.full(n, c * (1 + bias)), c


def signed(rng: np.random.Generator, bias: float) -> Estimator:
    """Normal values of both signs about a smaller mean."""
    m = rng.uniform(0.3, 1) * rng.choice([-1, 1])
    return lambda generator, n: m * (1 + bias) + generator.standard_normal(n), m


NUMBERS = (ratio, delta, residual, series, inverse, roulette, splitting, power, lognormal, constant, signed)

# ---- Reservoirs: w_i and W, for a target.

Target = Callable[[Array, Array], Array]
Weights = Callable[[Array, Array], tuple[Array, Array]]


def some_target(rng: np.random.Generator, with_zeros: bool) -> tuple[Target, str]:
    """A cap or a half of the hemisphere, or a lobe about an axis or the mirrored w_o, times the cosine."""
    axis, k, base = by_uniform(rng, 1)[0], log_uniform(rng, 1, 80), rng.uniform(0.02, 0.4)
    shapes: dict[str, Target] = {
        "lobe": lambda wo, wi: base + np.maximum(wi @ axis, 0) ** k,
        "cap": lambda wo, wi: (wi @ axis) > 0.3,
        "half": lambda wo, wi: (wi[:, 0] > 0) * (base + wi[:, 1] ** 2),
        "mirror": lambda wo, wi: base + np.maximum((wo * [-1, -1, 1] * wi).sum(1), 0) ** k,
    }
    name = str(rng.choice(["cap", "half"] if with_zeros else list(shapes)))
    return lambda wo, wi: np.maximum(wi[:, 2], 0) * shapes[name](wo, wi), f"{name} k={k:.3g}"


def by_cosine(rng: np.random.Generator, n: int) -> Array:
    return direction(np.sqrt(1 - rng.random(n)), 2 * np.pi * rng.random(n))


def by_uniform(rng: np.random.Generator, n: int) -> Array:
    return direction(rng.random(n), 2 * np.pi * rng.random(n))


class Reservoirs:
    """One for each w_o: the direction that is kept, and the sum of the weights."""

    def __init__(self, rng: np.random.Generator, n: int) -> None:
        self.rng, self.kept, self.total = rng, np.tile([0.0, 0.0, 1.0], (n, 1)), np.zeros(n)

    def add(self, wi: Array, weight: Array) -> None:
        self.total += weight
        take = self.rng.random(len(weight)) * self.total < weight
        self.kept[take] = wi[take]

    def weights(self, target: Array) -> Array:
        return np.where(target > 0, self.total / np.maximum(target, 1e-300), 0)


def ris(rng: np.random.Generator, target: Target, fault: str, size: float) -> tuple[Weights, str]:
    """RIS of 1 to 64 candidates, uniform or by the cosine."""
    m, cosine = int(rng.choice([1, 2, 8, 64])), rng.random() < 0.5

    def sample(wo: Array, u: Array) -> tuple[Array, Array]:
        n = len(wo)
        reservoirs, counted = Reservoirs(rng, n), np.zeros(n)
        for _ in range(m):
            wi = by_cosine(rng, n) if cosine else by_uniform(rng, n)
            value = target(wo, wi)
            reservoirs.add(wi, value / np.maximum(wi[:, 2] / np.pi if cosine else 1 / (2 * np.pi), 1e-12))
            counted += (value > 0) if fault == "only candidates with a target counted" else 1
        if fault == "a dead neighbour counted":  # in this share of the reservoirs, as often as all candidates
            counted += m * (rng.random(n) < size)
        return reservoirs.kept, reservoirs.weights(target(wo, reservoirs.kept)) / np.maximum(counted, 1)

    return sample, f"M={m} cosine={cosine}"


def mis(rng: np.random.Generator, target: Target, fault: str, size: float) -> tuple[Weights, str]:
    """Candidates of two techniques by the balance heuristic (Lin et al. 2022)."""
    m = [int(v) for v in rng.integers(1, 9, 2)]

    def sample(wo: Array, u: Array) -> tuple[Array, Array]:
        reservoirs = Reservoirs(rng, len(wo))
        for i in range(sum(m)):
            wi = by_cosine(rng, len(wo)) if i < m[0] else by_uniform(rng, len(wo))
            reservoirs.add(wi, target(wo, wi) / (m[0] * wi[:, 2] / np.pi + m[1] / (2 * np.pi)))
        return reservoirs.kept, reservoirs.weights(target(wo, reservoirs.kept))

    return sample, f"M={m}"


def merged(rng: np.random.Generator, target: Target, fault: str, size: float) -> tuple[Weights, str]:
    """Two reservoirs merged by their confidences, as over time."""
    m = [int(v) for v in rng.integers(1, 20, 2)]

    def sample(wo: Array, u: Array) -> tuple[Array, Array]:
        of_both = Reservoirs(rng, len(wo))
        for count in m:
            one = Reservoirs(rng, len(wo))
            for _ in range(count):
                wi = by_cosine(rng, len(wo))
                one.add(wi, target(wo, wi) * np.pi / np.maximum(wi[:, 2], 1e-12))
            value = target(wo, one.kept)
            of_both.add(one.kept, value * one.weights(value))  # count x target x W, and W divides by the count
        return of_both.kept, of_both.weights(target(wo, of_both.kept)) / sum(m)

    return sample, f"M={m}"


RESERVOIRS = (ris, mis, merged)

# ---- Checks.


def record(result: Any, **known: Any) -> dict[str, Any]:
    not_right = [v for v in result.verdicts if v.state not in ("right", "skipped")]
    return {**known, "state": result.state, "message": [v.message for v in not_right], "causes": [v.cause for v in not_right]}


def check_number(rng: np.random.Generator, number: int, wrong: bool) -> dict[str, Any]:
    family = NUMBERS[number % len(NUMBERS)]
    size = float(rng.choice([0.01, 0.03])) if wrong else 0.0
    draw, mean = family(rng, size)
    result = crescent.check(
        lambda u: draw(rng, len(u)), domain="number", own_random=True, estimates=mean, seed=number + 1, threads=1
    )
    return record(result, family=family.__name__, case=number, size=size)


def check_reservoir(rng: np.random.Generator, number: int, wrong: bool) -> dict[str, Any]:
    family = RESERVOIRS[number % len(RESERVOIRS)]
    faults = (
        ["a factor"]
        if family is not ris
        else ["a factor", "only candidates with a target counted", "a dead neighbour counted"]
    )
    fault, size = (str(rng.choice(faults)), float(rng.choice([0.01, 0.03]))) if wrong else ("", 0.0)
    target, name = some_target(rng, fault == "only candidates with a target counted")
    sample, parameters = family(rng, target, fault, size)

    def with_factor(wo: Array, u: Array) -> tuple[Array, Array]:
        wi, weight = sample(wo, u)
        return wi, weight * (1 - size)

    known = {"weight": "reciprocal", "own_random": True, "domain": "hemisphere", "wo_deg": float(rng.uniform(0, 80))}
    of_check = with_factor if fault == "a factor" else sample
    result = crescent.check(of_check, target=target, seed=number + 1, threads=1, **known)
    return record(
        result, family=family.__name__, case=number, fault=fault, size=size, parameters=f"{name} {parameters}"
    )


def print_table(records: list[dict[str, Any]], what: str) -> None:
    print(f"| {what} | cases | right | wrong | inconclusive |\n|---|---|---|---|---|")
    kinds = dict.fromkeys((r.get("fault") or r["family"], r["size"]) for r in records)
    for kind in (*kinds, None):
        rs = [r for r in records if kind in ((r.get("fault") or r["family"], r["size"]), None)]
        name = "all" if kind is None else kind[0] + (f", {100 * kind[1]:g} %" if kind[1] else "")
        print(
            f"| {name} | {len(rs)} | "
            + " | ".join(str(sum(r["state"] == s for r in rs)) for s in ("right", "wrong", "inconclusive"))
            + " |"
        )
    wrong = sum(r["state"] in ("wrong", "error") for r in records)
    print("\nReported wrong: {:.2g} to {:.2g} % (95 % each).".format(*(100 * b for b in bounds(wrong, len(records)))))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("set", choices=["numbers", "reservoirs"])
    parser.add_argument("--wrong", action="store_true", help="with a bias of 1 or 3 %%, or another fault")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--cases", default="0:33", metavar="FROM:TO")
    parser.add_argument("--out", type=Path, help="file to which a line for each check is appended")
    a = parser.parse_args()
    check = check_number if a.set == "numbers" else check_reservoir
    records: list[dict[str, Any]] = []
    for number in range(*(int(v) for v in a.cases.split(":"))):
        rng = np.random.default_rng([zlib.crc32(f"{a.set} {a.wrong}".encode()), a.seed, number])
        records.append(check(rng, number, a.wrong))
        if a.out:
            with a.out.open("a") as file:
                file.write(json.dumps(records[-1]) + "\n")
    print_table(records, a.set)


if __name__ == "__main__":
    main()
