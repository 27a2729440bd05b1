"""Reservoirs: weighted candidates of neighbours, whose contribution weight W estimates 1 / p."""

import numpy as np
from parts import cosine, polar

from crescent import Sampler
from crescent.field import Fault

TILTS = np.array([[0.0, 0.0, 1.0], [0.6, 0.0, 0.8], [-0.8, 0.0, 0.6]])  # normals of the receiver and two neighbours


def light(wi):
    return 0.2 + np.maximum(wi[:, 0], 0) ** 2


def target_at(k, wi):
    """The target function at surface k: radiance times cosine, 0 below its horizon."""
    return light(wi) * np.maximum(wi @ TILTS[k], 0)


def target(wo, wi):
    return target_at(0, wi) * (wi[:, 2] > 0)


def about(k, u):
    """Uniform draws over the hemisphere of surface k, and their density."""
    n = TILTS[k]
    x = np.array([n[2], 0.0, -n[0]])
    w = polar(u[:, 0], 2 * np.pi * u[:, 1])
    wi = w[:, :1] * x + w[:, 1:2] * np.array([0.0, 1.0, 0.0]) + w[:, 2:] * n
    return wi, np.full(len(wi), 0.5 / np.pi)


def density_at(k, wi):
    return (wi @ TILTS[k] > 0) * 0.5 / np.pi


def merged(share, scored_at_source=False, seed=11):
    """One candidate of each surface, merged at the receiver.

    `share(k, wi)`: the MIS weight of a candidate of surface k; `scored_at_source`: a candidate is selected by the
    target of its own surface."""
    rng = np.random.default_rng(seed)

    def sample(wo, u):
        n = len(wo)
        kept, kept_target, total = (
            np.tile([0.0, 0.0, 1.0], (n, 1)),
            np.zeros(n),
            np.zeros(n),
        )
        for k in range(len(TILTS)):
            wi, p = about(k, rng.random((n, 2)))
            value = target(wo, wi)
            score = target_at(k, wi) if scored_at_source else value
            weight = share(k, wi) * score / p
            total += weight
            take = rng.random(n) * total < weight
            kept[take], kept_target[take] = wi[take], value[take]
        return kept, np.where(kept_target > 0, total / np.maximum(kept_target, 1e-12), 0.0)

    return Sampler(
        sample,
        target=target,
        weight="reciprocal",
        own_random=True,
        domain="hemisphere",
        name="reservoir",
    )


def balance(k, wi):
    """Balance heuristic over the densities of the surfaces."""
    return density_at(k, wi) / np.maximum(sum(density_at(j, wi) for j in range(len(TILTS))), 1e-12)


def one_over_m(k, wi):
    """1 / M, whether the surface could have drawn the candidate or not."""
    return np.full(len(wi), 1 / len(TILTS))


DEAD = 0.05  # of the neighbours have no target


def dead(counted, seed=5):
    """Two candidates; the second is of a neighbour that has none in 5 % of the reservoirs: it must not count in M."""
    rng = np.random.default_rng(seed)

    def sample(wo, u):
        n = len(wo)
        gone = rng.random(n) < DEAD
        kept, kept_target, total = (
            np.tile([0.0, 0.0, 1.0], (n, 1)),
            np.zeros(n),
            np.zeros(n),
        )
        for k in range(2):
            wi, p = cosine(rng.random((n, 2)))
            value = target(wo, wi) * ~(gone & (k == 1))
            total += value / p
            take = rng.random(n) * total < value / p
            kept[take], kept_target[take] = wi[take], value[take]
        m = 2.0 if counted else np.where(gone, 1.0, 2.0)
        return kept, np.where(kept_target > 0, total / m / np.maximum(kept_target, 1e-12), 0.0)

    return Sampler(
        sample,
        target=target,
        weight="reciprocal",
        own_random=True,
        domain="hemisphere",
        name="reservoir",
    )


HEIGHT, SHIFT = (
    1.0,
    np.array([0.4, 0.0, 0.0]),
)  # a ceiling of sample points, and the neighbour's place


def reconnected(jacobian, seed=3):
    """A direction to a point of the plane z = 1 that a neighbour at SHIFT has drawn, and the receiver connects to."""
    rng = np.random.default_rng(seed)

    def sample(wo, u):
        w, p = cosine(rng.random((len(wo), 2)))
        q = SHIFT + w * (HEIGHT / np.maximum(w[:, 2:], 1e-9))
        away = np.linalg.norm(q, axis=1)
        wi = q / away[:, None]
        # dw / dw' = (cos / cos') (r' / r)^2, with cos = 1 / r on the plane
        ratio = (w[:, 2] / wi[:, 2]) ** 3 if not jacobian else np.ones(len(w))
        return wi, 1 / np.maximum(p, 1e-12) * (wi[:, 2] / np.maximum(w[:, 2], 1e-9)) ** 3 * ratio

    def bounded(wo, wi):
        """Support within 70 degrees, where the plane is near."""
        return np.where(wi[:, 2] > np.cos(np.radians(70)), light(wi) * wi[:, 2], 0.0)

    return Sampler(
        sample,
        target=bounded,
        weight="reciprocal",
        own_random=True,
        domain="hemisphere",
        name="reservoir",
    )


FAULTS = [
    Fault(
        "a neighbour without a target that counts in M",
        "RTXDI",
        "https://github.com/NVIDIA-RTX/RTXDI/pull/42",
        "Candidates whose shift fails have the target 0 and are counted all the same: W is too small. Here 5 % of the "
        "neighbours.",
        ("mean",),
        dead(True),
        dead(False),
    ),
    Fault(
        "neighbours merged with 1 / M",
        "Bevy (Solari)",
        "https://github.com/bevyengine/bevy/pull/22033",
        "Reservoirs of other surfaces are merged without MIS weights: what a neighbour cannot draw is too dark.",
        ("mean",),
        merged(one_over_m),
        merged(balance),
    ),
    Fault(
        "a neighbour weighted by the target of its own surface",
        "Blade",
        "https://github.com/kvark/blade/pull/366",
        "A reused reservoir is selected by the target of the surface that drew it, and shaded at the receiver.",
        ("mean",),
        merged(balance, scored_at_source=True),
        merged(balance),
    ),
    Fault(
        "a reconnection without its Jacobian",
        "bevy-hikari",
        "https://github.com/cryscan/bevy-hikari/pull/21",
        "A neighbour's sample point is reused from another place, and the change of solid angle is left out.",
        ("mean",),
        reconnected(False),
        reconnected(True),
    ),
]
