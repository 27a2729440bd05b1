"""What identifies a result of a sweep: a sampler with its state; and results that are damaged or cannot be distinguished."""

import dataclasses
import functools
import json
import os
import re
import subprocess
import sys

import numpy as np
import pytest
from tiny import TINY

import crescent

for needed in ("dask", "distributed", "pyarrow"):
    pytest.importorskip(needed)

from crescent._sweep.attributes import with_attributes  # noqa: E402
from crescent._sweep.grid import UsageError  # noqa: E402
from crescent._sweep.dataset import COLUMNS, Results  # noqa: E402
from crescent._sweep.identity import arms_of  # noqa: E402
from crescent._sweep.state import state_of  # noqa: E402
from crescent._sweep.store import Store, locked, write_whole  # noqa: E402



def cosine(wo, u):  # workers do not have the modules next to this one
    r, phi, z = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1], np.sqrt(1 - u[:, 0])
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], -1), z / np.pi


def cosine_pdf(wo, wi):
    return np.maximum(wi[:, 2], 0) / np.pi


FACTOR = 1.0
TABLE = {"factors": np.ones(3)}


def scaled_pdf(wo, wi):
    return FACTOR * TABLE["factors"][0] * cosine_pdf(wo, wi)


def _inside(wo, wi):
    return FACTOR * cosine_pdf(wo, wi)


def calling_pdf(wo, wi):
    return _inside(wo, wi)


class Scaled:
    step = 1.0

    def __init__(self, factor):
        self.factor = factor
        self.nested = {"list": [factor]}

    def sample(self, wo, u):
        wi, pdf = cosine(wo, u)
        return wi, self.factor * self.step * pdf


class Slotted:
    __slots__ = ("factor",)

    def __init__(self, factor):
        self.factor = factor

    def __call__(self, wo, u):
        return cosine(wo, u)


def identity(sampler):
    e = crescent.parse(TINY)
    e.samplers["mine"] = sampler
    return arms_of(e, {})["mine"].id


def test_attributes_closures_defaults_and_globals_are_part_of_a_sampler(monkeypatch):
    def closed(factor):
        def sample(wo, u):
            return cosine(wo, u * factor)

        return sample

    def default(factor):
        def sample(wo, u, by=factor):
            return cosine(wo, u * by)

        return sample

    def keyword(factor):
        def sample(wo, u, *, by):
            return cosine(wo, u * by)

        return functools.partial(sample, by=factor)

    makers = [closed, default, keyword, lambda f: Scaled(f).sample, Slotted, lambda f: closed(np.array([f, 1.0])),
              lambda f: closed({"a": {"b": [f]}}), lambda f: closed(Scaled(f))]  # fmt: skip
    for make in makers:
        assert identity(make(1.0)) == identity(make(1.0))
        assert identity(make(1.0)) != identity(make(1.5))
    for pdf in (scaled_pdf, calling_pdf):
        before = identity(crescent.Sampler(cosine, pdf))
        monkeypatch.setattr(sys.modules[__name__], "FACTOR", 2.0)
        assert identity(crescent.Sampler(cosine, pdf)) != before
        monkeypatch.setattr(sys.modules[__name__], "FACTOR", 1.0)
        assert identity(crescent.Sampler(cosine, pdf)) == before
    before = identity(crescent.Sampler(cosine, scaled_pdf))
    TABLE["factors"][0] = 1.25
    assert identity(crescent.Sampler(cosine, scaled_pdf)) != before
    TABLE["factors"][0] = 1.0
    before = identity(Scaled(1.0).sample)
    monkeypatch.setattr(Scaled, "step", 2.0)
    assert identity(Scaled(1.0).sample) != before


def test_a_state_ends_and_is_the_same_in_another_process():
    loop = []
    loop.append(loop)
    assert state_of(loop)
    code = "import test_sweep_identity as t; print(t.identity(t.Scaled(1.5).sample), t.state_of(t.scaled_pdf))"
    there = {
        subprocess.run(
            [sys.executable, "-c", code], cwd=os.path.dirname(__file__), capture_output=True, text=True, check=True,
            env={**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": os.pathsep.join(sys.path)},
        ).stdout
        for seed in ("1", "2")
    }  # fmt: skip
    assert len(there) == 1


def test_a_sweep_of_an_ablation_computes_each_value(tmp_path):
    e = crescent.parse(TINY)
    e["arms.phong.n"] = e["arms.cosine.n"]
    found = []
    for factor in (1.0, 1.5):
        e.samplers["mine"] = Scaled(factor).sample
        swept = crescent.sweep(e, seeds=1, out=tmp_path / "out", workers=1, verify=0)
        assert swept.computed > 0 and not swept.failed
        rows = [r for r in swept.measured().records() if (r["arm"], r["metric"]) == ("mine", "y_mean")]
        found.append(rows[-1]["value"])
    assert found[0] == pytest.approx(1.5 * found[1], rel=1e-5)


def test_keys_of_the_sweep_itself_are_refused_at_once(tmp_path):
    e = crescent.parse(TINY)
    for over in ("n=4,16", "seed=1,2", "seeds=2,3", "'n'=4,16"):
        with pytest.raises(UsageError, match="expected"):
            crescent.sweep(e, over=[over], out=tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_points_that_differ_in_an_arm_alone_are_told_apart(tmp_path):
    e = crescent.parse(TINY)
    swept = crescent.sweep(e, over={"arms.phong.n": [[4], [4, 8]]}, seeds=2, out=tmp_path / "out", workers=1, verify=0)
    assert not swept.failed and len({point["scene"] for point in swept.points}) == 2
    rows = swept.to_pandas()
    rows = rows[(rows.arm == "phong") & (rows.metric == "y_mean") & (rows.n == 4) & (rows.s == 32)]
    assert len(rows) == 4  # two points of two seeds


def test_a_damaged_result_is_not_used(tmp_path):
    store = Store(tmp_path)
    row = dict.fromkeys(COLUMNS, None)
    path = Results(tmp_path, {}).add("scene-arm-1-2-point", [row], {}, {"json": "x" * 100, "worker": ""})
    check = Results(tmp_path, {}).add("c", [row], {}, {"state": "right", "worker": ""})
    store.add("studies", "s", b"{}")
    store.add("references", "r", b"reference")
    there = Results(tmp_path, {})
    assert there.blocks("scene", "arm") == [(1, 2)] and there.text("scene", "arm", 1, 2) == "x" * 100
    assert there.about(there.find("c"))["state"] == "right" and store.read("studies", "s") == b"{}"
    assert store.has("references", "r") and store.read("references", "r") == b"reference"
    for file in (path, check, *(tmp_path / "store" / name for name in ("studies/s", "references/r"))):
        whole = file.read_bytes()
        changed = bytearray(whole)
        changed[len(whole) // 2] ^= 1
        for damaged in (whole[: len(whole) // 2], bytes(changed), b"", b"null"):
            file.write_bytes(damaged)
            fresh, results = Store(tmp_path), Results(tmp_path, {})
            blobs = (fresh.has("studies", "s"), fresh.has("references", "r"))
            found = (results.blocks("scene", "arm"), results.find("c"), *blobs)
            assert sum(map(bool, found)) == 3, (file, damaged)
        file.write_bytes(whole)


def test_a_result_that_a_command_wrote_meanwhile_stays(tmp_path):
    row = dict.fromkeys(COLUMNS, None)
    about = {"json": "x", "worker": ""}
    names = [f"scene-arm-{k}-{k}-point" for k in range(4)]
    first = Results(tmp_path, {})
    first.add(names[0], [row], {}, about)
    first.add(names[1], [row], {}, about)
    first.forget("scene", "arm")  # --no-resume
    meanwhile = Results(tmp_path, {}, pattern="none")
    meanwhile.add(names[2], [row], {}, about)
    meanwhile.add(names[3], [row], {}, about).write_bytes(b"damaged")
    first.sync({})
    assert [path.stem[:19] for path in (tmp_path / "data").iterdir()] == [names[2]]
    second = Results(tmp_path, {})
    second.sync({})  # of no point of the sweep
    assert second.blocks("scene", "arm") == [(2, 2)] and not list((tmp_path / "data").iterdir())
    second.sync({names[2]: {}})
    assert len(list((tmp_path / "data").iterdir())) == 1 and not list((tmp_path / "store" / "results").iterdir())


def test_a_truncated_result_is_computed_again(tmp_path):
    e = crescent.parse(TINY)
    run = functools.partial(crescent.sweep, e, seeds=2, out=tmp_path / "out", workers=1, verify=0)
    first = run().measured().metrics
    for file in (tmp_path / "out" / "data").glob("*.parquet"):
        file.write_bytes(file.read_bytes()[:100])
    again = run()
    assert again.computed > 0
    assert again.measured().metrics["runs"] == first["runs"]
    files = sorted((tmp_path / "out" / "points").glob("*/*"))
    texts = [file.read_bytes() for file in files]
    for file in files:
        file.write_bytes(file.read_bytes()[:100])
    assert run().computed == 0
    assert [file.read_bytes() for file in files] == texts


def test_a_folder_has_one_sweep_and_no_unfinished_files(tmp_path):
    write_whole(tmp_path / "store" / "x.json", "{}")
    dead = subprocess.run([sys.executable, "-c", "import os; print(os.getpid())"], capture_output=True, text=True).stdout.strip()
    import socket

    left = tmp_path / "store" / f".x.json.{socket.gethostname()}-{dead}.partial"
    mine = tmp_path / "store" / f".y.json.{socket.gethostname()}-{os.getpid()}.partial"
    for partial in (left, mine):
        partial.write_text("x")
    with locked(tmp_path):
        assert not left.exists() and mine.exists()
        with pytest.raises(BlockingIOError, match="another sweep"), locked(tmp_path):
            pass
    assert json.loads((tmp_path / "store" / "x.json").read_text()) == {}


def command(*words, cwd):
    run = subprocess.run([sys.executable, "-m", "crescent._sweep", *words], cwd=cwd, capture_output=True, text=True,
                         env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)})  # fmt: skip
    return run.returncode, run.stdout + run.stderr


def test_exit_codes_of_mistakes_locks_and_bugs(tmp_path):
    (tmp_path / "e.toml").write_text(TINY)
    assert command("e.toml", "--over", "n=4,8", cwd=tmp_path)[0] == 2
    code, text = command("e.toml", "--set", "ball.q=4", cwd=tmp_path)
    assert code == 2 and "ball.q" in text
    assert command("task", cwd=tmp_path)[0] == 2
    (tmp_path / "o" / "store").mkdir(parents=True)
    with locked(tmp_path / "o"):
        code, text = command("e.toml", "--out", "o", cwd=tmp_path)
        assert code == 3 and "another sweep" in text
    (tmp_path / "o" / "store" / "tasks").mkdir(parents=True)
    (tmp_path / "o" / "store" / "tasks" / "x.task").write_bytes(b"no pickle")
    code, text = command("task", "o/store/tasks/x.task", cwd=tmp_path)
    assert code == 70 and "bug" in text


def test_set_changes_every_point(tmp_path):
    (tmp_path / "e.toml").write_text(TINY)
    code, text = command("e.toml", "--set", "arms.phong.n=4", "--set", "arms.cosine.n=8", "--over", "ball.s=8,16",
                         "--seeds", "1", "--out", "o", "--workers", "1", "--quiet", cwd=tmp_path)  # fmt: skip
    assert code == 0, text
    from crescent._sweep.dataset import read

    table = read(tmp_path / "o").to_pandas()
    assert set(table[table.arm == "cosine"].n) == {8} and set(table[(table.arm == "phong") & (table.s < 20)].n) == {4}


class Power:
    """A sampler whose attribute decides what it draws."""

    def __init__(self, k):
        self.k = k

    def sample(self, wo, u):
        z = u[:, 0] ** (1 / (self.k + 1))
        r, phi = np.sqrt(1 - z * z), 2 * np.pi * u[:, 1]
        return np.stack([r * np.cos(phi), r * np.sin(phi), z], -1), (self.k + 1) / (2 * np.pi) * z**self.k


def test_attributes_of_samplers_are_swept(tmp_path):
    e = crescent.parse(TINY)
    power = Power(1.0)
    e.samplers["power"] = power.sample
    made = crescent.sweep(e, over={"samplers.power.k": [1.0, 3.0]}, out=tmp_path / "out", workers=1, verify=0, seeds=1)
    assert not made.failed and power.k == 1.0
    rows = [r for r in made.to_arrow().to_pylist() if r["metric"] == "rmse" and r["arm"] == "power" and r["n"] == 16]
    swept = {r["samplers.power.k"]: r["value"] for r in rows}
    for k, value in swept.items():
        e.samplers["power"] = Power(k).sample
        (row,) = [r for r in crescent.run(e, seeds=1).records() if value == r["value"]]
        assert (row["arm"], row["n"]) == ("power", 16)
    assert len(set(swept.values())) == 2
    again = crescent.sweep(e, over={"samplers.power.k": [1.0, 3.0]}, out=tmp_path / "out", workers=1, verify=0, seeds=1)
    assert again.computed == 0
    for path, said in (("samplers.powr.k", "did you mean 'power'"), ("samplers.power.kk", "no attribute 'kk'")):
        with pytest.raises(ValueError, match=said):
            crescent.sweep(e, over={path: [1.0]}, out=tmp_path / "other", workers=1)


CELL = """
import crescent
import numpy as np

def draw(wo, u):
    r, phi, z = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1], np.sqrt(1 - u[:, 0])
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], -1), z / np.pi

e = crescent.load("e.toml")
e.samplers["mine"] = draw
for _ in range(2):
    print(crescent.sweep(e, over={"ball.s": [8]}, seeds=1, out="out", workers=1, verify=0).computed)
"""


def test_a_sampler_of_a_cell_has_no_file_and_is_swept(tmp_path):
    (tmp_path / "e.toml").write_text(TINY)
    (tmp_path / "kernel.py").write_text(f"exec(compile({CELL!r}, '<cell>', 'exec'))")  # in __main__, as a notebook's
    ended = subprocess.run([sys.executable, "kernel.py"], cwd=tmp_path, capture_output=True, text=True, timeout=240)
    assert ended.stdout.split() == ["5", "0"], ended.stderr  # references, three arms, studies


@dataclasses.dataclass(frozen=True)
class Frozen:
    k: float = 1.0

    def __call__(self, wo, u):
        return Power(self.k).sample(wo, u)

    @property
    def twice(self):
        return 2 * self.k


class Calling(Power):
    def __call__(self, wo, u):
        return self.sample(wo, u)


def to_a_power(wo, u, k):
    return Power(k).sample(wo, u)


def test_what_a_sampler_calls_has_attributes_too():
    e = crescent.parse(TINY)
    e.samplers["object"] = Calling(1.0)
    e.samplers["frozen"] = Frozen()
    e.samplers["partial"] = functools.partial(to_a_power, k=1.0)
    e.samplers["ris"] = crescent.ris("cosine", "phong", candidates=2)
    e.samplers["mis"] = crescent.mis("cosine", "phong")
    wo, u = np.ones((2, 3)), np.full((2, 2), 0.25)
    for name in ("object", "frozen", "partial"):
        for k in (1.0, 3.0):
            changed = with_attributes(e, {f"samplers.{name}.k": k})
            np.testing.assert_array_equal(changed.samplers[name].sample(wo, u)[1], Power(k).sample(wo, u)[1])
        assert changed.hash != e.hash
    assert with_attributes(e, {"samplers.ris.candidates": 4}).samplers["ris"].candidates == 4
    assert with_attributes(e, {"samplers.ris.n": [2, 8]}).samplers["ris"].n == (2, 8)
    for path, said in (
        ("samplers.object.kk", "the sampler has k; did you mean 'k'?"),
        ("samplers.partial.kk", "the sampler has k; did you mean 'k'?"),
        ("samplers.frozen.twice", "'twice' cannot be set"),
        ("samplers.ris.candidate", "the sampler has candidates, n; did you mean 'candidates'?"),
    ):
        with pytest.raises(UsageError, match=re.escape(said)):
            with_attributes(e, {path: 2})


def test_flags_without_effect_are_refused(tmp_path):
    (tmp_path / "e.toml").write_text(TINY)
    for words, said in (
        (("summary", ".", "--set", "n=3"), "--set: a summary computes nothing"),
        (("summary", ".", "--no-resume"), "--no-resume: a summary computes nothing"),
        (("e.toml", "--over", "ball.s=8", "--engine", "commands", "--workers", "2"), "workers is 2: is of the engine 'local'"),
    ):
        code, text = command(*words, cwd=tmp_path)
        assert code == 2 and said in text, text
