"""Estimators of a number: Russian roulette and transmittance."""

import numpy as np

from crescent import Sampler
from crescent.field import Fault

SIGMA, MAJORANT, LENGTH, ALBEDO = 0.7, 2.0, 1.5, 0.8


def roulette(weighted):
    """A path that ends with the probability 1/2 at each of four bounces of albedo 0.8, and meets a light of 1."""

    def sample(u):
        throughput, total, alive = (
            np.ones(len(u)),
            np.ones(len(u)),
            np.ones(len(u), bool),
        )
        for bounce in range(4):
            alive = alive & (u[:, bounce] < 0.5)
            throughput = throughput * ALBEDO * (2.0 if weighted else 1.0)
            total = total + np.where(alive, throughput, 0.0)
        return total

    return Sampler(sample, domain="number", u=4, name="roulette")


def tracked(one_event):
    """Ratio tracking of a constant medium: tentative collisions at the rate of the majorant."""
    rng = np.random.default_rng(7)

    def sample(u):
        t = -np.log1p(-u[:, 0]) / MAJORANT
        value = np.where(t < LENGTH, 1 - SIGMA / MAJORANT, 1.0)
        while not one_event and np.any(t < LENGTH):
            t = t - np.log1p(-rng.random(len(t))) / MAJORANT
            value = np.where(t < LENGTH, value * (1 - SIGMA / MAJORANT), value)
        return value

    return Sampler(sample, domain="number", u=1, name="ratio tracking")


FAULTS = [
    Fault(
        "roulette without a weight for the survivors",
        "Chunky",
        "https://github.com/chunky-dev/chunky/issues/1018",
        "Half of the rays end at each bounce and the others are not weighted by 2: light is lost.",
        ("mean",),
        roulette(False),
        roulette(True),
        estimates=sum(ALBEDO**k for k in range(5)),
    ),
    Fault(
        "a shadow ray that stops at its first event",
        "VisRTX",
        "https://github.com/NVIDIA/VisRTX/pull/298",
        "Transmittance is attenuated at the first tentative collision and the ray ends there, instead of at every one.",
        ("mean",),
        tracked(True),
        tracked(False),
        estimates=float(np.exp(-SIGMA * LENGTH)),
    ),
]
