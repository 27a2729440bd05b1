"""``python -m crescent.serve FILE.py:NAME``: a sampler in Python behind the pipe protocol, for ``crescent check``.

Protocol 2 in blocks of doubles (docs/samplers.md has its grammar): a request is four letters, a count and so many rows
of w_o and u, or of w_o and w_i; an answer is the count and its rows. The sampler's own output goes to stderr.
"""

from __future__ import annotations

import os
import signal
import struct
import sys
from collections.abc import Callable
from typing import Any, BinaryIO

import numpy as np

from . import _arrays
from ._arrays import Array
from ._check import _look, _of_library
from ._files import sampler_at
from ._sampler import Sampler

Answer = Callable[[Array], Array]


def _samples(s: Sampler, weights: int, delta: bool) -> Answer:
    """Rows of w_o and u -> rows of w_i, pdf and weights; -q is the pdf of a delta part."""
    ask = _arrays.asks_sample(s.sample, s.title(), s.wo != "none")

    def answer(rows: Array) -> Array:
        wi, pdf, weight, chosen = ask(rows[:, :3], rows[:, 3:])
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


def _values(ask: Callable[[Array, Array], Array]) -> Answer:
    """Rows of w_o and w_i -> values."""
    return lambda rows: ask(rows[:, :3], rows[:, 3:])


def _f(s: Sampler, count: int) -> Answer:
    """f by channel, NaN where the sampler has none."""
    if s.f is None:
        return lambda rows: np.full((len(rows), count), np.nan)
    ask = _arrays.asks_f(s.f, s.title(), count)
    return lambda rows: np.broadcast_to(ask(rows[:, :3], rows[:, 3:]), (len(rows), count))


def _handshake(s: Sampler, count: int, weighs: bool, delta: bool) -> str:
    """The line that declares what the sampler is."""
    keys: dict[str, Any] = {"u": s.u, "domain": s.domain, "wo": s.wo, "channels": count, "block": "f64"}
    given = {
        "weight": ("yes", weighs),
        "delta": ("yes", delta),
        "pdf": ("no", s.pdf is None),
        "transport": ("importance", s.importance),
        "reciprocal": ("no", not s.reciprocal),
        "random": ("own", s.own_random),
    }
    keys.update({key: value for key, (value, there) in given.items() if there})
    if s.eta is not None:
        keys["eta"] = ",".join(repr(float(v)) for v in np.atleast_1d(s.eta))
    name = " ".join(s.title().replace("=", "-").split()) or "sampler"
    return f"hello 2 {name} " + " ".join(f"{key}={value}" for key, value in keys.items())


def _started(where: str) -> tuple[str, dict[bytes, tuple[int, Answer]]]:
    """The handshake of the sampler there, and for each operation the columns of a request and its answer."""
    s = _of_library(sampler_at(where))
    channels, weighs, delta = _look(s)
    count = s.channels or channels
    delta = delta if s.delta is None else s.delta
    if delta and not weighs:
        raise ValueError(f"{where}: sample gives delta parts without weights; expected (wi, pdf, weight, delta)")
    pdf = _arrays.asks_pdf(s.pdf, s.title(), s.wo != "none") if s.pdf is not None else lambda wo, wi: np.ones(len(wo))
    return _handshake(s, count, weighs, delta), {
        b"smpl": (3 + s.u, _samples(s, count if weighs else 0, delta)),
        b"pdf_": (6, _values(pdf)),
        b"f___": (6, _f(s, count)),
    }


def _said(error: BaseException) -> str:
    """An error in one line."""
    text = " ".join(str(error).split())
    return text if isinstance(error, ValueError) and text else f"{type(error).__name__}: {text}"


def _serve(requests: BinaryIO, answers: BinaryIO, operations: dict[bytes, tuple[int, Answer]]) -> None:
    """Answers blocks until the input ends."""
    while len(head := requests.read(8)) == 8:
        columns, answer = operations[head[:4]]
        count = struct.unpack("<I", head[4:])[0]
        rows = np.frombuffer(requests.read(8 * count * columns), "<f8").reshape(count, columns)
        try:
            out = np.ascontiguousarray(answer(rows), "<f8")
        except Exception as error:  # noqa: BLE001: whatever the sampler raises is reported by the check
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
        handshake, operations = _started(sys.argv[1])
    except Exception as error:  # noqa: BLE001: an error of the module that is imported is one of the call
        answers.write(f"error {_said(error).removeprefix(sys.argv[-1] + ': ')}\n".encode())
        answers.flush()
        return 2
    answers.write(handshake.encode(errors="replace") + b"\n")
    answers.flush()
    with np.errstate(all="ignore"):
        _serve(requests, answers, operations)
    return 0


if __name__ == "__main__":
    sys.exit(main())
