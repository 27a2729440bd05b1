"""Faults of public projects: each is caught by the verdicts that it is said to be caught by, and mended it is right."""

import os
from pathlib import Path

import pytest

from crescent.field import faults_in

FOLDER = Path(os.environ.get("CRESCENT_FIELD", Path(__file__).resolve().parents[2] / "laws" / "field"))
FAULTS = faults_in(FOLDER) if FOLDER.is_dir() else []


def test_there_are_thirteen_at_least_each_with_its_source():
    if not FAULTS:
        pytest.skip("the repository's laws/field is not here")
    assert len(FAULTS) >= 13 and len({f.name for f in FAULTS}) == len(FAULTS)
    assert all(f.source.startswith("https://") and f.caught_by for f in FAULTS)


@pytest.mark.parametrize("fault", FAULTS, ids=lambda f: f.name)
def test_a_fault_is_caught_and_mended_it_is_right(fault):
    broken = fault.judged().broken()
    assert set(fault.caught_by) <= set(broken), broken
    assert fault.judged(mended=True).state == "right", str(fault.judged(mended=True))
