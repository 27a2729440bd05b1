"""A device of WebGPU that evaluates programs in batches: a graphics processor if there is one, else Mesa's llvmpipe."""

from __future__ import annotations

import os
import re
import sys
import tempfile
from typing import Any

import numpy as np

from . import BadInput, MissingPart
from .compilers import Code, hint, not_given
from .languages import IN, OUT, ROWS_IN_GROUP, SET, Program
from .request import Request

MOST_ROWS = 1 << 16  # of a block of the protocol

Array = np.ndarray[Any, Any]


def _wgpu() -> Any:
    """The module wgpu without its OpenGL back end, which looks for a display first."""
    os.environ.setdefault("XDG_RUNTIME_DIR", tempfile.gettempdir())  # else libraries of the display report its absence
    try:
        import wgpu  # type: ignore[import-untyped,unused-ignore]
    except ImportError as error:
        raise MissingPart(f"no Python package wgpu ({error}): pip install 'crescent-bench[shader]'") from None
    if sys.platform == "linux":
        from wgpu.backends.wgpu_native import extras  # type: ignore[import-untyped,unused-ignore]

        try:
            extras.set_instance_extras(backends=["Vulkan"])
        except (RuntimeError, TypeError, ValueError):
            pass  # another part of this process has made the instance, or another version of wgpu
    return wgpu


def _is_cpu(adapter: Any) -> bool:
    return str(adapter.info["adapter_type"]).upper() == "CPU"


def adapters() -> list[Any]:
    """All adapters, graphics processors first."""
    found = _wgpu().gpu.enumerate_adapters_sync()
    if not found:
        raise MissingPart(
            "no driver of Vulkan, Metal or Direct3D: in Debian the package mesa-vulkan-drivers runs on a CPU"
        )
    return sorted(found, key=_is_cpu)


def name_of(adapter: Any) -> str:
    """The name of the hardware."""
    return str(adapter.info["device"])


def driver_of(adapter: Any) -> str:
    """The driver and its interface."""
    info = adapter.info
    return f"{info['description']} ({info['backend_type']})" if info["description"] else str(info["backend_type"])


def title_of(adapter: Any) -> str:
    """The adapter and its driver."""
    return f"{name_of(adapter)}, {driver_of(adapter)}"


class Device:
    """An adapter that is opened."""

    def __init__(self, name: str = "") -> None:
        found = adapters()
        chosen = [a for a in found if name.lower() in title_of(a).lower()]
        if not chosen:
            raise BadInput(f"--device {name}: no such adapter; expected one of: {'; '.join(title_of(a) for a in found)}")
        self.adapter = chosen[0]
        wanted = ("shader-f16", "shader-f64", "shader-int64", "subgroup")
        features = [feature for feature in wanted if feature in self.adapter.features]
        self.device = self.adapter.request_device_sync(required_features=features)

    def evaluator(self, request: Request, program: Program, code: Code) -> Evaluator:
        """Makes a program's pipeline; raises BadInput with the place of an error."""
        return Evaluator(self.device, request, program, code)


class Evaluator:
    """A program on a device: rows of numbers in, rows of numbers out, single precision between."""

    def __init__(self, device: Any, request: Request, program: Program, code: Code) -> None:
        wgpu = _wgpu()
        self._device, self._out_columns = device, program.columns_out
        kinds = {IN: "read-only-storage", OUT: "storage"}
        layout = device.create_bind_group_layout(
            entries=[
                {"binding": at, "visibility": wgpu.ShaderStage.COMPUTE, "buffer": {"type": kind}}
                for at, kind in kinds.items()
            ]
        )
        usage = wgpu.BufferUsage
        sizes = 4 * MOST_ROWS * program.columns_in, 4 * MOST_ROWS * program.columns_out
        self._rows = device.create_buffer(size=sizes[0], usage=usage.STORAGE | usage.COPY_DST)
        self._out = device.create_buffer(size=sizes[1], usage=usage.STORAGE | usage.COPY_SRC)
        self._staging = device.create_buffer(size=sizes[1], usage=usage.MAP_READ | usage.COPY_DST)
        self._group = device.create_bind_group(
            layout=layout,
            entries=[
                {"binding": at, "resource": {"buffer": buffer, "offset": 0, "size": buffer.size}}
                for at, buffer in ((IN, self._rows), (OUT, self._out))
            ],
        )
        empty = device.create_bind_group_layout(entries=[])
        self._empty = device.create_bind_group(layout=empty, entries=[])
        try:
            module = device.create_shader_module(code=code.code)
            self._pipeline = device.create_compute_pipeline(
                layout=device.create_pipeline_layout(bind_group_layouts=[empty] * SET + [layout]),
                compute={"module": module, "entry_point": code.entry},
            )
        except wgpu.GPUError as error:
            raise _error_of(request, code, str(error)) from None

    def __call__(self, rows: Array) -> Array:
        """Evaluates at most MOST_ROWS rows."""
        size = 4 * len(rows) * self._out_columns
        queue = self._device.queue
        queue.write_buffer(self._rows, 0, np.ascontiguousarray(rows, np.float32))
        encoder = self._device.create_command_encoder()
        work = encoder.begin_compute_pass()
        work.set_pipeline(self._pipeline)
        for at in range(SET):
            work.set_bind_group(at, self._empty)
        work.set_bind_group(SET, self._group)
        work.dispatch_workgroups(-(-len(rows) // ROWS_IN_GROUP))
        work.end()
        encoder.copy_buffer_to_buffer(self._out, 0, self._staging, 0, size)
        queue.submit([encoder.finish()])
        self._staging.map_sync("READ", 0, size)
        try:
            return np.frombuffer(self._staging.read_mapped(0, size), np.float32).reshape(-1, self._out_columns)
        finally:
            self._staging.unmap()


def _error_of(request: Request, code: Code, said: str) -> BadInput:
    """The device's message with the place of the line in the file or snippet."""
    resource = re.search(r"ResourceBinding \{ group: (\d+), binding: (\d+) \}", said)
    if resource and isinstance(code.code, str):
        name = re.search(rf"@group\({resource[1]}\)\s*@binding\({resource[2]}\)\s*var[^;:]*?(\w+)\s*:", code.code)
        return not_given(request, f"'{name[1]}'" if name else "")
    place = re.search(r"┌─ [^:\n]*:(\d+):(\d+)", said)
    texts = [line.strip() for line in said.splitlines()]
    if not place or not code.lines:
        text = next((t for t in reversed(texts) if t and not set(t) <= set("^│ ┌─=")), said)
        return BadInput(f"{request.path}: {' '.join(text.split())}" + hint(text, request))
    line = code.lines[int(place[1]) - 1]
    main = next((t for t in texts if re.match(r"(error|Shader '.*' parsing error|.*[Ee]rror): ", t)), texts[0])
    detail = next((t for t in texts if "^" in t), "").partition("^")[2].lstrip("^ ")
    reasons = [re.sub(r"\S* ?\[\d+\]", "it", t.removeprefix("= ")) for t in texts if t.startswith("= ")]
    reasons = [t for t in reasons if t != "it is invalid"] or reasons
    if "naga::" in detail:  # the compiler's own numbering
        detail = ""
    if reasons or detail in main:
        detail = "; ".join(reasons)
    text = " ".join(re.sub(r"^.*?[Ee]rror: ", "", main).split()) + (f" ({detail})" if detail else "")
    text = text.replace("crescent_main at Compute", "of the snippet")
    at = f"{line.label}:{line.number}:{place[2]}" if line.number else f"{request.path}: in the generated lines"
    return BadInput(f"{at}: {text}" + hint(text, request))
