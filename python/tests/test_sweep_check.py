"""Checks over a grid: of samplers in files, of built-in ones, and of the arms of an experiment."""

import subprocess
import sys

import pytest

import crescent

for needed in ("dask", "distributed", "pyarrow"):
    pytest.importorskip(needed)

import pyarrow.parquet as parquet  # noqa: E402
from crescent._sweep.dataset import read  # noqa: E402
from samplers import cosine_pdf  # noqa: E402
from tiny import TINY  # noqa: E402

COMMAND = [sys.executable, "-m", "crescent._sweep"]
POWER = """
import numpy as np

class Power:
    def __init__(self, k=1.0, factor=1.0):
        self.k, self.factor = k, factor

    def sample(self, wo, u):
        z = u[:, 0] ** (1 / (self.k + 1))
        r, phi = np.sqrt(1 - z * z), 2 * np.pi * u[:, 1]
        wi = np.stack([r * np.cos(phi), r * np.sin(phi), z], -1)
        return wi, self.pdf(wo, wi)

    def pdf(self, wo, wi):
        z = np.maximum(wi[:, 2], 0)
        return self.factor * (self.k + 1) / (2 * np.pi) * z**self.k
"""
MADE = f"""
import crescent
{POWER}
power = Power()
made = crescent.Sampler(power.sample, power.pdf, name="made")

def sample(wo, u):
    return power.sample(wo, u)
"""


def command(*words, **how):
    return subprocess.run([*COMMAND, *map(str, words)], text=True, capture_output=True, timeout=240, **how)


class Cosine:
    """A cosine lobe whose pdf has a factor."""

    def __init__(self, factor=1.0):
        self.factor = factor

    def sample(self, wo, u):
        import numpy as np

        r, phi, z = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1], np.sqrt(1 - u[:, 0])
        return np.stack([r * np.cos(phi), r * np.sin(phi), z], -1), self.factor * z / np.pi

    def pdf(self, wo, wi):
        return self.factor * cosine_pdf(wo, wi)


def kinds(swept, *paths):
    """The kind of each point, by its values at these paths."""
    return {tuple(p["values"][path] for path in paths): p["kind"] for p in swept.points}


def test_a_check_over_a_grid_maps_where_a_sampler_is_wrong(tmp_path):
    (tmp_path / "power.py").write_text(POWER)
    out = tmp_path / "out"
    over = ["--over", "k=1,2", "--over", "factor=1,1.05"]
    ended = command("--check", f"{tmp_path}/power.py:Power", *over, "--out", out, "--workers", "2")
    assert ended.returncode == 1, ended.stderr
    assert "wrong: 2 of 4" in ended.stdout and "p integrates to 1.0" in ended.stdout, ended.stdout
    again = command("--check", f"{tmp_path}/power.py:Power", "--over", "k=1,2,3", "--over", "factor=1", "--out", out)
    assert "1 to check, 2 there" in again.stderr, again.stderr
    tables = [parquet.read_table(path, partitioning=None) for path in out.glob("data/*.parquet")]
    shares = [table["alpha"][0].as_py() for table in tables]
    assert len(shares) == 5 and sum(shares) < 1e-3
    assert {"k", "factor", "kind", "verdict", "message"} <= set(tables[0].column_names)
    for words, says in (
        (["power.py:Powr", "--over", "k=1"], "did you mean 'Power'"),
        (["power.py:Power", "--over", "kk=1"], "did you mean 'k'"),
        (["phnog", "--over", "s=1"], "did you mean 'phong'"),
        (["phong"], "at least one --over"),
    ):
        ended = command("--check", *words, cwd=tmp_path)
        assert ended.returncode == 2 and says in ended.stderr, ended.stderr


def test_a_parameter_with_the_name_of_a_column_is_in_the_dataset(tmp_path):
    power = POWER.replace("k=1.0, factor=", "alpha=1.0, factor=").replace("= k, factor", "= alpha, factor")
    (tmp_path / "power.py").write_text(power)
    over = {"alpha": [1.0, 2.0]}
    swept = crescent.sweep_check(f"{tmp_path}/power.py:Power", over=over, out=tmp_path / "out", workers=1)
    assert kinds(swept, "alpha") == {(1.0,): "right", (2.0,): "right"}
    rows = read(tmp_path / "out").to_pylist()
    assert {row["values.alpha"] for row in rows} == {1.0, 2.0} and {row["alpha"] for row in rows} == {2.5e-4}


def test_a_sampler_that_is_there_takes_attributes_and_nothing_is_dropped(tmp_path):
    (tmp_path / "made.py").write_text(MADE)
    swept = crescent.sweep_check(
        f"{tmp_path}/made.py:made", over={"factor": [1.0, 1.05]}, out=tmp_path / "out", workers=1
    )
    assert kinds(swept, "factor") == {(1.0,): "right", (1.05,): "wrong"}
    swept = crescent.sweep_check(f"{tmp_path}/made.py:made", over={"kk": [1]}, out=tmp_path / "other", workers=1)
    assert "no attribute 'kk'" in swept.failed["kk=1"]
    swept = crescent.sweep_check(f"{tmp_path}/made.py", over={"k": [1]}, out=tmp_path / "third", workers=1)
    assert "no methods of an object" in swept.failed["k=1"]


def test_arms_are_checked_over_keys_lights_and_attributes(tmp_path):
    e = crescent.parse(TINY)
    mine = Cosine()
    e.samplers["mine"] = crescent.Sampler(mine.sample, mine.pdf)
    over = {"samplers.mine.factor": [1.0, 1.1], "key.radius": [0.1, 0.6]}
    swept = crescent.sweep(e, over=over, check="mine", pixels=2, out=tmp_path / "out", workers=1)
    assert swept.computed == 4 and not swept.failed
    assert {at: kind == "wrong" for at, kind in kinds(swept, *over).items()} == {
        (1.0, 0.1): False, (1.0, 0.6): False, (1.1, 0.1): True, (1.1, 0.6): True,
    }  # fmt: skip
    again = crescent.sweep(
        e, over={**over, "key.radius": [0.6, 0.9]}, check="mine", pixels=2, out=tmp_path / "out", workers=1
    )
    assert again.computed == 2 and len(again.points) == 6
    with pytest.raises(ValueError, match="alpha"):
        crescent.sweep(e, over=over, check="mine", pixels=2, out=tmp_path / "out", alpha=0.01)
    pytest.importorskip("matplotlib").use("Agg")
    drawn = crescent.plot.sweep(tmp_path / "out").axes[0]
    assert drawn.images[0].get_array().shape == (2, 3)  # factors by radii
    assert {"right", "wrong"} <= {text.get_text() for text in drawn.get_legend().get_texts()}
    with pytest.raises(ValueError, match="has one map"):
        crescent.plot.sweep(tmp_path / "out", "rmse")


def test_all_arms_are_checked_and_each_is_stored(tmp_path):
    (tmp_path / "tiny.toml").write_text(TINY)
    words = ["tiny.toml", "--pixels", "1", "--over", "key.radius=0.3,0.6", "--out", "out", "--workers", "2"]
    ended = command("--check", *words, cwd=tmp_path)
    assert ended.returncode == 1, ended.stderr  # phong alone leaves out directions
    assert ended.stdout.startswith("cosine, phong of a ball: 4 points, alpha 0.001 over all"), ended.stdout
    assert "wrong: 2 of 4" in ended.stdout and "arm=phong" in ended.stdout, ended.stdout
    one = command(*words, "--check", "cosine", cwd=tmp_path)
    assert "2 points: 0 to check, 2 there" in one.stderr, one.stderr
    assert one.stdout.startswith("cosine of a ball: 2 points"), one.stdout


def test_a_script_without_a_guard_is_run_once(tmp_path):
    (tmp_path / "tiny.toml").write_text(TINY)
    (tmp_path / "script.py").write_text("""
import sys
import crescent

print("begins")
sweep = crescent.sweep("tiny.toml", over={"key.radius": [0.3, 0.6]}, check="cosine", pixels=1, out="out", workers=1)
print(sweep.computed, __file__.endswith(sys.argv[0]))
""")
    ended = subprocess.run(
        [sys.executable, "script.py"], cwd=tmp_path, text=True, capture_output=True, timeout=240
    )
    assert ended.stdout.split() == ["begins", "2", "True"], ended.stderr


def test_what_has_no_effect_is_refused(tmp_path):
    (tmp_path / "tiny.toml").write_text(TINY)
    over = ["--over", "key.radius=0.3"]
    for words, says in (
        (["tiny.toml", "--check", "phnog", *over], "did you mean 'phong'"),
        (["tiny.toml", "--check"], "at least one --over"),
        (["--check", *over], "expected FILE.toml"),
        (["tiny.toml", "--check", *over, "--seeds", "2"], "--seeds"),
        (["tiny.toml", "--check", *over, "--films"], "--films"),
        (["tiny.toml", "--check", "--over", "key.radus=0.3"], "did you mean 'radius'"),
        (["tiny.toml", "--check", "--over", "n=4,16"], "does not depend on it"),
        (["tiny.toml", *over, "--alpha", "0.1"], "expected --check too"),
        (["tiny.toml", "--check", *over, "--engine", "dask://h:1", "--workers", "2"], "is of the engine 'local'"),
        (["--check", "phong", "--over", "s=8", "--pixels", "4"], "expected FILE.toml --check"),
    ):
        ended = command(*words, cwd=tmp_path)
        assert ended.returncode == 2 and says in ended.stderr, (words, ended.stderr)
    e = crescent.parse(TINY)
    with pytest.raises(TypeError, match="seeds is for runs"):
        crescent.sweep(e, over={"key.radius": [1.0]}, check=True, seeds=2, out=tmp_path / "out")
    with pytest.raises(TypeError, match="pixels is for checks"):
        crescent.sweep(e, over={"key.radius": [1.0]}, pixels=2, out=tmp_path / "out")
    crescent.sweep(e, over={"key.radius": [1.0]}, seeds=1, out=tmp_path / "run", workers=1)
    with pytest.raises(ValueError, match="another folder"):
        crescent.sweep(e, over={"key.radius": [1.0]}, check="phong", out=tmp_path / "run")
