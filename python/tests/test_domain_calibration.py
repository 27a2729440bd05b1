"""A few cases of the calibration over domains of points, which needs SciPy and the repository."""

import importlib.util
import sys
from pathlib import Path

import pytest

pytest.importorskip("scipy")
SCRIPT = Path(__file__).parents[2] / "tests" / "calibration" / "domains.py"
if not SCRIPT.exists():
    pytest.skip("the calibration is not here", allow_module_level=True)


@pytest.fixture(scope="module")
def calibration():
    spec = importlib.util.spec_from_file_location("domain_calibration", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("family", ["beta", "pareto", "mixture", "alias_one", "concentric", "lobes"])
def test_right_samplers_are_right(calibration, family):
    number = [f.__name__ for f in calibration.FAMILIES].index(family)
    assert calibration.check_right(1, number, False)[0]["state"] == "right"


@pytest.mark.parametrize("fault", ["square root missing", "coordinates exchanged", "off by one"])
def test_faults_are_found_with_their_cause(calibration, fault):
    number = [kind[0] for kind in calibration.KINDS].index(fault)
    found = calibration.check_faults(1, number, False)[0]
    assert found["state"] == "wrong"
    assert found["true"] == found["causes"] != []
