"""A daemon thread in one of our calls does not disturb the end of the interpreter, at any point of the call."""

import subprocess
import sys
import time

import pytest
from tiny import TINY

SCRIPT = """
import atexit, os, sys, threading, time
import numpy as np
import crescent

began, kind = threading.Event(), sys.argv[1]
scene = crescent.parse(sys.argv[2])

def sample(wo, u):
    if len(u) > 8:
        began.set()
        while kind == "computes":
            pass
        time.sleep({"sleeps": 60, "naps": 0.01}.get(kind, 0))
    r, phi = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1]
    z = np.sqrt(1 - u[:, 0])
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], -1), z / np.pi

def pdf(wo, wi):
    return np.maximum(wi[:, 2], 0) / np.pi

def progress(what, done, total):
    began.set()
    time.sleep(0.02)

CALLS = {
    "an arm": lambda: crescent.check("ggx-vndf", full=True, progress=progress),
    "a run": lambda: crescent.run(scene.with_({"seeds": 64, "arms.cosine.n": 65536}), progress=progress),
    "functions": lambda: (began.set(), crescent.arm("ggx-vndf").sample([0, 0, 1], np.full((100000, 2), 0.5))),
    "serial": lambda: crescent.check(sample, pdf, full=True, serial=True),
    "a join": lambda: (began.set(), crescent.join([sys.argv[4]])),
}
if kind == "a join":
    crescent.run(scene, seeds=(1, 1), out=sys.argv[4])

def work():
    while True:
        CALLS.get(kind, lambda: crescent.check(sample, pdf, full=True))()

threading.Thread(target=work, daemon=True).start()
assert began.wait(30)
time.sleep(float(sys.argv[3]))
print("over")
"""


@pytest.mark.parametrize(
    "kind", ["callables", "naps", "sleeps", "computes", "serial", "an arm", "a run", "functions", "a join"]
)
def test_an_interpreter_ends_as_usual_beside_a_daemon_thread(kind, tmp_path):
    for wait in ("0", "0.11"):
        start = time.monotonic()
        ended = subprocess.run(
            [sys.executable, "-c", SCRIPT, kind, TINY, wait, str(tmp_path / "part")],
            capture_output=True,
            text=True,
            timeout=50,
        )
        assert (ended.returncode, ended.stdout, ended.stderr) == (0, "over\n", "")
        assert time.monotonic() - start < 30


def test_work_that_begins_while_the_interpreter_ends_is_an_error_that_says_so():
    script = "import atexit, sys; sys.stderr = sys.stdout; atexit.register(lambda: crescent.check('cosine'))\n"
    ended = subprocess.run(
        [sys.executable, "-c", script + "import crescent"], capture_output=True, text=True, timeout=50
    )
    assert ended.returncode == 0 and "cannot begin work while the interpreter is ending" in ended.stdout


def test_a_forked_child_ends_as_usual_while_its_parent_works():
    script = """
import os, threading, time, crescent
began = threading.Event()
threading.Thread(
    target=lambda: crescent.check("ggx-vndf", full=True, progress=lambda *at: began.set()), daemon=True
).start()
began.wait(30)
child = os.fork()
if child == 0:
    raise SystemExit(7)
print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
"""
    start = time.monotonic()
    ended = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=50)
    assert (ended.returncode, ended.stdout) == (0, "7\n"), ended.stderr
    assert time.monotonic() - start < 30
