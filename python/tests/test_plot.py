"""Figures and tables of a result: what they show is what was measured."""

import re

import numpy as np
import pytest

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")

import crescent  # noqa: E402
from crescent import plot  # noqa: E402
from crescent._intervals import best_of, fitted_slope, log_interval, t_quantile  # noqa: E402
from tiny import TINY  # noqa: E402


@pytest.fixture(scope="module")
def result():
    return crescent.run(crescent.parse(TINY.replace("seeds = 2", "seeds = 3")), seeds=(1, 3))


@pytest.mark.parametrize(
    ("p", "freedom", "x"), [(0.975, 1, 12.70620), (0.975, 3, 3.18245), (0.95, 5, 2.01505), (0.975, 30, 2.04227)]
)
def test_t_quantiles_are_those_of_tables(p, freedom, x):
    assert t_quantile(p, freedom) == pytest.approx(x, rel=1e-5)


def test_an_interval_of_the_mean_covers_it_as_often_as_it_states():
    rng = np.random.default_rng(7)
    held = 0
    for _ in range(1000):
        low, high = log_interval(np.exp(rng.normal(0.3, 0.2, 4)))
        held += low <= np.exp(0.3) <= high
    assert 925 <= held <= 972
    assert log_interval([1.0]) is None


def test_a_slope_is_that_of_the_power_law():
    n = np.array([4, 16, 64])
    slope = fitted_slope(n, [np.array([2.0, 3.0]) * k**-0.5 for k in n])
    assert slope.value == pytest.approx(-0.5) and slope.half == pytest.approx(0, abs=1e-9)


def test_only_significant_differences_are_ranked():
    one = np.array([1.0, 1.2, 0.9, 1.1])
    assert best_of({"a": one, "b": one * np.array([1.3, 1.31, 1.29, 1.3])}) == {"a"}
    assert best_of({"a": one, "b": one[::-1]}) == {"a", "b"}
    assert best_of({"a": one[:1], "b": one[:1]}) == set()


def test_no_arm_is_bold_beside_a_better_one():
    one, zero = np.array([1.0, 1.2, 0.9, 1.1]), np.zeros(4)
    assert best_of({"a": one, "none": zero, "b": one + 3}) == {"none"}
    assert best_of({"none": zero, "some": np.array([0.0, 1, 0, 0])}) == {"none", "some"}
    assert best_of({"a": one, "b": one + 5, "once": np.array([0.1])}) == set()
    assert best_of({"a": one, "b": one + 5, "broken": np.array([0.1, np.nan, 0.1, 0.1])}) == set()
    assert best_of({"a": np.full(4, 5.0), "b": np.full(4, 4.0)}) == {"b"}


def test_the_interval_of_a_slope_over_seeds_has_its_coverage():
    rng, n, held = np.random.default_rng(5), np.array([4, 16, 64]), 0
    for _ in range(1000):
        slope = fitted_slope(n, [k**-0.5 * np.exp(rng.normal(0, 0.1, 4)) for k in n])
        held += abs(slope.value + 0.5) <= slope.half
    assert 925 <= held <= 972


def test_a_ladder_draws_the_medians_of_every_arm(result):
    ax = plot.ladder(result)
    rows = [r for r in result.records() if r["metric"] == "rmse" and r["s"] == result.s]
    for line in ax.get_lines():
        arm = line.get_label().split(":")[0]
        for n, y in zip(line.get_xdata(), line.get_ydata()):
            region = rows[0]["region"]
            over = [r["value"] for r in rows if (r["arm"], r["n"], r["region"]) == (arm, n, region)]
            assert y == pytest.approx(np.median(over))
    assert "N" in ax.get_xlabel() and "RMSE" in ax.get_ylabel()


def test_every_figure_is_drawn_and_saved_with_its_text(result, tmp_path):
    arm, n = next((f.arm, f.n) for f in result.films.values())
    other = next(f.arm for f in result.films.values() if f.arm != arm and (f.arm, n) in result.films)
    height, width = result.films[arm, n].y.shape
    axes = [
        plot.bars(result), plot.heat(result, arm, n), plot.heat(result, arm, n, what="var"),
        plot.where_noise_moved(result, arm, other, n, tile=2), *plot.crops(result, n, [0, 0, width, height // 2]),
        plot.hemisphere(lambda wo, wi: wi[:, 2] / np.pi, lambda wo, wi: wi[:, 2]),
    ]  # fmt: skip
    for k, ax in enumerate(axes):
        for kind in ("pdf", "svg", "png"):
            plot.save(ax, tmp_path / f"{k}.{kind}")
        assert b"/FontFile2" in (tmp_path / f"{k}.pdf").read_bytes(), "fonts are embedded as TrueType"


def test_heat_shows_rows_top_down(result):
    arm, n = next((f.arm, f.n) for f in result.films.values())
    image = plot.heat(result, arm, n, what="var").images[0].get_array()
    np.testing.assert_array_equal(image, result.films[arm, n].var[::-1])


def test_a_table_has_every_arm_and_count_and_says_where_it_comes_from(result):
    text = result.to_latex()
    rows = [r for r in result.records() if r["metric"] == "rmse" and r["s"] == result.s]
    for arm in {r["arm"] for r in rows}:
        assert arm.replace("_", r"\_") in text
    for n in {r["n"] for r in rows}:
        assert f"$N = {n}$" in text
    assert result.metrics["provenance"]["experiment"]["hash"] in text.splitlines()[0]
    with pytest.raises(KeyError, match="rmse"):
        result.to_latex("rsme")


def test_a_data_frame_has_the_records(result):
    pytest.importorskip("pandas")
    assert result.to_pandas().to_dict("records")[0]["arm"] == result.records()[0]["arm"]


def test_unknown_names_are_errors_with_what_there_is(result):
    with pytest.raises(KeyError, match="there are"):
        plot.ladder(result, metric="rsme")
    with pytest.raises(KeyError, match="no arm"):
        plot.bars(result, arms=["nobody"])
    with pytest.raises(ValueError, match=r"box is \[0, 0, 0, 1\]: expected .* with x0 < x1"):
        plot.heat(result, *next((f.arm, f.n) for f in result.films.values()), box=[0, 0, 0, 1])


@pytest.mark.parametrize(
    ("use", "said"),
    [
        (lambda r: plot.ladder(r, arms="phong"), r"^arms is 'phong': expected a list of names, \['phong'\]"),
        (lambda r: plot.ladder(r, labels={"phnog": "Ours"}), "labels has 'phnog'.*did you mean 'phong'"),
        (lambda r: plot.ladder(r, labels=["Ours"]), r"^labels is \['Ours'\]: expected a dictionary by arm"),
        (lambda r: plot.bars(r, colours={"phnog": "red"}), "colours has 'phnog'.*did you mean 'phong'"),
        (lambda r: plot.bars(r, colours={"phong": "rde"}), r"^colours\['phong'\] is 'rde': expected a colour"),
        (lambda r: plot.bars(r, against="time", budget="1"), "^budget is '1': expected an amount above 0"),
        (lambda r: plot.heat(r, "phnog", 4), "did you mean 'phong'"),
        (lambda r: plot.heat(r, "phong", 4, box=[3, 4]), r"^box is \[3, 4\]: expected a box \[x0, y0, x1, y1\]"),
        (lambda r: plot.crops(r, 4, [3, 4]), r"^box is \[3, 4\]: expected a box"),
        (lambda r: plot.significance(r, "cosine", "phong", 4, tile=1), "^tile is 1: expected 2 or more pixels"),
        (lambda r: plot.where_noise_moved(r, "cosine", "phong", 4, tile=0), "^tile is 0: expected 1 or more pixels"),
        (lambda r: plot.page(r, "ball"), r"^insets is 'ball': expected a list of regions and boxes, \['ball'\]"),
        (lambda r: plot.page(r, ["bal"]), "insets has 'bal'.*did you mean 'ball'"),
        (lambda r: plot.page(r, [[1, 2, 3]]), r"insets is \[1, 2, 3\]: expected a box"),
        (lambda r: plot.page(r, show="grid"), "^show is 'grid': expected a list of picture"),
        (lambda r: r.to_latex(labels={"phnog": "Ours"}), "labels has 'phnog'.*did you mean 'phong'"),
        (lambda r: r.to_latex(budgets=[3]), "^budgets has 3: no arm has rmse at this N: N are"),
        (lambda r: r.to_latex(against="time", budgets=[-3]), "^a budget of budgets is -3: expected an amount above 0"),
        (lambda r: r.to_latex(digits=0), "^digits is 0: expected 1 to 17 digits"),
    ],
)
def test_nothing_that_is_given_to_a_figure_is_ignored(result, use, said):
    with pytest.raises((KeyError, ValueError, TypeError)) as raised:
        use(result)
    assert re.search(said, raised.value.args[0]), raised.value.args[0]


def test_a_table_has_no_empty_column(result):
    lines = result.to_latex("flip", against="rays").splitlines()
    rows = [line.rstrip(" \\").split(" & ")[1:] for line in lines if line.startswith(("cosine &", "phong &"))]
    assert rows and all(any(cell != "--" for cell in column) for column in zip(*rows, strict=True))


def test_a_legend_covers_no_line(result):
    ax = plot.ladder(result)
    ax.figure.canvas.draw()
    assert ax.get_legend().get_window_extent().y1 <= ax.get_xaxis().label.get_window_extent().y0


def test_a_colour_scale_is_no_higher_than_the_picture(result):
    film = next(iter(result.films.values()))
    ax = plot.heat(result, film.arm, film.n, what="var")
    ax.figure.canvas.draw()
    picture, scale = ax.get_window_extent(), ax.child_axes[0].get_window_extent()
    assert picture.y0 - 1 < scale.y0 and scale.y1 < picture.y1 + 1


def test_the_smallest_is_ranked_only_where_it_is_the_best(result):
    assert r"\mathbf" not in result.to_latex("y_mean")


def test_a_density_of_another_shape_is_an_error():
    with pytest.raises(ValueError, match=r"integrand: shape \(8, 8\), expected"):
        plot.hemisphere(lambda wo, wi: wi[:, 2] / np.pi, lambda wo, wi: wi[:, 2] * wi[:, 2:])
