"""assert_sampler, the pytest plugin that shares one alpha, and mutants."""

from importlib.metadata import entry_points

import pytest
from samplers import cosine, cosine_pdf, lambert

from crescent import Sampler, check
from crescent.testing import Session, assert_sampler, mutants, who_notices

pytest_plugins = ["pytester"]
#: An installed package's plugin is loaded automatically.
LOAD = () if entry_points(group="pytest11", name="crescent") else ("-p", "crescent.pytest_plugin")
MINE = Sampler(cosine, cosine_pdf, lambert, name="mine")


def test_assert_sampler_passes_what_is_right_and_tells_what_is_not():
    assert assert_sampler(MINE, wo_deg=[30]).state == "right"
    with pytest.raises(AssertionError, match="normalised"):
        assert_sampler(cosine, lambda wo, wi: 1.02 * cosine_pdf(wo, wi), lambert, wo_deg=[30])


def test_the_shares_of_a_session_come_to_alpha_at_most():
    session = Session(alpha=0.01, tests=50)
    shares = []
    for test in range(50):
        session.test = str(test)
        shares += [session.share() for _ in range(20)]
    assert 0.009 < sum(shares) <= 0.01 and session.checked == 1000
    assert shares[0] > shares[1] and shares[0] == shares[20]


def test_the_plugin_shares_alpha_over_the_tests_of_a_session_and_says_so(pytester):
    pytester.makepyfile("""
        import numpy as np
        from crescent import testing

        def sample(wo, u):
            r, phi = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1]
            z = np.sqrt(1 - u[:, 0])
            return np.stack([r * np.cos(phi), r * np.sin(phi), z], -1), z / np.pi

        def test_one(assert_sampler):
            assert_sampler(sample, lambda wo, wi: np.maximum(wi[:, 2], 0) / np.pi, wo_deg=[30])
            assert testing._session.tests == 3 and testing._session.alpha == 0.02

        def test_other(assert_sampler):
            assert_sampler(sample, lambda wo, wi: np.maximum(wi[:, 2], 0) / 3, wo_deg=[30])

        def test_nothing():
            pass
        """)
    result = pytester.runpytest_subprocess(*LOAD, "--crescent-alpha", "0.02")
    result.assert_outcomes(passed=2, failed=1)
    result.stdout.fnmatch_lines(["*crescent: 2 samplers checked in 3 tests, which share alpha = 0.02*at most once in*"])


def test_every_mutant_is_caught_by_check_and_a_weak_test_misses_most():
    for mutant in mutants(MINE):
        assert check(mutant.sampler, wo_deg=[(45, 130)]).state == "wrong", mutant.name


def test_who_notices_says_which_tests_see_which_fault():
    def looks_at_z(sampler):
        import numpy as np

        wi, _ = sampler.sample(np.tile([0.0, 0.0, 1.0], (64, 1)), np.full((64, 2), 0.5))[:2]
        return np.all(wi[:, 2] > 0)  # a NumPy bool

    def checks(sampler):
        return check(sampler, wo_deg=[(45, 130)]).state == "right"

    noticed = who_notices(MINE, [looks_at_z, checks])
    assert not noticed.missed() and "directions lean by 5 degrees" in noticed.by
    assert any("looks_at_z" not in tests for tests in noticed.by.values())
    assert "looks_at_z" in noticed.by["a direction in 100 is no number"]
    assert "planted faults are noticed" in str(noticed)
    with pytest.raises(ValueError, match="fails with the sampler as it is"):
        who_notices(MINE, [lambda sampler: False])
