"""Answers the block protocol of ``crescent check --exec`` (docs/samplers.md) for a shader."""

from __future__ import annotations

import mmap
import os
import signal
import struct
import sys
import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any, BinaryIO
from urllib.parse import quote

import numpy as np

from . import GREETING_OF_PYTHON, BadInput, MissingPart
from .compilers import compiled
from .device import Array, Device, adapters, driver_of, name_of, title_of
from .languages import assigns, columns, program
from .request import Request, read_request, wants_list

BATCH_SECONDS = 8.0  # of one batch of at most 65536 rows: below the 10 s after which crescent ends a silent program
LOOK_SECONDS = 30.0  # of the first batches, which include the driver's compilation

Answer = Callable[[Array], Array]  # from rows to rows


class Watchdog:
    """Ends the process where a batch takes too long: a driver cannot be interrupted."""

    _LOOKS_A_SECOND = 8

    def __init__(self, report: Callable[[str], None]) -> None:
        self._report = report
        self._running: tuple[float, str] | None = None  # until when, and what to say then
        threading.Thread(target=self._look, daemon=True).start()

    def __call__(self, seconds: float, what: str, call: Callable[[], Array]) -> Array:
        text = f"{what} did not finish within {seconds:g} s: does a loop of the shader never end?"
        self._running = (time.monotonic() + seconds, text)
        try:
            return call()
        finally:
            self._running = None

    def _look(self) -> None:
        while True:
            time.sleep(1 / self._LOOKS_A_SECOND)
            if (running := self._running) and time.monotonic() > running[0]:
                self._report(running[1])
                os._exit(3)


@dataclass(frozen=True)
class Shader:
    """A compiled request: each operation, and what the handshake declares."""

    request: Request
    adapter: Any
    channels: int
    weights: int
    delta: bool
    operations: dict[str, Answer]

    def handshake(self, to_python: bool = False, memory: bool = False) -> str:
        """The line that declares the sampler; `to_python`: with what crescent_shader.client asks for."""
        request = self.request
        keys = {
            "u": str(request.numbers),
            "domain": request.domain,
            "wo": request.sides,
            "channels": str(self.channels),
            "block": "f32",
            "real": "f32",
            "device": quote(name_of(self.adapter)),
            "driver": quote(driver_of(self.adapter)),
        }
        given = {
            "weight": ("yes", self.weights > 0),
            "delta": ("yes", self.delta),
            "pdf": ("no", "pdf" not in self.operations),
            "f": ("cos", request.f_has_cosine),
            "eta": (request.eta, bool(request.eta)),
            "uses": (",".join(request.uses), bool(request.uses)),
            "transport": ("importance", request.transport == "importance"),
            "reciprocal": ("no", not request.reciprocal),
            "memory": ("yes", memory),
        }
        keys |= {key: value for key, (value, there) in given.items() if there}
        if to_python:
            keys |= {"coordinates": str(request.coordinates), "has_f": "yes" if "f" in self.operations else "no"}
        name = " ".join(request.name.replace("=", " ").split()) or "shader"
        return f"hello 2 {name} " + " ".join(f"{key}={value}" for key, value in keys.items())


def _check_numbers(request: Request, samples: Array) -> None:
    """Refuses samples that take more random numbers than they are given: their last column counts them."""
    if request.random and (taken := samples[:, -1].max(initial=0)) > request.numbers:
        raise BadInput(f"a sample takes {taken:.0f} random numbers, and {request.numbers} are given: --numbers K")


def _rows_to_look_with(count: int) -> Array:
    """A few rows that a function can evaluate: two oblique directions, then numbers spread over (0, 1)."""
    at = np.arange(64)[:, None] + 0.5
    z, phi = 0.1 + 0.8 * np.modf(at * 0.6180339887)[0], 2 * np.pi * np.modf(at * 0.7548776662)[0]
    r = np.sqrt(1 - z * z)
    rows: Array = np.modf(at * np.array([[0.5698402910 + 0.137 * k for k in range(count)]]))[0]
    directions = np.hstack([r * np.cos(phi), r * np.sin(phi), z, r * np.sin(phi), -r * np.cos(phi), z])
    if count >= 6:
        rows[:, :6] = directions
    elif count >= 3:
        rows[:, :3] = directions[:, :3]
    return rows


def opened(request: Request, watch: Watchdog) -> Shader:
    """Compiles the operations and evaluates each once; raises BadInput or MissingPart."""
    device = Device(request.device)

    def made(operation: str, channels: int, weights: int) -> Answer:
        text = program(request, operation, channels, weights)
        return device.evaluator(request, text, compiled(request, text))

    def look(operation: str, answer: Answer) -> Array:
        rows = _rows_to_look_with(columns(request, operation)[0])
        return watch(LOOK_SECONDS, f"{operation} of {len(rows)} rows", lambda: answer(rows))

    operations: dict[str, Answer] = {}
    channels = request.channels
    if request.f:
        candidates = (channels,) if channels else (3,) if request.language in ("hlsl", "slang") else (1, 3)
        operations["f"] = _first_that_compiles(lambda count: made("f", count, 0), candidates)[0]
        seen = look("f", operations["f"])
        channels = channels or int(seen[0, 3])
    weighs = assigns(request.sample, "weight")
    candidates = (0,) if not weighs else (channels,) if channels else (1, 3)
    operations["sample"], weights = _first_that_compiles(lambda count: made("sample", max(count, 1), count), candidates)
    _check_numbers(request, look("sample", operations["sample"]))
    if request.pdf:
        operations["pdf"] = made("pdf", 1, 0)
        look("pdf", operations["pdf"])
    delta = assigns(request.sample, "delta")
    if delta and not weighs:
        raise BadInput("--sample assigns delta without weight: expected weight = f |cos| / delta with it")
    if not request.pdf and not assigns(request.sample, "pdf") and not weighs:
        raise BadInput(f"{request.path}: expected --pdf 'EXPRESSION', or a sample that assigns pdf or weight")
    return Shader(request, device.adapter, channels or max(weights, 1), weights, delta, operations)


def _first_that_compiles(make: Callable[[int], Answer], candidates: tuple[int, ...]) -> tuple[Answer, int]:
    """The first of these counts that the snippet's types fit; else the error of the first one."""
    first: BadInput | None = None
    for count in candidates:
        try:
            return make(count), count
        except BadInput as error:
            first = first or error
    assert first is not None
    raise first


# ---- The protocol.


def _answers(shader: Shader) -> dict[bytes, tuple[int, Answer]]:
    """For each operation of the protocol the columns of a row, and its answer."""
    request = shader.request
    operations = shader.operations

    def sample(rows: Array) -> Array:
        out = operations["sample"](rows)
        _check_numbers(request, out)
        return out[:, : (request.coordinates or 3) + 1 + shader.weights]

    def pdf(rows: Array) -> Array:
        return operations["pdf"](rows) if "pdf" in operations else np.ones((len(rows), 1))

    def f(rows: Array) -> Array:
        if "f" not in operations:
            return np.full((len(rows), shader.channels), np.nan)
        return operations["f"](rows)[:, : shader.channels]

    answers = {b"smpl": ("sample", sample), b"pdf_": ("pdf", pdf), b"f___": ("f", f)}
    return {letters: (columns(request, operation)[0], answer) for letters, (operation, answer) in answers.items()}


class Memory:
    """The memory for blocks that crescent shares (PipeConnection in src/check/sources/pipe_io.h): they use the slots in
    turn, and the answers are in the second half of a slot."""

    WORD = "--memory"  # the first one where crescent gives the memory, as descriptor 3
    _FILE, _SLOTS, _SLOT_BYTES = 3, 2, 16 << 20

    def __init__(self) -> None:
        try:
            shared = mmap.mmap(self._FILE, self._SLOTS * self._SLOT_BYTES)
        except (OSError, ValueError):
            text = f"{self.WORD}: descriptor {self._FILE} is no memory: crescent check starts this module"
            raise BadInput(text) from None
        self._floats = np.frombuffer(shared, "<f4").reshape(self._SLOTS, 2, -1)
        self._read = self._written = 0

    def rows(self, count: int, columns: int) -> Array:
        """Those of the next block."""
        given: Array = self._floats[self._read % self._SLOTS, 0, : count * columns]
        self._read += 1
        return given.reshape(count, columns)

    def answer(self, rows: Array | None) -> None:
        """The answer to the next block; none after an error."""
        if rows is not None:
            self._floats[self._written % self._SLOTS, 1, : rows.size].reshape(rows.shape)[:] = rows
        self._written += 1


def _serve(requests: BinaryIO, answers: BinaryIO, shader: Shader, watch: Watchdog, memory: Memory | None) -> None:
    """Reads the next block and writes the last one while one is evaluated; raises where either fails."""
    operations = _answers(shader)

    def read() -> tuple[str, Answer, Array] | None:
        head = requests.read(8)
        if len(head) < 8:
            return None
        letters, (count,) = head[:4], struct.unpack("<I", head[4:])
        columns, answer = operations[letters]
        if memory:
            rows = memory.rows(count, columns)
        else:
            rows = np.frombuffer(requests.read(4 * count * columns), "<f4").reshape(count, columns)
        return f"{letters.decode().strip('_').replace('smpl', 'sample')} of {count} rows", answer, rows

    def evaluated(what: str, answer: Answer, rows: Array) -> tuple[bytes, Array | None]:
        try:
            return struct.pack("<I", len(rows)), watch(BATCH_SECONDS, what, lambda: answer(rows))
        except Exception as error:  # noqa: BLE001: crescent reports every error of the device
            return _error_block(str(error)), None

    def write(head: bytes, rows: Array | None) -> None:
        if memory:
            memory.answer(rows)
        answers.write(head)
        if rows is not None and not memory:
            answers.write(np.ascontiguousarray(rows, "<f4").data)
        answers.flush()

    if memory:  # there is little to read and write
        while block := read():
            write(*evaluated(*block))
        return
    with ThreadPoolExecutor(1) as reader, ThreadPoolExecutor(1) as writer:
        asked, written = reader.submit(read), writer.submit(lambda: None)
        while block := asked.result():
            asked = reader.submit(read)
            answer = evaluated(*block)
            written.result()
            written = writer.submit(write, *answer)
        written.result()


def _error_block(text: str) -> bytes:
    data = " ".join(text.split()).encode()[:4000]
    return struct.pack("<II", 0, len(data)) + data


def main(words: list[str] | None = None) -> int:
    """Serves the shader that the command line names."""
    words = sys.argv[1:] if words is None else words
    shares_memory = words[:1] == [Memory.WORD]
    words = words[shares_memory:]
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    if "-h" in words or "--help" in words or (not words and sys.stdin.isatty()):
        from .request import _parser

        _parser().print_help()
        return 0
    answers: Any = os.fdopen(os.dup(1), "wb", 1 << 20)
    os.dup2(2, 1)

    def say(line: str) -> None:
        answers.write((" ".join(line.split()) + "\n").encode(errors="replace"))
        answers.flush()

    try:
        if wants_list(words):
            for adapter in adapters():
                say(title_of(adapter))
            return 0
        request = read_request(words)
        greeting = sys.stdin.buffer.readline()
        if not greeting.startswith(b"hello 2"):
            print("crescent check starts this module: crescent check FILE.wgsl", file=sys.stderr)
            return 2
        memory = Memory() if shares_memory else None
        shader = opened(request, Watchdog(lambda text: say(f"error {request.path}: {text}")))
    except BadInput as error:
        say(f"error {error}")
        return 2
    except MissingPart as error:
        say(f"missing {error}")
        return 3
    say(shader.handshake(to_python=greeting.strip() == GREETING_OF_PYTHON, memory=shares_memory))

    def report(text: str) -> None:
        answers.write(_error_block(text))
        answers.flush()

    _serve(sys.stdin.buffer, answers, shader, Watchdog(report), memory)
    return 0
