"""The fixture `render_regression`: the renders of a test against the baseline that is committed next to it.

The baseline of `test_box` in `tests/test_scene.py` is `tests/test_scene/test_box-moments.exr`: mean and variance of
each pixel. `pytest --crescent-accept` replaces the baseline by the renders of the tests that run.
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ._compare import (
    Comparison,
    compare_suite,
    escape_pattern,
    file_name,
    run_compare,
    suite_text,
    write_renders,
)


@dataclass(frozen=True)
class RenderRegression:
    """Compares renders with the baseline of one test."""

    view: str  #: the name of the test
    folder: Path  #: of the baseline
    alpha: Any  #: called once for each comparison
    accept: bool = False
    because: str = ""

    def __call__(
        self,
        renders: Any,
        *,
        smallest: float | str = 0.01,
        regions: Mapping[str, Sequence[int]] | None = None,
        brightest: float | None = None,
        name: str = "",
        out: Path | str | None = None,
    ) -> Comparison | None:
        """Raises AssertionError unless mean and variance are those of the baseline, or the variance is smaller.

        `renders` and the other arguments are those of the candidate of :func:`crescent.compare`; `name`: of the view,
        for several in one test. With --crescent-accept the renders become the baseline, and None is returned.
        """
        view = f"{self.view}-{name}" if name else self.view
        options = {"alpha": None if self.accept else self.alpha(), "smallest": smallest, "brightest": brightest}
        with tempfile.TemporaryDirectory(prefix="crescent-") as work:
            write_renders(Path(work) / "candidate", view, renders, "renders")
            suite = Path(work) / "suite.toml"
            baseline = escape_pattern(str(self.folder.absolute())) + "/{view}-*.exr"
            suite.write_text(
                suite_text(baseline, "candidate/{view}/*", options, {view: regions} if regions else {}),
                encoding="utf-8",
            )
            if self.accept:
                why = ["--because", self.because] if self.because else []
                run_compare([str(suite), "--accept", file_name(view), "--store", "moments", "--quiet", *why])
                return None
            result = compare_suite(suite, out=out)
        found = result.views[file_name(view)]
        if found.state == "new":
            raise AssertionError(f"{view}: no baseline in {self.folder}; pytest --crescent-accept makes these renders it")
        if found.state not in ("same", "improved"):
            raise AssertionError(f"{view}: {found.state}\n{found.sentence}")
        return result
