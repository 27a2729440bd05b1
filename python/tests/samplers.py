"""Samplers in NumPy that the tests check."""

import numpy as np


def cosine(wo, u):
    """cos theta / pi over the upper hemisphere; u[:, 0] is the radius."""
    r, phi, z = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1], np.sqrt(np.maximum(0, 1 - u[:, 0]))
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], -1), z / np.pi


def cosine_pdf(wo, wi):
    return np.maximum(wi[:, 2], 0) / np.pi


def lambert(wo, wi):
    return np.where(wi[:, 2] > 0, 1 / np.pi, 0.0)


def sphere(u):
    """The whole sphere uniformly, without w_o, like an environment light."""
    z, phi = 1 - 2 * u[:, 0], 2 * np.pi * u[:, 1]
    r = np.sqrt(np.maximum(0, 1 - z * z))
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], -1), np.full(len(u), 1 / (4 * np.pi))


def sphere_pdf(wi):
    return 1 / (4 * np.pi)


def mirror(wo, u):
    """A mirror of 0.4 on one side of u, Lambert of 0.5 on the other: a delta part and a density."""
    wi, p = cosine(wo, u)
    chosen = u[:, 2] < 0.25
    wi = np.where(chosen[:, None], wo * [-1, -1, 1], wi)
    weight = np.where(chosen, 0.4 / 0.25, 0.5 / 0.75)
    return wi, np.where(chosen, 0.25, 0.75 * p), weight, chosen
