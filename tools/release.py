#!/usr/bin/env python3
"""release.py: the parts of a release that need no network.

    release.py check [TAG]     TAG is v and VERSION; CHANGELOG.md has that version with a date, and text below it;
                               with TAG, nothing is left under [Unreleased]
    release.py notes           prints the text of CHANGELOG.md for VERSION
    release.py metadata FILE   writes the metadata of a DOI (DataCite 4.5, as JSON) from CITATION.cff, VERSION, the date in
                               CHANGELOG.md and tools/addresses.txt
    release.py address NAME    prints an address of tools/addresses.txt

Exit 1: a check fails, with the file and what was expected.
"""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


class Mistake(Exception):
    """What does not fit a release: file and expectation."""


def version() -> str:
    return (ROOT / "VERSION").read_text(encoding="utf-8").strip()


def changes() -> tuple[str, str]:
    """Returns the date and the text of VERSION in CHANGELOG.md."""
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    found = re.search(rf"^## \[{re.escape(version())}\] - (\d{{4}}-\d\d-\d\d)\n(.*?)(?=^## \[|\Z)", text, re.M | re.S)
    if not found:
        raise Mistake(f"CHANGELOG.md: expected '## [{version()}] - YYYY-MM-DD', the version of VERSION")
    if not re.search(r"^- ", found[2], re.M):
        raise Mistake(f"CHANGELOG.md: expected changes below [{version()}]")
    return found[1], found[2].strip()


def unreleased() -> bool:
    """Returns whether CHANGELOG.md has changes of no version."""
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    found = re.search(r"^## \[Unreleased\]\n(.*?)(?=^## \[|\Z)", text, re.M | re.S)
    return bool(found and re.search(r"^- ", found[1], re.M))


def addresses() -> dict[str, str]:
    lines = (ROOT / "tools/addresses.txt").read_text(encoding="utf-8").splitlines()
    return dict(line.split() for line in lines if line.strip() and not line.startswith("#"))


def address(name: str) -> str:
    known = addresses()
    if name not in known:
        raise Mistake(f"tools/addresses.txt: expected one of {', '.join(known)}, not '{name}'")
    return known[name]


def citation(key: str) -> str:
    """Returns a value of CITATION.cff: one line, or the lines of a folded text."""
    text = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    found = re.search(rf'^{key}: (?:>-\n((?:  .*\n)+)|"?(.*?)"?$)', text, re.M)
    if not found:
        raise Mistake(f"CITATION.cff: expected the key '{key}'")
    return " ".join((found[1] or found[2]).split())


def metadata() -> dict[str, object]:
    date, _ = changes()
    authors = re.findall(r'^  - name: "(.*)"$', (ROOT / "CITATION.cff").read_text(encoding="utf-8"), re.M)
    if not authors:
        raise Mistake("CITATION.cff: expected authors with a name")
    return {
        "doi": address("doi"),
        "url": address("repository"),
        "creators": [{"name": name} for name in authors],
        "titles": [{"title": citation("title")}],
        "descriptions": [{"description": citation("abstract"), "descriptionType": "Abstract"}],
        "publisher": {"name": "Zenodo"},
        "publicationYear": date[:4],
        "dates": [{"date": date, "dateType": "Issued"}],
        "types": {"resourceTypeGeneral": "Software"},
        "version": version(),
        "rightsList": [{"rightsIdentifier": citation("license"), "rightsIdentifierScheme": "SPDX"}],
        "schemaVersion": "http://datacite.org/schema/kernel-4",
    }


def main() -> int:
    try:
        match sys.argv[1:]:
            case ["check", *tag] if len(tag) <= 1:
                if tag and tag[0] != f"v{version()}":
                    raise Mistake(f"VERSION: expected the tag v{version()}, not {tag[0]}")
                changes()
                if tag and unreleased():
                    raise Mistake(f"CHANGELOG.md: expected no changes below [Unreleased]; move them to [{version()}]")
                metadata()
            case ["notes"]:
                print(changes()[1])
            case ["metadata", file]:
                Path(file).write_text(json.dumps(metadata(), indent=1) + "\n", encoding="utf-8")
            case ["address", name]:
                print(address(name))
            case _:
                print(__doc__, file=sys.stderr)
                return 2
    except Mistake as e:
        print(e, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
