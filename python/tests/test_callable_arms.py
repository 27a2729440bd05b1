"""Samplers in Python as arms of a run: they agree with built-in samplers, and what they raise ends the run."""

import copy
import os
import pickle
import signal
import threading

import numpy as np
import pytest
from samplers import cosine, mirror
from tiny import TINY

import crescent

def same_cosine(wo, u):
    """The built-in cosine sampler: cos theta is the root of u[0]; the directions are the same but for rounding."""
    z, sin, phi = np.sqrt(u[:, 0]), np.sqrt(1 - u[:, 0]), 2 * np.pi * u[:, 1]
    return np.stack([sin * np.cos(phi), sin * np.sin(phi), z], -1), z / np.pi


def basis(axis):
    """Two unit vectors at right angles to each row of unit vectors, and to each other."""
    helper = np.where(np.abs(axis[..., :1]) < 0.9, [1.0, 0, 0], [0, 1.0, 0])
    t = np.cross(helper, axis)
    t /= np.linalg.norm(t, axis=-1, keepdims=True)
    return t, np.cross(axis, t)


def phong(wo, u, ctx):
    """cos^s about the mirror direction R of wo."""
    r = wo * [-1, -1, 1]
    t, b = basis(r)
    cos = u[:, 0] ** (1 / (ctx.s + 1))
    sin, phi = np.sqrt(1 - cos * cos), 2 * np.pi * u[:, 1]
    wi = (sin * np.cos(phi))[:, None] * t + (sin * np.sin(phi))[:, None] * b + cos[:, None] * r
    return wi / np.linalg.norm(wi, axis=1, keepdims=True), (ctx.s + 1) / (2 * np.pi) * cos**ctx.s


def disk_by_area(wo, u, ctx):
    """Uniform on one of the disk lights, chosen by a third random number."""
    rows, lights = np.arange(len(u)), ctx.lights
    k = np.minimum((u[:, 2] * len(lights)).astype(int), len(lights) - 1)
    normal, radius = lights.normal[rows, k], lights.radius[rows, k]
    t, b = basis(normal)
    r, phi = radius * np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1]
    y = lights.position[rows, k] + (r * np.cos(phi))[:, None] * t + (r * np.sin(phi))[:, None] * b
    d2 = np.sum(y * y, axis=1)
    wi = y / np.sqrt(d2)[:, None]
    cos = np.abs(np.sum(wi * normal, axis=1))
    with np.errstate(divide="ignore"):
        pdf = d2 / (np.pi * radius**2 * cos) / len(lights)
    return wi, np.where(lights.shines[rows, k] & np.isfinite(pdf), pdf, 0)


def with_samplers(changes=None, **samplers):
    e = crescent.parse(TINY).with_(changes or {})
    e.samplers.update(samplers)
    return e


def difference(a, b):
    """The difference of two films' sums in standard errors."""
    seen = (a.var > 0) | (b.var > 0)
    error = np.sqrt(a.var[seen].sum(dtype=float) + b.var[seen].sum(dtype=float))
    return abs(a.y[seen].sum(dtype=float) - b.y[seen].sum(dtype=float)) / error


def test_a_copy_of_the_cosine_sampler_has_its_film():
    measured = crescent.run(with_samplers(mine=crescent.Sampler(same_cosine)), seeds=(1, 1))
    assert ("mine", 4) in measured.films and ("mine", 16) in measured.films
    for n in (4, 16):
        built_in, mine = measured.films["cosine", n], measured.films["mine", n]
        close = np.isclose(built_in.y, mine.y, rtol=1e-3)
        assert close.mean() > 0.99 and difference(built_in, mine) < 0.1
    row = next(r for r in measured.records() if r["arm"] == "mine" and r["metric"] == "rmse")
    assert row["value"] > 0


def test_a_copy_of_the_phong_sampler_agrees_within_the_noise():
    e = with_samplers({"arms.phong.n": [4, 256]}, mine=crescent.Sampler(phong, uses=("s",)))
    measured = crescent.run(e, seeds=(1, 1))
    built_in, mine = measured.films["phong", 256], measured.films["mine", 256]
    assert difference(built_in, mine) < 4
    ball = np.s_[8:25, 16:33]
    of_both = [film.var[ball] for film in (built_in, mine)]
    lit = (of_both[0] > 0) & (of_both[1] > 0)
    assert lit.mean() > 0.5
    assert np.median(of_both[0][lit] / of_both[1][lit]) == pytest.approx(1, abs=0.1)


@pytest.mark.parametrize("lights", ["one", "two"])
def test_a_sampler_of_the_lights_agrees_with_light_area(lights):
    other = {"center": [-2, 2, 2], "normal": [0.48, -0.64, -0.6], "radius": 0.2, "radiance": [20, 40, 60]}
    e = with_samplers(
        {
            "fill.radiance": [0, 0, 0],
            **({"disks.other": other} if lights == "two" else {}),
            "arms.light-area.n": [64],
        },
        mine=crescent.Sampler(disk_by_area, uses=("lights",), u=3),
    )
    measured = crescent.run(e, seeds=(1, 1))
    for name in ("light-area", "mine"):
        film, reference = measured.films[name, 64], measured.references[32.0]["y"]
        error = np.sqrt(film.var.sum(dtype=float))
        assert abs(film.y.sum(dtype=float) - reference.sum(dtype=float)) < 4 * error
    assert difference(measured.films["light-area", 64], measured.films["mine", 64]) < 4


def test_the_context_has_the_material_and_the_lights_of_the_scene():
    seen = []

    def sample(wo, u, ctx):
        seen.append(ctx)
        assert np.allclose(np.linalg.norm(wo, axis=1), 1)
        return cosine(wo, u)

    e = with_samplers(
        {
            "lights.bulb": {"kind": "sphere", "center": [-1, 3, 1], "radius": 0.4, "radiance": [5, 6, 7]},
            "lights.panel": {
                "kind": "rectangle",
                "corner": [-1, 3, -1],
                "edge_u": [2, 0, 0],
                "edge_v": [0, 0, 1],
                "radiance": [1, 2, 3],
            },
        },
        mine=crescent.Sampler(sample, uses=("rho_d", "rho_s", "s", "alpha", "lights")),
    )
    crescent.run(e, seeds=(1, 1))
    ctx = max(seen, key=lambda c: len(c.s))
    n = len(ctx.s)
    assert n > 1000 and np.all(ctx.s == 32) and np.allclose(ctx.rho_s, 0.12) and np.allclose(ctx.rho_d, 0.2)
    assert ctx.alpha.shape == (n,) and ctx.rho_d.shape == (n, 3)
    lights = ctx.lights
    assert lights.kind == ("disk", "sphere", "rectangle") and len(lights) == 3
    for name, shape in (("position", (n, 3, 3)), ("shines", (n, 3)), ("radius", (n, 3)), ("radiance", (n, 3, 3))):
        assert getattr(lights, name).shape == shape
    assert np.allclose(lights.radiance[-1], [[90, 90, 90], [5, 6, 7], [1, 2, 3]])
    assert np.allclose(lights.radius[0], [0.3, 0.4, np.hypot(1, 0.5)])
    assert np.allclose(np.linalg.norm(lights.edge_u, axis=2), [0, 0, 1])
    assert np.allclose(np.linalg.norm(lights.edge_v, axis=2), [0, 0, 0.5])
    assert np.allclose(np.linalg.norm(lights.normal, axis=2), [1, 0, 1], atol=1e-6)
    # The distance between two lights is that of the world in every local frame.
    apart = np.linalg.norm(lights.position[:, 0] - lights.position[:, 1], axis=1)
    assert np.allclose(apart, np.linalg.norm(np.subtract([1.2, 2.9, 1.3], [-1, 3, 1])), atol=1e-5)
    assert lights.shines.dtype == bool and 0 < lights.shines[:, 0].mean() <= 1


def test_films_have_the_same_bits_for_any_number_of_threads():
    samplers = {
        "mine": crescent.Sampler(phong, uses=("s",)),
        "aimed": crescent.Sampler(disk_by_area, uses=("lights",), u=3),
        "alone": crescent.Sampler(cosine, serial=True),
    }
    changes = {"image.width": 200, "image.height": 140}
    one, two = (crescent.run(with_samplers(changes, **samplers), seeds=(1, 1), threads=t) for t in (1, 2))
    several = crescent.run(with_samplers(changes, mine=samplers["mine"]), seeds=(1, 1), threads=2)
    for key, film in one.films.items():
        for name, plane in film.planes.items():
            assert np.array_equal(plane, two.films[key].planes[name]), (key, name)
            assert key[0] != "mine" or np.array_equal(plane, several.films[key].planes[name])


def test_what_a_sampler_raises_ends_the_run(interruptible):
    class Odd(Exception):
        pass

    def raises(wo, u):
        raise Odd("as planned") if len(u) > 8 else None or Odd("at once")

    def short(wo, u):
        wi, p = cosine(wo, u)
        return (wi[:-1], p) if len(u) > 8 else (wi, p)

    def interrupted(wo, u):
        if len(u) > 8:
            os.kill(os.getpid(), signal.SIGINT)
        return cosine(wo, u)

    def late(wo, u):
        if len(u) > 8:
            raise Odd("as planned")
        return cosine(wo, u)

    for sample, kind, said in (
        (raises, Odd, "at once"),
        (late, Odd, "as planned"),
        (short, ValueError, "short: sample's wi: .* rows"),
        (crescent.Sampler(mirror, u=3), ValueError, "mirror: row .* delta part"),
        (crescent.Sampler(lambda wo, u, ctx: ctx.alpha, uses=("s",)), AttributeError, "does not use 'alpha'"),
    ):
        with pytest.raises(kind, match=said):
            crescent.run(with_samplers(mine=sample), seeds=(1, 1))
    for serial in (False, True):
        with pytest.raises(KeyboardInterrupt):
            crescent.run(with_samplers(mine=crescent.Sampler(interrupted, serial=serial)), seeds=(1, 1))


def test_bad_draws_are_counted():
    def sample(wo, u):
        wi, p = cosine(wo, u)
        return wi, np.where(u[:, 0] < 0.25, np.nan, p)

    measured = crescent.run(with_samplers(mine=crescent.Sampler(sample)), seeds=(1, 1))
    bad = {(r["arm"], r["n"]): r["value"] for r in measured.records() if r["metric"] == "bad"}
    assert bad["cosine", 16] == 0 and bad["mine", 16] > 100


def test_wrong_samplers_are_named():
    e = crescent.parse(TINY)
    for value in (3, None, object()):
        with pytest.raises(TypeError, match=r"samplers\['mine'\]"):
            e.samplers["mine"] = value
    with pytest.raises(TypeError, match="no name"):
        e.samplers[3] = cosine
    with pytest.raises(TypeError, match="uses is 'alpha'"):
        crescent.Sampler(cosine, uses="alpha")
    with pytest.raises(ValueError, match="did you mean 'alpha'"):
        crescent.Sampler(cosine, uses=("alfa",))
    e.samplers["cosine"] = crescent.Sampler(cosine)
    with pytest.raises(ValueError, match="has an arm 'cosine'"):
        crescent.run(e)
    del e.samplers["cosine"]
    e.samplers["no name"] = cosine
    with pytest.raises(ValueError, match="no name"):
        crescent.run(e)


def test_samplers_stay_with_their_experiment():
    e = with_samplers(mine=crescent.Sampler(cosine))
    without = crescent.parse(TINY)
    assert e.hash != without.hash and e != without
    for other in (e.with_({}), copy.deepcopy(e), pickle.loads(pickle.dumps(e))):
        assert other == e and list(other.samplers) == ["mine"]
    e["image.width"] = 40
    assert list(e.samplers) == ["mine"] and "arms.mine" not in e
    changed = e.with_({"fill.radiance": [1, 2, 3]})
    row = crescent.run(changed, seeds=(1, 1)).records()[0]
    assert row["fill.radiance"] == [1, 2, 3] and not any("mine" in key for key in row)


def test_an_experiment_names_a_sampler_in_a_file(tmp_path):
    code = "import numpy as np\nfrom crescent import Sampler\n" + (
        "def sample(wo, u, ctx):\n"
        "    assert ctx.rho_d.shape == (len(u), 3)\n"
        "    r, phi = np.sqrt(1 - u[:, 0]), 2 * np.pi * u[:, 1]\n"
        "    z = np.sqrt(u[:, 0])\n"
        "    return np.stack([r * np.cos(phi), r * np.sin(phi), z], -1), z / np.pi\n"
        "sampler = Sampler(sample, uses=('rho_d',))\n"
    )
    (tmp_path / "own_sampler.py").write_text(code)
    (tmp_path / "tiny.toml").write_text(TINY + '[arms.mine]\npython = "own_sampler.py:sampler"\nn = [16]\n')
    e = crescent.load(tmp_path / "tiny.toml")
    measured = crescent.run(e, seeds=(1, 1))
    assert np.isclose(measured.films["mine", 16].y, measured.films["cosine", 16].y, rtol=1e-3).mean() > 0.99
    before = e.hash
    (tmp_path / "own_sampler.py").write_text(code + "# changed\n")
    assert e.hash != before
    e.samplers["again"] = f"{tmp_path}/own_sampler.py:sampler"
    assert ("again", 4) in crescent.run(e, seeds=(1, 1)).films
    for value, said in (("own_sampler", "FILE.py:NAME"), ("", "empty"), (3, "text")):
        with pytest.raises(ValueError, match=said):
            e["arms.mine.python"] = value
    with pytest.raises(ValueError, match="found several"):
        e["arms.mine.sampler"] = "cosine"
    with pytest.raises(ValueError, match="no 'sampel'.*did you mean '[sS]ampler'"):
        crescent.run(e.with_({"arms.mine.python": f"{tmp_path}/own_sampler.py:sampel"}))


def test_a_sampler_with_a_context_is_checked_on_one_surface():
    def pdf(wo, wi, ctx):
        cos = np.sum(wo * [-1, -1, 1] * wi, axis=1)
        return (ctx.s + 1) / (2 * np.pi) * np.maximum(cos, 0) ** ctx.s

    sampler = crescent.Sampler(phong, pdf, uses=("s",))
    assert crescent.check(sampler, wo_deg=[30], settings={"s": 8}).of("density")[0].state == "right"
    wrong = crescent.Sampler(phong, lambda wo, wi, ctx: pdf(wo, wi, ctx) * 1.1, uses=("s",))
    assert crescent.check(wrong, wo_deg=[30]).state == "wrong"
    with pytest.raises(ValueError, match="no 'alfa'"):
        crescent.check(sampler, settings={"alfa": 8})
    with pytest.raises(TypeError, match="settings"):
        crescent.check(cosine, settings={"s": 8})


@pytest.mark.parametrize("library", ["torch", "jax"])
def test_arms_take_arrays_of_their_own_library(library):
    module = pytest.importorskip("jax.numpy" if library == "jax" else "torch")

    def sample(wo, u, ctx):
        assert type(ctx.alpha) is type(u) and ctx.lights.radiance.shape == (len(u), 1, 3)
        r, phi = module.sqrt(1 - u[:, 0]), 2 * np.pi * u[:, 1]
        z = module.sqrt(u[:, 0])
        return module.stack([r * module.cos(phi), r * module.sin(phi), z], -1), z / np.pi

    e = with_samplers(mine=crescent.Sampler(sample, uses=("alpha", "lights"), array_module=library))
    measured = crescent.run(e, seeds=(1, 1))
    assert np.isclose(measured.films["mine", 16].y, measured.films["cosine", 16].y, rtol=1e-3).mean() > 0.99


class Lobe:
    """A sampler whose attribute decides what it draws."""

    def __init__(self, power):
        self.power = power

    def sample(self, wo, u):
        z = u[:, 0] ** (1 / (self.power + 1))
        r, phi = np.sqrt(1 - z * z), 2 * np.pi * u[:, 1]
        return np.stack([r * np.cos(phi), r * np.sin(phi), z], -1), (self.power + 1) / (2 * np.pi) * z**self.power


def test_the_identity_of_a_sampler_covers_what_it_uses(tmp_path):
    def with_sampler(sampler):
        e = crescent.parse(TINY)
        e.samplers["mine"] = sampler
        return e

    def closed(scale):
        return crescent.Sampler(lambda wo, u: (wo, scale * u[:, 0]))

    hashes = [with_sampler(s).hash for s in (Lobe(1).sample, Lobe(2).sample, closed(1), closed(2))]
    assert len(set(hashes)) == 4 and with_sampler(Lobe(1).sample).hash == hashes[0]
    measured = crescent.run(with_sampler(Lobe(1).sample), seeds=(1, 1))
    identity = measured.samplers["mine"]
    assert f"sampler mine {identity}" in measured.provenance
    measured.write(tmp_path / "out")
    assert crescent.open(tmp_path / "out").samplers == {"mine": identity}
    lobe = Lobe(1)
    lobe.lock = threading.Lock()
    assert "_thread.lock, which cannot be hashed" in crescent.run(with_sampler(lobe.sample), seeds=(1, 1)).provenance
