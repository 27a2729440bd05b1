"""The text of an experiment with what was changed since it was read, and what is taken out together with a name.

A change is applied to what was read, as by --set: a value that a file does not give may depend on the changed key.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from . import _crescent
from ._paths import Steps, found, lines, overrides, path_of, steps_of, without


@dataclass(frozen=True)
class Source:
    """What was read, and what was changed since."""

    text: str
    name: str  #: of the file, in messages
    folder: str  #: absolute; paths of the file are relative to it
    changes: tuple[str, ...] = ()  #: PATH=VALUE each

    def changed(self, more: Sequence[str]) -> Source:
        """With more changes; one of the key that was changed last replaces it."""
        kept = list(self.changes)
        for change in more:
            if kept and kept[-1].partition("=")[0] == change.partition("=")[0]:
                kept.pop()
            kept.append(change)
        return replace(self, changes=tuple(kept))

    def core(self) -> _crescent.Experiment:
        """The experiment; ValueError states what is wrong."""
        return _crescent.parse(self.text, self.name, list(self.changes), self.folder)

    def tree(self) -> dict[str, Any]:
        """The keys that the file, or a change, gives."""
        return _by_name(tomllib.loads(_crescent.text_with_overrides(self.text, self.name, list(self.changes))))

    def without(self, all_steps: Sequence[Sequence[str]]) -> Source:
        """Without these keys and tables; other changes stay."""
        tree, given = self.tree(), _by_name(tomllib.loads(self.text))
        out = given
        for steps in all_steps:
            out = without(out, steps)

        def stays(change: str) -> bool:
            path = _path_of_change(change)
            try:
                at = found(tree, path)[0]
            except KeyError:
                at = steps_of(path)
            return not any(at[: len(steps)] == list(steps) for steps in all_steps)

        text = self.text if out == given else "\n".join(lines(out))
        return replace(self, text=text, changes=tuple(filter(stays, self.changes)))

    def with_value(self, path: str, value: Any) -> tuple[Source, list[Steps]]:
        """With a value at this path, and the names that a table there had and has no more. A table replaces the one that
        was there."""
        if not isinstance(value, Mapping):
            return self.changed(overrides({path: value})), []
        try:
            steps, old = found(self.tree(), path)
        except KeyError:
            return self.changed(overrides({path: value})), []
        lost = [(*steps, name) for name in old if name not in value] if isinstance(old, Mapping) else []
        return self.without([steps]).changed(overrides({path_of(steps): value})), lost


def _by_name(tree: Mapping[str, Any]) -> dict[str, Any]:
    """A tree whose lists of tables with a name, [[assertions]], are tables by these names."""
    out = dict(tree)
    for key, value in tree.items():
        if isinstance(value, list) and value and all(isinstance(v, Mapping) and "name" in v for v in value):
            out[key] = {v["name"]: {k: part for k, part in v.items() if k != "name"} for v in value}
    return out


def _path_of_change(change: str) -> str:
    """PATH of PATH=VALUE, whose names may have an equals sign in quotes."""
    match = re.match(r"(?:\"[^\"]*\"|'[^']*'|[^=\"'])+", change)
    return match.group().strip() if match else ""


def _texts(value: Any) -> Iterator[str]:
    """Every text in a value."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, Mapping):
        for v in value.values():
            yield from _texts(v)
    elif isinstance(value, list):
        for v in value:
            yield from _texts(v)


def _dependents(tree: Mapping[str, Any], lost: Sequence[Steps]) -> list[Steps]:
    """The tables that name one of these, or name one that does."""
    out: dict[Steps, None] = {}
    words = {steps[-1] for steps in lost}
    while True:
        one_of = re.compile("|".join(rf"(?<![\w-]){re.escape(word)}(?![\w-])" for word in words))
        more: dict[Steps, None] = {}
        for family, table in tree.items():
            if not isinstance(table, Mapping):
                continue
            named: dict[Steps, Any] = {
                (family, name): value for name, value in table.items() if isinstance(value, Mapping)
            }
            for steps, value in (named or {(family,): table}).items():
                if steps not in out and steps not in lost and any(one_of.search(text) for text in _texts(value)):
                    more[steps] = None
        if not more:
            return list(out)
        out |= more
        words |= {steps[-1] for steps in more}


_ROUNDS = 4  # of messages: each names the tables that became wrong by the removal of those before
_MEASURED = ("plates", "assertions", "furnaces", "regions")  # they need others, and no scene needs them


def mistakes_of(error: ValueError) -> list[tuple[str, str]]:
    """The kind and the path of each mistake in an experiment that the core found; none of another error."""
    return list(getattr(error, "mistakes", ()))


def _wrong_tables(tree: Mapping[str, Any], error: ValueError) -> list[Steps]:
    """The tables that an error finds wrong."""
    paths = [path for _, path in mistakes_of(error)]
    named = [(family, name) for family in _MEASURED for name in tree.get(family, {})]
    return [
        steps for steps in named if any(path.startswith((f"{'.'.join(steps)}.", f"{path_of(steps)}.")) for path in paths)
    ]


def taken_out(
    source: Source, lost: Sequence[Steps], before: Source
) -> tuple[Source, _crescent.Experiment, list[Steps]]:
    """`source`, from which these names were taken out, without the tables that need them: no others are taken out.

    ValueError states what remains wrong without them."""
    try:
        return source, source.core(), []
    except ValueError as error:
        remains = error
    needed = _dependents(before.tree(), lost) if lost else []
    for _ in range(_ROUNDS if lost else 0):
        try:
            source.without(needed).core()
            break
        except ValueError as error:
            remains = error
            wrong = [steps for steps in _wrong_tables(before.tree(), error) if steps not in needed]
            if not wrong:
                raise
            needed += wrong
    else:
        raise remains
    for steps in list(needed):
        kept = [other for other in needed if other != steps]
        try:
            source.without(kept).core()
        except ValueError:
            continue
        needed = kept
    out = source.without(needed)
    return out, out.core(), needed
