"""site_search.py DIR: adds the words of the pages' headings, bold terms and first cells of tables, and the options and
variables that pages name, to the search field of the site that Doxygen made in DIR. Doxygen itself lists titles of pages
alone, by their first word.

An entry is found by what its key begins with, so each word of a heading gets a key that begins there. An option is found
with its dashes and without.
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
OPTION = re.compile(r"(?<![\w!-])(--[a-z][a-z-]+)\b")
VARIABLE = re.compile(r"<code>([A-Z]+_[A-Z_]+)\b")
TERM = re.compile(r"<b>([^<]{3,40})</b>|<tr[^>]*>\s*<td[^>]*>((?:[^<]|</?code>){3,40})</td>")
SUMMARY = re.compile(r'class="textblock"><p ?>(.*?)</p>', re.S)
SECTIONS = re.compile(r'^  0: "(.*)"', re.M)


def plain(text: str) -> str:
    return " ".join(html.unescape(re.sub(r"<[^>]*>", "", text)).split())


def key_of(text: str) -> str:
    """As convertToId() of Doxygen's search.js."""
    return re.sub(r"[^a-z0-9\u0080-\uffff]", lambda c: f"_{ord(c[0]):02x}", text.lower())


def entries(page: Path) -> Iterator[tuple[str, str, str, str]]:
    """(words that find it, label, link, title of the page) of the entries of a page."""
    text = page.read_text(encoding="utf-8")
    title = plain(found[1]) if (found := TITLE.search(text)) else page.stem
    for anchor, heading in [("", title), *HEADING.findall(text)]:
        label = plain(heading)
        for word in re.finditer(r"\w{3,}", label):
            if word.start() > 0 or anchor:  # Doxygen has the titles by their first word
                yield label[word.start() :], label, f"../{page.name}#{anchor}", title
    names = {plain(bold or cell).rstrip(".") for bold, cell in TERM.findall(text)} | set(VARIABLE.findall(text))
    for name in sorted(names):
        for word in re.finditer(r"[^\W\d_]\w{2,}", name):
            yield name[word.start() :], name, f"../{page.name}#", title
    for word in sorted(set(re.findall(r"\b[A-Z]{2,}\b", plain(found[1]) if (found := SUMMARY.search(text)) else ""))):
        yield word, title, f"../{page.name}#", word
    for option in sorted(set(OPTION.findall(text))):
        yield option[2:], option, f"../{page.name}#", title
        yield option, option, f"../{page.name}#", title


def add_section(search: Path, letters: str, letter: str) -> str:
    """Adds a first letter that Doxygen has no entry for, with an empty list; returns the letters."""
    data = search / "searchdata.js"
    text = data.read_text(encoding="utf-8")
    data.write_text(text.replace(f'0: "{letters}"', f'0: "{letters}{letter}"', 1), encoding="utf-8")
    name = f"all_{len(letters):x}"
    (search / f"{name}.js").write_text("var searchData=\n[\n];\n", encoding="utf-8")
    if (first := search / "all_0.html").is_file():
        frame = first.read_text(encoding="utf-8").replace("all_0.js", f"{name}.js")
        (search / f"{name}.html").write_text(frame, encoding="utf-8")
    return letters + letter


def main() -> int:
    search = Path(sys.argv[1]) / "search"
    found = SECTIONS.search((search / "searchdata.js").read_text(encoding="utf-8"))
    if not found:
        print(f"{search}/searchdata.js: expected the first letters of all entries", file=sys.stderr)
        return 1
    letters, count = found[1], 0
    lines: dict[str, list[str]] = {}
    for page in [*sorted(search.parent.glob("md_*.html")), search.parent / "index.html"]:
        for words, label, link, title in dict.fromkeys(entries(page)):
            rows = lines.setdefault(words[0].lower(), [])
            rows.append("  " + json.dumps([f"{key_of(words)}_s{count}", [label, [link, 1, title]]]))
            count += 1
    for letter, rows in lines.items():
        if letter not in letters:
            letters = add_section(search, letters, letter)
        file = search / f"all_{letters.index(letter):x}.js"
        text = file.read_text(encoding="utf-8")
        file.write_text(text.replace("[\n", "[\n" + ",\n".join(rows) + ",\n", 1), encoding="utf-8")
    print(f"{count} entries of the pages in the search field")
    return 0


if __name__ == "__main__":
    sys.exit(main())
