"""Swept attributes of samplers in Python, ``samplers.NAME.ATTRIBUTE``: of the object whose methods a sampler calls, or which
it calls, a keyword of a functools.partial, or a key of a combination."""

from __future__ import annotations

import copy
import dataclasses
import functools
from collections.abc import Iterable, Mapping
from dataclasses import replace
from types import BuiltinFunctionType, FunctionType, MethodType
from typing import Any

from .. import _crescent
from .._paths import steps_of
from .._sampler import Sampler, counts
from ..combinations import Combination
from ..experiments import Experiment
from .grid import UsageError, hint


def of_samplers(values: Mapping[str, Any]) -> dict[str, Any]:
    """The values whose paths are attributes of samplers."""
    return {path: value for path, value in values.items() if steps_of(path)[0] == "samplers"}


def with_attributes(e: Experiment, values: Mapping[str, Any]) -> Experiment:
    """An experiment whose samplers have these attributes, in copies of their objects."""
    out = e.with_({})
    for path, value in values.items():
        steps = steps_of(path)
        if len(steps) != 3:
            raise UsageError(f"--over {path}: expected samplers.NAME.ATTRIBUTE")
        _, name, attribute = steps
        if name not in out.samplers:
            near = _crescent.nearest(name, list(out.samplers))
            there = ", ".join(out.samplers) or "none: e.samplers[NAME] = sampler adds one"
            raise UsageError(f"--over {path}: no sampler '{name}': expected one of e.samplers, {there}" + hint(near))
        out.samplers[name] = with_attribute(out.samplers[name], attribute, value, path)
    return out


def _owner(call: Any) -> Any:
    """The object whose attributes a callable reads: of a method, its object; a callable object itself; else None."""
    if isinstance(call, MethodType):
        return call.__self__
    plain = call is None or isinstance(call, (FunctionType, BuiltinFunctionType, type, functools.partial))
    return None if plain else call


def _with(owner: Any, attribute: str, value: Any, path: str) -> Any:
    """A copy of an object with this attribute; of a data class, made again with it."""
    try:
        fields = dataclasses.fields(owner) if dataclasses.is_dataclass(owner) else ()
        if any(field.name == attribute and field.init for field in fields):
            made: Any = dataclasses.replace(owner, **{attribute: value})
            return made
        out = copy.copy(owner)
        setattr(out, attribute, value)
    except AttributeError as error:
        raise UsageError(f"--over {path}: '{attribute}' cannot be set: {error}") from None
    return out


def _known(sampler: Sampler | Combination, calls: Mapping[str, Any]) -> list[str]:
    """The attributes of a sampler that can be swept."""
    names = {name for call in calls.values() for name in getattr(_owner(call), "__dict__", {})}
    names |= {name for call in calls.values() if isinstance(call, functools.partial) for name in call.keywords}
    if isinstance(sampler, Combination):
        names |= {*sampler.table(), "n"} - {"kind", "of"}
    return sorted(names)


def with_attribute(sampler: Sampler | Combination, attribute: str, value: Any, path: str) -> Sampler | Combination:
    """A sampler with this attribute, in a copy of the object whose methods it calls, or which it calls; a keyword of a
    functools.partial; or a key of a combination. `path` names it in messages."""
    calls = {name: call for name, call in vars(sampler).items() if callable(call)}
    owners = {id(owner): owner for call in calls.values() if (owner := _owner(call)) is not None}
    copies = {
        key: _with(owner, attribute, value, path) for key, owner in owners.items() if hasattr(owner, attribute)
    }  # fmt: skip
    changed: dict[str, Any] = {}
    for name, call in calls.items():
        owner = copies.get(id(_owner(call)))
        if owner is not None:
            changed[name] = MethodType(call.__func__, owner) if isinstance(call, MethodType) else owner
        elif isinstance(call, functools.partial) and attribute in call.keywords:
            changed[name] = functools.partial(call.func, *call.args, **{**call.keywords, attribute: value})
    if isinstance(sampler, Combination) and attribute in _known(sampler, {}):
        whole = tuple(value) if isinstance(value, Iterable) and not isinstance(value, str) else value
        changed[attribute] = counts(value) if attribute == "n" else whole
    if not changed:
        known = _known(sampler, calls)
        near = _crescent.nearest(attribute, known)
        there = ", ".join(known) or "none: it calls no methods of an object"
        raise UsageError(f"--over {path}: no attribute '{attribute}': the sampler has {there}" + hint(near))
    return replace(sampler, **changed)
