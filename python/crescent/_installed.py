"""The experiments that are installed with the package, by their names."""

from __future__ import annotations

import os
from pathlib import Path

from . import _crescent


def experiments() -> dict[str, Path]:
    """The files of the installed experiments by name."""
    folder = Path(_crescent.__file__ or "").parent / "share" / "crescent" / "experiments"
    return {path.stem: path for path in sorted(folder.glob("*.toml"))}


def experiment_file(given: str | os.PathLike[str]) -> str:
    """The path of an experiment: the file itself, or the installed one of that name. ValueError names those."""
    text = os.fspath(given)
    if "\n" in text:
        first = next(filter(None, text.splitlines()), "")
        raise ValueError(f"the path is a text of several lines, {first!r} ...: expected a file; crescent.parse reads text")
    if Path(text).is_file():
        return text
    names = experiments()
    if text in names:
        return str(names[text])
    if Path(text).exists():
        return text  # a folder: reported where it is read
    near = _crescent.nearest(Path(text).stem, list(names))
    hint = f"; did you mean '{near}'?" if near else ""
    raise ValueError(
        f"{text}: no such file: expected an experiment file or an installed experiment: {', '.join(names)}{hint}"
    )
