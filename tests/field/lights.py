"""Directions towards lights: a sky in cells, and a disk. None of them depends on w_o."""

import numpy as np
from parts import polar, unit

from crescent import Sampler
from crescent.field import Fault

ROWS, COLUMNS = 6, 12
ROW, COLUMN = np.indices((ROWS, COLUMNS))
SKY = 1 + 4 * np.exp(-((ROW - 1.0) ** 2 + (COLUMN - 4.0) ** 2) / 3)  # radiance by cell: theta by rows, phi by columns
SINE = np.sin((np.arange(ROWS) + 0.5) * np.pi / ROWS)[:, None]


def cell_of(wi):
    """(row, column, sin theta) of directions."""
    theta, phi = np.arccos(np.clip(wi[:, 2], -1, 1)), np.arctan2(wi[:, 1], wi[:, 0]) % (2 * np.pi)
    row = np.clip((theta / np.pi * ROWS).astype(int), 0, ROWS - 1)
    column = ((phi / (2 * np.pi) * COLUMNS).astype(int)) % COLUMNS
    return row, column, np.sin(theta)


def sky(with_sine=True, pmf=1.0, shift=0.0, reached=None):
    """Cells by radiance and sin theta, uniform inside in theta and phi; `with_sine`: p is divided by it.

    `pmf`: of this light among others, drawn and omitted from p; `shift`: of the draws, in columns; `reached`: the
    columns that are drawn."""
    weights = SKY * SINE if reached is None else SKY * SINE * reached
    share = (weights / weights.sum()).ravel()
    told = (SKY * SINE / (SKY * SINE).sum()).ravel()
    edges = np.cumsum(share)

    def sample(u):
        cell = np.minimum(np.searchsorted(edges, u[:, 0] * edges[-1], side="right"), len(share) - 1)
        inside = (u[:, 0] * edges[-1] - (edges - share)[cell]) / share[cell]
        row, column = np.divmod(cell, COLUMNS)
        theta = (row + np.clip(inside, 0, 1)) / ROWS * np.pi
        wi = polar(np.cos(theta), (column + u[:, 1] + shift) / COLUMNS * 2 * np.pi)
        return wi, np.where(u[:, 2] < pmf, pdf(wi), 0)

    def pdf(wi):
        row, column, sine = cell_of(wi)
        p = told[row * COLUMNS + column] * ROWS * COLUMNS / (2 * np.pi**2)
        return p / np.maximum(sine, 1e-9) if with_sine else p

    return Sampler(sample, pdf, name="sky", u=3, wo="none")


HEIGHT, RADIUS, TILT = 1.0, 0.8, unit(np.array([[0.5, 0.0, -1.0]]))[0]
RIGHT = sky()


def disk(solid_angle=True):
    """A disk of radius 0.8 at height 1, tilted by 27 degrees, by area."""
    x = np.cross(TILT, [0.0, 1.0, 0.0])
    x /= np.linalg.norm(x)
    y = np.cross(TILT, x)
    centre = np.array([0.0, 0.0, HEIGHT])

    def by_area(wi, distance2):
        p = 1 / (np.pi * RADIUS**2)
        return p * distance2 / np.maximum(-wi @ TILT, 1e-12) if solid_angle else np.full(len(wi), p)

    def sample(u):
        r, phi = RADIUS * np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1]
        point = centre + r[:, None] * (np.cos(phi)[:, None] * x + np.sin(phi)[:, None] * y)
        distance2 = np.sum(point**2, axis=1)
        wi = point / np.sqrt(distance2)[:, None]
        return wi, by_area(wi, distance2)

    def pdf(wi):
        facing = -wi @ TILT
        t = np.where(facing > 1e-9, (-centre @ TILT) / np.where(facing > 1e-9, facing, 1), -1)
        met = (t > 0) & (np.sum((t[:, None] * wi - centre) ** 2, axis=1) <= RADIUS**2)
        return np.where(met, by_area(wi, t * t), 0)

    return Sampler(sample, pdf, name="disk", wo="none")


FAULTS = [
    Fault(
        "the sky's pdf without sin theta",
        "Tauray",
        "https://github.com/vga-group/tauray/pull/5",
        "The density over the picture is not divided by sin theta: the poles are too dark.",
        ("normalised", "density"),
        sky(with_sine=False),
        RIGHT,
    ),
    Fault(
        "missing probability of choosing the light",
        "redner",
        "https://github.com/BachiLi/redner/issues/56",
        "The sky is one of several lights; its pdf is returned as if it were always chosen.",
        ("normalised",),
        sky(pmf=0.6),
        RIGHT,
    ),
    Fault(
        "the sky's cells off by half a texel",
        "pbrt-v3",
        "https://github.com/mmp/pbrt-v3/issues/62",
        "The pdf of a texel is that of the area around its corner; draws come from the area next to it.",
        ("density",),
        sky(shift=0.5),
        RIGHT,
    ),
    Fault(
        "texels at the border that are never drawn",
        "three-gpu-pathtracer",
        "https://github.com/gkjohnson/three-gpu-pathtracer/issues/541",
        "The first and last texels are never sampled, but p is positive there.",
        ("density",),
        sky(reached=(COLUMN > 0) & (COLUMN < COLUMNS - 1)),
        RIGHT,
    ),
    Fault(
        "area measure on one side of MIS",
        "Bevy (Solari)",
        "https://github.com/bevyengine/bevy/pull/24671",
        "The density of a point on the light is returned per area instead of per solid angle: cos / distance^2 is "
        "missing.",
        ("normalised", "density"),
        disk(solid_angle=False),
        disk(),
    ),
]
