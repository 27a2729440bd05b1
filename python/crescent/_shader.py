"""Samplers in shader files: :func:`shader`."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from os import PathLike
from typing import Any
from urllib.parse import unquote

import numpy as np
from crescent_shader.client import Host

from ._arrays import Array
from ._context import ARRAYS
from ._sampler import Sampler

Value = float | int | bool | Iterable[float]


def _text(value: Value | str) -> str:
    """A value as --set reads it: 0.3 is a float, 3 an int."""
    if isinstance(value, str):
        return value
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    return ",".join(_text(v) for v in value)


def _many(value: str | Iterable[str]) -> list[str]:
    return [value] if isinstance(value, str) else [os.fspath(v) for v in value]


@dataclass(frozen=True)
class _Calls:
    """The callables of a host; they can be sent to another process, which starts a host of its own."""

    host: Host
    point: int  # coordinates of a point of a domain; 0: directions
    has_wo: bool
    weights: int
    channels: int
    delta: bool
    cosine: bool
    uses: tuple[str, ...]

    def _rows(self, parts: tuple[Any, ...]) -> Array:
        """w_o if the host takes it, what the callable is given after it, and the columns of a context."""
        given = [np.asarray(part, np.float64) for part in parts[: len(parts) - bool(self.uses)]]
        columns = [part[:, None] if part.ndim == 1 else part for part in given]
        n = len(columns[-1])
        if self.has_wo and len(columns) == 1:  # a sampler that takes no w_o
            columns.insert(0, np.broadcast_to([0.0, 0.0, 1.0], (n, 3)))
        for name in self.uses:
            value = np.asarray(getattr(parts[-1], name), np.float64)
            columns.append(value.reshape(n, -1))
        return np.concatenate(columns, 1)

    def sample(self, *at: Any) -> tuple[Any, ...]:
        """(w_i or x, pdf[, weight[, delta]])"""
        width = self.point or 3
        out = self.host.ask(b"smpl", self._rows(at), width + 1 + self.weights)
        x, pdf = out[:, 0] if self.point == 1 else out[:, :width], out[:, width]
        if not self.weights:
            return x, pdf
        if not self.delta:
            return x, pdf, out[:, width + 1 :]
        return x, np.maximum(pdf, 0), out[:, width + 1 :], np.maximum(-pdf, 0)

    def pdf(self, *at: Any) -> Array:
        """The density."""
        return self.host.ask(b"pdf_", self._rows(at), 1)[:, 0]

    def f(self, *at: Any) -> Array:
        """f without the cosine."""
        rows = self._rows(at)
        out = self.host.ask(b"f___", rows, self.channels)
        if self.cosine:
            cosine = np.abs(rows[:, 5:6])
            out = np.divide(out, cosine, out=np.zeros_like(out), where=cosine > 0)
        return out


def shader(
    file: str | PathLike[str],
    *,
    sample: str | None = None,
    pdf: str | None = None,
    f: str | None = None,
    f_cos: str | None = None,
    set: Mapping[str, Value | str] | None = None,  # the word of the command line
    let: str | Iterable[str] = (),
    numbers: int | None = None,
    include: str | Iterable[str] = (),
    define: Mapping[str, Value | str] | None = None,
    prelude: str | Iterable[str] = (),
    random: str | Iterable[str] = (),
    up: str | None = None,
    frame: str | None = None,
    domain: str | None = None,
    sides: str | None = None,
    eta: Value | None = None,
    channels: int | None = None,
    uses: Iterable[str] = (),
    reciprocal: bool = True,
    importance: bool = False,
    name: str | None = None,
    device: str | None = None,
) -> Sampler:
    """Returns the sampler in a WGSL, GLSL, HLSL or Slang file, by the options of ``crescent check FILE``.

    ``crescent.shader("ggx.wgsl", sample="wi = ggx_sample(wo, u, alpha)", pdf="ggx_pdf(wo, wi, alpha)",
    set={"alpha": 0.3})`` can be checked, and be an arm of a run. A process of its own evaluates it. Raises ValueError
    for a mistake in the file or a snippet, with its place, and RuntimeError if a compiler or a driver is missing.
    """
    single = {
        "sample": sample, "pdf": pdf, "f": f, "f-cos": f_cos, "numbers": numbers, "up": up, "frame": frame,
        "domain": domain, "sides": sides, "channels": channels, "name": name, "device": device,
        "eta": None if eta is None else _text(eta), "uses": ",".join(uses) or None,
        "transport": "importance" if importance else None,
    }  # fmt: skip
    words = [f"--{key}={value}" for key, value in single.items() if value is not None]
    words += [f"--set={key}={_text(value)}" for key, value in (set or {}).items()]
    words += [f"--let={text}" for text in _many(let)]
    words += [f"--prelude={path}" for path in _many(prelude)]
    words += [f"--random={text}" for text in _many(random)]
    words += [f"-I{os.path.abspath(path)}" for path in _many(include)]
    words += [f"-D{key}={_text(value)}" for key, value in (define or {}).items()]
    words += ["--no-reciprocal"] if not reciprocal else []
    host = Host([*words, "--", os.path.abspath(file)])
    host.start()
    keys = host.keys
    point = 0 if keys["domain"] in ("sphere", "hemisphere") else int(keys["coordinates"])
    count = int(keys["channels"])
    calls = _Calls(
        host=host,
        point=point,
        has_wo=point == 0 or keys["wo"] != "none",
        weights=count if keys.get("weight") == "yes" else 0,
        channels=count,
        delta=keys.get("delta") == "yes",
        cosine=keys.get("f") == "cos",
        uses=tuple(name for name in ARRAYS if name in keys.get("uses", "").split(",")),
    )
    indices = [float(v) for v in keys["eta"].split(",")] if "eta" in keys else None
    return Sampler(
        calls.sample,
        None if keys.get("pdf") == "no" else calls.pdf,
        calls.f if keys["has_f"] == "yes" else None,
        name=host.name,
        u=int(keys["u"]),
        domain=keys["domain"],
        wo=keys["wo"],  # type: ignore[arg-type]
        channels=count,
        delta=calls.delta or None,
        eta=indices,
        importance=keys.get("transport") == "importance",
        reciprocal=keys.get("reciprocal") != "no",
        serial=True,
        evaluator=(unquote(keys["device"]), unquote(keys["driver"]), "single"),
        uses=calls.uses,  # type: ignore[arg-type]
        array_module="numpy",
    )
