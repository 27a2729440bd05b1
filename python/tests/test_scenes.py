"""Scenes from arrays and from Mitsuba 3."""

import numpy as np
import pytest

import crescent
from crescent import scenes

SQUARE = np.array([[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]], float)
CORNERS = np.array([[0, 2, 1], [0, 3, 2]])
EXPERIMENT = """
[image]
width = 32
height = 18
[camera]
eye = [0, 2, 2]
target = [0, 0, 0]
vfov_deg = 30
[meshes.floor]
file = "floor.mesh"
rho_d = [0.5, 0.5, 0.5]
[sky]
file = "sky.exr"
[reference]
n = 16
[arms.cosine]
n = [16]
"""


def test_arrays_become_a_scene(tmp_path):
    scenes.write_mesh(tmp_path / "floor.mesh", SQUARE, CORNERS, normals=np.full((4, 3), [0, 2, 0]))
    scenes.write_sky(tmp_path / "sky.exr", np.full((4, 8, 3), 2.0))
    (tmp_path / "scene.toml").write_text(EXPERIMENT)
    result = crescent.run(crescent.load(tmp_path / "scene.toml"))
    planes = result.films["cosine", 16].planes
    # A plane under an even sky: every sample of the cosine sampler is rho L, which is 1; beside it the sky is seen.
    floor = planes["hits"] > 0
    assert np.allclose(planes["g"][floor], 1, rtol=1e-5)
    assert (planes["g"][~floor] == 2).all()
    assert 0.5 < floor.mean() < 1


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"positions": np.zeros((4, 2))}, "positions has the shape"),
        ({"positions": np.where(np.arange(12).reshape(4, 3) == 5, np.nan, 0)}, "positions: row 1 is not finite"),
        ({"triangles": np.array([[0, 1, 4]])}, "triangles: row 0 is"),
        ({"triangles": np.zeros((1, 3))}, "expected integers"),
        ({"normals": np.zeros((4, 3))}, "normals: row 0 is 0"),
        ({"uv": np.zeros((3, 2))}, "uv has 3 rows for 4 positions"),
    ],
)
def test_wrong_arrays_are_refused(tmp_path, given, said):
    with pytest.raises(ValueError, match=said):
        scenes.write_mesh(tmp_path / "x.mesh", **{"positions": SQUARE, "triangles": CORNERS, **given})
    assert not (tmp_path / "x.mesh").exists()


def test_skies_are_twice_as_wide_as_high(tmp_path):
    with pytest.raises(ValueError, match="expected \\(height, 2 height, 3\\)"):
        scenes.write_sky(tmp_path / "x.exr", np.zeros((4, 4, 3)))


def test_textures_are_albedos(tmp_path):
    for bad in (-0.1, 1.5, np.nan):
        with pytest.raises(ValueError, match="texels: row 1, column 0 is"):
            scenes.write_texture(tmp_path / "x.exr", [[0.5, 0.5], [bad, 0.5]])
    with pytest.raises(ValueError, match="expected \\(height, width\\)"):
        scenes.write_texture(tmp_path / "x.exr", [0.5])


def test_a_texture_multiplies_the_albedo(tmp_path):
    uv = (SQUARE[:, [0, 2]] * [1, -1] + 1) / 2  # v is 1 at z = -1
    scenes.write_mesh(tmp_path / "floor.mesh", SQUARE, CORNERS, uv=uv)
    scenes.write_sky(tmp_path / "sky.exr", np.full((4, 8, 3), 2.0))
    scenes.write_texture(tmp_path / "four.exr", [[0.2, 0.4], [0.6, 0.8]])
    (tmp_path / "scene.toml").write_text(EXPERIMENT.replace("rho_d =", 'rho_d_texture = "four.exr"\nrho_d ='))
    e = crescent.load(tmp_path / "scene.toml").with_({"camera.eye": [0, 10, 0.01], "camera.vfov_deg": 11})
    green = crescent.run(e).films["cosine", 16].planes["g"]  # ours begins at the bottom: z = 1
    for expected, x, y in ((0.6, 12, 4), (0.8, 20, 4), (0.2, 12, 13), (0.4, 20, 13)):
        assert abs(green[y, x] - expected) < 1e-5
    bare = crescent.load(tmp_path / "scene.toml").hash
    scenes.write_texture(tmp_path / "four.exr", [[0.2, 0.4], [0.6, 0.9]])
    assert crescent.load(tmp_path / "scene.toml").hash != bare  # the content is the identity


def _mitsuba_scene(mi):
    at = mi.ScalarTransform4f
    color = {"type": "rgb", "value": [0.1, 0.2, 0.3]}
    gloss = {
        "type": "roughconductor",
        "material": "none",
        "distribution": "ggx",
        "alpha": 0.3,
        "specular_reflectance": {"type": "rgb", "value": [0.5, 0.5, 0.5]},
    }
    sky = np.repeat(np.repeat(np.random.default_rng(1).random((4, 8, 3)), 64, 0), 64, 1).astype(np.float32)
    return {
        "type": "scene",
        "integrator": {"type": "direct", "hide_emitters": True, "emitter_samples": 1, "bsdf_samples": 1},
        "sensor": {
            "type": "perspective",
            "fov": 40,
            "to_world": at().look_at(origin=[1, 2, 5], target=[0, 0.5, 0], up=[0, 1, 0]),
            "film": {"type": "hdrfilm", "width": 96, "height": 54, "rfilter": {"type": "box"}},
            "sampler": {"type": "independent", "sample_count": 256},
        },
        "box": {
            "type": "cube",
            "to_world": at().translate([0, 0.5, 0]).rotate([0, 1, 0], 30).scale(0.5),
            "bsdf": {"type": "twosided", "below": {"type": "diffuse", "reflectance": color}},
        },
        "floor": {"type": "rectangle", "to_world": at().rotate([1, 0, 0], -90).scale(4), "bsdf": gloss},
        "ball": {"type": "sphere", "center": [1.3, 0.4, 0], "radius": 0.4, "bsdf": {"type": "diffuse"}},
        "lamp": {
            "type": "rectangle",
            "to_world": at().translate([0, 3, 0]).rotate([1, 0, 0], 90).scale(0.5),
            "emitter": {"type": "area", "radiance": {"type": "rgb", "value": [5, 5, 5]}},
        },
        "around": {
            "type": "envmap",
            "bitmap": mi.Bitmap(sky),
            "scale": 0.5,
            "to_world": at().rotate([0, 1, 0], 40),
        },
    }


@pytest.fixture
def mi():
    library = pytest.importorskip("mitsuba")
    if not library.variant():
        library.set_variant("llvm_ad_rgb", "scalar_rgb")
    return library


def _with_z_up(mi, scene):
    """The same scene in other coordinates."""
    turn = mi.ScalarTransform4f().rotate([1, 0, 0], 90)
    for part in scene.values():
        if isinstance(part, dict) and part["type"] == "sphere":
            part["to_world"] = turn @ mi.ScalarTransform4f().translate(part.pop("center")).scale(part.pop("radius"))
        elif isinstance(part, dict) and "to_world" in part:
            part["to_world"] = turn @ part["to_world"]
    return scene


@pytest.mark.parametrize("up", ["y", "z"])
@pytest.mark.parametrize("hidden", [True, False])
def test_a_mitsuba_scene_has_mitsubas_radiance(mi, tmp_path, up, hidden):
    given = _mitsuba_scene(mi) if up == "y" else _with_z_up(mi, _mitsuba_scene(mi))
    given["integrator"]["hide_emitters"] = hidden
    e = crescent.adapters.mitsuba.scene(given, tmp_path / "made", n=(16,))
    assert [name for name in ("cosine", "sky", "light-triangle") if f"arms.{name}" in e] == [
        "cosine",
        "sky",
        "light-triangle",
    ]
    reference = crescent.run(e.with_({"reference.n": 256})).references[e["s"] if "s" in e else 0.0]
    theirs = np.array(mi.render(mi.load_dict(given)))[::-1]  # ours begins at the bottom
    for k, channel in enumerate("rgb"):
        ours, other = np.asarray(reference[channel]), theirs[..., k]
        for rows, columns in ((slice(0, 54), slice(0, 96)), (slice(20, 34), slice(38, 58)), (slice(2, 12), slice(5, 90))):
            assert abs(ours[rows, columns].mean() / other[rows, columns].mean() - 1) < 0.02


def _textured(mi, filter_type="nearest", wrap_mode="repeat"):
    """A floor of texels of any albedo, and a gloss of any roughness on a wall, three times along each side."""
    random = np.random.default_rng(5)
    at, again = mi.ScalarTransform4f, {"filter_type": filter_type, "wrap_mode": wrap_mode}
    colours = mi.Bitmap((255 * random.random((5, 7, 3))).astype(np.uint8))
    rough = mi.Bitmap((0.1 + 0.8 * random.random((4, 3, 1))).astype(np.float32))
    scene = _mitsuba_scene(mi)
    for name in ("ball", "box", "lamp"):
        del scene[name]
    albedo = {"type": "bitmap", "bitmap": colours, **again}
    alpha = {"type": "bitmap", "bitmap": rough, "raw": True, **again}
    scene["floor"]["bsdf"] = {"type": "diffuse", "reflectance": albedo}
    scene["wall"] = {
        "type": "rectangle",
        "to_world": at().translate([0, 1, -1]).scale(1.5),
        "bsdf": {"type": "roughconductor", "material": "none", "distribution": "ggx", "alpha": alpha},
    }
    scene["sensor"]["sampler"]["sample_count"] = 4096
    return scene


def test_textures_have_mitsubas_radiance(mi, tmp_path):
    given = _textured(mi)
    e = crescent.adapters.mitsuba.scene(given, tmp_path / "made", n=(16,))
    assert e["meshes.floor.rho_d_texture"] == "floor-rho_d.exr"
    assert e["meshes.wall.alpha_texture"] == "wall-alpha.exr"
    reference = crescent.run(e.with_({"reference.n": 256})).references[e["s"] if "s" in e else 0.0]
    theirs = np.array(mi.render(mi.load_dict(given)))[::-1]
    apart = []
    for k, channel in enumerate("rgb"):
        ours, other = np.asarray(reference[channel]), theirs[..., k]
        assert abs(ours.mean() / other.mean() - 1) < 0.005
        for y in range(2, 48, 6):  # blocks of pixels, a few of them in a texel
            for x in range(0, 96, 6):
                a, b = ours[y : y + 6, x : x + 6].mean(), other[y : y + 6, x : x + 6].mean()
                apart.append(abs(a - b) / (b + 0.05))
    assert np.median(apart) < 0.01 and np.quantile(apart, 0.95) < 0.05  # Mitsuba's pixels are averages over their area


@pytest.mark.parametrize(("filter_type", "wrap_mode"), [("bilinear", "repeat"), ("nearest", "clamp")])
def test_other_textures_are_refused(mi, tmp_path, filter_type, wrap_mode):
    given = _textured(mi, filter_type, wrap_mode)
    with pytest.raises(crescent.adapters.UnsupportedScene, match="filter_type nearest") as refused:
        crescent.adapters.mitsuba.scene(given, tmp_path / "made")
    assert [line.split(":")[0] for line in sorted(refused.value.parts)] == ["floor", "wall"]
    with pytest.warns(UserWarning, match="its mean is used"):
        e = crescent.adapters.mitsuba.scene(given, tmp_path / "made", approximate=True)
    assert 0.2 < e["meshes.floor.rho_d"][0] < 0.5 and 0.4 < e["meshes.wall.alpha"] < 0.6


def test_what_has_no_counterpart_is_listed(mi, tmp_path):
    given = _mitsuba_scene(mi) | {
        "pipe": {"type": "cylinder"},
        "coat": {"type": "cube", "bsdf": {"type": "plastic"}},
        "spot": {"type": "point", "intensity": {"type": "rgb", "value": 1.0}},
    }
    with pytest.raises(crescent.adapters.UnsupportedScene) as refused:
        crescent.adapters.mitsuba.scene(given, tmp_path / "made")
    assert [line.split(":")[0] for line in sorted(refused.value.parts)][:2] == ["coat", "pipe"]
    assert any("PointLight" in line for line in refused.value.parts)
    assert not (tmp_path / "made").exists()
    with pytest.warns(UserWarning, match="the BSDF SmoothPlastic"):
        e = crescent.adapters.mitsuba.scene(given, tmp_path / "made", approximate=True)
    assert e["meshes.coat.rho_d"] == [0.5, 0.5, 0.5]
