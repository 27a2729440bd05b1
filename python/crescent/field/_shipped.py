"""The plugins of Mitsuba 3: every BSDF that reflects or transmits and every emitter that has directions, at several
parameters."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

ABOVE = [(0.0, 0.0), (30.0, 0.0), (60.0, 250.0), (85.0, 75.0)]
BELOW = [(150.0, 0.0), (120.0, 250.0), (95.0, 75.0)]


@dataclass(frozen=True)
class Made:
    """A parameter made by a line of Python, with mi and np."""

    code: str

    def made(self) -> Any:
        """Returns the value of the line."""
        import mitsuba as mi

        return eval(self.code, {"mi": mi, "np": np})


@dataclass(frozen=True)
class Shipped:
    """A plugin with its parameters."""

    kind: str  #: "bsdf" or "emitter"
    plugin: dict[str, Any]
    known: dict[str, Any] = field(default_factory=dict)  #: of crescent.Sampler
    label: str = ""  #: instead of the parameters

    def title(self) -> str:
        """The plugin and its parameters, except nested ones."""
        if self.label:
            return self.label
        told = [f"{k} = {_told(v)}" for k, v in self.plugin.items() if k != "type"]
        return str(self.plugin["type"]) + (": " + ", ".join(told) if told else "")

    def built(self) -> dict[str, Any]:
        """Returns the dictionary for mi.load_dict."""
        return {k: _built(v) for k, v in self.plugin.items()}

    def code(self) -> str:
        """Returns the dictionary as Python."""
        return "{" + ", ".join(f'"{k}": {_code(v)}' for k, v in self.plugin.items()) + "}"


def _built(value: Any) -> Any:
    if isinstance(value, dict):
        return {k: _built(v) for k, v in value.items()}
    return value.made() if isinstance(value, Made) else value


def _told(value: Any) -> str:
    if isinstance(value, list):
        return "(" + ", ".join(map(_told, value)) + ")"
    if isinstance(value, dict):
        return str(value["type"])
    return f"{value:g}" if isinstance(value, float) else str(value)


def _code(value: Any) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f'"{k}": {_code(v)}' for k, v in value.items()) + "}"
    if isinstance(value, Made):
        return value.code
    return f'"{value}"' if isinstance(value, str) else repr(value)


#: A height that rises along x and y.
_RAMP = "mi.Bitmap(np.float32(np.indices((4, 4)).sum(axis=0)[..., None] / 8))"


def bsdfs() -> list[Shipped]:
    """Reflecting and transmitting BSDFs."""
    rgb = {"type": "rgb", "value": [0.8, 0.5, 0.2]}
    diffuse = {"type": "diffuse", "reflectance": rgb}
    gloss = {"type": "roughconductor", "alpha": 0.2, "distribution": "ggx"}
    all_of: list[dict[str, Any]] = [
        diffuse,
        {"type": "conductor", "material": "Au"},
        {"type": "roughconductor", "alpha": 0.05, "distribution": "ggx"},
        {"type": "roughconductor", "alpha": 0.3, "distribution": "ggx"},
        {"type": "roughconductor", "alpha_u": 0.1, "alpha_v": 0.4, "distribution": "ggx"},
        {"type": "roughconductor", "alpha": 0.3, "distribution": "ggx", "sample_visible": False},
        {"type": "roughconductor", "alpha": 0.1, "distribution": "beckmann"},
        {"type": "roughconductor", "alpha": 0.3, "distribution": "beckmann"},
        {"type": "roughconductor", "alpha": 0.3, "distribution": "beckmann", "sample_visible": False},
        {"type": "dielectric"},
        {"type": "thindielectric"},
        {"type": "roughdielectric", "alpha": 0.1, "distribution": "ggx"},
        {"type": "roughdielectric", "alpha": 0.4, "distribution": "ggx"},
        {"type": "roughdielectric", "alpha": 0.2, "distribution": "beckmann"},
        {"type": "plastic", "diffuse_reflectance": rgb},
        {"type": "plastic", "diffuse_reflectance": rgb, "nonlinear": True},
        {"type": "roughplastic", "diffuse_reflectance": rgb, "alpha": 0.1, "distribution": "ggx"},
        {"type": "roughplastic", "diffuse_reflectance": rgb, "alpha": 0.3, "distribution": "beckmann"},
        {"type": "principled", "base_color": rgb, "roughness": 0.5},
        {"type": "principled", "base_color": rgb, "roughness": 0.3, "metallic": 1.0, "anisotropic": 0.7},
        {"type": "principled", "base_color": rgb, "roughness": 0.4, "clearcoat": 1.0, "clearcoat_gloss": 0.6},
        {"type": "principled", "base_color": rgb, "roughness": 0.3, "spec_trans": 1.0, "eta": 1.5},
        {"type": "principled", "base_color": rgb, "roughness": 0.5, "flatness": 0.5, "sheen": 1.0, "sheen_tint": 0.5},
        {
            "type": "principledthin",
            "base_color": rgb,
            "roughness": 0.4,
            "spec_trans": 0.5,
            "diff_trans": 0.6,
            "eta": 1.5,
        },
        {"type": "blendbsdf", "weight": 0.3, "a": diffuse, "b": gloss},
        {"type": "blendbsdf", "weight": 0.5, "a": diffuse, "b": {"type": "null"}},
        {"type": "mask", "opacity": 0.4, "nested": gloss},
        {"type": "twosided", "nested": gloss},
        {"type": "hair"},
        {"type": "pplastic", "diffuse_reflectance": rgb, "alpha": 0.1},
        {"type": "pplastic", "diffuse_reflectance": rgb, "alpha": 0.3},
        {"type": "normalmap", "normalmap": {"type": "rgb", "value": [0.6, 0.5, 0.95]}, "bsdf": diffuse},
        {
            "type": "bumpmap",
            "texture": {"type": "bitmap", "raw": True, "bitmap": Made(_RAMP)},
            "scale": 0.2,
            "bsdf": diffuse,
        },
        {"type": "null"},
        {"type": "polarizer"},
        {"type": "retarder"},
        {"type": "circular"},
    ]
    return [Shipped("bsdf", p, {"reciprocal": False} if p["type"] == "hair" else {}) for p in all_of]


def emitters() -> list[Shipped]:
    """Emitters as they are sampled from the origin."""
    import mitsuba as mi

    light = {"type": "area", "radiance": {"type": "rgb", "value": 1.0}}
    at = mi.ScalarTransform4f
    rows, columns = np.indices((8, 16))
    picture = np.stack([1 + 5 * np.exp(-((rows - 2.0) ** 2 + (columns - 5.0) ** 2) / 4)] * 3, -1).astype(np.float32)
    shapes: dict[str, dict[str, Any]] = {
        "constant": {"type": "constant"},
        "envmap of 16 x 8 texels": {"type": "envmap", "bitmap": mi.Bitmap(picture)},
        "area on a sphere": {"type": "sphere", "center": [0.0, 1.0, 2.0], "radius": 0.5, "emitter": light},
        "area on a rectangle": {
            "type": "rectangle",
            "to_world": at().translate([0, 0.5, 1.5]).rotate([1, 0, 0], 160),
            "emitter": light,
        },
        "area on a disk": {
            "type": "disk",
            "to_world": at().translate([0.5, 0, 2]).rotate([1, 0, 0], 150),
            "emitter": light,
        },
        "area on a cylinder": {
            "type": "cylinder",
            "p0": [1.0, -1.0, 1.0],
            "p1": [1.0, 1.0, 1.0],
            "radius": 0.3,
            "emitter": light,
        },
        "area on a cube": {"type": "cube", "to_world": at().translate([0, 0, 3]), "emitter": light},
    }
    skies: list[dict[str, Any]] = [
        {"type": "sunsky"},
        {"type": "sunsky", "turbidity": 6.0, "sun_direction": [0.0, 0.6, 0.8]},
        {"type": "sunsky", "sun_aperture": 5.0},
        {"type": "sunsky", "sun_scale": 0.0},
        {"type": "timed_sunsky"},
    ]
    shining = [Shipped("emitter", plugin, label=label) for label, plugin in shapes.items()]
    return shining + [Shipped("emitter", plugin) for plugin in skies]
