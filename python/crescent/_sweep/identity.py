"""The inputs of a result as hashes: the scene, each sampler with its source, and the version of the numerics.

The scene's hash covers every value of the experiment except those of samplers, plates, assertions, furnaces and titles:
adding a sampler or changing the number of seeds keeps the finished results.
"""

from __future__ import annotations

import ast
import base64
import functools
import hashlib
import importlib.metadata
import importlib.util
import inspect
import json
import shlex
import shutil
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from .. import _crescent
from .._callable_arms import source_of
from .._files import names_a_file
from .._sampler import Sampler
from ..combinations import Combination
from ..experiments import Experiment
from .grid import hint
from .state import library, state_of, unhashable_in, versions_of

NUMERICS = f"{_crescent.version} {_crescent.commit}"  #: version of the numerics: equal builds give equal bits
NOT_OF_THE_SCENE = (
    "title", "seeds", "n", "exposure", "published", "note_evidence", "arms", "plates", "assertions", "furnaces", "samplers",
)  # fmt: skip
_NOT_OF_THE_REFERENCE = ("regions", "firefly_k", "flip_seeds")

Code = dict[str, Any]  #: {"files": {name: base64}, "at": "FILE.py:NAME"} of a sampler that is sent


def digest(*parts: Any) -> str:
    """16 hexadecimal digits of SHA-256 of these values."""
    text = json.dumps(parts, sort_keys=True, ensure_ascii=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def scene_id(e: Experiment) -> str:
    """The identity of the scene and its metrics, without the samplers."""
    return digest(NUMERICS, {k: v for k, v in e._tree().items() if k not in NOT_OF_THE_SCENE})


def reference_id(e: Experiment) -> str:
    """The identity of the references of an experiment."""
    left_out = (*NOT_OF_THE_SCENE, *_NOT_OF_THE_REFERENCE)
    return digest(NUMERICS, {k: v for k, v in e._tree().items() if k not in left_out})


def _root_of(file: Path) -> Path:
    """The folder of the package of a file, or its own: that of its imports, as crescent._files has it."""
    folder = file.resolve().parent
    while (folder / "__init__.py").is_file():
        folder = folder.parent
    return folder


def _imported(source: str, package: str) -> set[str]:
    """The whole names that a source in a package imports: of modules, and of what may be modules."""
    out: set[str] = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            out |= {name.name for name in node.names}
        elif isinstance(node, ast.ImportFrom):
            parents = package.split(".")[: len(package.split(".")) - node.level + 1] if node.level else []
            module = ".".join([*filter(None, parents), *([node.module] if node.module else [])])
            out |= {module, *(f"{module}.{name.name}".strip(".") for name in node.names)}
    return out - {""}


def _files_of(module: str, root: Path) -> dict[str, Path]:
    """The files of a module of the user and of the packages around it, by their names below its folder, which is `root`
    or one of sys.path; none of a library."""
    steps = module.split(".")
    if steps[0] in sys.stdlib_module_names or steps[0] == "crescent":
        return {}
    for folder in (root, *map(Path, sys.path)):
        if "site-packages" in folder.parts or "dist-packages" in folder.parts:
            continue
        out: dict[str, Path] = {}
        for k in range(1, len(steps) + 1):
            at = "/".join(steps[:k])
            found = next((name for name in (f"{at}/__init__.py", f"{at}.py") if (folder / name).is_file()), None)
            if found:
                out[found] = folder / found
            elif not (folder / at).is_dir():
                break
        if out:
            return out
    return {}


def python_sources(file: Path) -> tuple[dict[str, bytes], list[str]]:
    """A Python file and the files that it imports, in its folder, its package or elsewhere on sys.path, by their names
    below these folders; and the versions of the libraries that they import."""
    root = _root_of(file)
    files: dict[str, bytes] = {}
    packages: set[str] = set()
    waiting = {file.resolve().relative_to(root).as_posix(): file}
    for name in _parents(next(iter(waiting))):
        waiting[name] = root / name
    while waiting:
        name, at = waiting.popitem()
        files[name] = at.read_bytes()
        package = ".".join(Path(name).parent.parts)
        for module in sorted(_imported(files[name].decode(errors="replace"), package)):
            top = module.partition(".")[0]
            found = _files_of(module, root)
            waiting |= {name: path for name, path in found.items() if name not in files}
            if not found and top != "crescent" and top not in sys.stdlib_module_names:
                packages |= set(versions_of(top))
    return files, sorted(packages)


def _parents(name: str) -> list[str]:
    """The __init__.py of the packages around a file."""
    return [(folder / "__init__.py").as_posix() for folder in Path(name).parents if folder.parts]


def _code_of(files: Mapping[str, bytes], at: str) -> Code:
    return {"files": {name: base64.b64encode(data).decode() for name, data in sorted(files.items())}, "at": at}


def _of_python(where: str) -> tuple[Any, Code | None]:
    """Identity and code of "FILE.py:NAME" or "module:NAME"."""
    name, colon, inside = where.rpartition(":") if not where.endswith(".py") else (where, "", "")
    if not name.endswith(".py"):
        package = name.partition(".")[0]
        versions = versions_of(package)
        return [where, versions, _hashes_of_module(package)], None
    path = Path(name)
    files, packages = python_sources(path)
    hashes = {file: hashlib.sha256(data).hexdigest() for file, data in files.items()}
    at = path.resolve().relative_to(_root_of(path)).as_posix()
    return [at, inside, hashes, packages], _code_of(files, f"{at}{colon}{inside}")


def _hashes_of_module(name: str) -> dict[str, str]:
    """The hashes of the Python files of a top-level module; of one that is not installed, of what it imports too."""
    spec = importlib.util.find_spec(name) if name != "__main__" else None  # of a notebook, which has none
    origin = spec.origin if spec else None
    if not origin or not origin.endswith(".py"):
        return {}
    file = Path(origin)
    files = {str(path.relative_to(file.parent)): path.read_bytes() for path in file.parent.rglob("*.py")} \
        if file.name == "__init__.py" else python_sources(file)[0]  # fmt: skip
    return {name: hashlib.sha256(data).hexdigest() for name, data in sorted(files.items())}


def _of_plugin(where: str) -> tuple[Any, Code]:
    data = Path(where).read_bytes()
    return [hashlib.sha256(data).hexdigest()], _code_of({Path(where).name: data}, Path(where).name)


def _of_program(command: str) -> Any:
    """Identity of a command: its text, the program, and the files that it names, of Python those that they import."""
    try:
        words = shlex.split(command)
    except ValueError:  # quotes that the shell will report
        words = []
    files = [Path(found) for word in words if (found := word if Path(word).is_file() else shutil.which(word))]
    hashes = {
        name: hashlib.sha256(data).hexdigest()
        for file in files
        for name, data in (python_sources(file)[0] if file.suffix == ".py" else {file.name: file.read_bytes()}).items()
    }
    return [command, hashes]


def _function_of(call: Any) -> Any:
    """The function inside functools.partial and decorators."""
    call = inspect.unwrap(call)
    while isinstance(call, functools.partial):
        call = inspect.unwrap(call.func)
    return call


def _modules_of(name: str, found: set[Any]) -> None:
    """Adds a module of the user, which other machines do not have, and those that it takes names from."""
    module = sys.modules.get(name)
    if module is None or module in found or name == "__main__" or library(name) or not hasattr(module, "__file__"):
        return
    found.add(module)
    for value in list(vars(module).values()):
        _modules_of(value.__name__ if inspect.ismodule(value) else str(getattr(value, "__module__", "")), found)


def _of_callable(sampler: Sampler | Combination) -> tuple[Any, Code]:
    """Identity and code of a sampler, or of a combination with its weights, in memory, which is sent by value."""
    import cloudpickle  # type: ignore[import-untyped,unused-ignore]

    modules: set[Any] = set()
    texts: list[Any] = []
    own = [value for value in vars(sampler).values() if callable(value)]
    for call in own:
        _modules_of(getattr(_function_of(call), "__module__", "") or "", modules)
        where = source_of(own[0])
        if names_a_file(where) and Path(where.rpartition(":")[0]).is_file():
            texts.append(_of_python(where)[0])
            continue
        try:
            texts.append(inspect.getsource(inspect.unwrap(call)))
        except (OSError, TypeError):
            texts.append(hashlib.sha256(cloudpickle.dumps(call)).hexdigest())
    for module in modules:
        cloudpickle.register_pickle_by_value(module)
    try:
        data = cloudpickle.dumps(sampler)
    except Exception as error:  # anything that an object raises
        raise ValueError(f"cannot be sent to the workers of a sweep: {error}") from None
    finally:
        for module in modules:
            cloudpickle.unregister_pickle_by_value(module)
    code = {"files": {}, "at": "", "pickle": base64.b64encode(data).decode()}
    return [texts, state_of(vars(sampler))], code


def unhashable_of(sampler: Sampler | Combination) -> list[str]:
    """The types of what a sampler uses and what cannot be hashed."""
    return unhashable_in(vars(sampler))


def sampler_id(sampler: Sampler | Combination) -> str:
    """The identity of a sampler in Python: its code, attributes, closures, and the globals that its code names."""
    return digest(state_of(vars(sampler)))


def _source_of_arm(table: Mapping[str, Any]) -> tuple[Any, Code | None]:
    """Identity and code of the file that the table of an arm names; None of a built-in sampler."""
    for key in ("python", "weights_python"):
        if key in table:
            return _of_python(table[key])
    if "exec" in table:
        return _of_program(table["exec"]), None
    return _of_plugin(table["plugin"]) if "plugin" in table else (None, None)


def file_ids(arms: Mapping[str, Mapping[str, Any]]) -> dict[str, str]:
    """By arm, the identities of the files that the tables of arms name: their contents, and those that they import."""
    return {name: digest(found) for name, table in arms.items() if (found := _source_of_arm(table)[0]) is not None}


class Arm:
    """One arm of an experiment: its identity, and the data with which a worker runs it."""

    def __init__(
        self, name: str, table: Mapping[str, Any], given: Sampler | Combination | None, version: str | None,
        call: str = "",
    ) -> None:  # fmt: skip
        """`call` identifies the call of a sweep: a sampler that cannot be hashed is another one in each."""
        self.name = name
        self.most: int = max(table["n"])  #: the largest sample count
        named = ("sampler", "python", "plugin", "exec", "weights_python")
        self.sampler = str(next((table[key] for key in named if table.get(key)), None))
        self.code: Code | None = None
        code = ("python", "plugin", "exec", "weights_python")
        self.built_in = not set(code) & set(table) and given is None
        kind = next((key for key in code if key in table), "")
        source: Any = None
        if given is not None:
            try:
                source, self.code = _of_callable(given)
            except ValueError as error:
                raise ValueError(f"samplers.{name}: {error}") from None
        else:
            source, self.code = _source_of_arm(table)
        kept = {k: v for k, v in table.items() if k not in ("python", "plugin", "weights_python")}
        self.unhashable = [] if given is None or version is not None else unhashable_of(given)
        if self.unhashable:
            source = [source, call]
        self.id = digest(NUMERICS, name, kept, source if version is None else ["declared", version])
        self.kind = "callable" if given is not None else kind
        self.of: list[str] = []  #: the arms of a combination

    def set_parts(self, of: Sequence[Arm]) -> None:
        """Sets the arms of a combination, which must be complete."""
        self.of = list(dict.fromkeys(name for arm in of for name in (arm.name, *arm.of)))
        self.built_in = self.built_in and all(arm.built_in for arm in of)
        self.id = digest(self.id, [arm.id for arm in of])


def arms_of(e: Experiment, versions: Mapping[str, str], call: str = "") -> dict[str, Arm]:
    """The arms of an experiment, those of `e.samplers` included; `call` as of an :class:`Arm`."""
    tables = e._with_arms()._tree()["arms"]
    for name in versions:
        if name not in tables:
            near = _crescent.nearest(name, list(tables))
            raise ValueError(f"--sampler-version: no arm '{name}': expected one of {', '.join(tables)}" + hint(near))
    arms: dict[str, Arm] = {}

    def add(name: str) -> Arm:
        if name not in arms:
            given = e.samplers.get(name)
            code = isinstance(given, Sampler) or (given is not None and callable(given.weights))
            arm = Arm(name, tables[name], given if code else None, versions.get(name), call)
            if "kind" in tables[name]:
                parts = [*tables[name]["of"], *([tables[name]["target"]] if "target" in tables[name] else [])]
                arm.set_parts([add(part) for part in parts if part in tables])
            arms[name] = arm
        return arms[name]

    return {name: add(name) for name in tables}
