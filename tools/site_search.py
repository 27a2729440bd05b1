"""site_search.py DIR: adds the words of the pages' headings, and the options that pages name, to the search field of
the site that Doxygen made in DIR. Doxygen itself lists titles of pages alone, by their first word.

An entry is found by what its key begins with, so each word of a heading gets a key that begins there.
"""

from __future__ import annotations

import html
import json
import re
import sys
from collections.abc import Iterator
from pathlib import Path

TITLE = re.compile(r'<div class="title">(.*?)</div>', re.S)
HEADING = re.compile(r'<h[1-6]><a class="anchor" id="([^"]*)"></a>\s*(.*?)</h[1-6]>', re.S)
OPTION = re.compile(r"<code>(--[a-z][a-z-]+)\b")
SECTIONS = re.compile(r'^  0: "(.*)"', re.M)


def plain(text: str) -> str:
    return " ".join(html.unescape(re.sub(r"<[^>]*>", "", text)).split())


def key_of(text: str) -> str:
    """As convertToId() of Doxygen's search.js."""
    return re.sub(r"[^a-z0-9\u0080-\uffff]", lambda c: f"_{ord(c[0]):02x}", text.lower())


def entries(page: Path) -> Iterator[tuple[str, str, str, str]]:
    """(key, label, link, title of the page) of the words of a page."""
    text = page.read_text(encoding="utf-8")
    title = plain(found[1]) if (found := TITLE.search(text)) else page.stem
    for anchor, heading in [("", title), *HEADING.findall(text)]:
        label = plain(heading)
        for word in re.finditer(r"\w{3,}", label):
            if word.start() > 0 or anchor:  # Doxygen has the titles by their first word
                yield key_of(label[word.start() :]), label, f"../{page.name}#{anchor}", title
    for option in sorted(set(OPTION.findall(text))):
        yield key_of(option[2:]), option, f"../{page.name}#", title


def main() -> int:
    site = Path(sys.argv[1])
    found = SECTIONS.search((site / "search/searchdata.js").read_text(encoding="utf-8"))
    if not found:
        print(f"{site}/search/searchdata.js: expected the first letters of all entries", file=sys.stderr)
        return 1
    lines: dict[str, list[str]] = {}
    for page in [*sorted(site.glob("md_*.html")), site / "index.html"]:
        for key, label, link, title in entries(page):
            row = [f"{key}_s{sum(map(len, lines.values()))}", [label, [link, 1, title]]]
            lines.setdefault(key[0], []).append("  " + json.dumps(row))
    for letter, rows in lines.items():
        if letter in found[1]:
            file = site / f"search/all_{found[1].index(letter):x}.js"
            text = file.read_text(encoding="utf-8")
            file.write_text(text.replace("[\n", "[\n" + ",\n".join(rows) + ",\n", 1), encoding="utf-8")
    print(f"{sum(map(len, lines.values()))} entries of the pages in the search field")
    return 0


if __name__ == "__main__":
    sys.exit(main())
