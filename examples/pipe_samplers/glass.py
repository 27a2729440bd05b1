#!/usr/bin/env python3
"""Rough glass for `crescent check --exec 'python3 glass.py'`, by blocks of doubles.

GGX, Smith's G separable: Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces", with equation
numbers at the lines; normals are drawn from the visible ones, Heitz 2018. Three random numbers per sample: the third
selects reflection or refraction by Fresnel. w_o on both sides, radiance scaled by eta^2. A million responses take about
a second."""
import struct
import sys

import numpy as np

ALPHA, ETA = 0.3, 1.5  # eta: index below over above


def dot(a, b):
    return np.einsum("ij,ij->i", a, b)


def unit(v):
    return v / np.sqrt(dot(v, v))[:, None]


def fresnel(c, eta):
    """Unpolarised, c = |cos| on the side of incidence, eta: index on the other side over index on this side."""
    g2 = eta * eta - 1 + c * c
    g = np.sqrt(np.maximum(g2, 0))
    f = 0.5 * ((g - c) / (g + c)) ** 2 * (1 + ((c * (g + c) - 1) / (c * (g - c) + 1)) ** 2)  # (22)
    return np.where(g2 > 0, f, 1.0)


def g1(w, m):
    t2 = np.maximum(1 / np.maximum(w[:, 2] ** 2, 1e-300) - 1, 0)
    return np.where(dot(w, m) * w[:, 2] > 0, 2 / (1 + np.sqrt(1 + ALPHA**2 * t2)), 0)  # (34)


def ggx(m):
    t = 1 + (ALPHA**2 - 1) * m[:, 2] ** 2
    return np.where(m[:, 2] > 0, ALPHA**2 / (np.pi * t * t), 0)  # (33)


def normals(o, i):
    """Returns the half vector of reflection or refraction, on the upper side, and related values."""
    eta = np.where(o[:, 2] > 0, ETA, 1 / ETA)
    across = o[:, 2] * i[:, 2] < 0
    m = unit(o + np.where(across, eta, 1.0)[:, None] * i)  # (13), (16)
    return eta, across, m * np.sign(m[:, 2])[:, None]


def evaluate(o, i):
    """f and pdf."""
    eta, across, m = normals(o, i)
    om, im = dot(o, m), dot(i, m)
    fr = fresnel(np.abs(om), eta)
    seen = ggx(m) * g1(o, m) * np.abs(om) / np.abs(o[:, 2])  # density of visible normals
    half = om + eta * im
    jacobian = np.where(across, eta**2 * np.abs(im) / np.maximum(half**2, 1e-300), 1 / (4 * np.abs(om)))  # (14), (17)
    possible = np.where(across, om * im < 0, om * im > 0) & (o[:, 2] * i[:, 2] != 0)
    pdf = np.where(possible, seen * jacobian * np.where(across, 1 - fr, fr), 0)
    scale = np.where(across, 1 / eta**2, 1.0)  # of radiance
    f = np.where(possible, pdf * g1(i, m) * scale / np.maximum(np.abs(i[:, 2]), 1e-300), 0)  # (20), (21)
    return f, pdf


def sample(o, u):
    side = np.where(o[:, 2] > 0, 1.0, -1.0)
    v = o * side[:, None]
    s = unit(v * [ALPHA, ALPHA, 1])
    size = np.hypot(s[:, 0], s[:, 1])
    beside = np.stack([-s[:, 1], s[:, 0], 0 * size], 1) / np.maximum(size, 1e-300)[:, None]
    t = np.where(size[:, None] > 0, beside, [1.0, 0, 0])
    b = np.cross(s, t)
    r, phi, k = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1], 0.5 * (1 + s[:, 2])
    x = r * np.cos(phi)
    y = (1 - k) * np.sqrt(np.maximum(1 - x * x, 0)) + k * r * np.sin(phi)
    h = t * x[:, None] + b * y[:, None] + s * np.sqrt(np.maximum(1 - x * x - y * y, 0))[:, None]
    m = unit(np.stack([ALPHA * h[:, 0], ALPHA * h[:, 1], np.maximum(h[:, 2], 1e-12)], 1)) * side[:, None]
    eta = np.where(side > 0, ETA, 1 / ETA)
    c = dot(o, m)
    reflect = u[:, 2] < fresnel(np.abs(c), eta)
    root = np.sqrt(np.maximum(1 - (1 - c * c) / eta**2, 0))
    wi = np.where(reflect[:, None], 2 * c[:, None] * m - o, (c / eta - root)[:, None] * m - o / eta[:, None])
    wi = unit(wi)
    pdf = np.where((wi[:, 2] * o[:, 2] > 0) == reflect, evaluate(o, wi)[1], 0)  # on the wrong side: nothing drawn
    return np.column_stack([wi, pdf])


def answer(operation, rows):
    if operation == b"smpl":
        return sample(rows[:, :3], rows[:, 3:])
    f, pdf = evaluate(rows[:, :3], rows[:, 3:])
    return pdf if operation == b"pdf_" else f


columns = {b"smpl": 6, b"pdf_": 6, b"f___": 6}
sys.stdin.buffer.readline()
print(f"hello 2 glass.py u=3 domain=sphere wo=both eta={ETA} block=f64", flush=True)
np.seterr(all="ignore")
while head := sys.stdin.buffer.read(8):
    operation, count = head[:4], struct.unpack("<I", head[4:])[0]
    rows = np.frombuffer(sys.stdin.buffer.read(8 * count * columns[operation]), "<f8").reshape(count, -1)
    out = np.ascontiguousarray(answer(operation, rows), "<f8")
    sys.stdout.buffer.write(struct.pack("<I", count) + out.tobytes())
    sys.stdout.buffer.flush()
