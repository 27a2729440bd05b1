"""crescent sweep: grids, results that are computed once, the same bits as one run, and what each fault leaves.

Every process is a real one: local clusters, a scheduler and workers as a user starts them, signals, a full disk.
"""

import contextlib
import hashlib
import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import crescent

for needed in ("dask", "distributed", "pyarrow"):
    pytest.importorskip(needed)

import distributed  # noqa: E402
import pyarrow.parquet as parquet  # noqa: E402

from crescent._sweep.dataset import read  # noqa: E402
from crescent._sweep.engines import engine_of, profile_of, usable_cores  # noqa: E402
from crescent._sweep.grid import UsageError, axes_of, grid  # noqa: E402
from crescent._sweep.plan import missing  # noqa: E402
from tiny import TINY as SCENE  # noqa: E402

TINY = f"""{SCENE}
[furnaces.ball]
arm = "cosine"
shape = "ball"
n = 16
[exponent]
arm = "phong"
s = [8, 64]
shape = "ball"
n = 4
"""
ARMS = """
import os
import numpy as np

def up(u):
    r, phi = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1]
    z = np.sqrt(1 - u[:, 0])
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], -1), z / np.pi

class good:
    @staticmethod
    def sample(wo, u):
        return up(u)

class bad:
    @staticmethod
    def sample(wo, u):
        BODY
        return up(u)
"""
COMMAND = [sys.executable, "-m", "crescent._sweep"]


def command(*words, **how):
    return subprocess.run([*COMMAND, *map(str, words)], text=True, capture_output=True, timeout=240, **how)


def until(condition, seconds=60):
    end = time.monotonic() + seconds
    while not (found := condition()):
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.05)
    return found


def results(out):
    return sorted(Path(out).glob("data/*.parquet"))


def arms_in(path):
    return set(parquet.read_table(path, partitioning=None)["arm"].to_pylist())


def is_whole(path):
    """Whether the checksum in the name of a file is that of its bytes."""
    return path.stem.endswith("-" + hashlib.sha256(path.read_bytes()).hexdigest()[:16])


@pytest.fixture
def tiny(tmp_path):
    (tmp_path / "tiny.toml").write_text(TINY)
    return tmp_path / "tiny.toml"


@pytest.fixture
def slow(tmp_path):
    """Tasks of several seconds."""
    text = TINY.replace("width = 48\nheight = 32", "width = 480\nheight = 320").replace("n = [4, 16]", "n = [4, 256]")
    (tmp_path / "slow.toml").write_text(text.replace("seeds = 2", "seeds = 24"))
    return tmp_path / "slow.toml"


# ---- the grid


def test_axes_are_lists_and_spacings_and_points_their_combinations():
    (axis,) = axes_of("sphere.alpha=log:0.05:0.8:9")
    assert len(axis.values) == 9 and (axis.values[0], axis.values[-1]) == (0.05, 0.8)
    np.testing.assert_allclose(np.diff(np.log(axis.values)), np.log(16) / 8, rtol=1e-8)
    assert axes_of(["a=lin:0:1:3"])[0].values == (0, 0.5, 1)
    assert axes_of({"a.rho_d": [[0, 0, 0], [1, 1, 1]]})[0].values == ([0, 0, 0], [1, 1, 1])
    assert axes_of("a.rho_d=[0,0,0],[1,1,1]")[0].values == ([0, 0, 0], [1, 1, 1])
    two = axes_of(["a=1,2", "b=x,y"])
    assert grid(two) == [{"a": 1, "b": "x"}, {"a": 1, "b": "y"}, {"a": 2, "b": "x"}, {"a": 2, "b": "y"}]
    assert grid(two, zip_=True) == [{"a": 1, "b": "x"}, {"a": 2, "b": "y"}]


@pytest.mark.parametrize(
    "text, says",
    [
        ("a", "PATH=VALUES"),
        ("a=", "PATH=VALUES"),
        ("a=1,,2", "no value"),
        ("a=lgo:1:2:3", "did you mean 'log'"),
        ("a=log:0:1:3", "above 0"),
        ("a=log:1:2", "FIRST:LAST:COUNT"),
        ("a=lin:1:2:1", "COUNT"),
    ],
)
def test_wrong_axes_say_what_is_expected(text, says):
    with pytest.raises(UsageError, match=says):
        axes_of(text)


def test_missing_seeds_are_the_gaps_between_blocks():
    assert missing([], 8) == [(1, 8)]
    assert missing([(1, 4), (7, 8)], 10) == [(5, 6), (9, 10)]
    assert missing([(1, 16)], 8) == []


def test_the_cores_of_a_job_are_respected(monkeypatch):
    monkeypatch.setenv("SLURM_CPUS_PER_TASK", "1")
    assert usable_cores() == 1
    monkeypatch.delenv("SLURM_CPUS_PER_TASK")
    assert usable_cores() <= len(os.sched_getaffinity(0))


def test_engines_and_profiles_say_what_is_expected(tmp_path):
    assert engine_of("dask://host:8786") == "dask://host:8786"
    with pytest.raises(UsageError, match="did you mean 'local'"):
        engine_of("lokal")
    profile = tmp_path / "queue.toml"
    profile.write_text("scheduler = 'slurm'\nqueu = 'short'\n")
    with pytest.raises(UsageError, match="did you mean 'queue'"):
        profile_of(str(profile))


# ---- results


def test_a_sweep_has_the_bytes_of_runs_and_computes_only_what_is_new(tiny, tmp_path):
    out = tmp_path / "out"
    over = {"ball.s": [8, 32], "key.radius": [0.2, 0.3]}
    made = crescent.sweep(tiny, over=over, seeds=3, out=out, workers=2, verify=1.0, films=True)
    assert not made.failed and len(made.points) == 4
    assert crescent.sweep(tiny, over=over, seeds=3, out=out, workers=2).computed == 0
    before = {path: path.stat().st_mtime_ns for path in results(out)}

    more = crescent.sweep(tiny, over=over, seeds=5, out=out, workers=2)  # seeds 4 and 5 alone
    new = [path for path in results(out) if path not in before]
    assert {tuple(path.stem.split("-")[2:4]) for path in new} == {("4", "5")} and more.computed == 8
    assert all(path.stat().st_mtime_ns == when for path, when in before.items())

    e = crescent.load(tiny, {"ball.s": 8, "key.radius": 0.3, "seeds": 5})
    whole = crescent.run(e, studies=True)
    folder = out / "points" / "ball.s=8,key.radius=0.3"
    one, joined = whole._core.json, (folder / "metrics.json").read_text()
    assert joined.partition('"provenance"')[0] == one.partition('"provenance"')[0]
    film = crescent.run(e, seeds=(1, 1))
    film.write(tmp_path / "run")
    for path in (tmp_path / "run" / "films").glob("*.exr"):
        assert (folder / "films" / path.name).read_bytes() == path.read_bytes()

    text = TINY.replace("[regions.ball]", "[arms.uniform]\nn = [4]\n[regions.ball]")  # another sampler
    tiny.write_text(text)
    known = set(results(out))
    added = crescent.sweep(tiny, over=over, seeds=5, out=out, workers=2)
    new = [path for path in results(out) if path not in known]
    assert not added.failed and len(new) == 4
    assert all(arms_in(path) == {"uniform"} for path in new)

    e = crescent.load(tiny, {"ball.s": 32, "key.radius": 0.2, "seeds": 5})
    one = crescent.run(e, studies=True)._core.json
    joined = (out / "points" / "ball.s=32,key.radius=0.2" / "metrics.json").read_text()
    assert joined.partition('"provenance"')[0] == one.partition('"provenance"')[0]

    rows = added.to_arrow().to_pylist()
    columns = {
        "ball.s",
        "key.radius",
        "arm",
        "n",
        "s",
        "seed",
        "metric",
        "region",
        "value",
        "experiment",
        "version",
        "worker",
    }
    assert columns <= set(rows[0]) and not any(row["suspect"] for row in rows)
    found = {
        row["seed"]: row["value"]
        for row in rows
        if (row["ball.s"], row["key.radius"], row["arm"], row["n"], row["metric"], row["s"])
        == (32, 0.2, "cosine", 16, "rmse", 32)
    }
    wanted = {
        row["seed"]: row["value"]
        for row in crescent.run(e).records()
        if (row["arm"], row["n"], row["metric"], row["s"]) == ("cosine", 16, "rmse", 32)
    }
    assert found == wanted and len(found) == 5
    assert "ball.s" in added.summary("rmse_frame") and "[" in added.summary()


def test_a_dry_run_states_the_cost_and_writes_nothing(tiny, tmp_path):
    out = tmp_path / "out"
    ended = command(tiny, "--over", "ball.s=8,32", "--seeds", "64", "--out", out, "--dry-run")
    assert ended.returncode == 0 and not out.exists()
    assert re.search(r"2 points, 64 seeds, 2 samplers: \d+ tasks, [\d.]+ \w*samples", ended.stderr), ended.stderr
    assert re.search(r"[\d.]+ \w*byte on disk", ended.stderr), ended.stderr


def test_zip_pairs_values_and_a_wrong_call_ends_with_2(tiny, tmp_path):
    over = ["--over", "ball.s=8,32", "--over", "key.radius=0.2,0.3"]
    ended = command(tiny, *over, "--zip", "--seeds", "1", "--out", tmp_path / "out", "--workers", "1")
    assert ended.returncode == 0, ended.stderr
    assert len(json.loads((tmp_path / "out" / "sweep.json").read_text())["points"]) == 2
    before = results(tmp_path / "out")
    ended = command(tiny, *over, "--zip", "--seeds", "1", "--out", tmp_path / "out", "--no-resume", "--dry-run")
    assert "2 samplers: 4 tasks" in ended.stderr and results(tmp_path / "out") == before, ended.stderr
    for words, says in (
        ([tiny, "--over", "bal.s=1"], "did you mean 'ball'"),
        ([tiny, "--ovr", "ball.s=1"], "did you mean '--over'"),
        ([tiny, "--zip", "--over", "ball.s=1,2", "--over", "key.radius=1"], "equal length"),
        ([tiny, "--seeds", "0"], "1 to 4096"),
        ([tmp_path / "none.toml"], "none.toml"),
        ([tiny, "--out", tmp_path, "--over", "ball.s=1"], "other files"),
        (["summary", tmp_path], "no sweep"),
        (["summary", tmp_path / "out", "--metric", "rmze"], "did you mean 'rmse"),
    ):
        ended = command(*words)
        assert ended.returncode == 2 and says in ended.stderr, (words, ended.stderr)
        assert "Traceback" not in ended.stderr


def test_commands_can_run_twice_and_in_any_order(tiny, tmp_path):
    out = tmp_path / "out"
    words = [tiny, "--over", "ball.s=8", "--seeds", "2", "--out", out]
    printed = command(*words, "--engine", "commands").stdout.splitlines()
    assert len(printed) == 4  # references, two arms, studies
    for line in [*reversed(printed), printed[0]]:
        subprocess.run(["sh", "-c", line], check=True)
    ended = command(*words)
    assert ended.returncode == 0 and "every result is there" in ended.stderr, ended.stderr
    assert list((out / "points").glob("*/metrics.json"))


def test_workers_of_a_queue(tiny, tmp_path):
    pytest.importorskip("dask_jobqueue")
    profile = tmp_path / "queue.toml"
    profile.write_text("scheduler = 'local'\njobs = 2\ncores = 1\nmemory = '1GB'\n")  # dask-jobqueue without a queue
    ended = command(
        tiny,
        "--over",
        "ball.s=8,32",
        "--seeds",
        "2",
        "--engine",
        f"slurm:{profile}",
        "--out",
        tmp_path / "out",
        cwd=tmp_path,
    )
    assert ended.returncode == 0, ended.stderr


# ---- faults


def with_bad_arm(tmp_path, body):
    (tmp_path / "arms.py").write_text(ARMS.replace("BODY", body))
    text = TINY.replace(
        "[regions.ball]",
        "[arms.good]\npython='arms.py:good'\nn=[4]\n[arms.bad]\npython='arms.py:bad'\nn=[4]\n[regions.ball]",
    )
    (tmp_path / "mine.toml").write_text(text)
    return tmp_path / "mine.toml"


@pytest.mark.parametrize(
    "body, says", [("raise RuntimeError('no directions')", "no directions"), ("os.kill(os.getpid(), 11)", "SIGSEGV")]
)
def test_a_sampler_that_fails_leaves_the_others_and_is_finished_later(tmp_path, body, says):
    file, out = with_bad_arm(tmp_path, body), tmp_path / "out"
    words = [file, "--over", "ball.s=8,zz", "--seeds", "2", "--out", out, "--workers", "2", "--quiet"]
    ended = command(*words)
    assert ended.returncode == 3 and says in ended.stderr and "ball.s=zz" in ended.stderr, ended.stderr
    known = {path: path.stat().st_mtime_ns for path in results(out)}
    assert len(known) == 3  # cosine, phong, good
    with_bad_arm(tmp_path, "pass")
    ended = command(*(word if word != "ball.s=8,zz" else "ball.s=8" for word in words))
    assert ended.returncode == 0, ended.stderr
    names = {arm for path in results(out) if path not in known for arm in arms_in(path)}
    assert names <= {"good", "bad"} and "bad" in names  # both are in the file that changed
    others = out / "store" / "results"  # of the sampler before the change
    kept = {path: path if path.exists() else others / path.name for path in known}
    assert all(path.stat().st_mtime_ns == known[before] for before, path in kept.items())


def test_a_declared_version_identifies_a_sampler(tmp_path):
    file, out = with_bad_arm(tmp_path, "pass"), tmp_path / "out"
    versions = {"good": "1", "bad": "1"}
    assert not crescent.sweep(file, seeds=1, out=out, workers=1, sampler_versions=versions).failed
    with_bad_arm(tmp_path, "u = u * 1.0")
    again = crescent.sweep(file, seeds=1, out=out, workers=1, sampler_versions=versions)
    assert again.cost["samples"] == 0
    newer = crescent.sweep(file, seeds=1, out=out, workers=1, sampler_versions={**versions, "bad": "2"})
    assert newer.cost["samples"] > 0 and not newer.failed


def test_a_sampler_of_a_notebook_travels(tiny, tmp_path):
    def draw(wo, u):
        z = np.sqrt(1 - u[:, 0])
        r, phi = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1]
        return np.stack([r * np.cos(phi), r * np.sin(phi), z], -1), z / np.pi

    e = crescent.load(tiny)
    e.samplers["mine"] = draw
    made = crescent.sweep(e, over={"ball.s": [8]}, seeds=2, out=tmp_path / "out", workers=1)
    assert not made.failed
    mine = [row for row in made.to_arrow().to_pylist() if row["arm"] == "mine"]
    assert mine and len({row["seed"] for row in mine}) == 2


def test_a_combination_comes_with_the_samplers_that_it_is_of(tiny, tmp_path):
    def draw(wo, u):
        z = np.sqrt(1 - u[:, 0])
        r, phi = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1]
        return np.stack([r * np.cos(phi), r * np.sin(phi), z], -1), z / np.pi

    def pdf(wo, wi):
        return np.maximum(wi[:, 2], 0) / np.pi

    e = crescent.load(tiny)
    e.samplers["mine"] = crescent.Sampler(draw, pdf)
    e.samplers["both"] = crescent.mis("mine", "phong")
    made = crescent.sweep(e, over={"ball.s": [8]}, seeds=2, out=tmp_path / "out", workers=1)
    assert not made.failed
    at = e.with_({"ball.s": 8})
    at.samplers.update(e.samplers)
    there = [r["value"] for r in crescent.run(at, seeds=(1, 2)).records() if (r["arm"], r["metric"]) == ("both", "y_mean")]
    swept = [r["value"] for r in made.to_arrow().to_pylist() if (r["arm"], r["metric"]) == ("both", "y_mean")]
    assert there and sorted(swept) == sorted(there)
    e.samplers["mine"] = crescent.Sampler(lambda wo, u: draw(wo, 1 - u), pdf)  # the combination is another one, too
    again = crescent.sweep(e, over={"ball.s": [8]}, seeds=2, out=tmp_path / "out", workers=1)
    assert sorted(r["value"] for r in again.to_arrow().to_pylist() if (r["arm"], r["metric"]) == ("both", "y_mean")) != (
        sorted(there)
    )


def test_a_function_for_the_weights_travels_and_is_part_of_the_identity(tiny, tmp_path):
    def swept():
        made = crescent.sweep(e, over={"ball.s": [8]}, seeds=1, out=tmp_path / "out", workers=1)
        assert not made.failed
        rows = [row for row in made.to_arrow().to_pylist() if row["metric"] == "rmse_frame"]
        return {(row["arm"], row["n"]): row["value"] for row in rows}

    e = crescent.load(tiny)
    e.samplers["power"] = crescent.mis("cosine", "light-area", heuristic="power")
    e.samplers["own"] = crescent.mis("cosine", "light-area", weights=lambda wo, wi, p: p / p.sum(1, keepdims=True))
    first = swept()
    e.samplers["own"] = crescent.mis("cosine", "light-area", weights=lambda wo, wi, p: p**2 / (p**2).sum(1, keepdims=True))
    second = swept()
    for (arm, n), value in second.items():
        if arm == "own":
            assert value == pytest.approx(second["power", n], rel=1e-6) and value != first[arm, n]
        else:
            assert value == first[arm, n]


def children_of(pid):
    """The processes below a process."""
    found = subprocess.run(["ps", "-eo", "pid=,ppid=,args="], text=True, capture_output=True).stdout
    rows = [line.split(None, 2) for line in found.splitlines()]
    below = {str(pid)}
    for _ in range(6):
        below |= {row[0] for row in rows if row[1] in below}
    return [int(row[0]) for row in rows if row[0] in below and row[0] != str(pid)]


def alive(pid):
    with contextlib.suppress(OSError, IndexError):
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    return False


def test_ctrl_c_stops_tasks_within_two_seconds(slow, tmp_path):
    out = tmp_path / "out"
    process = subprocess.Popen(
        [*COMMAND, slow, "--over", "ball.s=8,16,32", "--out", out, "--workers", "2"], stderr=subprocess.PIPE, text=True,
        start_new_session=True,
    )  # fmt: skip
    until(lambda: results(out), 200)
    kept = results(out)
    runners = children_of(process.pid)
    start = time.monotonic()
    os.killpg(process.pid, signal.SIGINT)  # as a terminal does
    until(lambda: not any(alive(pid) for pid in runners), 30)
    stopped = time.monotonic() - start
    _, said = process.communicate(timeout=30)
    assert process.returncode == 130 and "interrupted" in said and "Traceback" not in said, said
    assert stopped < 2 + 2 * (os.getloadavg()[0] > 2 * (os.cpu_count() or 1)), stopped
    assert set(kept) <= set(results(out))


@pytest.fixture
def cluster(tmp_path):
    """A scheduler and workers, as a user starts them: start() gives a scheduler, start(address, ...) a worker."""
    started = []

    def start(*words, **environment):
        what = "dask_worker" if words else "dask_scheduler"
        at = tmp_path / f"cluster{len(started)}"
        with open(at, "w") as log:
            started.append(
                subprocess.Popen(
                    [sys.executable, "-m", f"distributed.cli.{what}", *map(str, words), "--no-dashboard",
                     *(["--nthreads", "1", "--no-nanny"] if words else ["--port", "0", "--host", "127.0.0.1"])],
                    stdout=log, stderr=log, env={**os.environ, **environment}, cwd=tmp_path,
                )
            )  # fmt: skip
        if words:
            return started[-1], ""
        found = until(lambda: re.search(r"Scheduler at:\s+tcp://(\S+)", at.read_text()))
        return started[-1], found[1]

    yield start
    for process in started:
        process.kill()
        process.wait()


def test_a_killed_worker_is_replaced_and_a_killed_scheduler_ends_the_sweep(slow, tiny, tmp_path, cluster):
    scheduler, address = cluster()
    workers = [cluster(f"tcp://{address}", "--name", f"w{k}")[0] for k in range(3)]
    out = tmp_path / "out"
    process = subprocess.Popen(
        [*COMMAND, slow, "--over", "ball.s=8,16,32", "--seeds", "6", "--engine", f"dask://{address}", "--out", out],
        stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    until(lambda: list(out.glob("store/references/*")), 200)
    workers[0].kill()
    _, said = process.communicate(timeout=240)
    assert process.returncode == 0, said

    process = subprocess.Popen(
        [*COMMAND, slow, "--over", "ball.s=8,16,32", "--seeds", "24", "--engine", f"dask://{address}", "--out", out],
        stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    count = len(results(out))
    until(lambda: len(results(out)) > count, 200)
    start = time.monotonic()
    scheduler.kill()
    _, said = process.communicate(timeout=60)
    assert process.returncode == 3 and "does not answer" in said, said
    assert time.monotonic() - start < 10
    kept = results(out)
    assert all(is_whole(path) for path in kept)
    ended = command(slow, "--over", "ball.s=8,16,32", "--seeds", "7", "--out", out, "--workers", "2")
    assert ended.returncode == 0, ended.stderr
    assert set(kept) <= set(results(out))


def test_stored_references_survive_the_loss_of_a_worker(slow, tmp_path, cluster):
    out = tmp_path / "out"
    over = ["--over", "ball.s=8,16", "--out", out]
    assert command(slow, *over, "--seeds", "1", "--workers", "2").returncode == 0
    _, address = cluster()
    workers = [cluster(f"tcp://{address}", "--name", f"w{k}")[0] for k in range(2)]
    words = [slow, *over, "--seeds", "24", "--engine", f"dask://{address}"]
    process = subprocess.Popen([*COMMAND, *map(str, words)], stderr=subprocess.PIPE, text=True)
    count = len(results(out))
    until(lambda: len(results(out)) > count, 200)
    workers[0].kill()
    _, said = process.communicate(timeout=240)
    assert process.returncode == 0, said


FLIP = """
from crescent._sweep import runner

compute = runner.Runner.compute

def flipped(self, task, reference, unwanted):
    result = compute(self, task, reference, unwanted)
    if task["kind"] == "part":
        text = result["json"]
        place = text.index('"rmse": ') + len('"rmse": ') + 3
        result["json"] = text[:place] + chr(ord(text[place]) ^ 1) + text[place + 1:]
    return result

def dask_setup(worker):
    runner.Runner.compute = flipped
"""


def test_a_worker_that_flips_a_bit_is_found_and_its_rows_are_suspect(tiny, tmp_path, cluster):
    _, address = cluster()
    (tmp_path / "flip.py").write_text(FLIP)
    cluster(f"tcp://{address}", "--name", "sound")
    cluster(f"tcp://{address}", "--name", "faulty", "--preload", tmp_path / "flip.py")
    out = tmp_path / "out"
    with distributed.Client(f"tcp://{address}", set_as_default=False) as client:
        client.wait_for_workers(2, timeout=60)
    words = [tiny, "--over", "ball.s=4,8,16,32", "--seeds", "2", "--out", out, "--verify", "100%"]
    ended = command(*words, "--engine", f"dask://{address}")
    assert ended.returncode == 3 and "differ" in ended.stderr, ended.stderr
    line = next(line for line in ended.stderr.splitlines() if "differ" in line)
    assert len(set(re.findall(r"tcp://[\d.:]+", line))) == 2, line
    rows = read(out).to_pylist()
    assert any(row["suspect"] for row in rows)
    again = command(*words[:-2], "--workers", "1")  # suspect results are computed again
    assert again.returncode == 0, again.stderr
    assert not any(row["suspect"] for row in read(out).to_pylist())


def test_a_full_disk_fails_tasks_and_leaves_whole_files(tiny, tmp_path):
    if subprocess.run(["unshare", "-rm", "true"], capture_output=True).returncode:
        pytest.skip("no mount namespaces here")
    out = tmp_path / "out"
    out.mkdir()
    words = [
        *COMMAND,
        str(tiny),
        "--over",
        "ball.s=4,8,16,32",
        "--seeds",
        "2",
        "--out",
        str(out / "sweep"),
        "--workers",
        "1",
    ]
    script = (
        f'mount -t tmpfs -o size=120k none {out}; "$@" 2>{tmp_path}/said; echo $? >{tmp_path}/rc; '
        f"cp -r {out}/sweep {tmp_path}/kept; "
        f'mount -o remount,size=20m {out}; "$@" 2>>{tmp_path}/said; echo $? >>{tmp_path}/rc'
    )
    subprocess.run(["unshare", "-rm", "sh", "-c", script, "sh", *words], timeout=240, capture_output=True)
    said = (tmp_path / "said").read_text()
    assert (tmp_path / "rc").read_text().split() == ["3", "0"], said
    assert "No space left on device" in said and "Traceback" not in said, said
    for path in (tmp_path / "kept").rglob("*.json"):
        json.loads(path.read_text())
    assert all(is_whole(path) for path in results(tmp_path / "kept"))


def test_the_references_of_a_pair_reach_the_workers(tmp_path):
    e = crescent.parse(SCENE)
    e["reference"] = {"kind": "paired"}
    swept = crescent.sweep(e, over={"key.radius": [0.4]}, seeds=2, out=tmp_path / "out", workers=1, verify=0)
    assert not swept.failed
    whole = crescent.run(e.with_({"key.radius": 0.4}), seeds=2, studies=True)
    values = [(r["metric"], r["seed"], r["value"]) for r in swept.measured().records()]
    assert values == [(r["metric"], r["seed"], r["value"]) for r in whole.records()]


# ---- without the extra


def test_without_the_extra_one_line_says_what_to_install(tmp_path):
    (tmp_path / "sitecustomize.py").write_text(
        "import sys\n"
        "class Without:\n"
        "    def find_spec(self, name, path=None, target=None):\n"
        "        if name.partition('.')[0] in ('dask', 'distributed', 'pyarrow'):\n"
        "            raise ModuleNotFoundError(name)\n"
        "sys.meta_path.insert(0, Without())\n"
    )
    paths = os.pathsep.join([str(tmp_path), os.environ.get("PYTHONPATH", "")])
    ended = command("x.toml", env={**os.environ, "PYTHONPATH": paths})
    assert ended.returncode == 3 and ended.stderr.count("\n") == 1, ended.stderr
    assert "pip install 'crescent-bench[sweep]'" in ended.stderr


def test_the_program_runs_crescent_sweep_from_the_path(tmp_path):
    program = Path(crescent.__file__).parent / "bin" / "crescent"
    if not program.exists():
        pytest.skip("no program in this package")
    ended = subprocess.run([program, "sweep", "x"], text=True, capture_output=True, env={"PATH": str(tmp_path)})
    assert (
        ended.returncode == 3
        and "pip install 'crescent-bench[sweep]'" in ended.stderr
        and ended.stderr.count("\n") == 1
    )
    script = tmp_path / "crescent-sweep"
    script.write_text('#!/bin/sh\necho "$@"; exit 7\n')
    script.chmod(0o755)
    ended = subprocess.run(
        [program, "sweep", "a b", "--c"], text=True, capture_output=True, env={"PATH": str(tmp_path)}
    )
    assert (ended.returncode, ended.stdout) == (7, "a b --c\n")


def test_a_sweep_has_figures_and_the_efficiency_at_equal_time(tiny, tmp_path):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    from crescent import plot

    out = tmp_path / "out"
    made = crescent.sweep(tiny, over={"ball.s": [8, 32], "key.radius": [0.2, 0.3]}, out=out, workers=1, verify=0)
    rows = made.to_arrow().to_pylist()
    keys = ("point", "arm", "n", "s", "seed", "region")
    by = {
        m: {tuple(r[k] for k in keys): r["value"] for r in rows if r["metric"] == m}
        for m in ("seconds", "var", "efficiency_time")
    }
    found = by["efficiency_time"].items()
    pixels = [by["seconds"][*key[:5], ""] * value * by["var"][key] for key, value in found]  # seconds are of all pixels
    assert pixels and np.ptp(pixels) < 1e-6 * pixels[0] and 0 < pixels[0] <= 48 * 32
    assert "cosine efficiency" in made.summary()
    maps = plot.sweep(out)
    pictures = [ax for ax in maps.axes if ax.images]
    assert [ax.get_title() for ax in pictures] == ["cosine, N = 16", "phong, N = 4"]
    curve = plot.sweep(out, "efficiency_time", over=["key.radius"], arms=["cosine"]).axes[0]
    assert list(curve.get_lines()[0].get_xdata()) == [0.2, 0.3]
    plot.save(maps, tmp_path / "maps.pdf")
    for wrong, said in (({"over": ["ball.t"]}, "did you mean 'ball.s'"), ({"arms": ["phon"]}, "no arm 'phon'")):
        with pytest.raises((ValueError, KeyError), match=said):
            plot.sweep(out, **wrong)
