"""From a program to code for WebGPU: WGSL as it is, GLSL and HLSL to SPIR-V by glslangValidator, Slang by slangc.

Code is kept by the hash of everything that it is made of. Messages of a compiler become one line with the place in the
user's file or snippet.
"""

from __future__ import annotations

import hashlib
import importlib.util
import os
import re
import shutil
import struct
import subprocess
import tempfile
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from . import BadInput, MissingPart
from .languages import OWN, SET, Line, Program
from .request import Request

COMPILER_SECONDS = 60  # a file of 1 MB takes 2 s
KEPT_FILES = 512  # a few kB each


@dataclass(frozen=True)
class Code:
    """What the device is given."""

    code: str | bytes
    entry: str
    lines: tuple[Line, ...] = ()  # of WGSL, for the device's messages


# ---- The cache.


def _cache_folder() -> Path:
    base = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    return Path(base) / "crescent" / "shaders"


def _checksum(data: bytes) -> bytes:
    return zlib.crc32(data).to_bytes(4, "little")


def _kept(key: str) -> bytes | None:
    """What was kept under a key; None if there is nothing, or a damaged file."""
    try:
        path = _cache_folder() / key
        checksum, data = (content := path.read_bytes())[:4], content[4:]
        os.utime(path)
        return data if checksum == _checksum(data) else None
    except OSError:
        return None


def _keep(key: str, data: bytes) -> None:
    """Written as a whole or not at all; the oldest files go. Without a folder to write to, nothing is kept."""
    try:
        folder = _cache_folder()
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=folder, delete=False, prefix=".new-") as file:
            file.write(_checksum(data) + data)
        os.replace(file.name, folder / key)
        files = sorted(folder.iterdir(), key=lambda path: path.stat().st_mtime)
        for old in files[:-KEPT_FILES]:
            old.unlink(missing_ok=True)
    except OSError:
        pass


def _included(text: str, folders: list[Path], found: set[Path]) -> Iterator[bytes]:
    """The contents of all files that a text may include, by any path of the preprocessor."""
    for name in re.findall(r'^\s*(?:#\s*include|import|__include|implementing)\s+"?<?([\w./\\ -]+)', text, re.M):
        for folder in folders:
            for path in (folder / name, folder / (name.strip().replace(".", "/") + ".slang")):
                if path.is_file() and path not in found:
                    found.add(path)
                    data = path.read_bytes()
                    yield str(path).encode() + b"\0" + data
                    yield from _included(data.decode("utf-8", "replace"), [path.parent, *folders], found)


def _key(text: str, command: list[str], tool: str, folders: list[Path]) -> str:
    out = hashlib.sha256()
    stat = os.stat(tool)
    for part in (tool, str(stat.st_size), str(stat.st_mtime_ns), *command, text):
        out.update(part.encode() + b"\0")
    for data in _included(text, folders, set()):
        out.update(data + b"\0")
    return out.hexdigest()


# ---- The compilers.


def _tool(name: str, package: str) -> str:
    if found := shutil.which(name):
        return found
    raise MissingPart(f"no {name} on the PATH: {package}")


def slangc() -> str:
    """The compiler of Slang: on the PATH, or that of the package slangtorch, which is not imported; or MissingPart."""
    spec = importlib.util.find_spec("slangtorch")
    for folder in (spec.submodule_search_locations or ()) if spec else ():
        if not shutil.which("slangc") and (program := Path(folder) / "bin" / "slangc").is_file():
            return str(program)
    releases = "https://github.com/shader-slang/slang/releases"
    return _tool("slangc", f"install Slang, {releases}, or: pip install --no-deps slangtorch")


def _run(command: list[str], folder: str) -> subprocess.CompletedProcess[str]:
    try:
        return subprocess.run(
            command,
            cwd=folder,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=COMPILER_SECONDS,
            stdin=subprocess.DEVNULL,
        )
    except subprocess.TimeoutExpired:
        raise BadInput(f"{Path(command[0]).name} did not end within {COMPILER_SECONDS} s") from None


def _absolute(request: Request) -> list[Path]:
    return [path.absolute() for path in (request.path.parent, *request.include)]


def _compile(request: Request, text: str, tool: str, options: list[str], suffix: str, result: str) -> bytes:
    """Runs a compiler on a text in a folder of its own; raises BadInput with its first error."""
    folders = _absolute(request)
    options = options + [f"-I{folder}" for folder in folders]
    key = _key(text, options, tool, folders)
    if (data := _kept(key)) is not None:
        return data
    with tempfile.TemporaryDirectory(prefix="crescent-shader-") as folder:
        source, output = Path(folder) / f"crescent{suffix}", Path(folder) / f"out{result}"
        source.write_text(text, "utf-8")
        done = _run([tool, *options, "-o", str(output), str(source)], folder)
        if done.returncode != 0 or not output.is_file():
            raise BadInput(_first_error(request, done.stdout + "\n" + done.stderr, Path(tool).name))
        data = output.read_bytes()
    _keep(key, data)
    return data


def _first_error(request: Request, said: str, tool: str) -> str:
    """The first error of glslangValidator or slangc in one line: PLACE: TEXT."""
    patterns = (
        r"^ERROR: (?P<file>.*?):(?P<line>\d+): (?P<text>.+)$",
        r"^(?P<file>.*?)\((?P<line>\d+)\): error(?: at column (?P<column>\d+))?,? ?(?:\d+)?:? ?(?P<text>.+)$",
        r"^error(?:\[(?P<code>\w+)\])?: (?P<text>.+)\n\s*(?:╭|-)+>? (?P<file>.*?):(?P<line>\d+):(?P<column>\d+)",
    )
    found = sorted((m for p in patterns for m in re.finditer(p, said, re.M)), key=lambda m: m.start())
    if not found:
        text = next((line for line in said.splitlines() if re.search(r"error", line, re.I)), said.strip()[:300])
        return f"{request.path}: {tool}: {' '.join(text.split())}"
    more = len({(m["file"], m["line"]) for m in found if "compilation errors" not in m["text"]}) - 1
    first = found[0]
    place = f"{first['file']}:{first['line']}" + (f":{first['column']}" if first.groupdict().get("column") else "")
    label = first["file"].removesuffix(".comp").removesuffix(".hlsl").removesuffix(".slang")
    text = " ".join(first["text"].split()).replace("'' : ", "")
    if os.path.basename(label) == OWN:
        place = f"{request.path}: in the generated lines"
    return f"{place}: {text}" + (f" (and {more} more)" if more > 0 else "") + hint(text, request)


def hint(text: str, request: Request) -> str:
    """What to try, for a few messages that many files give."""
    if re.search(
        r"gl_Frag|gl_Position|not supported with this (stage|profile)|storage qualifier|varying|dFd|discard", text
    ):
        return "; this is a compute shader: leave out what belongs to another stage with -D and #ifdef"
    if "undeclared" in text or "undefined identifier" in text or "no definition for" in text:
        return "; --set, --let, --prelude FILE and -I DIR give names that other files define"
    if "extension" in text and "not support" in text:
        return "; the device or the compiler lacks this extension"
    return ""


# ---- What a module reads besides the two buffers.

_UNIFORM_CONSTANT, _UNIFORM, _PUSH, _STORAGE = 0, 2, 9, 12


def _foreign_resources(module: bytes) -> bool:
    """Whether a SPIR-V module has a variable of a resource besides the two buffers (SPIR-V specification, 2.3, 3.7)."""
    words = struct.unpack(f"<{len(module) // 4}I", module)
    at, resources, ours = 5, set(), set()
    while at < len(words):
        size, code = words[at] >> 16, words[at] & 0xFFFF
        if size == 0:
            break
        if code == 59 and words[at + 3] in (_UNIFORM_CONSTANT, _UNIFORM, _PUSH, _STORAGE):  # OpVariable
            resources.add(words[at + 2])
        if code == 71 and words[at + 2] == 34 and words[at + 3] == SET:  # OpDecorate DescriptorSet
            ours.add(words[at + 1])
        at += size
    return bool(resources - ours)


def _named_resources(request: Request, text: str, tool: str, options: list[str], suffix: str) -> str:
    """The names of resources that the entry reads, by the reflection of glslangValidator."""
    with tempfile.TemporaryDirectory(prefix="crescent-shader-") as folder:
        source = Path(folder) / f"crescent{suffix}"
        source.write_text(text, "utf-8")
        options = [word for word in options if word != "-Os"] + [f"-I{path}" for path in _absolute(request)]
        said = _run([tool, *options, "-l", "-q", str(source)], folder).stdout
    names = re.findall(r"^([\w.\[\]]+): offset", said, re.M)
    return ", ".join(f"'{name}'" for name in dict.fromkeys(names) if not re.match("crescent_|gl_", name))


def not_given(request: Request, names: str) -> BadInput:
    """The error of functions that read what is not given."""
    return BadInput(
        f"{request.path}: the functions read {names or 'a uniform, texture or buffer'}, which is not given: "
        "--set NAME=VALUE gives a uniform a value, and -D or --prelude FILE replaces a texture or buffer by a function"
    )


def compiled(request: Request, program: Program) -> Code:
    """The code of a program; raises BadInput or MissingPart."""
    if request.language == "wgsl":
        return Code(program.plain(), "crescent_main", program.lines)
    text = program.with_places()
    if request.language == "slang":
        tool = slangc()
        options = ["-target", "wgsl", "-entry", "crescent_main", "-stage", "compute", "-O2"]
        return Code(_compile(request, text, tool, options, ".slang", ".wgsl").decode(), "crescent_main")
    tool = _tool("glslangValidator", "install glslang, in Debian the package glslang-tools")
    hlsl = request.language == "hlsl"
    options = ["-D", "-e", "crescent_main"] if hlsl else ["-R"]
    options += ["-V", "--amb", "--aml", "-S", "comp", "-Os"]
    suffix = ".hlsl" if hlsl else ".comp"
    module = _compile(request, text, tool, options, suffix, ".spv")
    if _foreign_resources(module):
        raise not_given(request, _named_resources(request, text, tool, options, suffix))
    return Code(module, "crescent_main" if hlsl else "main")
