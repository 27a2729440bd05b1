"""Why a verdict on a shipped plugin is not right, where that is understood. Sizes are the verdict's own; nothing here is
a measurement."""

from __future__ import annotations

import re
from dataclasses import dataclass

from .._judgement import Verdict


@dataclass(frozen=True)
class Note:
    """What explains verdicts of some plugins."""

    plugins: str  #: a regular expression over the plugin and its parameters
    verdicts: str  #: over the verdict's name
    says: str  #: over its sentence
    kind: str  #: "bug", "no picture changes", "corner", "approximation", "single precision" or "the model"
    because: str

    def covers(self, title: str, verdict: Verdict) -> bool:
        """Whether it explains this verdict of this plugin."""
        return all(
            re.search(pattern, text, re.S) is not None
            for pattern, text in ((self.plugins, title), (self.verdicts, verdict.name), (self.says, verdict.say))
        )


NOTES = [
    Note(
        "", "valid", "at u = .*corners of u", "corner",
        "Where a random number is exactly 0 or next to 1 the distribution of normals divides by zero: pdf or direction is "
        "no number. A generator of 24 bits comes upon such numbers as seldom as the verdict says.",
    ),
    Note(
        "roughplastic", "normalised|density", "", "no picture changes",
        "pdf() answers under the surface too, with the lobe's density there, of which sample() draws less than that; eval() "
        "is 0 there, so no picture changes. Beside it p is right above the surface.",
    ),
    Note(
        "^principled:(?!.*spec_trans)", "normalised|density|support|identity", "nothing|Fewer than two bins", "no picture changes",
        "For w_o under an opaque surface pdf() gives the density of lobes that sample() does not draw from; eval() is 0 "
        "there, so no picture changes.",
    ),
    Note(
        "beckmann", "normalised|density|identity|physics|mean", "", "approximation",
        "G1 of Beckmann's distribution is the rational fit of Walter et al. 2007, whose stated relative error is 0.35 %; as "
        "visible normals are drawn with the exact one, p is off by the fit's error.",
    ),
    Note(
        "roughdielectric|principled.*spec_trans", "identity", "pdf that came with the draw and pdf\\(w\\) differ", "single precision",
        "The half vector of a refraction is computed anew from two directions of single precision, and near the critical "
        "angle and the horizon most of its digits cancel.",
    ),
    Note(
        "cylinder", "identity|normalised|density", "", "single precision",
        "pdf(w) is found by sending a ray back; where it grazes the cylinder the cosine there is lost to the rounding of the "
        "direction and of the intersection, and p divides by it. The ratio of both is 1 in the middle of the lamp.",
    ),
    Note(
        "principled.*sheen", "physics", "creates energy", "the model",
        "Disney's sheen is added on top of the other lobes and takes nothing from them: at grazing w_o more leaves the "
        "surface than arrives. Burley 2012 and 2015 say so of it.",
    ),
]


def note_on(title: str, verdict: Verdict) -> Note | None:
    """The first note that explains the verdict; None: a bug, or not understood."""
    return next((note for note in NOTES if note.covers(title, verdict)), None)
