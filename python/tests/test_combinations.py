"""Combinations of samplers from Python, checks of arms of an experiment, and a whole study in 30 lines of NumPy."""

import itertools
import os
import signal
import time

import numpy as np
import pytest
from samplers import cosine
from test_callable_arms import difference, phong, with_samplers
from tiny import TINY

import crescent


def phong_pdf(wo, wi, ctx):
    cos = np.maximum(np.sum(wo * [-1, -1, 1] * wi, axis=1), 0)
    return (ctx.s + 1) / (2 * np.pi) * cos**ctx.s


def cosine_pdf(wo, wi):
    return np.maximum(wi[:, 2], 0) / np.pi


MINE = crescent.Sampler(phong, phong_pdf, uses=("s",))


def agrees(measured, arm, n):
    film, reference = measured.films[arm, n], measured.references[measured.s]["y"]
    error = np.sqrt(film.var.sum(dtype=float))
    return abs(film.y.sum(dtype=float) - reference.sum(dtype=float)) < 4 * error


def test_a_run_warns_of_weights_of_mis_that_lose_light():
    e = with_samplers(both=crescent.mis("cosine", "light-area", weights=[0.5, 0.5]))
    with pytest.warns(UserWarning, match="both: 'light-area' has MIS weight where its density is 0"):
        crescent.run(e)


def test_mis_of_a_sampler_in_python_with_the_lights_agrees_with_the_reference():
    e = with_samplers(mine=MINE)
    e.samplers["both"] = crescent.mis("mine", "cosine", "light-area", heuristic="power")
    e.samplers["one"] = crescent.mis("mine", "cosine", "light-area", draw="one", probabilities=[0.25, 0.5, "rest"])
    e.samplers["half"] = crescent.mixture("mine", "cosine", weights=["min(rho_s / (rho_s + rho_d), 0.9)", "rest"])
    e.samplers["resampled"] = crescent.ris("mine", "cosine", "light-area", candidates=6)
    measured = crescent.run(e, seeds=(1, 1))
    for arm in ("both", "one", "half", "resampled"):
        assert agrees(measured, arm, 16), arm
    assert measured.metric("bad", "both", 16).mean == 0


def cubes(wo, wi, p):
    return p**3 / (p**3).sum(axis=1, keepdims=True)


def test_mis_with_a_function_for_its_weights_has_the_film_of_the_same_formulas(tmp_path):
    names = ("mine", "cosine", "light-area")
    total = "(p1^3 + p2^3 + p3^3)"
    e = with_samplers(mine=MINE)
    e.samplers["formulas"] = crescent.mis(*names, weights=[f"p1^3 / {total}", f"p2^3 / {total}", f"p3^3 / {total}"])
    e.samplers["function"] = crescent.mis(*names, weights=cubes)
    e.samplers["of-one"] = crescent.mis(*names, weights=cubes, draw="one", probabilities=[0.25, 0.5, "rest"])
    measured = crescent.run(e, seeds=(1, 1))
    assert difference(measured.films["formulas", 16], measured.films["function", 16]) < 1e-3
    assert agrees(measured, "function", 16) and agrees(measured, "of-one", 16)
    assert crescent.check(e, sampler="function", pixels=2).state != "wrong"


def test_a_function_for_the_weights_uses_the_surface_and_its_rows_sum_to_one():
    e = with_samplers()

    def by_exponent(wo, wi, p, ctx):
        share = np.where(ctx.s > 1, 0.25, 0.75)[:, None] * [1, 0] + [0, 1] * np.where(ctx.s > 1, 0.75, 0.25)[:, None]
        return share * p / (share * p).sum(axis=1, keepdims=True)

    e.samplers["both"] = crescent.mis("cosine", "light-area", weights=by_exponent, uses=("s",))
    assert agrees(crescent.run(e, seeds=(1, 1)), "both", 16)
    balance = e.hash
    e.samplers["both"] = crescent.mis("cosine", "light-area")
    assert e.hash != balance
    for weights, words in (
        (lambda wo, wi, p: 0 * p + 0.4, r"both: weights: row 0 is \[0.4, 0.4\], whose sum is 0.8"),
        (lambda wo, wi, p: p[:, 0], r"both: weights: shape \(\d+,\), expected"),
    ):
        e.samplers["both"] = crescent.mis("cosine", "light-area", weights=weights)
        with pytest.raises(ValueError, match=words):
            crescent.run(e, seeds=(1, 1))
    with pytest.raises(TypeError, match="expected one of them"):
        crescent.mis("cosine", "phong", heuristic="power", weights=cubes)
    with pytest.raises(TypeError, match="functions weight mis alone"):
        crescent.mixture("cosine", "phong", weights=cubes)


def test_a_file_names_a_function_for_the_weights(tmp_path):
    (tmp_path / "own_weights.py").write_text("def equal(wo, wi, p):\n    return 0 * p + 0.5\n")
    arm = '\n[arms.both]\nkind = "mis"\nof = ["cosine", "uniform"]\nweights_python = "own_weights.py:equal"\nn = [16]\n'
    file = tmp_path / "t.toml"
    file.write_text(TINY + arm)
    assert agrees(crescent.run(file, seeds=(1, 1)), "both", 16)
    with pytest.raises(ValueError, match=r"t\.toml:\d+:\d+: arms\.both\.weights_python: with --no-code"):
        crescent.run(file, seeds=(1, 1), code=False)


def test_a_mixture_with_a_copy_of_phong_has_the_film_of_the_built_in_mixture():
    e = with_samplers({"arms.mixture.n": [64]}, mine=MINE)
    e.samplers["half"] = crescent.mixture("mine", "cosine", weights=["min(rho_s / (rho_s + rho_d), 0.9)", "rest"])
    measured = crescent.run(e, seeds=(1, 1))
    assert difference(measured.films["mixture", 64], measured.films["half", 64]) < 1


def test_a_combination_of_a_sampler_without_a_pdf_is_refused():
    e = with_samplers(mine=crescent.Sampler(cosine))
    e.samplers["both"] = crescent.mixture("mine", "cosine")
    with pytest.raises(ValueError, match=r"arms\.both\.of.*no pdf"):
        crescent.run(e, seeds=(1, 1))


@pytest.mark.parametrize(
    ("combination", "words"),
    [
        (crescent.mixture("cosine", "phong", weights=[0.5, 0.25]), "whose sum is one"),
        (crescent.mis("cosine", "phongg"), "did you mean 'phong'"),
        (crescent.ris("cosine", candidates=0), "from 1 to 4096"),
    ],
)
def test_a_wrong_combination_is_a_value_error(combination, words):
    e = with_samplers()
    e.samplers["both"] = combination
    with pytest.raises(ValueError, match=words):
        crescent.run(e, seeds=(1, 1))


def test_weights_that_do_not_sum_to_one_are_located_in_the_file():
    text = TINY + '\n[arms.both]\nkind = "mixture"\nof = ["cosine", "phong"]\nweights = [0.5, 0.25]\nn = [4]\n'
    line = text[: text.index("weights")].count("\n") + 1
    with pytest.raises(ValueError, match=rf"t\.toml:{line}:11: arms\.both\.weights: .*sum is one"):
        crescent.parse(text, "t.toml")


def test_a_sampler_is_checked_at_pixels_and_on_the_grid():
    e = with_samplers(mine=MINE)
    e.samplers["both"] = crescent.mis("mine", "cosine", "light-area")
    seen = []

    def watched(wo, u, ctx):
        seen.append((float(wo[0, 2]), float(ctx.s[0])))
        return phong(wo, u, ctx)

    e.samplers["mine"] = crescent.Sampler(watched, phong_pdf, uses=("s",))
    result = crescent.check(e, sampler="both", pixels=3)
    assert result.state != "wrong", str(result)
    assert len({v.case for v in result.verdicts}) == 3
    assert len(seen) > 3
    wrong = crescent.Sampler(phong, lambda wo, wi, ctx: 2 * phong_pdf(wo, wi, ctx), uses=("s",))
    e.samplers["mine"] = wrong
    assert crescent.check(e, sampler="mine", pixels=2).state == "wrong"


def test_an_arm_is_checked_at_given_w_o_and_against_another_arm():
    e = with_samplers(mine=MINE)
    e.samplers["flat"] = crescent.Sampler(cosine, cosine_pdf)
    result = crescent.check(e, sampler="flat", pixels=2, wo_deg=[30, (60, 250)])
    assert result.state != "wrong", str(result)
    assert {v.case.split(",")[0] for v in result.verdicts} == {"w_o 30 deg az 0", "w_o 60 deg az 250"}
    assert len({v.case for v in result.verdicts}) == 4
    same = crescent.check(e, sampler="mine", against="phong", wo_deg=30, pixels=1, expect_same=True)
    assert same.of("same_distribution")[0].state == "right", str(same)
    other = crescent.check(e, sampler="mine", against="cosine", wo_deg=30, pixels=1, expect_same=True)
    assert other.state == "wrong"
    with pytest.raises(ValueError, match="--against cosin.*did you mean 'cosine'"):
        crescent.check(e, sampler="mine", against="cosin")
    with pytest.raises(ValueError, match="under the surface"):
        crescent.check(e, sampler="mine", wo_deg=150)


def test_an_arm_without_a_pdf_is_checked_by_the_weights_of_its_draws():
    def twice(wo, u):
        wi, p = cosine(wo, u)
        return wi, 2 * p

    e = with_samplers(mine=crescent.Sampler(cosine), twice=crescent.Sampler(twice))
    right = crescent.check(e, sampler="mine", pixels=1, wo_deg=30)
    assert right.state == "right", str(right)
    assert right.of("mean")[0].state == "right"
    assert right.of("density")[0].state == "skipped"
    wrong = crescent.check(e, sampler="twice", pixels=1, wo_deg=30)
    assert wrong.of("mean")[0].state == "wrong", str(wrong)
    e.samplers["both"] = crescent.mis("mine", "light-area")
    with pytest.raises(ValueError, match="'mine' has no pdf of a direction, which a combination needs"):
        crescent.check(e, sampler="both", pixels=1)


def test_check_names_the_arms_that_there_are():
    with pytest.raises(ValueError, match="did you mean 'cosine'"):
        crescent.check(with_samplers(), sampler="cosin", pixels=2)
    with pytest.raises(TypeError, match="pixels are of an experiment"):
        crescent.check(cosine, pixels=2)


def test_an_interrupted_run_keeps_the_complete_seeds(tmp_path):
    calls = itertools.count(1)
    signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored in background jobs of a shell

    def slow(wo, u):
        call = next(calls)  # of any thread
        time.sleep(0.05)
        if call == 20:
            os.kill(os.getpid(), signal.SIGINT)
        return cosine(wo, u)

    e = with_samplers({"seeds": 40}, slow=crescent.Sampler(slow))
    with pytest.raises(crescent.RunInterrupted) as found:
        crescent.run(e, out=tmp_path / "part")
    part = found.value.result
    assert isinstance(found.value, KeyboardInterrupt)
    seeds = {r["seed"] for r in part.records()}
    assert 1 <= len(seeds) < 40
    assert (tmp_path / "part" / "metrics.json").is_file()
    whole = crescent.run(crescent.parse(TINY), seeds=(1, 1))
    assert np.array_equal(part.films["cosine", 16].y, whole.films["cosine", 16].y)


def test_times_and_efficiencies_have_values():
    e = with_samplers({"seeds": 3})
    r = crescent.run(e, repeats=3)
    assert all(t > 0 for t in r.times.values()) and "cosine" in r.times
    region = next(row["region"] for row in r.records() if row["region"])
    for metric in ("rmse", "bias2", "efficiency_n", "efficiency_time"):
        found = r.metric(metric, "cosine", 16, region)
        assert len(found.values) == 3 and found.half is not None
    by_hand = r.metric("var", "cosine", 16, region).values[0] * 16
    assert r.metric("efficiency_n", "cosine", 16, region).values[0] == pytest.approx(1 / by_hand)


# The study of a researcher: 30 lines from here on.
def study(tmp_path):
    def basis(axis):
        helper = np.where(np.abs(axis[:, :1]) < 0.9, [1.0, 0, 0], [0, 1.0, 0])
        t = np.cross(helper, axis)
        t /= np.linalg.norm(t, axis=1, keepdims=True)
        return t, np.cross(axis, t)

    def sample(wo, u, ctx):  # a cone about R, even over solid angle, wide enough for the lobe
        r = wo * [-1, -1, 1]
        t, b = basis(r)
        least = 1 - 8 / (ctx.s + 1)
        cos, phi = 1 - u[:, 0] * (1 - least), 2 * np.pi * u[:, 1]
        sin = np.sqrt(1 - cos * cos)
        wi = (sin * np.cos(phi))[:, None] * t + (sin * np.sin(phi))[:, None] * b + cos[:, None] * r
        return wi, 1 / (2 * np.pi * (1 - least))

    def pdf(wo, wi, ctx):
        least = 1 - 8 / (ctx.s + 1)
        cos = np.sum(wo * [-1, -1, 1] * wi, axis=1)
        return np.where(cos >= least, 1 / (2 * np.pi * (1 - least)), 0)

    e = crescent.parse(TINY).with_({"seeds": 3})
    e.samplers["cone"] = crescent.Sampler(sample, pdf, uses=("s",))
    e.samplers["both"] = crescent.mis("cone", "cosine", "light-area", heuristic="balance")
    r = crescent.run(e)
    verdicts = crescent.check(e, sampler="both", pixels=4)
    return r, verdicts


def test_a_new_sampler_by_mis_with_the_lights_in_30_lines(tmp_path):
    r, verdicts = study(tmp_path)
    assert agrees(r, "both", 16)
    assert verdicts.state != "wrong", str(verdicts)
    assert ("cone", 16) in r.films and ("both", 16) in r.films
    table = r.to_latex("rmse")
    assert "both" in table and r"\toprule" in table
    plot = pytest.importorskip("crescent.plot")
    pytest.importorskip("matplotlib")
    ax = plot.ladder(r)
    assert ax.collections, "a ladder of several seeds has bands"
    plot.save(ax, tmp_path / "ladder.pdf")
    assert (tmp_path / "ladder.pdf").stat().st_size > 1000


def test_a_light_is_checked_with_its_radiance():
    least = 0.8

    def sample(u):
        z, phi = 1 - (1 - least) * u[:, 0], 2 * np.pi * u[:, 1]
        r = np.sqrt(1 - z * z)
        return np.stack([r * np.cos(phi), r * np.sin(phi), z], -1), np.full(len(u), 1 / (2 * np.pi * (1 - least)))

    def pdf(wi):
        return np.where(wi[:, 2] > least, 1 / (2 * np.pi * (1 - least)), 0)

    def radiance(wi):
        return np.where(wi[:, 2] > least, 3 + wi[:, 0], 0)

    assert crescent.check(crescent.Sampler(sample, pdf, radiance=radiance)).state == "right"
    wider = crescent.check(sample, pdf, radiance=lambda wi: np.where(wi[:, 2] > 0.7, 3.0, 0), name="lamp")
    assert wider.state == "wrong" and any("support" in name for name in wider.broken())
    with pytest.raises(TypeError, match="a light has its radiance alone"):
        crescent.Sampler(sample, pdf, lambda wo, wi: 1, radiance=radiance)
