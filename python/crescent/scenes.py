"""Scenes from arrays: the files that the tables [meshes.NAME] and [sky] of an experiment name.

write_mesh(path, positions, triangles)    a .mesh file
write_sky(path, rgb)                      a latitude-longitude image
write_texture(path, texels)               an image for rho_d_texture or alpha_texture of a mesh
"""

from __future__ import annotations

import struct
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

__all__ = ["write_mesh", "write_sky", "write_texture"]


def _rows(name: str, values: Any, columns: int, kind: str = "<f4") -> Any:
    rows = np.asarray(values, kind)
    if rows.ndim != 2 or rows.shape[1] != columns:
        raise ValueError(f"{name} has the shape {rows.shape}: expected (n, {columns})")
    if not np.isfinite(rows).all():
        raise ValueError(f"{name}: row {int(np.argmin(np.isfinite(rows).all(axis=1)))} is not finite")
    return np.ascontiguousarray(rows)


def write_mesh(
    path: str | PathLike[str], positions: Any, triangles: Any, normals: Any = None, uv: Any = None
) -> None:
    """Writes a .mesh file.

    positions (n, 3), triangles (m, 3): indices of positions, counterclockwise seen from the front. normals (n, 3):
    smooth ones, of any length but 0; None: those of the triangles. uv (n, 2). ValueError says which row is wrong.
    """
    points = _rows("positions", positions, 3)
    corners = np.asarray(triangles)
    if corners.ndim != 2 or corners.shape[1] != 3 or corners.dtype.kind not in "iu":
        raise ValueError(f"triangles has {corners.dtype} of the shape {corners.shape}: expected integers (m, 3)")
    beyond = ((corners < 0) | (corners >= len(points))).any(axis=1)
    if beyond.any():
        at = int(np.argmax(beyond))
        raise ValueError(f"triangles: row {at} is {corners[at].tolist()}, with {len(points)} positions")
    parts = {"positions": points}
    if normals is not None:
        smooth = _rows("normals", normals, 3, "<f8")
        length = np.linalg.norm(smooth, axis=1, keepdims=True)
        if not (length > 0).all():
            raise ValueError(f"normals: row {int(np.argmin(length > 0))} is 0")
        parts["normals"] = (smooth / length).astype("<f4")
    if uv is not None:
        parts["uv"] = _rows("uv", uv, 2)
    for name, part in parts.items():
        if len(part) != len(points):
            raise ValueError(f"{name} has {len(part)} rows for {len(points)} positions")
    flags = ("normals" in parts) + 2 * ("uv" in parts)
    head = struct.pack("<8s6IQ", b"crescent", 0x6873656D, 1, len(points), len(corners), flags, 0, 0)
    data = b"".join(part.tobytes() for part in parts.values()) + corners.astype("<u4").tobytes()
    Path(path).write_bytes(head + data)


def write_sky(path: str | PathLike[str], rgb: Any) -> None:
    """Writes a latitude-longitude image as OpenEXR, float and uncompressed.

    rgb (height, 2 height, 3), linear, W/(sr m^2): the first row is up (+y), the first column towards -z, the next ones
    towards +x.
    """
    image = np.asarray(rgb, "<f4")
    if image.ndim != 3 or image.shape[2] != 3 or image.shape[1] != 2 * image.shape[0]:
        raise ValueError(f"rgb has the shape {image.shape}: expected (height, 2 height, 3)")
    _write_exr(path, image)


def write_texture(path: str | PathLike[str], texels: Any) -> None:
    """Writes a texture as OpenEXR, float and uncompressed.

    texels (height, width, 3), linear albedos, or (height, width), roughnesses or grey albedos; from 0 to 1. The first
    row is the upper one, v from 1 - 1 / height to 1. ValueError says which texel is wrong.
    """
    image = np.asarray(texels, "<f4")
    if image.ndim == 2:
        image = np.repeat(image[..., None], 3, axis=2)
    if image.ndim != 3 or image.shape[2] != 3 or 0 in image.shape:
        raise ValueError(f"texels has the shape {np.shape(texels)}: expected (height, width) or (height, width, 3)")
    wrong = ~((image >= 0) & (image <= 1)).all(axis=2)
    if wrong.any():
        row, column = (int(k) for k in np.argwhere(wrong)[0])
        raise ValueError(f"texels: row {row}, column {column} is {image[row, column].tolist()}: expected 0 to 1")
    _write_exr(path, image)


def _write_exr(path: str | PathLike[str], image: Any) -> None:
    height, width, _ = image.shape

    def attribute(name: bytes, kind: bytes, data: bytes) -> bytes:
        return name + b"\0" + kind + b"\0" + struct.pack("<i", len(data)) + data

    channels = b"".join(name + b"\0" + struct.pack("<iiii", 2, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    window = struct.pack("<iiii", 0, 0, width - 1, height - 1)
    head = struct.pack("<ii", 20000630, 2) + b"".join(
        (
            attribute(b"channels", b"chlist", channels),
            attribute(b"compression", b"compression", b"\0"),
            attribute(b"dataWindow", b"box2i", window),
            attribute(b"displayWindow", b"box2i", window),
            attribute(b"lineOrder", b"lineOrder", b"\0"),
            attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1)),
            attribute(b"screenWindowCenter", b"v2f", struct.pack("<ff", 0, 0)),
            attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)),
            b"\0",
        )
    )
    row = 8 + 12 * width
    offsets = struct.pack(f"<{height}Q", *(len(head) + 8 * height + row * y for y in range(height)))
    lines = (struct.pack("<ii", y, 12 * width) + image[y, :, ::-1].T.tobytes() for y in range(height))
    Path(path).write_bytes(head + offsets + b"".join(lines))
