"""A Mitsuba 3 scene as an experiment: meshes, sky, materials, lights and camera."""

from __future__ import annotations

import math
import re
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from os import PathLike, fspath
from pathlib import Path
from typing import Any

import numpy as np

from ..experiments import Experiment, load
from ..scenes import write_mesh, write_sky, write_texture

#: One table of the experiment file: its keys in order.
Table = dict[str, Any]


_not_mapped = " that is no bitmap with filter_type nearest and wrap_mode repeat on a mesh with texture coordinates"


class UnsupportedScene(ValueError):
    """Parts of a scene without a counterpart; `.parts` has one line for each."""

    def __init__(self, parts: list[str]) -> None:
        super().__init__("\n".join(["the scene has parts without a counterpart:", *parts]))
        self.parts = parts


@dataclass
class _Made:
    """The parts of an experiment so far. Files are written at the end, if nothing is refused."""

    mi: Any  #: the module
    tables: dict[str, Table] = field(default_factory=dict)
    files: dict[str, Callable[[Path], None]] = field(default_factory=dict)
    replaced: list[str] = field(default_factory=list)
    #: A rotation of the whole scene, so that the sky's poles are on the y axis (in a scene with z up they are on z).
    upright: Any = field(default_factory=lambda: np.eye(3))

    def refuse(self, what: str, instead: str) -> None:
        self.replaced.append(f"{what}; with approximate=True {instead}")


def _kind(thing: Any) -> str:
    """The class of a Mitsuba object, as its text begins."""
    return re.match(r"\w+", str(thing))[0]  # type: ignore[index]


def _rgb(params: Any, key: str, default: float) -> list[float] | None:
    """A colour of a material; None where it varies over the surface."""
    if key + ".data" in params or any(k.startswith(key + ".") and not k.endswith(".value") for k in params.keys()):
        return None
    value = np.ravel(np.array(params[key + ".value"], float)) if key + ".value" in params else np.array([default])
    return [float(v) for v in (np.repeat(value, 3) if value.size == 1 else value[:3])]


def _texels(params: Any, key: str) -> Any:
    """The texels of a bitmap (height, width, channels), linear; None: it is another texture."""
    if key + ".data" not in params:
        return None
    stored = np.array(params[key + ".data"])
    pixels = stored / np.iinfo(stored.dtype).max if stored.dtype.kind in "ui" else stored.astype(float)
    if " raw = 0" in str(params.properties[key + ".data"][2]) and stored.dtype.kind in "ui":  # sRGB, IEC 61966-2-1
        pixels = np.where(pixels <= 0.04045, pixels / 12.92, ((pixels + 0.055) / 1.055) ** 2.4)
    return np.clip(pixels, 0, 1)


def _is_nearest(mi: Any, params: Any, key: str, texels: Any) -> bool:
    """Whether Mitsuba looks up the nearest of these texels, repeated: at places inside and outside of [0, 1]^2, because
    a loaded bitmap does not say how it is filtered."""
    bitmap, si = params.properties[key + ".data"][2], mi.SurfaceInteraction3f()
    height, width, channels = texels.shape
    for u, v in np.random.default_rng(7).uniform(-1, 2, (64, 2)):
        si.uv = mi.Point2f(float(u), float(v))
        seen = np.ravel(np.array(bitmap.eval_1(si) if channels == 1 else bitmap.eval(si)))[:channels]
        if not np.allclose(seen, texels[int(v % 1 * height), int(u % 1 * width)], atol=1e-4):
            return False
    return True


def _texture(made: _Made, params: Any, key: str, name: str, what: str) -> str | None:
    """The file of a bitmap as a texture of a mesh; None: it is none that has a counterpart."""
    texels = _texels(params, key)
    if texels is None or not _is_nearest(made.mi, params, key, texels):
        return None
    file, grey = f"{name}-{what}.exr", texels.shape[2] == 1 or what == "alpha"
    made.files[file] = lambda path: write_texture(path, texels[..., 0] if grey else texels[..., :3])
    return file


def _mean_of_texture(params: Any, key: str) -> list[float]:
    texels = _texels(params, key)
    return [float(v) for v in texels.reshape(-1, texels.shape[-1]).mean(axis=0)[:3]]


def _colour(made: _Made, params: Any, key: str, default: float, name: str) -> list[float]:
    colour = _rgb(params, key, default)
    if colour is None:
        made.refuse(f"{name}: a texture of {key.rsplit('.', 1)[-1]}{_not_mapped}", "its mean is used")
        colour = _mean_of_texture(params, key) if key + ".data" in params else [default] * 3
        colour = colour * 3 if len(colour) == 1 else colour
    return [min(1.0, max(0.0, v)) for v in colour]


def _number(params: Any, key: str, default: float) -> float:
    return float(np.ravel(np.array(params[key], float))[0]) if key in params else default


def _diffuse(made: _Made, params: Any, key: str, name: str, textured: bool) -> Table:
    """rho_d, and its texture on a mesh that can have one."""
    file = _texture(made, params, key, name, "rho_d") if textured else None
    if file:
        return {"rho_d": [1.0, 1.0, 1.0], "rho_d_texture": file}
    return {"rho_d": _colour(made, params, key, 0.5, name)}


def _roughness(made: _Made, params: Any, prefix: str, name: str, textured: bool) -> Table:
    """alpha, and its texture on a mesh that can have one."""
    if prefix + "alpha.data" in params:
        texels = _texels(params, prefix + "alpha")
        file = _texture(made, params, prefix + "alpha", name, "alpha") if textured and (texels > 0).all() else None
        if file:
            return {"alpha": 1.0, "alpha_texture": file}
    alpha = []
    for key in ("alpha", "alpha_u", "alpha_v"):
        if prefix + key + ".data" in params:
            made.refuse(f"{name}: a texture of {key}{_not_mapped}", "its mean is used")
            alpha.append(max(1e-4, _mean_of_texture(params, prefix + key)[0]))
        else:
            alpha.append(_number(params, prefix + key + ".value", 0.1))
    if any(k.startswith(prefix + "alpha_u.") for k in params.keys()):
        if alpha[1] != alpha[2]:
            made.refuse(f"{name}: an anisotropic roughness", "the geometric mean is used")
        return {"alpha": math.sqrt(alpha[1] * alpha[2])}
    return {"alpha": alpha[0]}


def _material(made: _Made, bsdf: Any, name: str, textured: bool) -> Table:
    """The keys rho_d, rho_s, brdf and alpha or s; textures where the shape has coordinates for them."""
    params, text, kind = made.mi.traverse(bsdf), str(bsdf), _kind(bsdf)
    prefix = ""
    if kind == "TwoSided":
        prefix = "brdf_0." if any(k.startswith("brdf_0.") for k in params.keys()) else "bsdf."
        text = text[text.index("=") + 1 :].strip()
        kind = _kind(text)
    if kind == "SmoothDiffuse":
        return _diffuse(made, params, prefix + "reflectance", name, textured)
    if kind == "RoughConductor":
        values = np.ravel(np.array(params[prefix + "k.value"], float)) if prefix + "k.value" in params else np.zeros(1)
        eta = np.ravel(np.array(params[prefix + "eta.value"], float)) if prefix + "eta.value" in params else np.zeros(1)
        if eta.any() or (values.any() and not np.allclose(values, 1)):
            made.refuse(f"{name}: the Fresnel factor of a conductor", "it is 1")
        beckmann = "distribution = beckmann" in text
        specular = _colour(made, params, prefix + "specular_reflectance", 1.0, name)
        lobe: Table = {"rho_d": [0.0, 0.0, 0.0], "rho_s": specular, "brdf": "beckmann" if beckmann else "ggx"}
        return lobe | _roughness(made, params, prefix, name, textured)
    if kind == "Phong":
        return {
            **_diffuse(made, params, prefix + "diffuse_reflectance", name, textured),
            "rho_s": _colour(made, params, prefix + "specular_reflectance", 0.2, name),
            "brdf": "phong",
            "s": _number(params, prefix + "exponent.value", 30.0),
        }
    made.refuse(f"{name}: the BSDF {kind}", "it is diffuse")
    for key in ("diffuse_reflectance", "base_color", "reflectance"):
        if _rgb(params, prefix + key, -1.0) not in (None, [-1.0] * 3):
            return {"rho_d": _colour(made, params, prefix + key, 0.5, name)}
    return {"rho_d": [0.5, 0.5, 0.5]}


def _name_of(shape: Any, k: int, taken: dict[str, Table]) -> str:
    name = re.sub(r"[^A-Za-z0-9_-]", "-", shape.id() or "") or f"shape-{k}"
    used = {key.split(".")[-1] for key in taken}
    return name if name not in used else f"{name}-{k}"


def _radiance(made: _Made, emitter: Any) -> list[float] | None:
    return _rgb(made.mi.traverse(emitter), "radiance", 1.0)


def _matrix(made: _Made, thing: Any) -> Any:
    """Where a thing is in the upright scene."""
    to_world = np.array(made.mi.traverse(thing)["to_world"].matrix, float).reshape(4, 4)
    to_world[:3] = made.upright @ to_world[:3]
    return to_world


def _turn_of_sky(made: _Made, emitters: Any) -> Any:
    """The rotation that stands the poles of the sky upright; none if they are, or if the sky is mirrored or sheared."""
    for emitter in emitters:
        if _kind(emitter) == "EnvironmentMapEmitter":
            turn = _matrix(made, emitter)[:3, :3]
            is_rotation = np.allclose(turn @ turn.T, np.eye(3), atol=1e-4) and np.linalg.det(turn) > 0
            if is_rotation and not np.allclose(turn[:, 1], [0, 1, 0], atol=1e-4):
                return turn.T
    return np.eye(3)


def _add_mesh(made: _Made, shape: Any, name: str) -> None:
    params = made.mi.traverse(shape)
    if "vertex_positions" in params:
        positions = np.array(params["vertex_positions"], np.float32).reshape(-1, 3)
        triangles = np.array(params["faces"], np.int64).reshape(-1, 3)
        normals = np.array(params["vertex_normals"], np.float32).reshape(-1, 3) if "vertex_normals" in params else None
        uv = np.array(params["vertex_texcoords"], np.float32).reshape(-1, 2) if "vertex_texcoords" in params else None
        positions = positions @ made.upright.T.astype(np.float32)
        if normals is not None:
            normals = normals @ made.upright.T.astype(np.float32)
        if uv is not None and len(uv) != len(positions):
            uv = None
        if normals is not None and (len(normals) != len(positions) or not (np.linalg.norm(normals, axis=1) > 0).all()):
            normals = None
    else:  # a rectangle: [-1, 1]^2 at z = 0, its front towards +z
        to_world = _matrix(made, shape)
        corners = np.array([[-1, -1, 0, 1], [1, -1, 0, 1], [1, 1, 0, 1], [-1, 1, 0, 1]], float)
        positions, normals = (corners @ to_world.T)[:, :3], None
        triangles, uv = np.array([[0, 1, 2], [0, 2, 3]]), np.array([[0, 0], [1, 0], [1, 1], [0, 1]], np.float32)
        if np.linalg.det(to_world[:3, :3]) < 0:
            triangles = triangles[:, ::-1]
    if uv is not None:  # v runs down in Mitsuba's images
        uv = np.stack([uv[:, 0], 1 - uv[:, 1]], axis=1)
    made.files[f"{name}.mesh"] = lambda path: write_mesh(path, positions, triangles, normals, uv)
    table: Table = {"file": f"{name}.mesh", **_material(made, shape.bsdf(), name, uv is not None)}
    if shape.emitter() is not None:
        radiance = _radiance(made, shape.emitter())
        if radiance is None:
            made.refuse(f"{name}: a texture of the emitted radiance", "it emits nothing")
        else:
            table["emission"] = radiance
    made.tables[f"meshes.{name}"] = table


def _add_sphere(made: _Made, shape: Any, name: str) -> None:
    to_world = _matrix(made, shape)
    lengths = np.linalg.norm(to_world[:3, :3], axis=0)
    if not np.allclose(lengths, lengths[0], rtol=1e-4):
        return made.refuse(f"{name}: a sphere that is scaled to an ellipsoid", "it is left out")
    place = {"center": [float(v) for v in to_world[:3, 3]], "radius": float(lengths[0])}
    if shape.emitter() is not None:
        radiance = _radiance(made, shape.emitter())
        if radiance is not None:
            made.tables[f"lights.{name}"] = {"kind": "sphere", **place, "radiance": radiance}
            return None
        made.refuse(f"{name}: a texture of the emitted radiance", "it emits nothing")
    made.tables[f"shapes.{name}"] = {"kind": "sphere", **place, "occludes": True}
    made.tables[f"shapes.{name}"] |= _material(made, shape.bsdf(), name, False)
    return None


def _add_sky(made: _Made, emitter: Any) -> None:
    params = made.mi.traverse(emitter)
    if _kind(emitter) == "ConstantBackgroundEmitter":
        radiance = _radiance(made, emitter)
        even = np.broadcast_to(np.array(radiance or [1, 1, 1], np.float32), (2, 4, 3))
        made.files["sky.exr"] = lambda path: write_sky(path, even)
        made.tables["sky"] = {"file": "sky.exr"}
        return
    turn = _matrix(made, emitter)[:3, :3]
    degrees = math.degrees(math.atan2(turn[0, 2], turn[0, 0]))
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    if not np.allclose(turn, np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]), atol=1e-4):
        made.refuse("envmap: it is mirrored or scaled", "only its rotation about the y axis is used")
    pixels = np.array(params["data"], np.float32)[..., :3]
    resolution = re.search(r"res = \"?\[(\d+), \d+\]", str(emitter))
    repeated = pixels.shape[1] - int(resolution[1]) if resolution else 0  # columns about the seam: at both ends, or the last
    if repeated > 0:
        pixels = pixels[:, repeated // 2 : pixels.shape[1] - (repeated + 1) // 2]
    width = 2 * pixels.shape[0]
    if pixels.shape[1] != width:
        made.refuse(f"envmap: an image of {pixels.shape[1]} x {pixels.shape[0]}", "the nearest texels are used, twice as wide as high")
        columns = (np.arange(width) + 0.5) * pixels.shape[1] / width
        pixels = pixels[:, columns.astype(int)]
    made.files["sky.exr"] = lambda path: write_sky(path, pixels)
    made.tables["sky"] = {"file": "sky.exr", "rotation": degrees, "scale": _number(params, "scale", 1.0)}


def _camera(made: _Made, sensor: Any) -> tuple[Table, Table]:
    """The tables [image] and [camera]."""
    if _kind(sensor) != "PerspectiveCamera":
        made.refuse(f"the sensor {_kind(sensor)}", "it is a pinhole camera")
    width, height = (int(v) for v in sensor.film().size())
    if [int(v) for v in sensor.film().crop_size()] != [width, height]:
        made.refuse("a crop of the film", "the whole film is used")
    to_world = _matrix(made, sensor)
    eye, forward, up = to_world[:3, 3], to_world[:3, 2], to_world[:3, 1]
    if np.linalg.det(to_world[:3, :3]) < 0:
        made.refuse("a mirrored camera", "it is not mirrored")
    x_fov = math.radians(_number(made.mi.traverse(sensor), "x_fov", 45.0))
    vfov = 2 * math.degrees(math.atan(math.tan(x_fov / 2) * height / width))
    image: Table = {"width": width, "height": height}
    camera: Table = {"eye": eye.tolist(), "target": (eye + forward / np.linalg.norm(forward)).tolist()}
    camera |= {"up": (up / np.linalg.norm(up)).tolist(), "vfov_deg": vfov}
    return image, camera


def _toml(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_toml(v) for v in value) + "]"
    return f"{value:.7g}" if isinstance(value, float) else repr(value)  # Mitsuba's numbers are single precision


def _written(title: str, tables: dict[str, Table]) -> str:
    lines = [f"title = {_toml(title)}"]
    for name, table in tables.items():
        lines += ["", f"[{name}]", *(f"{key} = {_toml(value)}" for key, value in table.items())]
    return "\n".join(lines) + "\n"


def mitsuba_scene(
    scene: Any,
    folder: str | PathLike[str],
    *,
    samplers: tuple[str, ...] = ("cosine", "sky", "light-triangle"),
    n: tuple[int, ...] = (4, 16, 64),
    approximate: bool = False,
) -> Experiment:
    """Turns a Mitsuba 3 scene into an experiment: `folder`/scene.toml with its meshes and its sky, returned loaded.

    scene: the path of an XML file, a dictionary as mi.load_dict takes it, or a loaded mi.Scene. Meshes, rectangles and
    spheres; area emitters of one radiance, envmap and constant; the BSDFs diffuse, roughconductor without a Fresnel
    factor and phong, also two-sided; on meshes, bitmaps of the nearest texel, repeated, for the diffuse reflectance and
    alpha; a perspective sensor. Anything else raises :class:`UnsupportedScene`, which lists
    every such part, and nothing is written; with `approximate` each is replaced, with a warning that says by what.
    A scene whose envmap is turned about another axis than y (z up) is turned as a whole, with its camera. The camera
    sees the sky unless the integrator hides emitters.
    Mitsuba interpolates between the texels of an envmap; here each texel is constant. `samplers` that the scene has no
    light for are left out.
    """
    import mitsuba as mi

    if not mi.variant():
        mi.set_variant("scalar_rgb", "llvm_ad_rgb")
    title = "scene"
    if isinstance(scene, str | PathLike):
        title, scene = Path(fspath(scene)).stem, mi.load_file(fspath(scene))
    elif isinstance(scene, dict):
        scene = mi.load_dict(scene)
    made = _Made(mi)
    made.upright = _turn_of_sky(made, scene.emitters())
    image, camera = _camera(made, scene.sensors()[0])
    for k, shape in enumerate(scene.shapes()):
        name, kind = _name_of(shape, k, made.tables), _kind(shape)
        if shape.is_mesh():
            _add_mesh(made, shape, name)
        elif kind == "Sphere":
            _add_sphere(made, shape, name)
        else:
            made.refuse(f"{name}: the shape {kind}", "it is left out")
    for emitter in scene.emitters():
        kind = _kind(emitter)
        if kind in ("EnvironmentMapEmitter", "ConstantBackgroundEmitter"):
            _add_sky(made, emitter)
        elif kind != "AreaLight":
            made.refuse(f"the emitter {kind}", "it is left out")
    if made.replaced and not approximate:
        raise UnsupportedScene(made.replaced)
    for line in made.replaced:
        warnings.warn(line, stacklevel=2)
    if "sky" in made.tables and getattr(scene.integrator(), "hide_emitters", False):
        made.tables["sky"]["visible"] = False
    there = {"sky": "sky" in made.tables, "light-triangle": any("emission" in t for t in made.tables.values())}
    arms = {f"arms.{name}": {"n": list(n)} for name in samplers if there.get(name, True)}
    target = Path(folder)
    target.mkdir(parents=True, exist_ok=True)
    for name, write in made.files.items():
        write(target / name)
    path = target / "scene.toml"
    path.write_text(_written(title, {"image": image, "camera": camera, **made.tables, **arms}), encoding="utf-8")
    return load(path)
