"""Runners for the blocks of each language, in the working folder of the page. A runner returns the output of the block,
and raises Mistake if it is wrong, or Absent if this machine lacks what it needs."""

from __future__ import annotations

import ast
import functools
import json
import os
import re
import shutil
import subprocess
import tomllib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from blocks import Block, Mistake

#: Optional libraries of the package.
OPTIONAL = ("mitsuba", "drjit", "jax", "torch", "cupy", "xarray", "matplotlib")
EXIT = re.compile(r"\s#.*?\bexit (\d+)\b")


class Absent(Exception):
    """A part that is not installed here."""


@dataclass
class Setting:
    """The settings of all pages."""

    source: Path  #: the repository
    build: Path  #: its release build
    compiler: str
    python: str  #: an interpreter that has the module and its requirements; empty: none
    prefix: Path  #: the prefix of the installed build
    installed: dict[str, bool] = field(default_factory=dict)  #: whether an optional library can be imported


@dataclass
class Page:
    """One page, its folder and the definitions for later blocks."""

    setting: Setting
    folder: Path
    blocks: list[Block]
    worker: subprocess.Popen[str] | None = None
    cmake: list[Block] = field(default_factory=list)  #: fragments without their source so far

    def environment(self) -> dict[str, str]:
        s = self.setting
        paths = [str(s.build), *([str(Path(s.python).parent)] if s.python else []), os.environ["PATH"]]
        return {
            **{key: value for key, value in os.environ.items() if not key.startswith("CRESCENT")},
            **compiler_cache(s.prefix.parent),
            "PATH": ":".join(paths),
            "HOME": str(self.folder / "home"),
            "PYTHONPATH": str(s.build / "python"),
            "PYTHONDONTWRITEBYTECODE": "1",
            "MPLBACKEND": "agg",
            "COLUMNS": "100",
            "CXX": s.compiler,
        }

    def call(self, *command: str | Path) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            list(map(str, command)),
            cwd=self.folder,
            env=self.environment(),
            text=True,
            errors="replace",
            stdin=subprocess.DEVNULL,
            capture_output=True,
        )

    def must(self, *command: str | Path) -> str:
        """Returns the output; Mistake unless it exits with 0."""
        ended = self.call(*command)
        if ended.returncode:
            words = " ".join(map(str, command))
            raise Mistake(f"exit {ended.returncode}: {words}\n{_tail(ended.stdout + ended.stderr)}")
        return ended.stdout

    def close(self) -> None:
        if self.worker:
            self.worker.communicate()


@functools.cache
def compiler_cache(work: Path) -> dict[str, str]:
    """Returns the environment in which CMake compiles through ccache, which finds the user's cache from any HOME, and in it
    what was compiled before below another `work`; empty without ccache."""
    if not shutil.which("ccache"):
        return {}
    return {
        "CMAKE_CXX_COMPILER_LAUNCHER": "ccache",
        "CCACHE_DIR": subprocess.check_output(["ccache", "--get-config", "cache_dir"], text=True).strip(),
        "CCACHE_BASEDIR": str(work),
        "CCACHE_NOHASHDIR": "1",
        "CCACHE_SLOPPINESS": "pch_defines,time_macros",
    }


def _tail(text: str, lines: int = 25) -> str:
    return "\n".join(text.rstrip().split("\n")[-lines:])


def shell_script(block: Block) -> str:
    """Returns the block with line numbers kept: a command with `# exit N` must end with N, all others with 0."""
    lines, start = block.text.split("\n"), 0
    for i, line in enumerate(lines):
        continued = line.rstrip().endswith("\\")
        if not continued and (code := EXIT.search(line)):
            wanted = code[1]
            lines[i] = line[: code.start()] + (
                f"; }} && got=0 || got=$?; [ $got -eq {wanted} ] || "
                f'{{ echo "line {block.line + start + 1}: exit $got, expected {wanted}" >&2; exit 99; }}'
            )
            lines[start] = "{ " + lines[start]
        if not continued:
            start = i + 1
    trap = f"trap 'echo \"line $((LINENO + {block.line})): exit $?\" >&2' ERR; "
    return "set -Eeuo pipefail; " + trap + "\n".join(lines)


def run_sh(page: Page, block: Block) -> str:
    if not page.setting.python and re.search(r"^crescent check \S+\.py", block.text, re.MULTILINE):
        raise Absent("the Python module")
    ended = page.call("bash", "-c", shell_script(block))
    if ended.returncode:
        raise Mistake(f"exit {ended.returncode}\n{_tail(ended.stdout + ended.stderr)}")
    return ended.stdout


def _imports(text: str) -> set[str]:
    out = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            out |= {name.name.partition(".")[0] for name in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            out.add(node.module.partition(".")[0])
        elif isinstance(node, ast.Attribute) and ast.unparse(node).startswith("crescent.adapters."):
            out.add(node.attr.partition("_")[0])
    return out


def run_python(page: Page, block: Block) -> str:
    if not page.setting.python:
        raise Absent("the Python module")
    try:
        wanted = _imports(block.text) & set(OPTIONAL)
        functions = [at.name for at in ast.parse(block.text).body if isinstance(at, ast.FunctionDef)]
    except SyntaxError as e:
        raise Mistake(f"line {block.line + (e.lineno or 1)}: {e.msg}") from None
    installed = page.setting.installed
    for module in sorted(wanted):
        if module not in installed:
            installed[module] = page.call(page.setting.python, "-c", f"import {module}").returncode == 0
        if not installed[module]:
            raise Absent(module)
    if any(name.startswith("test_") for name in functions):
        return _run_pytest(page, block)
    if page.worker is None:
        _start_worker(page)
    assert page.worker and page.worker.stdin and page.worker.stdout
    request = {"text": block.text, "page": str(block.page), "line": block.line}
    print(json.dumps(request), file=page.worker.stdin, flush=True)
    line = page.worker.stdout.readline()
    if not line:
        ended, page.worker = page.worker.wait(), None  # the next block gets another one
        raise Mistake(f"the interpreter ended with {ended}")
    answer = json.loads(line)
    if answer["error"]:
        raise Mistake(answer["error"])
    return str(answer["printed"])


def _start_worker(page: Page) -> None:
    page.worker = subprocess.Popen(
        [page.setting.python, Path(__file__).with_name("worker.py")],
        cwd=page.folder,
        env=page.environment(),
        text=True,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
    )


def _run_pytest(page: Page, block: Block) -> str:
    file = block.file or f"test_line_{block.line}.py"
    (page.folder / file).write_text(block.text)
    return page.must(
        page.setting.python, "-m", "pytest", "-q", "-p", "crescent.pytest_plugin", "-p", "no:cacheprovider",
        "--rootdir", ".", file,
    )  # fmt: skip


def run_toml(page: Page, block: Block) -> str:
    """A whole experiment is checked; a part of one is inserted into a small one, which is run. One with a file's name
    is run by the commands of the page."""
    try:
        part = tomllib.loads(block.text)
    except tomllib.TOMLDecodeError as e:
        raise Mistake(str(e)) from None
    if block.file:
        later = page.blocks[page.blocks.index(block) + 1 :]
        if not any(block.file in other.text for other in later if not other.needs):
            raise Mistake(f"no later block uses {block.file}")
        return ""
    file = page.folder / f"line_{block.line}.toml"
    if "camera" in part:
        file.write_text(block.text)
        return page.must("crescent", "run", file, "--preview", "--out", page.folder / "preview")
    base = tomllib.loads((page.setting.source / "tests/system/tiny.toml").read_text())
    file.write_text("\n".join(_toml_lines(_merged(base, part))))
    return page.must("crescent", "run", file, "--out", page.folder / file.stem)


def _merged(base: Any, part: Any) -> Any:
    if not isinstance(base, dict) or not isinstance(part, dict):
        return part
    return {**base, **{key: _merged(base.get(key), value) for key, value in part.items()}}


def _toml_lines(table: dict[str, Any], path: str = "") -> list[str]:
    inside = {key: value for key, value in table.items() if isinstance(value, dict)}
    lines = [f"{json.dumps(key)} = {_toml_value(value)}" for key, value in table.items() if key not in inside]
    for key, value in inside.items():
        at = f"{path}.{json.dumps(key)}" if path else json.dumps(key)
        lines += [f"[{at}]", *_toml_lines(value, at)]
    return lines


def _toml_value(value: Any) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(key)} = {_toml_value(v)}" for key, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_toml_value, value)) + "]"
    return json.dumps(value)


def run_json(page: Page, block: Block) -> str:
    try:
        json.loads(block.text)
    except json.JSONDecodeError as e:
        raise Mistake(f"line {block.line + e.lineno}: {e.msg}") from None
    return ""


def install(page: Page) -> Path:
    """Installs the build, once for all pages."""
    prefix = page.setting.prefix
    if not (prefix / "bin").is_dir():
        page.must("cmake", "--install", page.setting.build, "--prefix", prefix)
    return prefix


def configure(page: Page, folder: Path) -> str:
    """Configures a project into its build/; -O1, since some run samplers."""
    choices = {
        "CMAKE_BUILD_TYPE": "Debug",
        "CMAKE_CXX_FLAGS_DEBUG": "-O1",
        "CMAKE_PREFIX_PATH": install(page),
        "CMAKE_CXX_COMPILER": page.setting.compiler,
    }
    flags = [f"-D{key}={value}" for key, value in choices.items()]
    return page.must("cmake", "-S", folder, "-B", folder / "build", "-G", "Ninja", *flags)


def run_cmake(page: Page, block: Block) -> str:
    """A whole project is configured; a part of one is combined with the C++ below it, of which its targets consist."""
    if "project(" not in block.text:
        page.cmake.append(block)
        return ""
    folder = page.folder / f"project_{block.line}"
    folder.mkdir()
    (folder / "CMakeLists.txt").write_text(block.text)
    return configure(page, folder)


def run_cpp(page: Page, block: Block) -> str:
    """If a part of a CMake project precedes it, its targets are built from the block and run. Else it is compiled
    alone, against the headers of the tree or the installed ones, and run if it has a main(). Warnings are errors."""
    if page.cmake:
        return _run_project(page, page.cmake.pop(), block)
    file = page.folder / (block.file or f"line_{block.line}.{'c' if block.language == 'c' else 'cpp'}")
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(f'#line {block.line + 1} "{block.page}"\n{block.text}')
    c = block.language == "c"
    flags = ["-Wall", "-Wextra", "-Werror", "-O1", *(["-std=c11"] if c else ["-std=c++20"])]
    tree = [f"-isystem{page.folder / at}" for at in ("src", "include", "apps/explainer")] if '#include "' in block.text else []
    includes = [*tree, *(f"-isystem{install(page) / at}" for at in ("include",))]
    compiler = os.environ.get("CC", "cc") if c else page.setting.compiler
    if not re.search(r"\bmain\(", block.text):
        return page.must(compiler, *flags, *includes, "-fsyntax-only", file)
    launcher = ["ccache"] if compiler_cache(page.setting.prefix.parent) else []
    page.must(*launcher, compiler, *flags, *includes, "-c", file, "-o", file.with_suffix(".o"))
    page.must(compiler, file.with_suffix(".o"), "-o", file.with_suffix(""), "-lm")
    return page.must(file.with_suffix("")) if not block.file else ""


def _run_project(page: Page, fragment: Block, block: Block) -> str:
    targets = re.findall(r"target_link_libraries\((\w+)", fragment.text)
    if not targets:
        raise Mistake(f"{fragment.place}: it links no target, so that there is nothing to build")
    folder = page.folder / f"project_{fragment.line}"
    folder.mkdir()
    (folder / "main.cpp").write_text(f'#line {block.line + 1} "{block.page}"\n{block.text}')
    (folder / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.25)\nproject(page LANGUAGES CXX)\n"
        + ("find_package(GTest REQUIRED)\n" if "GTest::" in fragment.text else "")
        + "".join(f"add_executable({target} main.cpp)\n" for target in targets)
        + "".join(f"target_compile_options({target} PRIVATE -Wall -Wextra -Werror)\n" for target in targets)
        + fragment.text
    )
    configure(page, folder)
    build = folder / "build"
    page.must("cmake", "--build", build)
    return "".join(page.must(build / target) for target in targets)


def run_yaml(page: Page, block: Block) -> str:
    try:
        import yaml
    except ImportError:
        raise Absent("PyYAML") from None
    try:
        yaml.safe_load(block.text)
    except yaml.YAMLError as e:
        raise Mistake(str(e)) from None
    return ""


def run_js(page: Page, block: Block) -> str:
    if not shutil.which("node"):
        raise Absent("node")
    script = page.folder / "block.mjs"
    script.write_text("\n" * block.line + block.text, encoding="utf-8")
    return page.must("node", script)


def run_groovy(page: Page, block: Block) -> str:
    raise Absent("Jenkins")


def run_glsl(page: Page, block: Block) -> str:
    raise Absent("the functions of a shader around it")


RUNNERS = {
    "sh": run_sh,
    "python": run_python,
    "toml": run_toml,
    "json": run_json,
    "yaml": run_yaml,
    "js": run_js,
    "groovy": run_groovy,
    "glsl": run_glsl,
    "cmake": run_cmake,
    "c": run_cpp,
    "cpp": run_cpp,
}
