"""load, parse and run: films without a copy, records, and the file's own checks; arms, BRDFs and tails as functions."""

import copy
import json
import os
import pickle
import re
import signal

import numpy as np
import pytest
from samplers import cosine, cosine_pdf, sphere, sphere_pdf
from tiny import TINY

import crescent


@pytest.fixture(scope="module")
def measured():
    return crescent.run(crescent.parse(TINY))


def test_an_experiment_is_read_and_changed_with_the_files_own_checks(tmp_path):
    e = crescent.parse(TINY, "tiny.toml")
    assert e["image.width"] == 48 and e["shapes.ball"]["s"] == 32
    before = e.hash
    e["shapes.ball.s"] = 8
    assert e["shapes.ball.s"] == 8 and e.hash != before
    assert e.with_({"shapes.ball.s": 32}).hash == before
    with pytest.raises(ValueError, match="widht"):
        e["image.widht"] = 9
    with pytest.raises(ValueError, match="image.width"):
        e["image.width"] = -1
    with pytest.raises(KeyError, match="image has width, height"):
        e["image.depth"]
    assert pickle.loads(pickle.dumps(e)) == e
    (tmp_path / "tiny.toml").write_text(e.text)
    assert crescent.load(tmp_path / "tiny.toml") == e
    with pytest.raises(ValueError, match="t.toml:1:"):
        crescent.parse("x = ", "t.toml")


def test_an_experiment_of_a_relative_path_works_in_any_folder(tmp_path, monkeypatch):
    figures = {"source": "a note", "runs": []}
    (tmp_path / "files").mkdir()
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "files" / "tiny.toml").write_text('published = "figures.json"\n' + TINY)
    (tmp_path / "files" / "figures.json").write_text(json.dumps(figures))
    monkeypatch.chdir(tmp_path)
    e = crescent.load("files/tiny.toml")
    first = e.hash
    monkeypatch.chdir(tmp_path / "elsewhere")
    assert e["published"] == str(tmp_path / "files" / "figures.json")
    e["image.width"] = 47
    assert e["image.width"] == 47 and e.hash != first
    e["image.width"] = 48
    del e["arms.cosine"]
    e["arms.cosine.n"] = [4, 16]
    assert e.with_({}) == e == pickle.loads(pickle.dumps(e)) == copy.deepcopy(e)
    with pytest.raises(ValueError, match="^--set image.width=-1"):
        e["image.width"] = -1
    assert crescent.run(e, seeds=(1, 1)).holds


def test_what_can_be_set_can_be_read_by_the_same_path():
    e = crescent.parse(TINY)
    values = {
        "title": "a ball beside 'it'",
        "ball.radius": 0.6,  # begins at a name, as --set accepts it
        "shapes.ball.center": [0, 0.7, 0.1],
        "ball.center[1]": 0.68,
        "camera.eye.2": 3.1,
        "key.radiance": [80, 70, 60],
        "assertions.'the lobe is better'.check": "rmse.ball(phong, n=4) < 90",
        "cosine.n": [4, 8],
        "cosine.n[1]": 16,
        "seeds": 3,
    }
    for path, value in values.items():
        e[path] = value
        assert e[path] == value and path in e, path
    assert e["ball.center"] == [0, 0.68, 0.1] and e["key"] == e["disks.key"] and e["cosine"]["n"] == [4, 16]
    assert "the lobe is better" in e
    e["assertions"] = {'a = b. "x"': {"check": "rmse.ball(phong, n=4) < 80"}}
    assert e["assertions"]['a = b. "x"']["check"].endswith("< 80")
    assert list(e["assertions"]) == ['a = b. "x"'], "a table replaces the one that was there"


def test_values_that_a_shape_inherits_can_be_read():
    e = crescent.parse(TINY)
    e["shapes.floor"] = {"kind": "plane", "point": [0, 0, 0], "normal": [0, 1, 0], "rho_d": [0.5] * 3}
    assert e["floor.s"] == e["ball.s"] == 32
    e["ball.s"] = 8
    assert e["floor.s"] == 8


@pytest.mark.parametrize(
    "path, said",
    [
        ("image.widht", "image has .*did you mean 'width'"),
        ("imag.width", "did you mean 'image'"),
        ("bal.radius", "the names .*did you mean 'ball'"),
        ("ball.radus", "shapes.ball has .*did you mean 'radius'"),
        ("camera.eye[3]", "camera.eye has items 0 to 2"),
        ("camera.eye.x", "camera.eye has items 0 to 2"),
        ("seed.x", "seed has no keys"),
        ("ball", None),  # a shape and a region
        ("", "expected a path"),
    ],
)
def test_a_wrong_key_is_an_error_with_the_nearest_valid_word(path, said):
    e = crescent.parse(TINY)
    with pytest.raises(KeyError, match=said or "ambiguous: expected shapes.ball or regions.ball"):
        e[path]
    assert path not in e
    if said:
        with pytest.raises(ValueError, match="did you mean|expected"):
            e[path] = 3


def test_tables_are_set_and_taken_out():
    e = crescent.parse(TINY)
    assert "arms.phong" in e and "arms.uniform" not in e and "image" in list(e)
    before = e.hash
    e["arms.uniform"] = {"n": [4, 8]}
    assert e["arms.uniform.n"] == [4, 8] and e.hash != before
    del e["arms.uniform"]
    assert "arms.uniform" not in e and e.hash == before
    with pytest.warns(UserWarning, match='also removed.*assertions."the lobe is better"'):
        del e["arms.phong"]
    assert "arms.phong" not in e and "assertions" not in e
    with pytest.raises(KeyError, match="arms has cosine"):
        del e["arms.uniform"]


@pytest.mark.parametrize(
    "known, said", [({"seeds": 0}, "seeds is 0"), ({"seeds": (1,)}, "first and the last"), ({"threads": -1}, "threads")]
)
def test_what_run_cannot_do_is_a_value_error(known, said):
    with pytest.raises(ValueError, match=said):
        crescent.run(crescent.parse(TINY), **known)


def test_a_number_of_seeds_is_that_of_the_experiment(measured):
    three = crescent.run(crescent.parse(TINY), seeds=3)
    assert len({row["seed"] for row in three.records()}) == 3 == three.metrics["bands"][0]["seeds"]
    assert crescent.run(crescent.parse(TINY), seeds=2).records() == measured.records()


def test_films_are_the_memory_of_the_run(measured):
    film = measured.films["cosine", 16]
    assert film.y.shape == (32, 48) and film.y.dtype == np.float32 and film.rgb.shape == (32, 48, 3)
    assert not film.y.flags.owndata and not film.y.flags.writeable
    assert set(measured.films) == {("cosine", 4, 32.0), ("cosine", 16, 32.0), ("phong", 4, 32.0)}
    reference = measured.references[32.0]["y"]
    assert reference.shape == (32, 48)
    box = np.s_[8:25, 16:33]  # both ends of a region's box are inclusive
    rmse = float(np.sqrt(np.mean((film.y[box].astype(float) - reference[box]) ** 2)))
    told = [r for r in measured.records() if (r["arm"], r["n"], r["seed"], r["metric"]) == ("cosine", 16, 7, "rmse")]
    assert told[0]["region"] == "ball" and told[0]["value"] == pytest.approx(rmse, rel=1e-5)
    for key in (("phong", 5), "phong"):
        with pytest.raises(KeyError, match="there are cosine n=4"):
            measured.films[key]
    assert repr(film) == "<Film cosine n=16 s=32 seed=7: 48 x 32>"


def test_films_outlive_their_run_and_threads_change_no_bit(measured):
    one = crescent.run(crescent.parse(TINY), threads=1).films["phong", 4]
    assert np.array_equal(one.y, measured.films["phong", 4].y)


def test_metrics_are_records_json_and_xarray(measured):
    assert measured.holds and measured.metrics["bands"]
    assert len({r["seed"] for r in measured.records()}) == 2
    xarray = pytest.importorskip("xarray")
    data = measured.to_xarray()
    assert isinstance(data, xarray.Dataset) and data.rmse.dims == ("arm", "n", "s", "seed", "region")
    assert np.isnan(data.rmse.sel(arm="phong", n=16)).all() and (data.rmse.sel(arm="phong", n=4) > 0).all()


def test_records_have_numbers_as_numbers(measured):
    kinds = {"arm": str, "n": int, "s": float, "seed": int, "metric": str, "region": str}
    for row in measured.records():
        assert {key: type(row[key]) for key in kinds} == kinds
        whole = row["metric"] in ("fireflies", "pixels", "tail_exceedances", "bad", "rays", "f_evaluations")
        assert row["value"] is None or type(row["value"]) is (int if whole else float), row
    changed = crescent.parse(TINY).with_({"fill.radiance": [1, 2, 3], "image.width": 40, "title": "x", "n": 16})
    row = crescent.run(changed, seeds=(1, 1)).records()[0]
    assert row["fill.radiance"] == [1, 2, 3] and row["image.width"] == 40 and row["title"] == "x"
    assert row["set.n"] == 16


@pytest.mark.parametrize("again", [copy.copy, copy.deepcopy, lambda it: pickle.loads(pickle.dumps(it))])
def test_what_a_run_found_can_be_pickled_and_copied(measured, again, tmp_path):
    other = again(measured)
    assert other.metrics == measured.metrics and other.records() == measured.records()
    assert other.times == measured.times and other.threads == measured.threads
    assert other.holds == measured.holds and repr(other) == repr(measured)
    assert set(other.films) == set(measured.films) and set(other.references) == set(measured.references)
    for key, film in measured.films.items():
        for name, plane in film.planes.items():
            same = other.films[key].planes[name]
            assert np.array_equal(same, plane) and same.dtype == plane.dtype
    for s, planes in measured.references.items():
        assert all(np.array_equal(other.references[s][name], plane) for name, plane in planes.items())
    film = again(measured.films["cosine", 16])
    assert np.array_equal(film.y, measured.films["cosine", 16].y) and film.n == 16
    for folder, run in (("first", measured), ("second", other)):
        run.write(tmp_path / folder)
    written = [p.relative_to(tmp_path / "first") for p in (tmp_path / "first").rglob("*.*") if p.is_file()]
    films = [p for p in written if p.suffix == ".exr"]
    assert len(films) == 2
    for p in films:
        assert (tmp_path / "first" / p).read_bytes() == (tmp_path / "second" / p).read_bytes()


def test_a_folder_is_written_as_one(measured, tmp_path):
    measured.write(tmp_path / "out")
    names = {
        str(p.relative_to(tmp_path / "out"))
        for p in (tmp_path / "out").rglob("*.*")
        if p.is_file() and "/." not in str(p)
    }
    assert {"metrics.json", "metrics.csv", "junit.xml", "films/cosine.exr", "films/phong.exr"} <= names
    (tmp_path / "file").write_text("")
    with pytest.raises(OSError):
        measured.write(tmp_path / "file")


def test_a_result_is_opened_as_it_was_written(measured, tmp_path):
    measured.write(tmp_path / "out")
    again = crescent.open(tmp_path / "out")
    assert again.metrics == measured.metrics and again.records() == measured.records()
    assert again.provenance == measured.provenance and again.holds == measured.holds and again.boxes == measured.boxes
    assert again.times == measured.times and again.threads == measured.threads > 0
    for key, film in measured.films.items():
        assert all(np.array_equal(again.films[key].planes[name], plane) for name, plane in film.planes.items())
    for s, planes in measured.references.items():
        assert all(np.array_equal(again.references[s][name], plane) for name, plane in planes.items())
    again.write(tmp_path / "again")
    for path in (tmp_path / "out").rglob("*.*"):
        if path.is_file() and "/." not in str(path) and path.suffix != ".npz":
            assert path.read_bytes() == (tmp_path / "again" / path.relative_to(tmp_path / "out")).read_bytes(), path
    with pytest.raises(ValueError, match="expected a folder of a result"):
        crescent.open(tmp_path)


def test_results_show_themselves(measured):
    page = measured._repr_html_()
    assert page.count("data:image/png") == 2 and "the lobe is better" in page and "RMSE ball" in page
    assert "48 x 32" in measured.films["cosine", 16]._repr_html_()
    assert "4, 16" in crescent.parse(TINY)._repr_html_()


def test_parts_of_the_seeds_join_to_the_whole(measured, tmp_path):
    crescent.run(crescent.parse(TINY), seeds=(1, 1), out=tmp_path / "first")
    crescent.run(crescent.parse(TINY), seeds=(2, 2), out=tmp_path / "second")
    joined = crescent.join([tmp_path / "second", tmp_path / "first/metrics.json"], out=tmp_path / "joined")
    whole, got = dict(measured.metrics), dict(joined.metrics)
    assert whole.pop("provenance")["seeds"] == got.pop("provenance")["seeds"]
    assert whole == got and joined.holds == measured.holds and joined.records() == measured.records()
    assert (tmp_path / "joined/metrics.csv").exists() and set(joined.films) == set(measured.films)
    assert all(np.array_equal(joined.films[key].y, film.y) for key, film in measured.films.items())
    assert set(joined.references) == set(measured.references) and len(joined._core.times) == len(measured._core.times)
    with pytest.raises(ValueError, match="other experiment"):
        other = crescent.parse(TINY).with_({"ball.s": 31})
        crescent.run(other, seeds=(2, 2), out=tmp_path / "other")
        crescent.join([tmp_path / "first", tmp_path / "other"])


def test_ctrl_c_ends_a_run(interruptible):
    e = crescent.parse(TINY).with_({"arms.cosine.n": [1 << 20], "image.width": 480, "image.height": 320})
    asked = []

    def once(what, done, total):
        if not asked:
            asked.append(what)
            os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        crescent.run(e, progress=once)


def test_arms_are_vectorised_functions():
    rng = np.random.default_rng(1)
    u, wo = rng.random((1000, 2)), [0.6, 0.0, 0.8]
    phong = crescent.arm("phong", brdf="phong", s=32)
    wi, p = phong.sample(wo, u)
    assert wi.shape == (1000, 3) and np.allclose(np.linalg.norm(wi, axis=1), 1, atol=1e-6)
    up = wi[:, 2] > 0
    assert np.allclose(phong.pdf(wo, wi)[up], p[up], rtol=1e-4)
    assert np.allclose(crescent.arm("cosine").f(wo, wi)[up], 0.5 / np.pi)
    ggx = crescent.brdf("ggx", alpha=0.2, rho_d=0)
    assert np.allclose(ggx(wo, wi), crescent.arm("ggx-d", brdf="ggx", alpha=0.2, rho_d=0).f(wo, wi))
    assert np.allclose(crescent.brdf()([0, 0, 1], [0, 0, 1]), 0.5 / np.pi)
    assert crescent.check(phong, wo_deg=[30]).of("density")[0].state == "right"
    assert "phong" in crescent.arm_names() and "ggx" in crescent.brdf_names()
    for bad in (
        *(dict(name="phon"), dict(name="light-area"), dict(name="phong", brdf="gxg")),
        *(
            dict(name="phong", s=-1),
            dict(name="phong", s=np.nan),
            dict(name="ggx-d", alpha=2),
            dict(name="cosine", rho_d=3),
        ),
    ):
        with pytest.raises(ValueError):
            crescent.arm(**bad)
    for wo_, u_, said in (
        ([0, 0], [0.5, 0.5], "wo: shape"),
        ([0, 0, 1], [0.5, 0.5, 0.5], "u: shape"),
        ([[0, 0, 1], [0, np.nan, 1]], [0.5, 0.5], "wo: row 1"),
        ([0, 0, 1], [[0.5, 0.5]] * 3 + [[0.5, 1.5]], "u: row 3"),
    ):
        with pytest.raises(ValueError, match=said):
            phong.sample(wo_, u_)
    with pytest.raises(ValueError, match="3 rows and 2"):
        phong.pdf(np.ones((3, 3)), np.ones((2, 3)))


def test_the_tail_of_weights():
    u = np.random.default_rng(5).random(100_000)
    heavy = crescent.tail(u**-0.8)  # Pareto with k = 0.8
    assert abs(heavy.k - 0.8) < 4 * heavy.se and heavy.heavy
    assert not crescent.tail(u).heavy and crescent.tail(np.ones(1000)) is None
    with pytest.raises(ValueError, match="row 2"):
        crescent.tail([1, 2, np.nan])


def test_the_density_of_a_warp_by_differences():
    u = np.random.default_rng(2).uniform(0.05, 0.95, (1000, 2))
    wi, p = crescent.pdf_of(cosine)(np.tile([0, 0, 1.0], (1000, 1)), u)
    assert np.allclose(p, cosine_pdf(None, wi), rtol=1e-4)
    edge = np.array([[0.5, 0.0], [0.5, 1.0], [0.0, 0.5]])
    assert np.allclose(crescent.pdf_of(cosine)(None, edge)[1][:2], np.sqrt(0.5) / np.pi, rtol=1e-3)
    sky = crescent.Sampler(sphere, sphere_pdf, wo="none")
    assert np.allclose(crescent.pdf_of(sky)(None, u)[1], 1 / (4 * np.pi), rtol=1e-4)
    with pytest.raises(ValueError, match="u: shape"):
        crescent.pdf_of(cosine)(None, np.full((4, 3), 0.5))


def test_flip_is_measured_of_the_first_seeds_and_joined(tmp_path):
    e = crescent.parse(TINY.replace("seeds = 2", "seeds = 3\nflip_seeds = 2"))
    whole = crescent.run(e)
    rows = [r for r in whole.records() if r["metric"] == "flip"]
    seeds = list(dict.fromkeys(r["seed"] for r in whole.records()))
    assert {r["seed"] for r in rows} == set(seeds[:2]) and all(0 <= r["value"] <= 1 for r in rows)
    assert len({(r["arm"], r["region"], r["seed"]) for r in rows}) == len(rows), "one sample count"
    row = next(r for r in rows if r["seed"] == seeds[0])
    found = whole.metric("flip", row["arm"], row["n"], row["region"], row["s"])
    assert len(found.values) == 2 and found.half is not None
    x0, y0, x1, y1 = whole.boxes[row["region"]]
    film, reference = whole.films[row["arm"], row["n"], row["s"]], whole.references[row["s"]]
    planes = [np.ascontiguousarray(of[c]) for of in (reference, film.planes) for c in "rgb"]
    everywhere = crescent._crescent.flip(*planes)
    assert row["value"] == pytest.approx(everywhere[y0 : y1 + 1, x0 : x1 + 1].mean(dtype=float), rel=1e-6)
    bands = {b["metric"]: b["seeds"] for b in whole.metrics["bands"]}
    assert bands[f"flip.{row['region']}"] == 2
    for k in (1, 3):
        crescent.run(e, seeds=(k, min(k + 1, 3)), out=tmp_path / str(k))
    joined = crescent.join([tmp_path / "1", tmp_path / "3"])
    assert [r for r in joined.records() if r["metric"] == "flip"] == rows
    assert joined.metrics["bands"] == whole.metrics["bands"]


@pytest.mark.parametrize(
    ("use", "said"),
    [
        (lambda m: m.metric("rmes", "phong", 4, "ball"), "did you mean 'rmse'"),
        (lambda m: m.metric("rmse", "phong", 4, "bal"), "did you mean 'ball'"),
        (lambda m: m.metric("rmse", "phnog", 4, "ball"), "did you mean 'phong'"),
        (lambda m: m.metric("rmse", "phong", 5, "ball"), "there are n=4 s=32"),
        (lambda m: m.to_latex("rmes"), "did you mean 'rmse'"),
        (lambda m: m.to_latex(arms=["phnog"]), "did you mean 'phong'"),
        (lambda m: m.films["phong", 4].z, "expected one of r, g, b, y"),
    ],
)
def test_a_number_or_plane_that_a_result_lacks_is_answered_by_the_nearest(use, said):
    with pytest.raises((KeyError, AttributeError), match=said):
        use(crescent.run(crescent.parse(TINY), seeds=1))


def test_a_damaged_result_is_named(tmp_path):
    crescent.run(crescent.parse(TINY), seeds=1, out=tmp_path / "out")
    (tmp_path / "out" / "arrays.npz").write_bytes(b"xx")
    with pytest.raises(ValueError, match="arrays.npz: is damaged"):
        crescent.open(tmp_path / "out")


def test_parts_of_another_sampler_are_not_joined(tmp_path):
    def sampler(factor):
        return lambda wo, u: (wo, factor * u[:, 0])

    for k, factor in enumerate((1.0, 1.0, 2.0)):
        e = crescent.parse(TINY)
        e.samplers["mine"] = crescent.Sampler(sampler(factor), n=4)
        crescent.run(e, seeds=(1 + (k > 0), 1 + (k > 0)), out=tmp_path / str(k))
    assert crescent.join([tmp_path / "0", tmp_path / "1"]).samplers == crescent.open(tmp_path / "0").samplers
    with pytest.raises(ValueError, match="2: cannot be joined with .*0: the sampler 'mine' is .* there and .* here"):
        crescent.join([tmp_path / "0", tmp_path / "2"])


@pytest.mark.parametrize(
    ("use", "said"),
    [
        (lambda m: crescent.run(TINY), "'title = .*: expected a file; crescent.parse reads text"),
        (lambda m: crescent.run(crescent.parse(TINY), seeds=(1, 2.5)), r"^seeds is 2.5: expected whole numbers"),
        (lambda m: crescent.run(crescent.parse(TINY), out=3), "^out is 3: expected the path of a folder"),
        (lambda m: crescent.join(["a"], out=3), "^out is 3: expected the path of a folder"),
        (lambda m: crescent.open(3), "^folder is 3: expected the path of a folder"),
        (lambda m: m.films["cosin", 4], r"did you mean 'cosine'\?$"),
        (lambda m: m.films["cosine", 5], r"n=16 s=32, phong n=4 s=32$"),
        (lambda m: m.to_latex(s=5), "^nothing at s = 5: there are s = 32$"),
    ],
)
def test_wrong_arguments_are_named(measured, use, said):
    with pytest.raises((TypeError, ValueError, KeyError)) as raised:
        use(measured)
    assert re.search(said, raised.value.args[0]), raised.value.args[0]


def test_films_alone_have_a_provenance():
    films = crescent.run(crescent.parse(TINY), references=False)
    assert films.records() == [] and "1 seed from 7" in films.provenance
