"""Prose and links of Markdown pages.

    prose.py text FOLDER PAGE...   writes the prose of each page into FOLDER, without code and link targets. A paragraph
                                   is one line, at the line on which it starts.
    prose.py links PAGE...         prints links to files and headings that do not exist. Exit 1: there is one.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

FENCE = re.compile(r"^ *(```+).*?^ *\1 *$", re.MULTILINE | re.DOTALL)
INLINE = re.compile(r"(`+)(?!`).+?(?<!`)\1(?!`)", re.DOTALL)
COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
LINK = re.compile(r"\[(?:[^\[\]]|\[[^\]]*\])*\]\(([^()\s]+)\)")
HEADING = re.compile(r"^#{1,6} +(.*?) *#*$")
STARTS = re.compile(r"\s*$|\s*([-*|#>]|\d+\.) ?")


def blank(match: re.Match[str]) -> str:
    """Replaces all but the ends of lines by spaces."""
    return re.sub(r"[^\n]", " ", match[0])


def without_code(text: str) -> str:
    for pattern in (FENCE, COMMENT, INLINE):
        text = pattern.sub(blank, text)
    return text


def prose(text: str) -> str:
    lines = re.sub(r"\]\([^()\s]+\)", blank, without_code(text)).split("\n")
    out = list(lines)
    first = 0
    for n in range(1, len(lines)):
        if STARTS.match(lines[n]) or not lines[first].strip() or lines[first].startswith(("#", "|")):
            first = n
        else:
            out[first] += " " + lines[n].strip()
            out[n] = ""
    return "\n".join(re.sub(r" +", " ", line).rstrip() for line in out)


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
    mode, *args = sys.argv[1:]
    if mode == "links":
        found = [line for page in args for line in broken_links(Path(page))]
        print(*found, sep="\n", end="\n" if found else "")
        return 1 if found else 0
    folder, *pages = map(Path, args)
    for page in pages:
        (folder / page).parent.mkdir(parents=True, exist_ok=True)
        (folder / page).write_text(prose(page.read_text(encoding="utf-8")), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
