"""Comments and docstrings of source files: comments.py FOLDER FILE... writes those of each file into FOLDER, without
text in backticks. A comment over several lines is one line, at the line on which it starts.
"""

from __future__ import annotations

import ast
import io
import re
import sys
import tokenize
from collections.abc import Iterator
from pathlib import Path

# C++, GLSL and TypeScript: comments, and the literals in which // is no comment.
C_LIKE = re.compile(
    r"""(?P<comment>//[^\n]*|/\*.*?\*/)
      | R"(?P<mark>[^()\\\s]*)\(.*?\)(?P=mark)"
      | "(?:\\.|[^"\\\n])*" | (?<![0-9a-zA-Z])'(?:\\.|[^'\\\n])*' | `(?:\\.|[^`\\])*`""",
    re.DOTALL | re.VERBOSE,
)
# Shell and CMake: a whole line, or the end of one after two blanks.
HASH = re.compile(r"(?:^[ \t]*|(?<=\S)  )#(?!!)(?P<comment>[^\n]*)", re.MULTILINE)
INLINE = re.compile(r"`[^`\n]*`")
MARKS = re.compile(r"^\s*(?:///?<?|/\*+|\*+/?|#+:?)\s?")


def of_python(text: str) -> Iterator[tuple[int, str]]:
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT:
            yield token.start[0], token.string
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)):
            first = node.body[0] if node.body else None
            if isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant):
                yield first.lineno, str(first.value.value)


def of_matches(pattern: re.Pattern[str], text: str) -> Iterator[tuple[int, str]]:
    for match in pattern.finditer(text):
        if match["comment"] is not None:
            yield text.count("\n", 0, match.start("comment")) + 1, match["comment"]


def comments(path: Path) -> Iterator[tuple[int, str]]:
    """The first line and the text of each comment."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".py":
        return of_python(text)
    return of_matches(HASH if path.suffix in (".sh", ".cmake", ".txt") else C_LIKE, text)


def joined(path: Path) -> str:
    lines: dict[int, str] = {}
    last = first = -1
    for line, text in sorted(comments(path)):
        parts = [MARKS.sub("", part).strip() for part in text.split("\n")]
        if line != last + 1 or not parts[0]:
            first = line
        lines[first] = f"{lines.get(first, '')} {' '.join(parts)}".strip()
        last = line + len(parts) - 1
    out = [""] * (max(lines, default=0) + 1)
    for line, text in lines.items():
        out[line] = INLINE.sub(" ", text)
    return "\n".join(out[1:]) + "\n"


def main() -> int:
    folder, *files = map(Path, sys.argv[1:])
    for file in files:
        (folder / file).parent.mkdir(parents=True, exist_ok=True)
        (folder / file).write_text(joined(file), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
