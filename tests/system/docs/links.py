"""links.py PAGE... prints links of Markdown pages to files and headings that do not exist. Exit 1: there is one."""

from __future__ import annotations

import re
import sys
from pathlib import Path

FENCE = re.compile(r"^ *(```+).*?^ *\1 *$", re.MULTILINE | re.DOTALL)
INLINE = re.compile(r"(`+)(?!`).+?(?<!`)\1(?!`)", re.DOTALL)
COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
LINK = re.compile(r"\[(?:[^\[\]]|\[[^\]]*\])*\]\(([^()\s]+)\)")
HEADING = re.compile(r"^#{1,6} +(.*?) *#*$")


def blank(match: re.Match[str]) -> str:
    """Replaces all but the ends of lines by spaces."""
    return re.sub(r"[^\n]", " ", match[0])


def without_code(text: str) -> str:
    for pattern in (FENCE, COMMENT, INLINE):
        text = pattern.sub(blank, text)
    return text


def anchors(page: Path) -> set[str]:
    """Returns the anchors of its headings, as GitHub makes them."""
    found: dict[str, int] = {}
    out = set()
    for line in FENCE.sub(blank, page.read_text(encoding="utf-8")).split("\n"):
        if heading := HEADING.match(line):
            title = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading[1]).replace("`", "")
            name = re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")
            seen = found.get(name, 0)
            found[name] = seen + 1
            out.add(f"{name}-{seen}" if seen else name)
    return out


def broken_links(page: Path) -> list[str]:
    out = []
    for link in LINK.finditer(text := without_code(page.read_text(encoding="utf-8"))):
        if re.match(r"[a-z]+:", link[1]):
            continue
        path, _, anchor = link[1].partition("#")
        target = (page.parent / path) if path else page
        place = f"{page}:{text.count(chr(10), 0, link.start()) + 1}"
        if not target.exists():
            out.append(f"{place}: {link[1]}: no such file")
        elif anchor and target.suffix == ".md" and anchor not in anchors(target):
            out.append(f"{place}: {link[1]}: no such heading")
    return out


def main() -> int:
    found = [line for page in sys.argv[1:] for line in broken_links(Path(page))]
    print(*found, sep="\n", end="\n" if found else "")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
