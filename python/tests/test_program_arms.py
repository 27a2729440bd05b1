"""Samplers in Python as arms of the program: `python` of an arm, programs with `uses`, and --no-code."""

import json
import subprocess
import sys

import numpy as np
import pytest
from tiny import TINY

import crescent

MINE = """
import numpy as np
import crescent

print("this goes to stderr")

def basis(axis):
    helper = np.where(np.abs(axis[..., :1]) < 0.9, [1.0, 0, 0], [0, 1.0, 0])
    t = np.cross(helper, axis)
    t /= np.linalg.norm(t, axis=-1, keepdims=True)
    return t, np.cross(axis, t)

def aimed(wo, u, ctx):
    lights = ctx.lights
    assert lights.kind == ("disk",) * len(lights) and ctx.rho_d.shape == (len(u), 3)
    rows = np.arange(len(u))
    k = np.minimum((u[:, 2] * len(lights)).astype(int), len(lights) - 1)
    normal, radius = lights.normal[rows, k], lights.radius[rows, k]
    t, b = basis(normal)
    r, phi = radius * np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1]
    y = lights.position[rows, k] + (r * np.cos(phi))[:, None] * t + (r * np.sin(phi))[:, None] * b
    d2 = np.sum(y * y, axis=1)
    wi = y / np.sqrt(d2)[:, None]
    pdf = d2 / (np.pi * radius**2 * np.abs(np.sum(wi * normal, axis=1))) / len(lights)
    return wi, np.where(lights.shines[rows, k] & np.isfinite(pdf), pdf, 0)

def aimed_pdf(wo, wi, ctx):
    pdf = np.zeros(len(wi))
    for k in range(len(ctx.lights)):
        normal, radius = ctx.lights.normal[:, k], ctx.lights.radius[:, k]
        cos = np.sum(wi * normal, axis=1)
        t = np.sum(ctx.lights.position[:, k] * normal, axis=1) / cos
        off = wi * t[:, None] - ctx.lights.position[:, k]
        met = (t > 0) & (np.sum(off * off, axis=1) <= radius**2) & ctx.lights.shines[:, k]
        pdf += np.where(met, t * t / (np.pi * radius**2 * np.abs(cos)) / len(ctx.lights), 0)
    return pdf

sampler = crescent.Sampler(aimed, aimed_pdf, uses=("rho_d", "lights"), u=3)
twice = crescent.Sampler(aimed, lambda wo, wi, ctx: 2 * aimed_pdf(wo, wi, ctx), uses=("lights", "rho_d"), u=3)

def late(wo, u, ctx):
    if len(u) > 8:
        raise RuntimeError("no table here")
    return aimed(wo, u, ctx)

fails = crescent.Sampler(late, aimed_pdf, uses=("rho_d", "lights"), u=3)
"""

# Text lines with `uses`: cos^s about the mirror direction, with the exponent of each row.
TEXT = """
import math, sys
for line in sys.stdin:
    verb, *words = line.split()
    if verb == "hello":
        print("hello 2 lobe u=2 uses=alpha,s,lights", flush=True)
        continue
    v = [float(w) for w in words]
    given = 5 if verb == "sample" else 6
    alpha, s, lights = v[given : given + 3]
    assert len(v) == given + 3 + 18 * int(lights) and 0 < alpha <= 1
    r = (-v[0], -v[1], v[2])
    if verb == "sample":
        cos, phi = v[3] ** (1 / (s + 1)), 2 * math.pi * v[4]
        sin = math.sqrt(max(0, 1 - cos * cos))
        h = (1, 0, 0) if abs(r[0]) < 0.9 else (0, 1, 0)
        t = [h[1] * r[2] - h[2] * r[1], h[2] * r[0] - h[0] * r[2], h[0] * r[1] - h[1] * r[0]]
        n = math.sqrt(sum(x * x for x in t))
        t = [x / n for x in t]
        b = [r[1] * t[2] - r[2] * t[1], r[2] * t[0] - r[0] * t[2], r[0] * t[1] - r[1] * t[0]]
        wi = [sin * (math.cos(phi) * t[k] + math.sin(phi) * b[k]) + cos * r[k] for k in range(3)]
        print(*wi, (s + 1) / (2 * math.pi) * cos**s, flush=True)
    elif verb == "pdf":
        cos = max(0, sum(r[k] * v[3 + k] for k in range(3)))
        print((s + 1) / (2 * math.pi) * cos**s, flush=True)
    else:
        print("-", flush=True)
"""

OTHER = '[disks.other]\ncenter = [-2, 2, 2]\nnormal = [0.48, -0.64, -0.6]\nradius = 0.2\nradiance = [20, 40, 60]\n'


@pytest.fixture
def run(tmp_path, monkeypatch):
    """run(WORD...): the program's end, in a folder with mine.py, text.py and tiny.toml."""
    (tmp_path / "mine.py").write_text(MINE)
    (tmp_path / "text.py").write_text(TEXT)
    (tmp_path / "tiny.toml").write_text(TINY.replace("radiance = [1.2, 1.2, 1.2]", "radiance = [0, 0, 0]") + OTHER)
    monkeypatch.setenv("CRESCENT_PYTHON", sys.executable)

    def program(*words):
        return subprocess.run(
            [sys.executable, "-m", "crescent", *words], cwd=tmp_path, capture_output=True, text=True, timeout=300
        )

    if program("--version").returncode == 3:
        pytest.skip("the program is not built")
    return program


def with_arm(folder, lines):
    """tiny.toml with the arm `mine`."""
    text = (folder / "tiny.toml").read_text() + f"[arms.mine]\nn = [16, 64]\n{lines}\n"
    (folder / "arm.toml").write_text(text)
    return "arm.toml"


def means(folder, out):
    """The mean of each run, (arm, n)."""
    found = json.loads((folder / out / "metrics.json").read_text())
    return {(r["arm"], r["n"]): r["y_mean"] for r in found["runs"]}


def test_the_program_and_the_package_run_the_same_arm(run, tmp_path):
    words = ("run", with_arm(tmp_path, 'python = "mine.py:sampler"'), "--seeds", "1", "--only", "metrics", "--quiet")
    done = run(*words, "--out", "out", "--threads", "1")
    assert done.returncode == 0 and "this goes to stderr" in done.stderr, done.stderr
    assert run(*words, "--out", "again", "--threads", "2").returncode == 0
    assert means(tmp_path, "out") == means(tmp_path, "again")
    measured = crescent.run(crescent.load(tmp_path / "arm.toml"), seeds=(1, 1))
    film = measured.films["mine", 64]
    seen = film.y > 0
    reference = measured.references[32.0]["y"]
    error = np.sqrt(film.var.sum(dtype=float))
    assert seen.any() and abs(film.y.sum(dtype=float) - reference.sum(dtype=float)) < 4 * error
    assert means(tmp_path, "out")["mine", 64] == pytest.approx(film.y.mean(dtype=float), rel=1e-4)


def test_a_program_receives_the_surface(run, tmp_path):
    python = sys.executable
    assert run("check", "--exec", f"{python} text.py", "--wo", "30", "--patience", "600").returncode == 0
    words = ("--seeds", "1", "--only", "metrics", "--quiet", "--out", "out", "--set", "cosine.n=16")
    words += ("--set", "phong.n=256", "--set", "ball.s=2", "--set", "key.radius=1.2")
    text = with_arm(tmp_path, f'exec = "{python} text.py"')
    plain = (tmp_path / text).read_text().replace("n = [16, 64]", "n = [256]").replace("(phong, n=4)", "(phong, n=256)")
    (tmp_path / text).write_text(plain)
    done = run("run", text, *words)
    assert done.returncode == 0, done.stderr
    found = means(tmp_path, "out")
    assert found["mine", 256] == pytest.approx(found["phong", 256], rel=0.2)
    bad = run("check", "--exec", "read h; echo hello 2 x uses=alpha,roughness", "--wo", "30")
    assert bad.returncode == 3 and "alpha, rho_d" in bad.stdout + bad.stderr


def test_a_sampler_with_a_context_is_checked_by_the_program(run):
    assert run("check", "mine.py:sampler", "--wo", "30").returncode == 0
    assert run("check", "mine.py:twice", "--wo", "30").returncode == 1


@pytest.mark.parametrize(
    "lines, code, said",
    [
        ('python = "mine.py:sampel"', 2, r"arm.toml:\d+:\d+: arms.mine.python: .*did you mean 'sampler'"),
        ('python = "/dev/zero"', 2, r"arm.toml:\d+:\d+: arms.mine.python: "),
        ('plugin = "/dev/zero"', 2, r"arm.toml:\d+:\d+: arms.mine.plugin: expected a regular file"),
        ('python = "mien.py:sampler"', 2, r"arm.toml:\d+:\d+: arms.mine.python: .*no such file.*mine.py"),
        ('python = "mine"', 2, r"arm.toml:\d+:\d+: arms.mine.python: expected .FILE.py:NAME"),
        ('python = ""', 2, r"arms.mine.python"),
        ('python = "mine.py:fails"', 3, "the arm 'mine' terminated: .*no table here"),
    ],
)
def test_an_arm_that_cannot_run_is_an_error(run, tmp_path, lines, code, said):
    import re

    done = run("run", with_arm(tmp_path, lines), "--seeds", "1", "--only", "metrics", "--quiet", "--out", "out")
    assert done.returncode == code and re.search(said, done.stderr, re.S), done.stderr
    assert not (tmp_path / "out" / "metrics.json").exists()


@pytest.mark.parametrize("lines", ['python = "mine.py:sampler"', 'exec = "touch started"', 'plugin = "libmine.so"'])
@pytest.mark.parametrize("command", ["run", "film"])
def test_no_code_refuses_code_before_it_starts(run, tmp_path, lines, command):
    key = lines.split()[0]
    file = with_arm(tmp_path, lines)
    line = (tmp_path / file).read_text()[: (tmp_path / file).read_text().index(lines)].count("\n") + 1
    done = run(command, file, "--no-code", "--quiet", "--out", "out")
    assert done.returncode == 2 and f"arm.toml:{line}:" in done.stderr and f"arms.mine.{key}" in done.stderr
    assert not (tmp_path / "started").exists() and not (tmp_path / "out").exists()
    with pytest.raises(ValueError, match=f"arms.mine.{key}"):
        crescent.run(crescent.load(tmp_path / file), code=False)
    by_flag = run("run", "tiny.toml", "--set", f"arms.mine.{lines.replace(' = ', '=')}", "--no-code", "--out", "out")
    assert by_flag.returncode == 2 and "--set" in by_flag.stderr
