"""Writes latitude-longitude images in OpenEXR, uncompressed, for the scripts next to this file; the standard library alone.

    sky_image.py FILE WIDTH EXPRESSION [HEIGHT [LAYER...]]

EXPRESSION gives (r, g, b) of a texel from its row y and column x, counted from the top-left, from the direction
(up, right, front) of its middle, +y, +x, +z, and from the name of its layer: "" unless some are named."""

import math
import struct
import sys


def attribute(name: str, kind: str, data: bytes) -> bytes:
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data


def write(path: str, width: int, height: int, layers: dict[str, list[tuple[float, float, float]]]) -> None:
    planes = {
        (f"{layer}." if layer else "") + colour: [texel["RGB".index(colour)] for texel in texels]
        for layer, texels in layers.items()
        for colour in "BGR"
    }
    names = sorted(planes)
    channels = b"".join(name.encode() + b"\0" + struct.pack("<iiii", 2, 0, 1, 1) for name in names) + b"\0"
    window = struct.pack("<iiii", 0, 0, width - 1, height - 1)
    head = struct.pack("<ii", 20000630, 2) + b"".join(
        [
            attribute("channels", "chlist", channels),
            attribute("compression", "compression", b"\0"),
            attribute("dataWindow", "box2i", window),
            attribute("displayWindow", "box2i", window),
            attribute("lineOrder", "lineOrder", b"\0"),
            attribute("pixelAspectRatio", "float", struct.pack("<f", 1)),
            attribute("screenWindowCenter", "v2f", struct.pack("<ff", 0, 0)),
            attribute("screenWindowWidth", "float", struct.pack("<f", 1)),
            b"\0",
        ]
    )
    size = 4 * width * len(names)  # of a row
    first, row = len(head) + 8 * height, 8 + size
    with open(path, "wb") as file:
        file.write(head + struct.pack(f"<{height}Q", *(first + row * y for y in range(height))))
        for y in range(height):
            file.write(struct.pack("<ii", y, size))
            for name in names:
                file.write(struct.pack(f"<{width}f", *planes[name][y * width : (y + 1) * width]))


def texels(width: int, height: int, expression: str, layer: str = "") -> list[tuple[float, float, float]]:
    rule = compile(expression, "expression", "eval")
    out = []
    for y in range(height):
        for x in range(width):
            theta, phi = math.pi * (y + 0.5) / height, 2 * math.pi * (x + 0.5) / width
            at = {
                "x": x,
                "y": y,
                "up": math.cos(theta),
                "right": math.sin(theta) * math.sin(phi),
                "front": -math.sin(theta) * math.cos(phi),
                "layer": layer,
                "inf": math.inf,
                "nan": math.nan,
            }
            out.append(eval(rule, {}, at))
    return out


if __name__ == "__main__":
    w = int(sys.argv[2])
    h = int(sys.argv[4]) if len(sys.argv) > 4 else w // 2
    write(sys.argv[1], w, h, {layer: texels(w, h, sys.argv[3], layer) for layer in sys.argv[5:] or [""]})
