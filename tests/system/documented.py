"""Finds undocumented public declarations: documented.py HEADER... prints every class, enumeration, function and public
member function without a comment, and exits with 1 if there are any.

A comment belongs to a declaration that follows it, and to those that follow that one without an empty line between; a
remark on the declaration's first or last line is sufficient. Constructors that are not explicit, destructors,
assignments and operators need none, nor do declarations that override, are private, in a namespace `detail` or inside a
function. Headers are expected in clang-format's layout.
"""
import re
import sys

TYPE = re.compile(r"(template <.*> )?(struct|class|enum class|enum|union) \w+[^;(]*\{")
NOTHING_TO_SAY = re.compile(
    r"#|using |namespace |friend |static_assert|typedef |extern \"C\"|template class |\}|//|"
    r"(struct|class|enum class) \w+;|.*(= default|= delete);|(virtual )?~\w+\(\)|concept |template <.*> concept |"
    r".*\boperator *[-+*/=<>&|!~^%\[(]|.*\boperator (bool|auto)\b|.*\boverride\b|(inline )?constexpr [^()]*=")


def indent(line):
    return len(line) - len(line.lstrip())


def statements(lines):
    """Yields (first, last, text) of each declaration head: lines up to one that ends it; bodies are handled by the
    caller."""
    n = 0
    while n < len(lines):
        first, text = n, lines[n].strip()
        while text and not text.startswith(("//", "#")) and not re.search(r"([;{}]|:)(\s*//.*)?$", lines[n]) \
                and n + 1 < len(lines):
            n += 1
            text += " " + lines[n].strip()
        yield first, n, text
        n += 1


def undocumented(path):
    with open(path, encoding="utf-8") as file:
        lines = file.read().split("\n")
    scopes = []  # (indent, "type" or "space" or "body", public, name)
    covered = False  # by a comment, since the last empty line
    for first, last, text in statements(lines):
        if not text:
            covered = False
            continue
        level = indent(lines[first])
        while scopes and text.startswith("}") and scopes[-1][0] >= level:
            scopes.pop()
        while scopes and scopes[-1][1] == "body" and scopes[-1][0] >= level and text[0] not in "}#":
            scopes.pop()  # one that ends in `}};`
        if any(s[1] == "body" for s in scopes):
            continue
        if text.startswith("//"):
            covered = True
            continue
        if re.match(r"(public|private|protected):", text):
            if scopes:
                scopes[-1][2] = text.startswith("public")
            continue
        opens = bool(re.search(r"\{(\s*//.*)?$", text))
        is_type = bool(TYPE.match(text)) or bool(re.match(r"(struct|class) \w+.*\{$", text))
        is_space = bool(re.match(r"(inline )?namespace\b|extern \"C\"", text))
        visible = all(s[2] for s in scopes) and not any(s[3] == "detail" for s in scopes)
        code = re.sub(r"\s*//.*$", "", text)
        remark = code != text or "//" in lines[first]
        calls = "(" in re.sub(r"\{.*|=.*", "", code) and "(*" not in code
        needs = is_type or calls and not NOTHING_TO_SAY.match(text)
        name = re.search(r"(\w+)\(", code) or re.search(r"(?:struct|class|enum|union) (\w+)", code)
        constructor = scopes and scopes[-1][1] == "type" and name and name[1] == scopes[-1][3]
        if needs and visible and not covered and not remark and not (constructor and "explicit" not in text):
            yield first + 1, code[:90]
        if remark or (needs and covered):
            covered = True
        if opens:
            kind = "space" if is_space else "type" if is_type else "body"
            inside = re.search(r"(?:struct|class|enum|union) (?:class )?(\w+)", code) if is_type else None
            space = re.search(r"namespace ([\w:]+)", code)
            scopes.append([level, kind, not (is_type and re.search(r"\bclass \w", code) and "enum" not in code),
                           inside[1] if inside else space[1].split("::")[-1] if space else ""])
            covered = covered and kind == "body"


def main():
    found = [f"{path}:{line}: no comment says what this is: {head}" for path in sys.argv[1:]
             for line, head in undocumented(path)]
    print("\n".join(found), end="\n" if found else "")
    sys.exit(bool(found))


main()
