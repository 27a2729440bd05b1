"""A bar on stderr: tasks, samples per second, time left. A line every ten seconds if stderr is not a terminal."""

from __future__ import annotations

import sys
import time


def duration(seconds: float) -> str:
    """Seconds as text with at most two units."""
    s = int(round(seconds))
    if s < 60:
        return f"{s} s"
    if s < 3600:
        return f"{s // 60} min {s % 60:02d} s"
    return f"{s // 3600} h {s % 3600 // 60:02d} min"


def quantity(value: float) -> str:
    """A count with an SI prefix."""
    for limit, unit in ((1e12, "T"), (1e9, "G"), (1e6, "M"), (1e3, "k")):
        if value >= limit:
            return f"{value / limit:.3g} {unit}"
    return f"{value:.3g} "


class Progress:
    """The finished part of `tasks` and `samples`."""

    def __init__(self, tasks: int, samples: float, shown: bool) -> None:
        self.tasks, self.samples, self.shown = tasks, samples, shown
        self.done, self.drawn, self.failed = 0, 0.0, 0
        self._start = self._last = time.monotonic()
        self._bar = sys.stderr.isatty()

    def add(self, samples: float, failed: bool) -> None:
        """Counts a finished task."""
        self.done += 1
        self.failed += failed
        self.drawn += 0.0 if failed else samples
        self.show()

    def show(self, last: bool = False) -> None:
        """Draws the bar, at most ten times a second."""
        now = time.monotonic()
        if not self.shown or not (last or now - self._last > (0.1 if self._bar else 10)):
            return
        self._last = now
        spent = max(now - self._start, 1e-9)
        share = self.drawn / self.samples if self.samples > 0 else self.done / max(self.tasks, 1)
        left = f", {duration(spent * (1 - share) / share)} left" if 0 < share < 1 and not last else ""
        text = f"{self.done} of {self.tasks} tasks, {quantity(self.drawn / spent)}samples/s{left}"
        text += f", {self.failed} failed" if self.failed else ""
        if self._bar:
            width = 24
            full = round(width * min(self.done / max(self.tasks, 1), 1))
            print(
                f"\r[{'#' * full}{'.' * (width - full)}] {text}\x1b[K",
                end="\n" if last else "",
                file=sys.stderr,
                flush=True,
            )
        else:
            print(text, file=sys.stderr, flush=True)
