#!/usr/bin/env python3
"""An environment light for `crescent check --exec 'python3 sky.py [ROWS COLUMNS]'`, by blocks of doubles.

2048 x 4096 texels in theta x phi with a sun of 0.27 degrees; a row by its CDF, a column by that row's. The probability
of a texel is its radiance times the sine at its middle, and p is constant in theta x phi within it: p = probability /
(d theta d phi sin theta). It depends on no w_o and has no BRDF."""
import sys

import numpy as np

ROWS, COLUMNS = (int(v) for v in sys.argv[1:3]) if len(sys.argv) > 2 else (2048, 4096)


def radiance():
    theta = np.pi * (np.arange(ROWS)[:, None] + 0.5) / ROWS
    phi = 2 * np.pi * (np.arange(COLUMNS) + 0.5) / COLUMNS
    sky = 0.3 + 0.7 * np.cos(theta / 2) ** 2 + 0.2 * np.sin(9 * phi) * np.sin(7 * theta) ** 2
    to_sun = np.cos(theta) * np.cos(0.7) + np.sin(theta) * np.sin(0.7) * np.cos(phi - 2)
    return np.where(to_sun > np.cos(0.00465), 4e4, sky) * np.sin(theta)


chance = radiance()
chance /= chance.sum()
row_cdf = np.concatenate([[0], np.cumsum(chance.sum(1))])
row_cdf /= row_cdf[-1]
column_cdf = np.concatenate([np.zeros((ROWS, 1)), np.cumsum(chance, 1)], 1)
column_cdf /= column_cdf[:, -1:]
ascending = (column_cdf[:, :-1] + np.arange(ROWS)[:, None]).ravel()  # row by row, for one search over all rows


def density(i, j, theta):
    return chance[i, j] * ROWS * COLUMNS / (2 * np.pi**2 * np.maximum(np.sin(theta), 1e-300))


def sample(u, v):
    i = np.clip(np.searchsorted(row_cdf, u, side="right") - 1, 0, ROWS - 1)
    j = np.clip(np.searchsorted(ascending, v + i, side="right") - 1 - i * COLUMNS, 0, COLUMNS - 1)
    down = (u - row_cdf[i]) / (row_cdf[i + 1] - row_cdf[i])
    along = (v - column_cdf[i, j]) / (column_cdf[i, j + 1] - column_cdf[i, j])
    theta = np.pi * (i + np.clip(down, 0, 1 - 1e-12)) / ROWS
    phi = 2 * np.pi * (j + np.clip(along, 0, 1 - 1e-12)) / COLUMNS
    wi = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], 1)
    return np.concatenate([wi, density(i, j, theta)[:, None]], 1)


def pdf(w):
    theta = np.arctan2(np.hypot(w[:, 0], w[:, 1]), w[:, 2])
    phi = np.arctan2(w[:, 1], w[:, 0]) % (2 * np.pi)
    i = np.minimum((theta / np.pi * ROWS).astype(int), ROWS - 1)
    j = np.minimum((phi / (2 * np.pi) * COLUMNS).astype(int), COLUMNS - 1)
    return density(i, j, theta)[:, None]


def read(count):
    data = sys.stdin.buffer.read(count)
    if len(data) < count:
        sys.exit(0)
    return data


sys.stdin.buffer.readline()  # hello 2
print("hello 2 sky.py domain=sphere wo=none block=f64", flush=True)
while True:
    what, count = read(4), int.from_bytes(read(4), "little")
    width = 5 if what == b"smpl" else 6  # w_o, which is not used, and u or wi
    rows = np.frombuffer(read(8 * count * width)).reshape(count, width)
    if what == b"smpl":
        answer = sample(rows[:, 3], rows[:, 4])
    else:
        answer = pdf(rows[:, 3:]) if what == b"pdf_" else np.full((count, 1), np.nan)  # f: there is no BRDF
    sys.stdout.buffer.write(count.to_bytes(4, "little") + np.ascontiguousarray(answer).tobytes())
    sys.stdout.buffer.flush()
