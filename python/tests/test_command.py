"""The program of the package with samplers in Python files: what it checks, and its exit codes."""

import json
import os
import struct
import subprocess
import sys

import pytest

MINE = """
import numpy as np
import crescent

print("this goes to stderr")

def sample(wo, u):
    r, phi = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1]
    z = np.sqrt(1 - u[:, 0])
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], -1), z / np.pi

def pdf(wo, wi):
    return np.maximum(wi[:, 2], 0) / np.pi

off = crescent.Sampler(sample, lambda wo, wi: 1.1 * pdf(wo, wi))

def raising(wo, wi):
    if len(wi) > 8:
        raise RuntimeError("no table here")
    return pdf(wo, wi)

late = crescent.Sampler(sample, raising)

def mirrored(wo, u):
    n = len(u)
    chosen = u[:, 2] < 0.5
    wi, p = sample(wo, u)
    wi = np.where(chosen[:, None], wo * [-1, -1, 1], wi)
    return wi, np.where(chosen, 0.5, 0.5 * p), np.ones((n, 3)), chosen

coat = crescent.Sampler(
    mirrored, lambda wo, wi: 0.5 * pdf(wo, wi), lambda wo, wi: np.full((len(wi), 3), 0.5 / np.pi), u=3,
    domain="hemisphere",
)
glass = crescent.Sampler(sample, pdf, wo="both", eta=1.5, reciprocal=False, importance=True, own_random=True)
sky = crescent.Sampler(
    lambda u: (np.stack([*(np.sqrt(1 - (1 - 2 * u[:, 0]) ** 2) * t(2 * np.pi * u[:, 1]) for t in (np.cos, np.sin)),
                         1 - 2 * u[:, 0]], -1), np.full(len(u), 0.25 / np.pi)),
    lambda wi: np.full(len(wi), 0.25 / np.pi), wo="none",
)
"""


@pytest.fixture
def run(tmp_path):
    """run(WORD...): the program's end, in a folder with mine.py."""
    (tmp_path / "mine.py").write_text(MINE)

    def program(*words):
        return subprocess.run(
            [sys.executable, "-m", "crescent", *words], cwd=tmp_path, capture_output=True, text=True, timeout=300
        )

    if program("--version").returncode == 3:
        pytest.skip("the program is not built")
    return program


def test_a_file_or_a_sampler_in_it_is_checked(run, tmp_path):
    assert run("check", "mine.py", "--wo", "30", "--junit", "j.xml", "--html", "j.html").returncode == 0
    off = run("check", "mine.py:off", "--wo", "30", "--json", "j.json")
    assert off.returncode == 1 and "normalised" in off.stdout and "this goes to stderr" in off.stderr
    result = json.loads((tmp_path / "j.json").read_text())
    assert result["state"] == "wrong" and "check mine.py:off" in result["command"]
    assert (tmp_path / "j.xml").stat().st_size and (tmp_path / "j.html").stat().st_size


@pytest.mark.parametrize("name", ["coat", "sky"])
def test_what_a_sampler_declares_reaches_the_check(run, name):
    done = run("check", f"mine.py:{name}", "--wo", "30") if name != "sky" else run("check", f"mine.py:{name}")
    assert done.returncode == 0, done.stdout + done.stderr


def test_two_samplers_are_compared(run):
    assert run("check", "mine.py", "--wo", "30", "--against", "mine.py", "--expect", "same").returncode == 0


def test_an_exception_is_an_error_of_the_sampler(run):
    done = run("check", "mine.py:late", "--wo", "30")
    assert done.returncode == 3 and "RuntimeError: no table here" in done.stdout


@pytest.mark.parametrize(
    "words, said",
    [
        (["mine.py:nope"], "no 'nope'"),
        (["mine.py:skyy"], "did you mean 'sky'"),
        (["nofile.py"], "no such file"),
        (["nomodule:sampler"], "ModuleNotFoundError"),
        (["cosin"], "did you mean 'cosine'"),
        (["mine.py", "--set", "s=3"], "is for built-in samplers"),
        (["mine.py", "--exec", "./mine"], "excludes"),
        (["mine.py", "--wo", "120"], "below the surface"),
        (["cosine", "--patience", "3"], "needs --exec, an experiment, or a sampler in a Python file or a shader"),
    ],
)
def test_bad_input_is_2(run, words, said):
    done = run("check", *words)
    assert done.returncode == 2 and said in done.stderr, done.stderr


def test_the_handshake_declares_the_sampler(tmp_path):
    (tmp_path / "mine.py").write_text(MINE)

    def serve(word, requests=b""):
        done = subprocess.run(
            [sys.executable, "-m", "crescent.serve", word],
            cwd=tmp_path, input=b"hello 2\n" + requests, capture_output=True, timeout=60,
        )
        line, _, rest = done.stdout.partition(b"\n")
        return line.decode(), rest

    assert serve("mine.py:coat")[0].split()[3:] == [
        "u=3", "domain=hemisphere", "wo=upper", "channels=3", "block=f64", "weight=yes", "delta=yes",
    ]
    line, answer = serve("mine.py:glass", b"f___" + struct.pack("<I6d", 1, 0, 0, 1, 0, 0, 1))
    assert line.endswith(
        "wo=both channels=1 block=f64 transport=importance reciprocal=no random=own eta=1.5"
    )
    count, f = struct.unpack("<Id", answer)
    assert count == 1 and f != f
    wi = struct.pack("<I5d", 1, 0, 0, 1, 0.25, 0.0)
    count, *draw = struct.unpack("<I4d", serve("mine.py", b"smpl" + wi)[1])
    assert count == 1 and draw == pytest.approx([0.5, 0, 0.75**0.5, 0.75**0.5 / 3.141592653589793])


@pytest.mark.parametrize(
    "text, code, said",
    [
        ("\ndef sample(wo, u):\n    raise RuntimeError('no table')\n", 2, "own.py:3: RuntimeError: no table"),
        ("def sample(wo, u):\n    return 1 / 0\n", 2, "own.py:2: ZeroDivisionError"),
        ("import numpy as np\n\ndef sample(wo, u):\n    return np.ones(3) @ np.ones(2), u\n", 2, "own.py:4: "),
        ("def sample(wo, u):\n    return (\n", 2, "own.py:2: SyntaxError: "),
        ("import no_such_module\n", 2, "own.py:1: ModuleNotFoundError"),
        ("import sys\n\nsys.exit(1)\n", 2, "own.py:3: SystemExit: 1"),
        ("import sys\n\ndef sample(wo, u):\n    sys.exit('stop')\n", 2, "own.py:4: SystemExit: stop"),
        ("import os\n\ndef sample(wo, u):\n    os._exit(1)\n", 3, "exit code 1"),
        ("import other\n\ndef sample(wo, u):\n    return other.draw(u)\n", 2, "other.py:2: ValueError: bad u"),
        (
            "import numpy as np\n\ndef sample(wo, u):\n    if len(u) > 100:\n        raise ValueError('many')\n"
            "    return np.broadcast_to([0.0, 0.0, 1.0], (len(u), 3)), np.ones(len(u))\n\n"
            "def pdf(wo, wi):\n    return np.ones(len(wi))\n",
            3,
            "own.py:5: many",
        ),
    ],
)
def test_an_exception_names_the_line_of_the_users_file(run, tmp_path, text, code, said):
    (tmp_path / "own.py").write_text(text)
    (tmp_path / "other.py").write_text("def draw(u):\n    raise ValueError('bad u')\n")
    done = run("check", "own.py", "--wo", "30")
    out = done.stdout + done.stderr
    assert done.returncode == code and said.removesuffix("ValueError: bad u") in out, out
    assert "pip install" not in out


def test_an_interpreter_without_the_package_is_named(run, monkeypatch):
    monkeypatch.setenv("CRESCENT_PYTHON", os.devnull)
    done = run("check", "mine.py")
    assert done.returncode == 3 and "pip install crescent-bench" in done.stderr
    monkeypatch.setenv("CRESCENT_PYTHON", "no-such-python")
    done = run("check", "mine.py")
    assert done.returncode == 3 and "pip install crescent-bench" in done.stderr


def test_headers_and_a_cmake_package_are_in_the_package(tmp_path):
    import shutil

    def folder(flag):
        run = subprocess.run([sys.executable, "-m", "crescent", flag], capture_output=True, text=True, check=True)
        return run.stdout.strip()

    include, cmake = folder("--include-dir"), folder("--cmake-dir")
    assert os.path.isfile(f"{include}/crescent/plugin.h") and os.path.isfile(f"{include}/crescent/check.h")
    assert os.path.isfile(f"{cmake}/crescentConfigVersion.cmake")
    (tmp_path / "plugin.c").write_text(
        '#include "crescent/plugin.h"\nunsigned crescent_sampler_abi(void) { return CRESCENT_SAMPLER_ABI; }\n'
    )
    if cc := shutil.which("cc"):
        subprocess.run([cc, "-shared", "-fPIC", f"-I{include}", "plugin.c", "-o", "p.so"], cwd=tmp_path, check=True)
    if not (shutil.which("cmake") and cc):
        return
    for component, code in (("headers", 0), ("check", 1)):
        (tmp_path / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.25)\nproject(p LANGUAGES C)\n"
            f"find_package(crescent REQUIRED COMPONENTS {component})\nadd_library(p MODULE plugin.c)\n"
            "target_link_libraries(p PRIVATE crescent::headers)\n"
        )
        made = ["cmake", "-S", ".", "-B", component, f"-Dcrescent_DIR={cmake}"]
        run = subprocess.run(made, cwd=tmp_path, capture_output=True, text=True)
        assert run.returncode == code, run.stderr
        if code:
            assert "installed by cmake" in run.stderr
        else:
            subprocess.run(["cmake", "--build", component], cwd=tmp_path, check=True, capture_output=True)
