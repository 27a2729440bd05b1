"""Swept attributes of samplers in Python: ``samplers.NAME.ATTRIBUTE`` of the object whose methods a sampler calls."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from dataclasses import replace
from types import MethodType
from typing import Any

from .. import _crescent
from .._paths import steps_of
from .._sampler import Sampler
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


def with_attribute(sampler: Any, attribute: str, value: Any, path: str) -> Sampler:
    """A sampler with this attribute, in a copy of the object whose methods it calls; `path` names it in messages."""
    calls = {
        field: call
        for field in ("sample", "pdf", "f", "target")
        if isinstance(sampler, Sampler) and isinstance(call := getattr(sampler, field), MethodType)
    }
    owners = {id(call.__self__): call.__self__ for call in calls.values()}
    copies = {key: copy.copy(owner) for key, owner in owners.items() if hasattr(owner, attribute)}
    if not copies:
        known = sorted({name for owner in owners.values() for name in vars(owner)})
        near = _crescent.nearest(attribute, known)
        there = ", ".join(known) or "none: its callables are no methods of an object"
        raise UsageError(f"--over {path}: no attribute '{attribute}': the sampler has {there}" + hint(near))
    for owner in copies.values():
        setattr(owner, attribute, value)
    changed = {
        field: MethodType(call.__func__, copies[id(call.__self__)])
        for field, call in calls.items()
        if id(call.__self__) in copies
    }
    out: Sampler = replace(sampler, **changed)
    return out
