"""The figure page: every part is there, every text is readable, and nothing overlaps."""

import itertools

import numpy as np
import pytest

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")

import crescent  # noqa: E402
from crescent import plot  # noqa: E402
from crescent._intervals import _p_values, differ, rounded, t_of, t_quantile  # noqa: E402
from crescent._tables import latex  # noqa: E402
from crescent._values import best_in, compared_at, values_of  # noqa: E402
from tiny import TINY  # noqa: E402

METRIC = "metric"
NINE = [f"{k}-an-arm-of-24-letters-{k}" for k in "abcdefghi"]


@pytest.fixture(scope="module")
def nine():
    e = crescent.parse(TINY.replace("seeds = 2", "seeds = 3"))
    for k, name in enumerate(NINE):
        e.samplers[name] = crescent.mixture("cosine", "uniform", weights=[(k + 1) / 10, "rest"])
    e.samplers["candidates"] = crescent.ris("phong", "cosine", candidates=9, n=[4, 16])
    return crescent.run(e)


def texts(figure):
    """Every visible text of a figure with its box in pixels; of ticks, those that are drawn."""
    figure.draw_without_rendering()
    hidden = set()
    for axis in (axis for ax in figure.axes for axis in (ax.xaxis, ax.yaxis)):
        drawn = {id(tick) for tick in axis._update_ticks()}
        ticks = (tick for tick in [*axis.majorTicks, *axis.minorTicks] if id(tick) not in drawn)
        hidden |= {id(label) for tick in ticks for label in (tick.label1, tick.label2)}
    found = [t for t in figure.findobj(matplotlib.text.Text) if t.get_visible() and id(t) not in hidden]
    return [(t.get_text(), t.get_window_extent()) for t in found if t.get_text().strip()]


@pytest.mark.parametrize("columns", [1, 2])
@pytest.mark.parametrize("against", ["n", "time"])
@pytest.mark.parametrize("letters", ["of the arms", "wide"])
def test_names_of_nine_arms_never_overlap(nine, columns, against, letters, tmp_path):
    names = NINE if letters == "of the arms" else [chr(ord("A") + k) + 23 * "W" for k in range(9)]
    assert all(len(name) == 24 for name in names)
    labels = dict(zip(NINE, names, strict=True))
    figure = plot.page(nine, ["ball", (0, 0, 20, 16)], arms=NINE, columns=columns, against=against, labels=labels)
    bars = next(ax for ax in figure.axes if ax.patches and not ax.images)
    assert bars.get_xlim()[1] < 4 * max(bar.get_x() + bar.get_width() for bar in bars.patches), "no room for names"
    found = texts(figure)
    width, height = figure.get_size_inches() * figure.dpi
    for text, box in found:
        assert box.x0 >= -0.5 and box.x1 <= width + 0.5 and box.y0 >= -0.5 and box.y1 <= height + 0.5, text
    for (a, first), (b, second) in itertools.combinations(found, 2):
        apart = (
            first.x1 <= second.x0 + 1
            or second.x1 <= first.x0 + 1
            or first.y1 <= second.y0 + 1
            or second.y1 <= first.y0 + 1
        )
        assert apart, (a, first, b, second)
    words = "".join(text for text, _ in found)
    for name in names:
        assert words.count(name) >= 1, "in one line at the bars"
    plot.save(figure, tmp_path / "page.pdf")
    data = (tmp_path / "page.pdf").read_bytes()
    box = data[data.index(b"/MediaBox") :].split(b"]")[0].split()
    assert float(box[-2]) == pytest.approx({1: 85, 2: 178}[columns] * 72 / 25.4, abs=0.5)
    assert b"/FontFile2" in data


def test_a_page_has_the_insets_of_every_method_and_the_reference_last(nine):
    arms = ["cosine", "phong"]
    figure = plot.page(nine, ["ball", (0, 0, 20, 16)], arms=arms, labels={"phong": "Ours"}, n=4)
    pictures = [ax for ax in figure.axes if ax.images]
    assert len(pictures) == 1 + 2 * 3
    x0, y0, x1, y1 = nine.boxes["ball"]
    grid = [np.asarray(ax.images[0].get_array()) for ax in pictures[1:]]
    assert grid[0].shape[:2] == (y1 - y0 + 1, x1 - x0 + 1) and grid[3].shape[:2] == (16, 20)
    reference = nine.references[nine.s]["g"]
    shown = plot.tone(reference[y0 : y1 + 1, x0 : x1 + 1][::-1].astype(float))
    np.testing.assert_allclose(grid[2][..., 1], shown, atol=1e-6)
    words = [text for text, _ in texts(figure)]
    left = {text: box.x0 for text, box in texts(figure) if box.y1 < figure.dpi * 1.2 * figure.get_size_inches()[1]}
    assert left["Reference"] > left["Ours"] and "cosine" in words and "phong" not in words


def test_arms_are_told_apart_in_grey(nine):
    looks = [plot._look(nine, arm) for arm in NINE]
    assert len({(look.marker, look.dashes) for look in looks}) == len({look.hatch for look in looks}) == 9


def test_at_equal_time_an_expensive_arm_has_fewer_samples(nine):
    compared = compared_at(nine, "rmse", "ball", None, ["cosine", "candidates"], "time", None, None)
    at = {arm: compared.costs.of(arm, n) for arm, n in compared.n.items()}
    assert at["cosine"] == pytest.approx(at["candidates"]) == pytest.approx(compared.cost)
    half = compared_at(nine, "rmse", "ball", None, ["cosine"], "time", None, compared.costs.of("cosine", 8))
    low, high = (nine.metric("rmse", "cosine", n, "ball").values for n in (4, 16))
    np.testing.assert_allclose(half.values["cosine"], np.sqrt(np.multiply(low, high)))
    for against in ("time", "rays"):
        ax = plot.ladder(nine, arms=["cosine", "candidates"], against=against)
        line = ax.get_lines()[0]
        np.testing.assert_allclose(
            line.get_xdata(), [compared.costs.of("cosine", n) for n in (4, 16)]
        ) if against == "time" else None
        assert ("time [" in ax.get_xlabel()) == (against == "time")
    with pytest.raises(TypeError, match="expected budget="):
        plot.bars(nine, n=4, against="time")
    with pytest.raises(ValueError, match="expected one of 'n', 'time', 'rays'"):
        plot.bars(nine, against="seconds")


def test_an_arm_without_such_samples_stays_in_the_bars(nine):
    ax = plot.bars(nine, arms=["cosine", "phong"], n=16)
    assert [t.get_text() for t in ax.get_yticklabels()] == ["phong", "cosine"]
    assert "no N = 16" in [t.get_text() for t in ax.texts]


def test_wrong_arguments_are_errors(nine):
    for wrong, said in (
        ({"insets": ["bal"]}, "insets has 'bal'"),
        ({"insets": [(0, 0, 500, 4)]}, r"insets is \[0, 0, 500, 4\]: expected .* x0 < x1 <= 48"),
        ({"labels": {"nobody": "x"}}, "labels has 'nobody'"),
        ({"columns": 3}, "expected 1 or 2"),
        ({"show": ["bar"]}, "show has 'bar'"),
        ({"picture": "nobody"}, "picture is 'nobody'"),
    ):
        with pytest.raises((KeyError, ValueError), match=said):
            plot.page(nine, **wrong)


def test_a_table_at_equal_time_has_every_arm_and_says_how_it_was_measured(nine):
    text = nine.to_latex("rmse", against="time", arms=["cosine", "candidates"], labels={"candidates": "RIS & Co"})
    assert "RIS \\& Co" in text and f"{nine.threads} threads" in text and " -- " not in text
    assert len([line for line in text.splitlines() if line.endswith(r"\\")]) == 4
    values = values_of(nine, "efficiency_time", "ball", None)["cosine"][16]
    np.testing.assert_allclose(values, nine.metric("efficiency_time", "cosine", 16, "ball").values)
    with pytest.raises(KeyError, match="bias2 of ball, .*did you mean 'relmse'"):
        nine.to_latex("rel_mse")
    assert plot.bars(nine, "relmse").get_xlabel().startswith("relMSE, region ball at N")
    assert nine.to_latex("efficiency_time", against="n").count("efficiency at equal time") == 1


def test_numbers_are_rounded_by_their_intervals():
    for mean, half, shown in (
        (6.69, 15.62, ("7", "16")),
        (0.4567, 0.0123, ("0.457", "0.012")),
        (0.4567, 0.0999, ("0.46", "0.10")),
        (1234.5, 45.6, ("1234", "46")),
        (12345.0, 456.0, ("12340", "460")),
        (3e-9, 2e-10, ("3.00e-9", "0.20e-9")),
        (0.0, 0.1, ("0.00", "0.10")),
        (0.123, None, ("0.123", None)),
    ):
        assert rounded(mean, half) == shown


def test_what_is_not_significantly_worse_than_the_best_is_bold():
    one = np.array([1.0, 1.2, 0.9, 1.1])
    assert best_in({"a": one, "b": one[::-1], "c": one * 3}, "rmse") == {"a", "b"}
    assert best_in({"a": one, "b": one[::-1], "c": one * 3}, "efficiency_time") == {"c"}
    assert best_in({"zero": 0 * one, "a": one}, "rmse") == {"zero"} and best_in({"a": one, "b": one}, "y_mean") == set()


class Named:
    """A result whose numbers are given: two arms, one of value 0, one with a heavy tail."""

    s, threads, provenance = 32.0, 2, "made for a test"
    films, references, boxes = {}, {}, {}

    def records(self):
        values = {"none": 0.0, "heavy": 3.0, "plain": 2.0}
        key = METRIC
        out = [
            {
                "arm": arm,
                "n": n,
                "s": 32.0,
                "seed": seed,
                key: "rmse",
                "region": "",
                "value": v * n**-0.5 * (1 + seed / 50),
            }
            for arm, v in values.items()
            for n in (4, 16)
            for seed in (1, 2, 3)
        ]
        return [*out, {"arm": "heavy", "n": 4, "s": 32.0, "seed": 1, key: "tail_k", "region": "", "value": 0.8}]


def test_an_arm_of_value_0_stays_and_a_heavy_tail_is_named():
    r = Named()
    ax = plot.ladder(r)
    labels = [line.get_label() for line in ax.get_lines()]
    assert "none: 0" in labels and any("heavy tail" in label for label in labels)
    edge = next(line for line in ax.get_lines() if line.get_gid() == "0")
    assert list(edge.get_xdata()) == [4, 16]
    shown = plot.bars(r)
    assert [t.get_text() for t in shown.get_yticklabels()] == ["heavy", "plain", "none"]
    assert any("heavy tail" in t.get_text() for t in shown.texts)
    text = latex(r, "rmse", None, 32.0, True, 3)
    rows = {line.split(" & ")[0]: line for line in text.splitlines() if " & " in line}
    assert r"\mathbf{0}" in rows["none"] and r"\mathbf" not in rows["plain"] and r"\dagger" in rows["heavy"]
    assert "heavy tail" in text.splitlines()[-2]


def test_false_discoveries_are_rare_and_differences_are_found():
    rng = np.random.default_rng(3)
    noise = rng.normal(size=(20, 20, 64))
    assert differ(noise).mean() < 0.01
    moved = noise.copy()
    moved[:10] += 1.0
    found = differ(moved)
    assert found[:10].all() and found[10:].mean() < 0.1
    for quantile in (0.9, 0.975, 0.9999):
        assert _p_values(np.array(t_quantile(quantile, 63)), 63) == pytest.approx(2 * (1 - quantile), rel=1e-3)
    assert np.isnan(t_of(np.zeros((2, 8)))).all() and not differ(np.zeros((2, 8))).any()


def test_maps_share_a_scale_and_show_what_they_say(nine):
    axes = plot.heat(nine, ["cosine", "phong"], 4, "relative")
    drawn = [ax.images[0] for ax in axes]
    assert drawn[0].get_clim() == drawn[1].get_clim()
    reference = nine.references[nine.s]["y"]
    shown = drawn[0].get_array()[::-1]
    lit = reference > 0
    error = np.abs(nine.films["cosine", 4].y - reference)
    np.testing.assert_allclose(np.asarray(shown)[lit], error[lit] / reference[lit])
    assert drawn[0].cmap(0.0)[:3] > (0.9, 0.9, 0.7), "0 is light"
    every = plot.where_noise_moved(nine, "cosine", "phong", 4, tile=4).images[0].get_array()
    only = plot.where_noise_moved(nine, "cosine", "phong", 4, tile=4, significant=True).images[0].get_array()
    assert ((only == every) | (only == 0) | ~np.isfinite(every)).all()
    t = plot.significance(nine, "cosine", "phong", 4, tile=4).images[0].get_array()
    assert t.shape == every.shape
    for wrong in ({"what": "err"}, {"background": "grey"}):
        with pytest.raises(ValueError, match="expected"):
            plot.heat(nine, "cosine", 4, **wrong)


def test_rows_of_pictures_with_long_names_do_not_overlap(nine):
    names = list(dict.fromkeys(film.arm for film in nine.films.values()))
    assert len(names) > 9
    for axes in (plot.crops(nine, 16, [0, 0, 24, 16]), plot.heat(nine, names, 4)):
        figure = axes[0].figure
        figure.canvas.draw()
        boxes = [box for ax in axes for box in (ax.title.get_window_extent(), ax.xaxis.label.get_window_extent())]
        boxes = [box for box in boxes if box.width > 1]
        assert len(boxes) >= len(axes) > 9
        for k, box in enumerate(boxes):
            assert not any(box.overlaps(other) for other in boxes[k + 1 :]), (k, box)


def test_maps_of_arms_with_long_names_do_not_overlap(nine):
    for draw in (plot.where_noise_moved, plot.significance):
        ax = draw(nine, NINE[0], NINE[8], 16, labels={NINE[0]: 24 * "W", NINE[8]: "M" * 24})
        boxes = [box for text, box in texts(ax.figure) if len(text) > 8]
        assert len(boxes) == 2 and not boxes[0].overlaps(boxes[1])
        assert ax.get_window_extent().width > 0.4 * ax.figure.get_window_extent().width
    ax = plot.ladder(nine, arms=NINE, labels={name: 24 * "W" for name in NINE})
    ax.figure.draw_without_rendering()
    assert ax.get_window_extent().width > 0.6 * ax.figure.get_window_extent().width


def test_times_state_their_threads_and_crops_name_heavy_tails(nine, monkeypatch):
    threads = f"{nine.threads} thread"
    assert threads in plot.bars(nine, against="time").get_xlabel() and threads not in plot.bars(nine).get_xlabel()
    crops = plot.crops(nine, None, [0, 0, 8, 8], against="time")
    assert threads in crops[0].get_xlabel() and not any("heavy" in ax.get_xlabel() for ax in crops)
    monkeypatch.setattr(plot, "heavy_arms", lambda *_: {"cosine"})
    crops = plot.crops(nine, 16, [0, 0, 8, 8])
    assert [ax.get_title()[:6] for ax in crops if "heavy tail" in ax.get_xlabel()] == ["cosine"]


def test_an_arm_without_variance_has_an_infinite_efficiency(nine):
    r = crescent.experiments.Measured(nine._core)
    rows = nine.records()
    for row in rows:
        if row["metric"] == "var" and row["arm"] == "cosine":
            row["value"] = 0.0
    r._rows = rows
    for metric in ("efficiency_n", "efficiency_time"):
        assert str(r.metric(metric, "cosine", 16, "ball")) == "∞"
        table = next(line for line in r.to_latex(metric, "ball").splitlines() if line.startswith("cosine"))
        assert table == r"cosine & $\mathbf{\infty}$ & $\mathbf{\infty}$ \\"
        ax = plot.bars(r, metric, "ball", arms=["cosine", "phong", NINE[0]], n=4)
        assert [t.get_text() for t in ax.get_yticklabels()][-1] == "cosine" and ax.texts[-1].get_text() == "∞"
        ax = plot.ladder(r, metric, "ball")
        edge = [line for line in ax.get_lines() if line.get_gid() == "∞"]
        assert len(edge) == 1 and list(edge[0].get_xdata()) == [4, 16]
        assert np.isfinite(ax.get_ylim()).all()
        plot.page(r, metric=metric).draw_without_rendering()


def test_an_efficiency_at_another_cost_is_that_of_the_nearest_count(nine):
    compared = compared_at(nine, "efficiency_n", "ball", None, ["phong", "cosine"], "n", 4, None)
    rays = compared_at(nine, "efficiency_n", "ball", None, ["phong", "cosine"], "rays", None, 64.0)
    np.testing.assert_array_equal(compared.values["phong"], rays.values["phong"])


def test_a_table_compiles_with_any_label(nine, monkeypatch):
    monkeypatch.setattr(crescent._tables, "heavy_arms", lambda *_: {"cosine"})
    rows = nine.records()
    for row in rows:
        row["value"] = row["value"] * 1e9 if row["metric"] == "rmse" else row["value"]
    r = crescent.experiments.Measured(nine._core)
    r._rows = rows
    table = r.to_latex("rmse", "ball", labels={"cosine": "a^b ~ \\c {d}_e\n"}, arms=["cosine"])
    row = next(line for line in table.splitlines() if line.startswith("a"))
    assert row.startswith(r"a\textasciicircum{}b \textasciitilde{} \textbackslash{}c \{d\}\_e  & ")
    assert r"\times 10^{" in row and "}^{" not in row.replace("{}^{", ""), "a second superscript"
