"""A child process that computes tasks, one after another, for one thread of a worker.

A user's sampler runs here, so a crash ends this process only, and a task is stopped by ending the process. It ends
with its worker.
"""

from __future__ import annotations

import contextlib
import ctypes
import faulthandler
import os
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections import OrderedDict
from collections.abc import Callable
from multiprocessing.connection import Connection, Pipe
from typing import Any

_KEPT_REFERENCES = 2  # a worker computes point after point: the current one and the next


class TaskStopped(Exception):
    """The task was cancelled."""


class Runner:
    """The worker's side: starts the process, sends tasks, restarts it after a crash."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[bytes] | None = None
        self._line: Connection | None = None
        self._code: Any = None
        self._errors: Any = None

    def _start(self, code: Any) -> Connection:
        here, there = Pipe()
        self._errors = tempfile.TemporaryFile()
        self._process = subprocess.Popen(
            [sys.executable, "-m", "crescent._sweep.runner", str(there.fileno())],
            pass_fds=[there.fileno()],
            stdin=subprocess.DEVNULL,
            stdout=self._errors,
            stderr=self._errors,
            start_new_session=True,  # the client handles Ctrl-C
        )
        there.close()
        self._line, self._code = here, code
        return here

    def stop(self) -> None:
        """Ends the process at once."""
        if self._process is not None:
            with contextlib.suppress(ProcessLookupError):
                self._process.kill()
            self._process.wait()
        if self._line is not None:
            self._line.close()
        self._process = self._line = None

    def _ended(self) -> str:
        """The reason for which the process ended."""
        process = self._process
        assert process is not None
        code = process.wait()
        self._errors.seek(0)
        lines = self._errors.read().decode(errors="replace").strip().splitlines()
        last = next((line.strip() for line in lines if line.startswith(("Fatal", "terminate"))), "")
        last = last or (lines[-1].strip() if lines else "")
        how = f"signal {signal.Signals(-code).name}" if code < 0 else f"exit code {code}"
        return f"its process ended with {how}" + (f": {last[:300]}" if last else "")

    def compute(self, task: dict[str, Any], reference: bytes | None, cancelled: Callable[[], bool]) -> dict[str, Any]:
        """The result of a task, or {"error": ...}. Raises TaskStopped as soon as `cancelled` returns True."""
        code = task.get("code_id")
        if self._line is not None and self._code != code:
            self.stop()
        line = self._line or self._start(code)
        try:
            line.send(("task", task))
            while True:
                while not line.poll(0.1):
                    if cancelled():
                        self.stop()
                        raise TaskStopped
                what, value = line.recv()
                if what == "result":
                    return dict(value)
                line.send(("reference", reference))
        except (EOFError, OSError):
            error = self._ended()
            self.stop()
            return {"error": error}


def _end_with_parent(parent: int) -> None:
    while os.getppid() == parent:
        time.sleep(0.3)
    os._exit(1)


def main() -> int:
    """The process itself."""
    from .tasks import compute, error_text

    faulthandler.enable()
    parent = os.getppid()
    with contextlib.suppress(OSError, AttributeError):  # Linux: the kernel ends this process with its parent
        ctypes.CDLL(None).prctl(1, signal.SIGKILL)
    threading.Thread(target=_end_with_parent, args=(parent,), daemon=True).start()
    line = Connection(int(sys.argv[1]))
    references: OrderedDict[str, Any] = OrderedDict()
    while True:
        try:
            _, task = line.recv()
        except EOFError:
            return 0
        try:
            name = task.get("reference")
            if name and name not in references:
                line.send(("need", name))
                references[name] = pickle.loads(line.recv()[1])
                while len(references) > _KEPT_REFERENCES:
                    references.popitem(last=False)
            result = compute(task, references.get(name))
        except KeyboardInterrupt:
            return 130
        except MemoryError:
            result = {"error": "not enough memory"}
        except BaseException as error:  # noqa: BLE001: the sweep lists every error
            result = {"error": error_text(error)}
        line.send(("result", result))


if __name__ == "__main__":
    sys.exit(main())
