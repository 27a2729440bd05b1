"""crescent.compare and the fixture render_regression."""

from importlib.metadata import entry_points

import numpy as np
import pytest

import crescent

pytest_plugins = ["pytester"]
#: An installed package's plugin is loaded automatically.
LOAD = () if entry_points(group="pytest11", name="crescent") else ("-p", "crescent.pytest_plugin")


def renders(seed, count=6, *, scale=1.0, sd=0.2, size=32):
    rng = np.random.default_rng(seed)
    return (scale * rng.gamma(1 / sd**2, sd**2, (count, size, size, 3))).astype(np.float32)


def test_arrays_are_compared():
    result = crescent.compare(renders(1), renders(2), smallest="5 %")
    assert result.state == "same" and result.exit_code == 0
    assert list(result.views) == ["view"]
    changed = crescent.compare(renders(1), renders(2, scale=1.05), smallest=0.05, name="crown")
    assert changed.state == "changed" and changed.exit_code == 1
    assert changed.views["crown"].state == "changed"
    assert "crown" in changed.to_markdown() and "changed" in changed.to_markdown()
    found = changed.views["crown"].numbers["means"]["frame"]
    assert abs(found["candidate"] / found["baseline"] - 1.05) < 0.01


def test_views_and_regions():
    result = crescent.compare(
        {"a": renders(1), "b": renders(3)},
        {"a": list(renders(2)), "c": renders(4)},
        smallest=0.2,
        regions={"corner": (0, 0, 7, 7)},
    )
    assert {name: view.state for name, view in result.views.items()} == {"a": "same", "b": "missing", "c": "new"}
    assert result.state == "missing" and result.exit_code == 1
    assert set(result.views["a"].numbers["means"]) == {"corner", "frame"}


def test_rows_run_from_the_top():
    brighter = renders(2)
    brighter[:, :8, :8] *= 2
    result = crescent.compare(renders(1), brighter, smallest=0.1, regions={"top": (0, 24, 7, 31)})
    top = result.views["view"].numbers["means"]["top"]
    assert top["candidate"] / top["baseline"] > 1.9


def test_files_are_compared(tmp_path):
    for k, (a, b) in enumerate(zip(renders(1), renders(2))):
        np.save(tmp_path / f"a{k}.npy", a)
        np.save(tmp_path / f"b{k}.npy", b)
    files = sorted(tmp_path.glob("b*.npy"))
    assert crescent.compare(f"{tmp_path}/a*.npy", files, smallest=0.05, out=tmp_path / "out").state == "same"
    assert (tmp_path / "out" / "report.html").stat().st_size > 10_000
    for k, (a, b) in enumerate(zip(renders(3), renders(4))):
        np.save(tmp_path / f"old-v{k}.npy", a)
        np.save(tmp_path / f"new-v{k}.npy", b)
    suite = tmp_path / "suite.toml"
    suite.write_text('[suite]\nsmallest = 0.05\nbaseline = "old-{view}?.npy"\ncandidate = "new-{view}?.npy"\n')
    result = crescent.compare(suite)
    assert set(result.views) == {"v"} and result.state == "same"
    (tmp_path / "new-v0.npy").write_bytes(b"no array")
    assert crescent.compare(suite).state == "unreadable"
    suite.write_text('[suite]\nbaseline = "old-{view}?.npy"\ncandidate = "old-{view}?.npy"\n')
    with pytest.raises(ValueError, match="both sides"):
        crescent.compare(suite)


def test_views_have_any_names():
    names = ["a/b", "a_b", "a%2fb", ".hidden", "x[1]", "*", 'say "hi"', "{view}"]
    same = {name: renders(2 * k) for k, name in enumerate(names)}
    other = {name: renders(2 * k + 1) for k, name in enumerate(names)}
    result = crescent.compare(same, other, smallest=0.5, regions={"corner": (0, 0, 7, 7)})
    assert sorted(result.views) == sorted(names)
    assert all(view.state == "same" and view.name == name for name, view in result.views.items())
    for name in ("", "x" * 300):
        with pytest.raises(ValueError, match="name of a view"):
            crescent.compare({name: renders(1)}, {name: renders(2)})


def test_bad_input_is_a_value_error(tmp_path):
    with pytest.raises(ValueError, match="found none"):
        crescent.compare(f"{tmp_path}/*.exr", renders(1))
    with pytest.raises(ValueError, match=r"shape \(32, 32\)"):
        crescent.compare(renders(1)[0, :, :, 0], renders(2))
    with pytest.raises(ValueError, match="expected 32 x 32 pixels"):
        crescent.compare(renders(1), renders(2, size=16))
    with pytest.raises(ValueError, match="suite.smallest"):
        crescent.compare(renders(1), renders(2), smallest="much")
    with pytest.raises(ValueError, match="candidate: expected"):
        crescent.compare(renders(1))


TEST = """
import numpy as np

def renders(seed, scale):
    return scale * np.random.default_rng(seed).gamma(25, 1 / 25, (6, 32, 32))

def test_lamp(render_regression):
    render_regression(renders({seed}, {scale}), smallest=0.05)
"""


def test_the_folder_of_a_fixture_is_no_pattern(pytester):
    folder = pytester.mkdir("run{1}%2f*")
    (folder / "test_scene.py").write_text(TEST.replace("{seed}", "1").replace("{scale}", "1"))
    pytester.runpytest_subprocess(*LOAD, "--crescent-accept", str(folder)).assert_outcomes(passed=1)
    assert (folder / "test_scene" / "test_lamp-moments.exr").exists()
    pytester.runpytest_subprocess(*LOAD, str(folder)).assert_outcomes(passed=1)


def test_the_fixture_compares_with_what_was_accepted(pytester):
    def run(seed, scale, *options):
        pytester.makepyfile(test_scene=TEST.replace("{seed}", str(seed)).replace("{scale}", str(scale)))
        return pytester.runpytest_subprocess(*LOAD, *options)

    run(1, 1).stdout.fnmatch_lines(["*no baseline in *--crescent-accept*"])
    run(1, 1, "--crescent-accept", "--crescent-because", "first").assert_outcomes(passed=1)
    folder = pytester.path / "test_scene"
    assert (folder / "test_lamp-moments.exr").exists()
    assert '"because": "first"' in (folder / "baseline.json").read_text()
    run(2, 1).assert_outcomes(passed=1)
    changed = run(2, 1.05)
    changed.assert_outcomes(failed=1)
    changed.stdout.fnmatch_lines(["*test_lamp: changed*"])
    run(2, 1.05, "--crescent-accept").assert_outcomes(passed=1)
    run(3, 1.05).assert_outcomes(passed=1)
