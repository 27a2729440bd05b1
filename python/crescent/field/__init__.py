"""Faults of public projects, written anew, and what ships in Mitsuba, checked. ``python -m crescent.field``."""

from ._faults import Fault, faults_in

__all__ = ["Fault", "faults_in"]
