"""Paths of keys in an experiment, ``shapes.sphere.s`` or ``sphere.s``, and values in the form of its file."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from os import PathLike, fspath
from typing import Any

import numpy as np

from . import _crescent

Steps = tuple[str, ...]


def toml(value: Any) -> str:
    """Formats a value for a file, or for a change as of --set."""
    if isinstance(value, np.generic) or isinstance(value, np.ndarray) and value.ndim == 0:
        value = value.item()
    if isinstance(value, PathLike):
        value = fspath(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        if any("\ud800" <= letter <= "\udfff" for letter in value):
            raise ValueError(f"{value!a} has half of a surrogate pair: expected a text of whole characters")
        return json.dumps(value, ensure_ascii=False).replace("\x7f", r"\u007f")
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{toml(str(key))} = {toml(v)}" for key, v in value.items()) + "}"
    if isinstance(value, Iterable):
        return "[" + ", ".join(toml(v) for v in value) + "]"
    more = "; e.remove(path) takes a key out" if value is None else ""
    if callable(value) or type(value).__name__ in ("Sampler", "Combination"):
        more = "; a sampler in Python is added by e.samplers[NAME] = sampler"
    raise TypeError(
        f"{type(value).__name__} is not a value of an experiment: expected a number, a text, or a list of them{more}"
    )


def quoted(key: str) -> str:
    """Formats a key as a step of a path: quoted if it is more than a bare word."""
    return key if re.fullmatch(r"[\w-]+", key, re.ASCII) else f"'{key}'" if '"' in key else f'"{key}"'


def path_of(steps: Sequence[str]) -> str:
    """The path of these steps."""
    return ".".join(quoted(step) for step in steps)


def overrides(changes: Mapping[str, Any]) -> list[str]:
    """Returns KEY=VALUE for each; a table gives one for each of its keys."""
    out: list[str] = []
    for path, value in changes.items():
        if isinstance(value, Mapping) and value:
            out += overrides({f"{path}.{quoted(str(key))}": v for key, v in value.items()})
        else:
            out.append(f"{path}={toml(value)}")
    return out


def steps_of(path: str) -> list[str]:
    """Splits shapes.'a ball'.center[1] into shapes, a ball, center, 1, as --set reads a path."""
    if not isinstance(path, str):
        raise TypeError(f"{path!r} is no path: expected a text such as 'sphere.s' or 'shapes.sphere.s'")
    found = [next(filter(None, step)) for step in re.findall(r"\"([^\"]*)\"|'([^']*)'|([^.\[\]\"']+)", path)]
    if not found:
        raise KeyError(f"{path!r}: expected a path such as sphere.s or shapes.sphere.s")
    return found


def inside(at: Any, step: str) -> Any:
    """Returns the value of a key of a table or at an index of a list; KeyError names the existing keys, and the
    nearest."""
    if isinstance(at, Mapping):
        if step in at:
            return at[step]
        near = _crescent.nearest(step, list(at))
        raise KeyError(f"has {', '.join(at)}" + (f"; did you mean '{near}'?" if near else ""))
    if isinstance(at, list) and at:
        if step.isdecimal() and int(step) < len(at):
            return at[int(step)]
        raise KeyError(f"has items 0 to {len(at) - 1}")
    raise KeyError("has no keys")


def found(tree: Mapping[str, Any], path: str) -> tuple[list[str], Any]:
    """Returns the steps from the top to a value, and the value. A path may begin at a name, as for --set: key.radius."""
    steps = steps_of(path)
    families = [key for key, value in tree.items() if isinstance(value, Mapping) and steps[0] in value]
    starts = [steps] if steps[0] in tree else []
    starts += [[family, *steps] for family in families if isinstance(tree[family][steps[0]], Mapping)]
    matches, problem = [], ""
    for start in starts:
        at: Any = tree
        for i, step in enumerate(start):
            try:
                at = inside(at, step)
            except KeyError as e:
                problem = problem or f"{path}: {'.'.join(start[:i])} {e.args[0]}"
                break
        else:
            matches.append((start, at))
    if len(matches) > 1 and matches[0][0] is not steps:
        raise KeyError(f"{path} is ambiguous: expected {' or '.join('.'.join(start) for start, _ in matches)}")
    if matches:
        return matches[0]
    if problem:
        raise KeyError(problem)
    tables = [value for value in tree.values() if isinstance(value, Mapping)]
    names = [name for table in tables for name, value in table.items() if isinstance(value, Mapping)]
    near = _crescent.nearest(steps[0], [*tree, *names]) or nearest_key(tree, steps[-1])
    hint = f"; did you mean '{near}'?" if near else ""
    raise KeyError(f"{path}: the experiment has {', '.join(tree)}, and the names {', '.join(names)}{hint}")


def nearest_key(tree: Mapping[str, Any], word: str) -> str:
    """The path of the key of a table of the file whose last step is nearest to a word: image.width; else nothing."""
    keys = {key: f"{name}.{key}" for name, table in tree.items() if isinstance(table, Mapping) for key in table}
    return keys.get(_crescent.nearest(word, list(keys)), "")


def lines(table: Mapping[str, Any], path: str = "") -> Iterator[str]:
    """A table as the lines of a file."""
    tables = {key: value for key, value in table.items() if isinstance(value, Mapping)}
    yield from (f"{toml(key)} = {toml(value)}" for key, value in table.items() if key not in tables)
    for key, value in tables.items():
        at = f"{path}.{toml(key)}" if path else toml(key)
        yield from (f"[{at}]", *lines(value, at))


def without(tree: Mapping[str, Any], steps: Sequence[str]) -> dict[str, Any]:
    """A copy of a tree without the value at these steps; the tree's own values where there is none."""
    out = dict(tree)
    if len(steps) == 1:
        out.pop(steps[0], None)
    elif isinstance(tree.get(steps[0]), Mapping):
        out[steps[0]] = without(tree[steps[0]], steps[1:])
    return out
