"""Tables and lists of an experiment as they are read from it: a change of one is a change of the experiment."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from ._paths import inside, path_of

if TYPE_CHECKING:
    from .experiments import Experiment


def live(e: Experiment, steps: Sequence[str], value: Any) -> Any:
    """A value of the experiment at these steps, whose tables and lists write into it."""
    if isinstance(value, Mapping):
        return Table(e, steps, value)
    if isinstance(value, list):
        return Items(e, steps, value)
    return value


def plain(value: Any) -> Any:
    """The same as dictionaries and lists of their own."""
    if isinstance(value, Mapping):
        return {key: plain(v) for key, v in value.items()}
    return [plain(v) for v in value] if isinstance(value, list) else value


class _WithoutAttributes:
    """What has keys and no attributes of the user: e["image"].width = 320 would change nothing."""

    _e: Experiment
    _steps: tuple[str, ...]

    def __setattr__(self, name: str, value: Any) -> None:
        if name not in ("_e", "_steps"):
            raise AttributeError(self._without(name, f" = {value!r}"))
        super().__setattr__(name, value)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        raise AttributeError(self._without(name, ""))

    def _without(self, name: str, rest: str) -> str:
        path = path_of(self._steps)
        if isinstance(self, dict):
            return f"{path} has no attribute '{name}': expected e[{path_of([*self._steps, name])!r}]{rest}"
        return f"{path} is a list without an attribute '{name}': expected an index, such as e['{path}[0]']{rest}"


class Table(_WithoutAttributes, dict[str, Any]):
    """A table of an experiment: a dictionary whose changes are checked and made in the experiment."""

    def __init__(self, e: Experiment, steps: Sequence[str], value: Mapping[str, Any]) -> None:
        super().__init__({key: live(e, (*steps, key), v) for key, v in value.items()})
        self._e, self._steps = e, tuple(steps)

    def _read(self) -> None:
        """Reads the experiment again: a change may change other values."""
        try:
            now = self._e._at(self._steps)
        except KeyError:
            now = {}
        super().clear()
        super().update({key: live(self._e, (*self._steps, key), v) for key, v in now.items()})

    def __missing__(self, key: Any) -> Any:
        """KeyError names the keys that there are, and the nearest."""
        path = path_of([*self._steps, str(key)])
        if self._steps == ("arms",) and key in self._e.samplers:
            raise KeyError(f"{path}: is a sampler in Python: expected e.samplers[{key!r}]")
        try:
            return inside(dict(self), str(key))
        except KeyError as error:
            raise KeyError(f"{path}: {path_of(self._steps)} {error.args[0]}") from None

    def __setitem__(self, key: str, value: Any) -> None:
        self.update({key: value})

    def update(self, *given: Any, **named: Any) -> None:
        """Changes several keys, which are checked together."""
        changes = dict(*given, **named)
        if len(self._steps) > 1:
            self._must_be_there()
        self._e._set({(*self._steps, key): value for key, value in changes.items()})
        self._read()

    def _must_be_there(self) -> None:
        """KeyError if this table was taken out since it was read: a change would add another one of its name."""
        try:
            self._e._at(self._steps)
        except KeyError:
            path = path_of(self._steps)
            raise KeyError(f"{path}: was removed from the experiment; e[{path!r}] = {{...}} adds one") from None

    def __ior__(self, other: Any) -> Table:  # type: ignore[override,misc]
        self.update(other)
        return self

    def setdefault(self, key: str, default: Any = None) -> Any:
        """The value of a key, which is set if there is none."""
        if key not in self:
            self[key] = default
        return self[key]

    def __delitem__(self, key: str) -> None:
        if key not in self:
            self.__missing__(key)
        self._e._take_out((*self._steps, key), stacklevel=3)
        self._read()

    def pop(self, key: str, *default: Any) -> Any:
        """Takes a key out, with what names it; returns its value."""
        if key not in self:
            return super().pop(key, *default) if default else self.__missing__(key)
        value = plain(self[key])
        self._e._take_out((*self._steps, key), stacklevel=3)
        self._read()
        return value

    def popitem(self) -> tuple[str, Any]:
        """Takes the last key out."""
        if not self:
            raise KeyError(f"{path_of(self._steps)} is empty")
        key = next(reversed(self))
        return key, self.pop(key)

    def clear(self) -> None:
        """Takes every key out."""
        self._e._set({self._steps: {}})
        self._read()

    def copy(self) -> dict[str, Any]:
        """A dictionary that is not of the experiment."""
        return plain(self)  # type: ignore[no-any-return]

    def __reduce_ex__(self, protocol: Any) -> tuple[Any, ...]:
        return dict, (plain(self),)


class Items(_WithoutAttributes, list[Any]):
    """A list of an experiment: its changes are checked and made in the experiment."""

    def __init__(self, e: Experiment, steps: Sequence[str], value: Sequence[Any]) -> None:
        super().__init__(live(e, (*steps, str(k)), v) for k, v in enumerate(value))
        self._e, self._steps = e, tuple(steps)

    def _changed(self, change: Callable[[list[Any]], Any]) -> Any:
        """Makes a change of the list that the experiment has now."""
        now = plain(self._e._at(self._steps))
        result = change(now)
        self._e._set({self._steps: now})
        new = self._e._at(self._steps)
        super().__setitem__(slice(None), [live(self._e, (*self._steps, str(k)), v) for k, v in enumerate(new)])
        return result

    def __setitem__(self, at: Any, value: Any) -> None:
        self._changed(lambda now: now.__setitem__(at, value))

    def __delitem__(self, at: Any) -> None:
        self._changed(lambda now: now.__delitem__(at))

    def __iadd__(self, more: Any) -> Items:  # type: ignore[misc]
        self._changed(lambda now: now.extend(more))
        return self

    def __imul__(self, times: Any) -> Items:  # type: ignore[misc]
        self._changed(lambda now: now.__imul__(times))
        return self

    def append(self, value: Any) -> None:
        """Adds a value at the end."""
        self._changed(lambda now: now.append(value))

    def extend(self, values: Any) -> None:
        """Adds values at the end."""
        self._changed(lambda now: now.extend(values))

    def insert(self, at: Any, value: Any) -> None:
        """Adds a value at an index."""
        self._changed(lambda now: now.insert(at, value))

    def pop(self, at: Any = -1) -> Any:
        """Takes out the value at an index."""
        return self._changed(lambda now: now.pop(at))

    def remove(self, value: Any) -> None:
        """Takes out the first equal value."""
        self._changed(lambda now: now.remove(value))

    def clear(self) -> None:
        """Takes out every value."""
        self._changed(lambda now: now.clear())

    def sort(self, **how: Any) -> None:
        """Sorts the values."""
        self._changed(lambda now: now.sort(**how))

    def reverse(self) -> None:
        """Reverses the values."""
        self._changed(lambda now: now.reverse())

    def copy(self) -> list[Any]:
        """A list that is not of the experiment."""
        return plain(self)  # type: ignore[no-any-return]

    def __reduce_ex__(self, protocol: Any) -> tuple[Any, ...]:
        return list, (plain(self),)
