"""Runs every code block of README.md, CONTRIBUTING.md, docs/*.md and the examples' pages, as it is printed.

    run_blocks.py --source REPOSITORY --build BUILD [--work FOLDER] [PAGE...]

The blocks of a page run in order in one folder, a copy of the repository in which `build` is the release build and the
experiments have one seed and no arm of more than 64 samples. tests/system/docs/pages/PAGE.sh first creates the files
that a reader of that page has. CONTRIBUTING.md and the head of blocks.py describe the marks of blocks. Exit 1: a block
fails.
"""

from __future__ import annotations

import argparse
import os
import re
import resource
import shutil
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

from blocks import Block, Mistake, blocks_of, matches
from runners import RUNNERS, Absent, Page, Setting

#: Pages whose blocks are tested by a script.
COVERED = {"docs/extending.md": "tests/system/extending.sh"}


@dataclass
class Count:
    """The outcomes of the blocks."""

    run: int = 0
    texts: int = 0
    elsewhere: int = 0
    left_out: list[str] = field(default_factory=list)  #: by a mark
    absent: list[str] = field(default_factory=list)  #: for what is not installed here
    slow: list[str] = field(default_factory=list)
    mistakes: list[str] = field(default_factory=list)


def pages_of(source: Path) -> list[Path]:
    found = [source / "README.md", source / "CONTRIBUTING.md", *sorted((source / "docs").rglob("*.md"))]
    return found + sorted((source / "examples").rglob("*.md"))


def few_samples(counts: re.Match[str]) -> str:
    """Returns an arm's list of sample counts without those above 64, which take most of a run's time."""
    few = [n for n in counts[1].split(",") if int(n) <= 64]
    return f"n = [{','.join(few)}]" if few else counts[0]


def make_folder(source: Path, build: Path, folder: Path) -> None:
    """Makes a copy of the repository without build outputs; the scripts at its top are links, because they build where
    they are."""
    skipped = re.compile(r"(build|out|dist)($|[-/])|\.git$|__pycache__")
    ignore = lambda at, names: {n for n in names if Path(at) == source and skipped.match(n)}  # noqa: E731
    shutil.copytree(source, folder, ignore=ignore, symlinks=True)
    (folder / "build").symlink_to(build)
    for script in ("run", "test", "film", "page", "wheel"):
        if (folder / script).is_file():
            (folder / script).unlink()
            (folder / script).symlink_to(source / script)
    for experiment in (folder / "experiments").glob("*.toml"):
        text = re.sub(r"(?m)^seeds = \d+", "seeds = 1", experiment.read_text(encoding="utf-8"))
        experiment.write_text(re.sub(r"(?m)^n = \[([\d, ]*)\]", few_samples, text), encoding="utf-8")
    (folder / "home").mkdir()


def check_covered(source: Path, page: Path, script: Path, blocks: list[Block]) -> None:
    """Raises Mistake if a block of the page is not one that the script writes into a file and compiles."""
    listed = re.search(r"for title in ([^;]+);", script.read_text(encoding="utf-8"))
    titles = set(re.findall(r'"([^"]+)"', listed[1] if listed else ""))
    lines = page.read_text(encoding="utf-8").split("\n")
    for block in blocks:
        title = next((at[3:] for at in reversed(lines[: block.line]) if at.startswith("## ")), "")
        if title not in titles or not re.fullmatch(r"<!-- (file|in) .+ -->", block.above):
            raise Mistake(f"{block.place}: {script.name} does not build this block")


def run_block(page: Page, block: Block, count: Count) -> None:
    if block.language == "text":
        count.texts += 1
    elif block.needs:
        count.left_out.append(f"{block.place}: needs {block.needs}")
    else:
        if block.file:
            (page.folder / block.file).parent.mkdir(parents=True, exist_ok=True)
            (page.folder / block.file).write_text(block.text, encoding="utf-8")
        printed = RUNNERS[block.language](page, block)
        if block.prints and not matches(block.prints.text, printed):
            raise Mistake(f"{block.prints.place} says that it prints\n{block.prints.text}and it printed\n{printed}")
        count.run += 1


def run_page(setting: Setting, at: Path, folder: Path, count: Count) -> None:
    source = setting.source
    try:
        blocks = blocks_of(at)
        name = str(at.relative_to(source)) if at.is_relative_to(source) else at.name
        if name in COVERED:
            check_covered(source, at, source / COVERED[name], blocks)
            count.elsewhere += len(blocks)
            return
    except Mistake as e:
        count.mistakes.append(str(e))
        return
    if not any(block.language != "text" and not block.needs for block in blocks):
        for block in blocks:
            run_block(Page(setting, folder, blocks), block, count)
        return
    make_folder(source, setting.build, folder)
    page = Page(setting, folder, blocks)
    has = source / "tests/system/docs/pages" / f"{at.stem}.sh"
    try:
        if has.is_file():
            page.must("bash", "-eu", has)
        for block in blocks:
            before = processor_seconds()
            try:
                run_block(page, block, count)
            except Absent as e:
                count.absent.append(f"{block.place}: needs {e}")
            except Mistake as e:
                count.mistakes.append(f"{block.place}: {e}")
            if (spent := processor_seconds() - before) >= 2:
                count.slow.append(f"{block.place}: {spent:.1f} s")
        for block in page.cmake:
            count.mistakes.append(f"{block.place}: a part of a CMake project without C++ below it")
    except Mistake as e:
        count.mistakes.append(f"{has.name}: {e}")
    finally:
        page.close()


def processor_seconds() -> float:
    both = [resource.getrusage(who) for who in (resource.RUSAGE_CHILDREN, resource.RUSAGE_SELF)]
    return sum(use.ru_utime + use.ru_stime for use in both)


def report(count: Count) -> int:
    for line in count.mistakes:
        print(line)
    lists = (("marked as not run", count.left_out), ("not run on this machine", count.absent))
    for what, lines in (*lists, ("take the most processor time", count.slow)):
        if lines:
            print(f"{len(lines)} {what}:", *lines, sep="\n  ")
    print(f"{processor_seconds():.0f} s of processor time")
    print(
        f"{count.run} blocks run, {len(count.mistakes)} wrong, {count.elsewhere} built by other tests, "
        f"{len(count.left_out)} marked, {len(count.absent)} not run here, {count.texts} of text"
    )
    return 1 if count.mistakes else 0


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--source", type=Path, required=True)
    parser.add_argument("--build", type=Path, required=True)
    parser.add_argument("--python", default="", help="an interpreter with NumPy and pytest, for BUILD/python")
    parser.add_argument("--work", type=Path, help="where to work; by default a folder that is removed")
    parser.add_argument("pages", nargs="*", type=Path)
    args = parser.parse_args()
    source, build = args.source.resolve(), args.build.resolve()
    count = Count()
    with tempfile.TemporaryDirectory() as temporary:
        work = args.work.resolve() if args.work else Path(temporary)
        setting = Setting(source, build, os.environ.get("CXX", "g++"), args.python, work / "prefix")
        for at in [page.resolve() for page in args.pages] or pages_of(source):
            run_page(setting, at, work / at.stem, count)
    return report(count)


if __name__ == "__main__":
    sys.exit(main())
