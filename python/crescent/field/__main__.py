"""``python -m crescent.field``: writes docs/field.md from the results in tests/field/results.

    python -m crescent.field [--mitsuba [PLUGIN ...]] [--replay] [--faults FOLDER] [--out FILE]

--mitsuba checks the plugins of Mitsuba 3 (from PyPI) and stores the results; --replay checks the faults of tests/field.
Equal results give an equal page.
"""

from __future__ import annotations

import argparse
import difflib
import sys
from pathlib import Path

from .. import _crescent
from ._faults import faults_in
from ._page import page
from ._replays import load_replays, replayed, store_replays
from ._results import load, store

REPLAYS = "replays.json"


def _plugins(only: list[str]) -> None:
    """Raises early the ImportError or ValueError that would otherwise come after minutes."""
    try:
        import mitsuba as mi
    except ImportError:
        raise ImportError("mitsuba is not here: pip install 'crescent[mitsuba]'") from None
    from ._shipped import bsdfs, emitters

    mi.set_variant("llvm_ad_rgb")
    checked = {it.plugin["type"] for it in bsdfs() + emitters()}
    for word in only:
        if word not in checked:
            near = difflib.get_close_matches(word, checked, 1)
            raise ValueError(f"--mitsuba {word}: no such plugin" + (f"; did you mean '{near[0]}'?" if near else ""))


def main(argv: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser("python -m crescent.field", description=(__doc__ or "").partition("\n\n")[0])
    parser.add_argument("--mitsuba", nargs="*", metavar="PLUGIN", help="check all plugins of Mitsuba, or these")
    parser.add_argument("--replay", action="store_true", help="check the faults of public projects")
    parser.add_argument("--faults", metavar="FOLDER", default="tests/field", help="of faults and results")
    parser.add_argument("--out", metavar="FILE", default="docs/field.md")
    args = parser.parse_args(argv)
    folder, out = Path(args.faults), Path(args.out)
    results = folder / "results"
    try:
        if not results.is_dir():
            raise ValueError(f"--faults {folder}: there is no folder {results}")
        if not out.parent.is_dir():
            raise ValueError(f"--out {out}: there is no folder {out.parent}")
        if args.mitsuba is not None:
            _plugins(args.mitsuba)
    except (ValueError, ImportError) as e:
        print(e, file=sys.stderr)
        return 2
    if args.mitsuba is not None:
        from ._shipped_run import shipped

        fresh = {r.what: r for r in shipped(args.mitsuba)}
        file = results / "mitsuba.json"
        known = {r.what: r for r in load(file)} if file.is_file() and args.mitsuba else {}
        store(file, (known | fresh).values())
    if args.replay:
        store_replays(results / REPLAYS, replayed(faults_in(folder)))
    stored = [r for file in sorted(results.glob("*.json")) if file.name != REPLAYS for r in load(file)]
    told = load_replays(results / REPLAYS) if (results / REPLAYS).is_file() else []
    _crescent.write_whole(str(out), "\n\n".join(page(stored, told)) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
