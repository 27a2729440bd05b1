"""A reservoir of four candidates (RIS), whose weight W estimates 1/p; `darker` loses 3 % of it."""

import crescent
import numpy as np

rng = np.random.default_rng(1)


def target(wo, wi):
    return np.maximum(wi[:, 2], 0) * (0.2 + np.maximum(wi[:, 0], 0) ** 4)


def sample(wo, u, candidates=4):
    kept, total = np.tile([0.0, 0.0, 1.0], (len(wo), 1)), np.zeros(len(wo))
    for _ in range(candidates):
        a = rng.random((len(wo), 2))
        r, phi = np.sqrt(a[:, 0]), 2 * np.pi * a[:, 1]
        wi = np.column_stack([r * np.cos(phi), r * np.sin(phi), np.sqrt(1 - a[:, 0])])
        weight = target(wo, wi) * np.pi / np.maximum(wi[:, 2], 1e-9)
        total += weight
        take = rng.random(len(wo)) * total < weight
        kept[take] = wi[take]
    return kept, total / candidates / np.maximum(target(wo, kept), 1e-30)


def sample_darker(wo, u):
    wi, weight = sample(wo, u)
    return wi, 0.97 * weight


ris = crescent.Sampler(sample, target=target, weight="reciprocal", own_random=True, domain="hemisphere")
darker = crescent.Sampler(sample_darker, target=target, weight="reciprocal", own_random=True, domain="hemisphere")
