"""The progress bar of a run: tqdm's where it is installed."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

Progress = Callable[[str, float, float], None]


def _is_shown() -> bool:
    """Whether somebody watches: stderr is a terminal, or the interpreter is that of a notebook."""
    return sys.stderr is not None and (sys.stderr.isatty() or "ipykernel" in sys.modules)


@contextmanager
def bar(progress: Progress | bool | None) -> Iterator[Progress | None]:
    """What _crescent.run calls: the user's callable, a bar, or None. Each stage ends at 100 %."""
    if callable(progress):
        last_call: list[Any] = []

        def end_stage() -> None:
            if last_call and last_call[1] < last_call[2]:
                progress(last_call[0], last_call[2], last_call[2])

        def told(what: str, done: float, total: float) -> None:
            if last_call and last_call[0] != what:
                end_stage()
            last_call[:] = [what, done, total]
            progress(what, done, total)

        yield told
        end_stage()
        return
    if not isinstance(progress, bool) and progress is not None:
        raise TypeError(f"progress is {type(progress).__name__}: expected a callable progress(what, done, total), or a bool")
    if progress is False or (progress is None and not _is_shown()):
        yield None
        return
    try:
        from tqdm.auto import tqdm  # type: ignore[import-untyped,unused-ignore]
    except ImportError:
        if progress:
            raise
        yield None
        return
    with tqdm(total=1.0, bar_format="{l_bar}{bar}| {elapsed}<{remaining}", leave=False) as shown:
        last: list[Any] = [""]

        def show(what: str, done: float, total: float) -> None:
            if what != last[0]:
                if last[0]:
                    shown.n = shown.total
                    shown.refresh()
                shown.reset(total=max(total, 1e-9))
                shown.set_description(what)
                last[0] = what
            shown.total = max(total, 1e-9)
            shown.n = min(done, shown.total)
            shown.refresh()

        yield show
        shown.n = shown.total
        shown.refresh()
