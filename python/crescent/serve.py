"""``python -m crescent.serve FILE.py:NAME``: a sampler in Python behind the pipe protocol, for ``check`` and ``run``.

Protocol 2 in blocks of doubles (docs/samplers.md has its grammar): a request is four letters, a count and so many rows
of w_o and u, or of w_o and w_i; an answer is the count and its rows. Protocol 3, of a sampler that uses a context, has
the columns of the context after them. The sampler's own output goes to stderr.
"""

from __future__ import annotations

import os
import signal
import struct
import sys
import sysconfig
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any, BinaryIO
from urllib.parse import quote

import numpy as np

from . import _arrays, _crescent
from ._arrays import Array
from ._check import _look, _of_library
from ._context import ContextCalls, columns_of, decoded, on_one_surface
from ._domains import NEIGHBOUR_COLUMNS, as_given, points, values, weighted, with_weights
from ._files import sampler_at
from ._sampler import Sampler, rows_to_look_with

Answer = Callable[[Array], Array]


class _Points:
    """The callables of a sampler of points of a domain on rows of w_o, if it takes one, and u or a point."""

    def __init__(self, s: Sampler) -> None:
        self.chart = _crescent.domain_chart(s.domain)
        self._sampler, self._name = _of_library(s), s.title()
        self.wo = 0 if s.wo == "none" else 3

    def sample(self, rows: Array) -> Array:
        """Rows of a point, its pdf and its weights."""
        given = (rows[:, : self.wo], rows[:, self.wo :]) if self.wo else (rows,)
        x, pdf, weight = points(self._sampler.sample(*given), len(rows), self._name, self.chart.coordinates)
        if self._sampler.pdf is None:
            pdf = (pdf > 0).astype(np.float64)
        return np.column_stack([x, pdf] if weight is None else [x, pdf, weight])

    def value(self, call: Callable[..., Any], what: str, rows: Array) -> Array:
        """Rows of pdf, or of f."""
        x = as_given(rows[:, self.wo :], self.chart)
        answer = call(rows[:, : self.wo], x) if self.wo else call(x)
        return _arrays.channels(answer, len(rows), f"{self._name}: {what}")

    def pdf(self, rows: Array) -> Array:
        """`pdf`, or 1 where the sampler has none."""
        return np.ones(len(rows)) if self._sampler.pdf is None else self.value(self._sampler.pdf, "pdf", rows)[:, 0]

    def f(self, rows: Array, count: int) -> Array:
        """f by channel, NaN where the sampler has none."""
        if self._sampler.f is None:
            return np.full((len(rows), count), np.nan)
        return np.broadcast_to(self.value(self._sampler.f, "f", rows), (len(rows), count))


def _started_points(s: Sampler) -> tuple[str, Sampler, dict[bytes, tuple[int, Answer]]]:
    """As `_started`, for a sampler of points of a domain."""
    calls = _Points(s)
    wo, u = rows_to_look_with(8, s.u)
    drawn = calls.sample(np.column_stack([wo, u]) if calls.wo else u)
    coordinates = calls.chart.coordinates
    weights = drawn.shape[1] - coordinates - 1
    counts = [weights] if weights else []
    if s.f is not None:
        counts.append(calls.value(s.f, "f", np.column_stack([wo[:, : calls.wo], drawn[:, :coordinates]])).shape[1])
    count = s.channels or max(counts, default=1)
    operations: dict[bytes, tuple[int, Answer]] = {
        b"smpl": (calls.wo + s.u, calls.sample),
        b"pdf_": (calls.wo + coordinates, calls.pdf),
        b"f___": (calls.wo + coordinates, lambda rows: calls.f(rows, count)),
    }
    return _handshake(s, count, weights > 0, False), s, operations


def _started_number(s: Sampler) -> tuple[str, Sampler, dict[bytes, tuple[int, Answer]]]:
    """As `_started`, for an estimator of a number."""
    inner = _of_library(s)

    def sample(u: Array) -> Array:
        return values(inner.sample(u), len(u), s.title())

    count = s.channels or sample(rows_to_look_with(8, s.u)[1]).shape[1]
    return _handshake(s, count, False, False), s, {b"smpl": (s.u, sample)}


def _started_reservoir(s: Sampler) -> tuple[str, Sampler, dict[bytes, tuple[int, Answer]]]:
    """As `_started`, for a sampler of directions with weights that estimate 1/p."""
    if not s.of_directions():
        raise ValueError("weight='reciprocal' in a file is for directions; crescent.check takes other domains too")
    inner = _of_library(s)
    drawing, takes_wo = with_weights(inner), s.wo != "none"

    def sample(rows: Array) -> Array:
        wo, u, rest = rows[:, :3], rows[:, 3 : 3 + s.u], rows[:, 4 + s.u :]
        if s.merge:
            answer = inner.sample(wo, u, rest.reshape(len(rows), -1, NEIGHBOUR_COLUMNS))
            wi, _, weight = weighted(answer, len(rows), s.title())
        else:
            wi, _, weight = drawing.sample(*((wo, u) if takes_wo else (u,)))
        return np.column_stack([_arrays.directions(wi, len(rows), f"{s.title()}: sample's wi"), weight])

    def target(rows: Array) -> Array:
        assert drawing.f is not None
        return _arrays.column(drawing.f(rows[:, :3], rows[:, 3:6]), len(rows), f"{s.title()}: target")

    return _handshake(s, 1, False, False), s, {b"smpl": (3 + s.u, sample), b"trgt": (6, target)}


class _Calls:
    """The callables of a sampler on rows of w_o, a second part and the columns of a context."""

    def __init__(self, s: Sampler) -> None:
        self._uses, self._name, self._takes_wo = s.uses, s.title(), s.wo != "none"
        self._calls = ContextCalls(s) if s.uses else None
        self._sampler = s if s.uses else _of_library(s)

    def sample(self, rows: Array) -> _arrays.Parts:
        """All four parts of `sample`."""
        end = 3 + self._sampler.u
        wo, u = rows[:, :3], rows[:, 3:end]
        if self._calls is None:
            return _arrays.asks_sample(self._sampler.sample, self._name, self._takes_wo)(wo, u)
        answer = self._calls.sample(wo, u, *decoded(self._uses, rows[:, end:]))
        return _arrays.draws(answer, len(rows), self._name)

    def _value(self, call: Callable[..., Any], rows: Array) -> Any:
        wo, wi = rows[:, :3], rows[:, 3:6]
        if self._calls is None:
            return call(wo, wi) if self._takes_wo else call(wi)
        return self._calls.value(call, wo, wi, *decoded(self._uses, rows[:, 6:]))

    def pdf(self, rows: Array) -> Array:
        """`pdf`, or 1 where the sampler has none."""
        if self._sampler.pdf is None:
            return np.ones(len(rows))
        return _arrays.column(self._value(self._sampler.pdf, rows), len(rows), f"{self._name}: pdf")

    def f(self, rows: Array, count: int) -> Array:
        """f by channel, NaN where the sampler has none."""
        if self._sampler.f is None:
            return np.full((len(rows), count), np.nan)
        call = self._sampler.f

        def bound(wo: Array, wi: Array) -> Any:
            return self._value(call, rows)

        ask = _arrays.asks_f(bound, self._name, count)
        return np.broadcast_to(ask(rows[:, :3], rows[:, 3:6]), (len(rows), count))


def _samples(s: Sampler, calls: _Calls, weights: int, delta: bool) -> Answer:
    """Rows of w_o and u -> rows of w_i, pdf and weights; -q is the pdf of a delta part."""

    def answer(rows: Array) -> Array:
        wi, pdf, weight, chosen = calls.sample(rows)
        out = np.empty((len(rows), 4 + weights))
        out[:, :3] = wi
        out[:, 3] = pdf if s.pdf is not None else pdf > 0
        if delta and chosen is not None:
            np.copyto(out[:, 3], -chosen, where=chosen > 0)
        if weights and weight is None:
            raise ValueError(f"{s.title()}: sample gave no weight here, and gave one before")
        if weights:
            out[:, 4:] = weight
        return out

    return answer


def _handshake(s: Sampler, count: int, weighs: bool, delta: bool) -> str:
    """The line that declares what the sampler is."""
    keys: dict[str, Any] = {"u": s.u, "domain": s.domain, "wo": s.wo, "channels": count, "block": "f64"}
    given = {
        "weight": (s.weight or "yes", weighs or s.weight is not None),
        "merge": ("yes", s.merge),
        "delta": ("yes", delta),
        "pdf": ("no", s.pdf is None and s.weight is None),
        "transport": ("importance", s.importance),
        "reciprocal": ("no", not s.reciprocal),
        "random": ("own", s.own_random),
        "u_bits": ("53", s.u_bits == 53),
    }
    keys.update({key: value for key, (value, there) in given.items() if there})
    if s.evaluator is not None:
        device, driver, precision = s.evaluator
        real = {"single": "f32", "double": "f64"}[precision]
        named = {"device": quote(device), "driver": quote(driver), "real": real}
        keys.update({key: value for key, value in named.items() if value})
    if s.eta is not None:
        keys["eta"] = ",".join(repr(float(v)) for v in np.atleast_1d(s.eta))
    if s.uses:
        keys["uses"] = ",".join(s.uses)
    name = " ".join(s.title().replace("=", "-").split()) or "sampler"
    return f"hello 2 {name} " + " ".join(f"{key}={value}" for key, value in keys.items())


def _started(where: str) -> tuple[str, Sampler, dict[bytes, tuple[int, Answer]]]:
    """The handshake of the sampler there, the sampler, and for each operation the columns before those of the context,
    and its answer."""
    s = sampler_at(where)
    if s.is_number():
        return _started_number(s)
    if s.weight is not None:
        return _started_reservoir(s)
    if not s.of_directions():
        return _started_points(s)
    channels, weighs, delta = _look(on_one_surface(s, {}) if s.uses else _of_library(s))
    count = s.channels or channels
    delta = delta if s.delta is None else s.delta
    if delta and not weighs:
        raise ValueError(f"{where}: sample gives delta parts without weights; expected (wi, pdf, weight, delta)")
    calls = _Calls(s)
    operations: dict[bytes, tuple[int, Answer]] = {
        b"smpl": (3 + s.u, _samples(s, calls, count if weighs else 0, delta)),
        b"pdf_": (6, calls.pdf),
        b"f___": (6, lambda rows: calls.f(rows, count)),
    }
    return _handshake(s, count, weighs, delta), s, operations


def _users_line(error: BaseException) -> str:
    """"FILE.py:LINE: " of the innermost line of the user's files that the error came through; "" if there is none."""
    libraries = [Path(path).resolve() for path in {*sysconfig.get_paths().values()} if Path(path).is_dir()]
    libraries.append(Path(__file__).resolve().parent)
    programs = {Path(path).resolve() for path in (sys.prefix, sys.base_prefix)}

    def is_users(name: str) -> bool:
        path = Path(name).resolve()
        if not path.is_file() or {"site-packages", "dist-packages"} & set(path.parts):
            return False  # "<frozen importlib._bootstrap>" is no file
        return not any(path.is_relative_to(folder) for folder in libraries if folder not in programs)

    places = [(frame.filename, frame.lineno) for frame in traceback.extract_tb(error.__traceback__)]
    if isinstance(error, SyntaxError) and error.filename:
        places.append((error.filename, error.lineno))
    for name, line in reversed(places):
        if line is not None and is_users(name):
            near = os.path.relpath(name)
            return f"{name if near.startswith(os.pardir) else near}:{line}: "
    return ""


def _said(error: BaseException) -> str:
    """An error in one line, with the line of the user's file."""
    text = " ".join((error.msg if isinstance(error, SyntaxError) else str(error)).split())
    return _users_line(error) + (text if isinstance(error, ValueError) and text else f"{type(error).__name__}: {text}")


def _serve(requests: BinaryIO, answers: BinaryIO, s: Sampler, operations: dict[bytes, tuple[int, Answer]]) -> None:
    """Answers blocks until the input ends."""
    while len(head := requests.read(8)) == 8:
        columns, answer = operations[head[:4]]
        count = struct.unpack("<I", head[4:])[0]
        lights = struct.unpack("<I", requests.read(4))[0] if "lights" in s.uses else 0
        columns += columns_of(s.uses, lights)
        if s.merge and head[:4] == b"smpl":
            columns += 1 + NEIGHBOUR_COLUMNS * struct.unpack("<I", requests.read(4))[0]
        rows = np.frombuffer(requests.read(8 * count * columns), "<f8").reshape(count, columns)
        try:
            out = np.ascontiguousarray(answer(rows), "<f8")
        except (Exception, SystemExit) as error:  # noqa: BLE001: the check reports every exception of the sampler
            text = _said(error).encode()
            answers.write(struct.pack("<II", 0, len(text)) + text)
        else:
            answers.write(struct.pack("<I", count))
            answers.write(out.data)
        answers.flush()


def main() -> int:
    """Serves the sampler that the command line names."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    requests = sys.stdin.buffer
    answers = os.fdopen(os.dup(1), "wb", 1 << 20)
    os.dup2(2, 1)
    if not requests.readline().startswith(b"hello 2"):
        print("crescent check starts this module: crescent check FILE.py:NAME", file=sys.stderr)
        return 2
    try:
        if len(sys.argv) != 2:
            raise ValueError("crescent.serve takes one FILE.py:NAME")
        handshake, sampler, operations = _started(sys.argv[1])
    except (Exception, SystemExit) as error:  # noqa: BLE001: an error of the imported module is one of the call
        answers.write(f"error {_said(error).removeprefix(sys.argv[-1] + ': ')}\n".encode())
        answers.flush()
        return 2
    answers.write(handshake.encode(errors="replace") + b"\n")
    answers.flush()
    with np.errstate(all="ignore"):
        _serve(requests, answers, sampler, operations)
    return 0


if __name__ == "__main__":
    sys.exit(main())
