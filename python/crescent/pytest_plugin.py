"""pytest: one alpha for a whole session, and at its end the probability that a right suite fails.

    def test_mine(assert_sampler):          # or crescent.testing.assert_sampler itself
        assert_sampler(sample, pdf, f)      # or "samplers/mine.py:sampler", from pytest's rootdir

`pytest --crescent-alpha 1e-4` changes alpha. Under pytest-xdist every worker collects the whole suite and
computes the same shares.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest

from . import testing
from ._regression import RenderRegression


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.getgroup("crescent").addoption(
        "--crescent-alpha",
        type=float,
        default=testing.ALPHA,
        metavar="A",
        help="how often a suite of right samplers may fail, over all tests of the session (default %(default)g)",
    )
    parser.getgroup("crescent").addoption(
        "--crescent-accept",
        action="store_true",
        help="make the renders of every render_regression that runs its baseline",
    )
    parser.getgroup("crescent").addoption(
        "--crescent-because", default="", metavar="TEXT", help="the reason, for the manifest of the baseline"
    )


_KEY = pytest.StashKey[testing.Session]()


def pytest_configure(config: pytest.Config) -> None:
    alpha = config.getoption("--crescent-alpha")
    if not 0 < alpha < 1:
        raise pytest.UsageError(f"--crescent-alpha {alpha:g}: expected a number between 0 and 1")
    config.stash[_KEY] = testing.Session(alpha, root=config.rootpath)
    testing.begin_session(config.stash[_KEY])


def pytest_unconfigure(config: pytest.Config) -> None:
    testing.begin_session(None)


def pytest_collection_finish(session: pytest.Session) -> None:
    session.config.stash[_KEY].tests = max(len(session.items), 1)


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    item.config.stash[_KEY].test = item.nodeid


@pytest.fixture
def assert_sampler() -> Iterator[Callable[..., Any]]:
    """crescent.testing.assert_sampler, which uses its share of the session's alpha."""
    yield testing.assert_sampler


@pytest.fixture
def render_regression(request: pytest.FixtureRequest) -> RenderRegression:
    """Compares renders with the baseline of the test, which is in a folder named after its file."""
    return RenderRegression(
        view=request.node.name,
        folder=request.path.with_suffix(""),
        alpha=request.config.stash[_KEY].share,
        accept=request.config.getoption("--crescent-accept"),
        because=request.config.getoption("--crescent-because"),
    )


def pytest_sessionfinish(session: pytest.Session) -> None:
    output = getattr(session.config, "workeroutput", None)  # set in a worker of pytest-xdist
    if output is not None:
        mine = session.config.stash[_KEY]
        output["crescent"] = (mine.tests, mine.checked, mine.spent)


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node: Any, error: Any) -> None:
    counts = getattr(node, "workeroutput", {}).get("crescent")
    if counts:
        mine = node.config.stash[_KEY]
        mine.tests, checked, spent = counts
        mine.checked += checked
        mine.spent += spent


def pytest_terminal_summary(terminalreporter: Any, config: pytest.Config) -> None:
    mine = config.stash[_KEY]
    if not mine.checked:
        return
    terminalreporter.write_line(
        f"crescent: {mine.checked} samplers checked in {mine.tests} tests, which share alpha = {mine.alpha:g}: "
        f"a suite of right samplers like this one fails by chance at most once in {round(1 / mine.spent)} sessions"
    )
