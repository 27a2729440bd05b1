"""Samplers of points of other domains than directions: right ones are right, faults are found with their cause."""

import subprocess
import sys
from pathlib import Path

import crescent
import numpy as np
import pytest
from tiny import TINY


def states(result):
    return {v.name: v.state for v in result.verdicts}


def disk(root):
    def sample(u):
        r, phi = root(u[:, 0]), 2 * np.pi * u[:, 1]
        return np.column_stack([r * np.cos(phi), r * np.sin(phi)]), 1 / np.pi

    return sample


def uniform_in_disk(x):
    return np.full(len(x), 1 / np.pi)


def test_a_right_lens_is_right_and_one_without_root_is_named():
    assert crescent.check(disk(np.sqrt), uniform_in_disk, domain="disk").state == "right"
    wrong = crescent.check(disk(lambda u: u), uniform_in_disk, domain="disk")
    assert wrong.state == "wrong"
    density = next(v for v in wrong.verdicts if v.name == "density")
    assert "square root is missing" in density.cause
    assert "radius" in density.message


@pytest.mark.parametrize("rate, state", [(2.0, "right"), (2.2, "wrong")])
def test_distances_on_a_line_without_end(rate, state):
    def sample(u):
        x = -np.log1p(-u[:, 0]) / 2
        return x, rate * np.exp(-rate * x)

    result = crescent.check(sample, lambda x: rate * np.exp(-rate * x), domain="line:0,inf", numbers=1)
    assert result.state == state
    if state == "wrong":
        assert any("x multiplied by" in v.cause for v in result.verdicts)


def test_an_entry_of_a_set_is_named():
    p = np.arange(1, 38) / 703
    drawn = p.copy()
    drawn[17] *= 0.5
    drawn[30] += p[17] / 2
    cdf = np.cumsum(drawn)

    def sample(u):
        i = np.minimum(np.searchsorted(cdf, u[:, 0], side="right"), 36)
        return i, p[i]

    result = crescent.check(sample, lambda i: p[i], domain="set:37", numbers=1)
    assert states(result)["density"] == "wrong"
    say = next(v.message for v in result.verdicts if v.name == "density")
    assert say.startswith(("Entry 17 is drawn with", "Entry 30 is drawn with"))


def test_a_product_and_its_integrand():
    """A lobe and a direction of it; f has the integral 1."""

    def density(x):
        return np.where(x[:, 0] > 0, 0.7 * np.maximum(x[:, 3], 0) / np.pi, 0.3 / (2 * np.pi))

    def sample(u):
        cosine = u[:, 0] >= 0.3
        z = np.where(cosine, np.sqrt(u[:, 1]), u[:, 1])
        r, phi = np.sqrt(1 - z * z), 2 * np.pi * u[:, 2]
        x = np.column_stack([cosine, r * np.cos(phi), r * np.sin(phi), z])
        return x, density(x)

    result = crescent.check(sample, density, density, domain="set:2 x hemisphere", numbers=3)
    assert result.state == "right"
    assert states(result)["mean"] == "right"
    assert states(result)["physics"] == "skipped"


@pytest.mark.parametrize(
    "known, message",
    [
        ({"domain": "disc"}, "did you mean 'disk'"),
        ({"domain": "set:0"}, "domain is 'set:0': expected"),
        ({"domain": "line:2,1"}, "domain is 'line:2,1': expected"),
        ({"domain": "cube x disk"}, "expected"),
        ({"domain": "disk", "eta": 1.5}, "eta is given"),
        ({"domain": "set:4", "numbers": 7}, "at most 6"),
    ],
)
def test_what_is_refused(known, message):
    with pytest.raises(ValueError, match=message):
        crescent.check(disk(np.sqrt), uniform_in_disk, **known)


def test_points_outside_are_named():
    result = crescent.check(lambda u: (2 * u - 1, 1 / np.pi), uniform_in_disk, domain="disk")
    valid = next(v for v in result.verdicts if v.name == "valid")
    assert valid.state == "wrong"
    assert "outside the unit disk" in valid.message


def test_an_arm_draws_directions():
    e = crescent.parse(TINY)
    e.samplers["lens"] = crescent.Sampler(disk(np.sqrt), uniform_in_disk, domain="disk")
    with pytest.raises(ValueError, match="an arm draws directions"):
        crescent.run(e)


FILE = """
import numpy as np
domain = "line:0,1"
numbers = 1
def sample(u):
    x = np.sqrt(u[:, 0])
    return x, 2 * x
def pdf(x):
    return 2 * x
"""


def test_a_file_states_its_domain(tmp_path, monkeypatch):
    (tmp_path / "ramp.py").write_text(FILE)
    result = crescent.check(str(tmp_path / "ramp.py"))
    assert result.state == "right"
    program = Path(crescent.__file__).parent / "bin" / "crescent"
    if not program.exists():
        pytest.skip("the command is not in this build")
    monkeypatch.setenv("CRESCENT_PYTHON", sys.executable)
    run = subprocess.run([program, "check", str(tmp_path / "ramp.py"), "--quiet"], capture_output=True, text=True)
    assert run.returncode == 0, run.stdout + run.stderr


def test_an_estimator_of_a_number():
    def roulette(u):
        return np.where(u[:, 0] < 0.05, 20.0, 0.0)

    known = {"domain": "number", "numbers": 1}
    assert crescent.check(roulette, estimates=1.0, **known).state == "right"
    assert crescent.check(roulette, estimates=1.1, **known).state == "wrong"
    against = crescent.Sampler(lambda u: 2 * u[:, 0], **known)
    assert crescent.check(roulette, against=against, **known).state == "right"
    with pytest.raises(TypeError, match="expected either estimates"):
        crescent.check(roulette, **known)
    with pytest.raises(TypeError, match="estimates is for a sampler whose draws are values"):
        crescent.check(disk(np.sqrt), uniform_in_disk, domain="disk", estimates=1.0)
    heavy = crescent.check(lambda u: 0.3 * u[:, 0] ** -0.7, estimates=1.0, **known)
    assert states(heavy)["mean"] == "inconclusive"


def reservoirs(loss):
    """Of eight cosine-distributed candidates one is kept in proportion to the target over its pdf."""
    rng = np.random.default_rng(5)

    def target(wo, wi):
        return np.maximum(wi[:, 2], 0) * (0.2 + np.maximum(wi @ np.array([0.6, 0, 0.8]), 0) ** 8)

    def sample(wo, u):
        n = len(wo)
        kept, total = np.tile([0.0, 0.0, 1.0], (n, 1)), np.zeros(n)
        for _ in range(8):
            a = rng.random((n, 2))
            r, phi = np.sqrt(a[:, 0]), 2 * np.pi * a[:, 1]
            wi = np.column_stack([r * np.cos(phi), r * np.sin(phi), np.sqrt(1 - a[:, 0])])
            weight = target(wo, wi) / np.maximum(wi[:, 2] / np.pi, 1e-12)
            total += weight
            take = rng.random(n) * total < weight
            kept[take] = wi[take]
        count = 8 * (1 + loss * (rng.random(n) < 0.05) / 0.05)
        return kept, total / count / np.maximum(target(wo, kept), 1e-30)

    return {"sample": sample, "target": target, "weight": "reciprocal", "own_random": True, "domain": "hemisphere"}


@pytest.mark.parametrize("loss, state", [(0.0, "right"), (0.03, "wrong")])
def test_reservoirs(loss, state):
    result = crescent.check(wo_deg=40, **reservoirs(loss))
    assert result.state == state
    if loss:
        assert "light is lost" in next(v.message for v in result.verdicts if v.name == "mean")
    with pytest.raises(TypeError, match="go together"):
        crescent.check(disk(np.sqrt), weight="reciprocal")


def merged(fault=""):
    """Each surface has one uniform candidate; one of them is kept at the receiver, all have Lambert's target."""
    rng = np.random.default_rng(11)

    def targets(wi, neighbours):
        n = np.concatenate([np.broadcast_to([0.0, 0.0, 1.0], (len(wi), 1, 3)), neighbours[:, :, 3:6]], axis=1)
        light = np.concatenate([np.ones((len(wi), 1)), neighbours[:, :, 6]], axis=1)
        return light * np.maximum(np.einsum("nkc,nc->nk", n, wi), 0), n

    def sample(wo, u, neighbours):
        kept, total = np.tile([0.0, 0.0, 1.0], (len(wo), 1)), np.zeros(len(wo))
        for k in range(neighbours.shape[1] + 1):
            wi = rng.normal(size=(len(wo), 3))
            wi /= np.linalg.norm(wi, axis=1, keepdims=True)
            _, n = targets(wi, neighbours)
            wi *= np.sign(np.sum(wi * n[:, k], axis=1))[:, None]
            there, _ = targets(wi, neighbours)
            balance = there[:, k] / np.maximum(there.sum(axis=1), 1e-30)
            mis = 1 / there.shape[1] if fault == "1/M" else balance
            weight = np.where(there[:, k] > 0, mis * there[:, k if fault == "source" else 0] * 2 * np.pi, 0)
            total += weight
            take = rng.random(len(wo)) * total < weight
            kept[take] = wi[take]
        dead = 1 - 0.14 * (fault == "dead") * (rng.random(len(wo)) < 0.05)  # one of seven counted in vain
        return kept, dead * total / np.maximum(targets(kept, neighbours)[0][:, 0], 1e-30)

    return {
        "sample": sample,
        "target": lambda wo, wi: np.maximum(wi[:, 2], 0),
        "weight": "reciprocal",
        "merge": True,
        "own_random": True,
    }


@pytest.mark.parametrize(
    "fault, cause", [("", ""), ("dead", ""), ("1/M", "1/M bias"), ("source", "the target of its source surface")]
)
def test_merged_reservoirs(fault, cause):
    result = crescent.check(wo_deg=30, **merged(fault))
    assert result.state == ("wrong" if fault else "right")
    if fault:
        mean = next(v for v in result.verdicts if v.name == "mean")
        assert "light is lost" in mean.message or "light is gained" in mean.message
        assert cause in mean.cause


def test_what_is_wrong_with_a_merge_is_said():
    with pytest.raises(ValueError, match="expected 1 to 64 neighbours"):
        crescent.check(neighbours=0, **merged())
    with pytest.raises(ValueError, match="merge is given: it is for directions"):
        crescent.check(disk(np.sqrt), uniform_in_disk, domain="disk", merge=True)
    with pytest.raises(ValueError, match="its neighbours are arrays of NumPy"):
        crescent.check(array_module="torch", **merged())
