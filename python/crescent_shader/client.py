"""A host of a shader as callables of arrays: starts it, sends blocks, and reads the answers."""

from __future__ import annotations

import os
import struct
import subprocess
import sys
import threading
from collections.abc import Sequence
from typing import IO, Any

import numpy as np

from . import GREETING_OF_PYTHON, BadInput, MissingPart

MOST_ROWS = 1 << 16  # of a request: as the program sends them
Array = np.ndarray[Any, Any]


class Host:
    """A process that evaluates a shader. It starts with the first request, also in a copy in another process, and ends
    with its input."""

    def __init__(self, words: Sequence[str]) -> None:
        self._words = tuple(words)
        self._lock = threading.Lock()
        self._process: subprocess.Popen[bytes] | None = None
        self.name = ""
        self.keys: dict[str, str] = {}

    def __reduce__(self) -> tuple[Any, ...]:
        return Host, (self._words,)

    def start(self) -> None:
        """Starts it, unless it runs; raises BadInput (a ValueError) or MissingPart."""
        if self._process is not None:
            return
        here = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
        path = os.pathsep.join(filter(None, (here, os.environ.get("PYTHONPATH", ""))))
        process = subprocess.Popen(
            [sys.executable, "-P", "-m", "crescent_shader", *self._words],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env={**os.environ, "PYTHONPATH": path},
        )
        self._ask(process).write(GREETING_OF_PYTHON + b"\n")
        self._ask(process).flush()
        answer = self._answer(process).readline().decode("utf-8", "replace").strip()
        kind, _, rest = answer.partition(" ")
        if kind != "hello":
            process.kill()
            process.wait()
            if kind == "error":
                raise BadInput(rest)
            raise MissingPart(rest if kind == "missing" else "the host of the shader ended without an answer")
        parts = [part for part in rest.split(" ")[1:]]
        first = next((at for at, part in enumerate(parts) if "=" in part), len(parts))
        self.name = " ".join(parts[:first])
        self.keys = {}
        for part in parts[first:]:  # the names of a product of domains have spaces
            key, equals, value = part.partition("=")
            if equals:
                self.keys[last := key] = value
            else:
                self.keys[last] += " " + part
        self._process = process

    @staticmethod
    def _ask(process: subprocess.Popen[bytes]) -> IO[bytes]:
        assert process.stdin is not None
        return process.stdin

    @staticmethod
    def _answer(process: subprocess.Popen[bytes]) -> IO[bytes]:
        assert process.stdout is not None
        return process.stdout

    def ask(self, operation: bytes, rows: Array, columns: int) -> Array:
        """The answers to rows, so many columns each."""
        with self._lock:
            self.start()
            out = np.empty((len(rows), columns))
            for at in range(0, len(rows), MOST_ROWS):
                part = np.ascontiguousarray(rows[at : at + MOST_ROWS], "<f4")
                out[at : at + len(part)] = self._block(operation, part, columns)
            return out

    def _block(self, operation: bytes, rows: Array, columns: int) -> Array:
        process = self._process
        assert process is not None
        try:
            self._ask(process).write(operation + struct.pack("<I", len(rows)) + rows.tobytes())
            self._ask(process).flush()
            head = self._answer(process).read(4)
            if len(head) == 4 and head != b"\0\0\0\0":
                return np.frombuffer(self._answer(process).read(4 * len(rows) * columns), "<f4").reshape(-1, columns)
            text = self._answer(process).read(struct.unpack("<I", self._answer(process).read(4))[0]) if head else b""
        except (BrokenPipeError, struct.error):
            text = b""
        if process.poll() is not None or not text:
            self.close()
        raise RuntimeError(text.decode("utf-8", "replace") or "the host of the shader ended: a crash of the driver?")

    def close(self) -> None:
        """Ends the process."""
        if self._process is not None:
            self._process.kill()
            self._process.communicate()
            self._process = None

    def __del__(self) -> None:
        process = getattr(self, "_process", None)
        if process is not None and process.stdin is not None:
            process.stdin.close()  # it ends with its input
