"""What a person cannot read in one sitting, on one screen: lengths.py LIMIT FILE... prints files of more than 600
lines, lines of more than 120 columns and C++ functions of more than LIMIT lines, and exits with 1 where there are any.

C++ is read as clang-format leaves it: a function's head starts a line of its own, and its last brace stands below the
head's first letter. Data are no part of a function's length: lines inside a raw string, and rows of a table, `{...},`
one a line. Functions inside other functions count with these.
"""
import re
import sys

MOST_LINES, MOST_COLUMNS = 600, 120
NO_FUNCTION = re.compile(
    r"(\}|(namespace|struct|class|enum|union|if|for|while|switch|else|do|try|catch|case|default|return)\b"
    r"|template <.*> (struct|class)\b[^(]*$)")
RAW_STRING = re.compile(r'(?<![\w"])R"([^()\\ "]{0,16})\(')
ENDS_BEFORE = re.compile(r"\s*$|.*[;{}]\s*(//.*)?$|\s*//|\s*(public|private|protected):|\s*#")
ROW = re.compile(r"\s*\{.*\}[,;]?(\s*//.*)?$")


def indent(line):
    return len(line) - len(line.lstrip())


def lines_in_raw_strings(lines):
    """For each line whether it starts inside a raw string."""
    inside, end = [], None
    for line in lines:
        inside.append(end is not None)
        if end is not None:
            if end in line:
                end = None
        elif m := RAW_STRING.search(line):
            end = ")" + m[1] + '"'
            if end in line[m.end():]:
                end = None
    return inside


def functions(lines):
    """Yields (lines that count, number of the first line, head) of each function of at least two lines."""
    raw = lines_in_raw_strings(lines)
    n = 0
    while n < len(lines):
        if not raw[n] and re.search(r"\{(\s+//.*)?$", lines[n]):
            first = n
            while first > 0 and indent(lines[first]) > 0 and not raw[first - 1] \
                    and not ENDS_BEFORE.match(lines[first - 1]):
                first -= 1
            head = " ".join(line.strip() for line in lines[first:n + 1])
            if "(" in head and not NO_FUNCTION.match(head) and not re.search(r"(=|return) \{$", head):
                closes = " " * indent(lines[first]) + "}"
                last = n + 1
                while last < len(lines) - 1 and (raw[last] or not lines[last].startswith(closes)):
                    last += 1
                yield sum(not raw[k] and not ROW.match(lines[k]) for k in range(first, last + 1)), first + 1, head
                n = last
        n += 1


def too_long(path, limit):
    """Yields a line of text for each thing that is too long."""
    with open(path, encoding="utf-8") as file:
        lines = file.read().removesuffix("\n").split("\n")
    if len(lines) > MOST_LINES:
        yield f"{path}: {len(lines)} lines, at most {MOST_LINES}"
    for number, line in enumerate(lines, 1):
        if len(line) > MOST_COLUMNS:
            yield f"{path}:{number}: {len(line)} columns, at most {MOST_COLUMNS}"
    if path.endswith((".cpp", ".h")):
        for count, number, head in functions(lines):
            if count > limit:
                yield f"{path}:{number}: a function of {count} lines, at most {limit}: {head[:80]}"


def main():
    found = [line for path in sys.argv[2:] for line in too_long(path, int(sys.argv[1]))]
    print("\n".join(found), end="\n" if found else "")
    sys.exit(bool(found))


main()
