"""Prints what a program measures, and replaces that part of a page."""
import re


def write_between(path, program, text):
    """Writes `text` between the lines of `path` that say "measured by PROGRAM" and "end of PROGRAM"."""
    with open(path, encoding="utf-8") as file:
        page = file.read()
    name = re.escape(program)
    lines = rf"(<!-- measured by {name} -->\n).*?(<!-- end of {name} -->)"
    page, found = re.subn(lines, lambda m: m[1] + text + "\n" + m[2], page, flags=re.S)
    if not found:
        raise SystemExit(f"{path}: no lines 'measured by {program}' and 'end of {program}'")
    with open(path, "w", encoding="utf-8") as file:
        file.write(page)


def print_measured(text, path, program):
    """Prints what was measured; writes it into a page, too, if one is named."""
    print(text)
    if path:
        write_between(path, program, text)
