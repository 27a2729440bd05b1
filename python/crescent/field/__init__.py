"""Faults of public projects, rewritten, and the plugins of Mitsuba, checked. ``python -m crescent.field``."""

from ._faults import Fault, faults_in

__all__ = ["Fault", "faults_in"]
