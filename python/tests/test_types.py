"""The package passes mypy --strict, which also finds a caller's mistakes."""

import subprocess
import sys
from pathlib import Path

import pytest

import crescent

pytest.importorskip("mypy")
PACKAGE = Path(crescent.__file__).parent


def mypy(*files):
    command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", PACKAGE.parent / "mypy", *files]
    return subprocess.run(command, capture_output=True, text=True, cwd=PACKAGE.parent)


def test_the_package_passes_mypy_strict_and_a_callers_mistakes_are_seen(tmp_path):
    right, wrong = tmp_path / "right.py", tmp_path / "wrong.py"
    head = "from typing import Any\nimport crescent\ndef sample(wo: Any, u: Any) -> Any: ...\n"
    right.write_text(
        head + "state: str = crescent.check(sample, u=3, domain='hemisphere', wo_deg=[30, (60, 9)]).state\n"
    )
    wrong.write_text(head + "crescent.check(sample, wo='left')\ncrescent.check(sample, wo_dg=[30])\n")
    ok = mypy(PACKAGE, right)
    assert ok.returncode == 0, ok.stdout
    told = mypy(wrong).stdout
    assert "wrong.py:4" in told and "wrong.py:5" in told and 'did you mean "wo_deg"?' in told.lower(), told
