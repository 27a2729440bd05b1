"""Reservoirs of neighbours, merged with MIS weights (`merged`) or by their number alone (`by_count`, which is wrong)."""

import functools

import crescent
import numpy as np

rng = np.random.default_rng(2)


def targets(wi, neighbours):
    """Returns the target functions at w_i, of the receiver and then of each neighbour, and their normals."""
    n = np.concatenate([np.broadcast_to([0.0, 0.0, 1.0], (len(wi), 1, 3)), neighbours[:, :, 3:6]], axis=1)
    light = np.concatenate([np.ones((len(wi), 1)), neighbours[:, :, 6]], axis=1)
    return light * np.maximum(np.einsum("nkc,nc->nk", n, wi), 0), n


def sample(wo, u, neighbours, by_count=False):
    kept, total = np.tile([0.0, 0.0, 1.0], (len(wo), 1)), np.zeros(len(wo))
    for k in range(neighbours.shape[1] + 1):
        wi = rng.normal(size=(len(wo), 3))  # uniform over the hemisphere of surface k
        wi /= np.linalg.norm(wi, axis=1, keepdims=True)
        _, n = targets(wi, neighbours)
        wi *= np.sign(np.sum(wi * n[:, k], axis=1))[:, None]
        there, _ = targets(wi, neighbours)
        mis = 1 / there.shape[1] if by_count else there[:, k] / np.maximum(there.sum(axis=1), 1e-30)
        weight = np.where(there[:, k] > 0, mis * there[:, 0] * 2 * np.pi, 0)
        total += weight
        take = rng.random(len(wo)) * total < weight
        kept[take] = wi[take]
    return kept, total / np.maximum(targets(kept, neighbours)[0][:, 0], 1e-30)


def target(wo, wi):
    return np.maximum(wi[:, 2], 0)


def reservoir(draw):
    return crescent.Sampler(draw, target=target, weight="reciprocal", merge=True, own_random=True)


merged = reservoir(sample)
by_count = reservoir(functools.partial(sample, by_count=True))
