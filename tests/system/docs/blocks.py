"""The code blocks of a Markdown page, and their marks.

A block begins with three backquotes and a language. The marks in it and around it are:

  # mine.py                     a first line that is only a comment with a file's name: the block is that file
  # exit 2                      at the end of a command of a shell block: the expected exit code
  not run in the tests: needs   in the paragraph directly above or below, between two blocks of the first: the block is
                                not run, and counted
  ```text                       directly below another block: its output; "..." matches any lines
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

LANGUAGES = ("sh", "python", "c", "cpp", "cmake", "toml", "json", "yaml", "js", "groovy", "glsl", "text")
MARK = re.compile(r"not run in the tests: needs\s+([^.;)]+)", re.IGNORECASE)
FILE = re.compile(r"^(?:#|//) ([\w.-]+(?:/[\w.-]+)*\.\w+)$")


class Mistake(Exception):
    """An error on a page: its place and its message."""


@dataclass
class Block:
    """A block: its first line of code is line `line` + 1 of its page."""

    page: Path
    line: int
    language: str
    text: str
    needs: str = ""  #: what is missing to run it, from its mark
    prints: Block | None = None  #: the block directly below with its output
    of: Block | None = field(default=None, repr=False)  #: the block whose output it is
    above: str = field(default="", repr=False)  #: the last non-blank line above it

    @property
    def place(self) -> str:
        return f"{self.page.name}:{self.line}"

    @property
    def file(self) -> str:
        """The file name in its first line; empty: none."""
        named = FILE.match(self.text.partition("\n")[0])
        return named[1] if named else ""


def _paragraph(lines: list[str], at: int, step: int) -> str:
    """Returns the paragraph that ends (step -1) or begins (step 1) at a line, skipping blank lines before it."""
    while 0 <= at < len(lines) and not lines[at].strip():
        at += step
    found: list[str] = []
    while 0 <= at < len(lines) and lines[at].strip() and not lines[at].startswith("```"):
        found.append(lines[at])
        at += step
    return " ".join(found[::step])


def _follows_a_block(lines: list[str], at: int) -> bool:
    """Returns whether at most one paragraph is between a block and this line."""
    above = [line.strip() for line in lines[:at]]
    while above and not above[-1]:
        above.pop()
    while above and above[-1] and not above[-1].startswith("```"):
        above.pop()
    while above and not above[-1]:
        above.pop()
    return bool(above) and above[-1] == "```"


def _closing(lines: list[str], opening: int, fence: str) -> int:
    for at in range(opening + 1, len(lines)):
        if lines[at].rstrip() == fence:
            return at
    raise Mistake("a block that does not end")


def _block(page: Path, lines: list[str], opening: int, closing: int) -> Block:
    language = lines[opening].strip().lstrip("`")
    if language not in LANGUAGES:
        known = ", ".join(LANGUAGES)
        what = f"a block in '{language}'" if language else "a block without a language"
        raise Mistake(f"{page.name}:{opening + 1}: {what}: expected one of {known}")
    indent = len(lines[opening]) - len(lines[opening].lstrip())
    text = "".join(line[indent:] + "\n" for line in lines[opening + 1 : closing])
    out = Block(page, opening + 1, language, text)
    beside = [_paragraph(lines, closing + 1, 1)]
    if not _follows_a_block(lines, opening):  # else the text above belongs to that block
        beside.append(_paragraph(lines, opening - 1, -1))
    for paragraph in beside:
        if mark := MARK.search(paragraph):
            out.needs = out.needs or mark[1].strip()
    above = [line for line in lines[:opening] if line.strip()]
    out.above = above[-1] if above else ""
    return out


def blocks_of(page: Path) -> list[Block]:
    """Returns the blocks of a page in order; Mistake if one is not marked as required."""
    lines = page.read_text(encoding="utf-8").split("\n")
    out: list[Block] = []
    at, last_end = 0, -2
    while at < len(lines):
        if lines[at].startswith("    ") and at and not lines[at - 1].strip() and not _in_list(lines, at):
            raise Mistake(f"{page.name}:{at + 1}: an indented block: expected one with a language")
        if not (opening := re.match(r" *(```+)", lines[at])):
            at += 1
            continue
        closing = _closing(lines, at, lines[at][: opening.end()])
        block = _block(page, lines, at, closing)
        touches = not any(line.strip() for line in lines[last_end + 1 : at])
        if block.language == "text" and out and out[-1].language != "text" and touches:
            out[-1].prints, block.of = block, out[-1]
        out.append(block)
        last_end, at = closing, closing + 1
    return out


def _in_list(lines: list[str], at: int) -> bool:
    """Returns whether an indented line continues a list item."""
    for line in reversed(lines[:at]):
        if line.strip() and not line.startswith(" "):
            return bool(re.match(r"([-*]|\d+\.) ", line))
    return False


def matches(expected: str, printed: str) -> bool:
    """Returns whether `printed` matches the page: numbers to three digits, "..." any lines, nan of either sign."""
    number = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
    parts = re.split(r"^\.\.\.$\n?", expected.strip("\n") + "\n", flags=re.MULTILINE)
    pattern, numbers = "", []
    for i, part in enumerate(parts):
        pattern += r"(?:.*\n)*?" if i else ""
        for j, piece in enumerate(re.split(f"({number})", part)):
            if j % 2:
                numbers.append(float(piece))
                pattern += f"({number})"
            else:
                pattern += re.sub(r"(\\ )+", " +", re.escape(piece)).replace(r"\-nan", "nan").replace("nan", "-?nan")
    found = re.fullmatch(pattern, printed.strip("\n") + "\n")
    return found is not None and all(abs(float(g) - x) <= 1e-3 * abs(x) for g, x in zip(found.groups(), numbers))
