"""words.py [--most N]: prints the words of each page that is written by hand, and their sum. Exit 1: more than N.

A word is what stands between spaces and has a letter or a digit. Code blocks do not count, and neither do
docs/field.md, which a program writes, nor parts between `<!-- measured by PROGRAM -->` and `<!-- end of PROGRAM -->`.
"""

from __future__ import annotations

import argparse
import re
import sys
from pathlib import Path

#: Pages whose whole text is the output of a program (CONTRIBUTING.md).
MEASURED = {"docs/field.md"}
PART = re.compile(r"^<!-- measured by (\S+) -->\n.*?^<!-- end of \1 -->\n", re.MULTILINE | re.DOTALL)
FENCE = re.compile(r"^ *(```+).*?^ *\1 *$", re.MULTILINE | re.DOTALL)


def words(text: str) -> int:
    return sum(any(map(str.isalnum, word)) for word in FENCE.sub("", PART.sub("", text)).split())


def pages(root: Path) -> list[str]:
    top = ["README.md", "AGENTS.md", "llms.txt", "CONTRIBUTING.md", "SECURITY.md"]
    found = [str(page.relative_to(root)) for folder in ("docs", "examples") for page in (root / folder).rglob("*.md")]
    return [page for page in top + sorted(found) if page not in MEASURED]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--root", type=Path, default=Path(__file__).resolve().parents[3])
    parser.add_argument("--most", type=int)
    given = parser.parse_args()
    counts = {page: words((given.root / page).read_text(encoding="utf-8")) for page in pages(given.root)}
    for page, count in counts.items():
        print(f"{count:6} {page}")
    total = sum(counts.values())
    print(f"{total:6} in all")
    if given.most is None or total <= given.most:
        return 0
    print(f"The pages written by hand have {total} words. Expected at most {given.most}.", file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main())
