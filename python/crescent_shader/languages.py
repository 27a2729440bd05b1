"""The text that is compiled: the user's file, then one entry point for each operation with the user's snippets in it.

Each entry evaluates one row: it reads w_o and u, or w_o and w_i, and the columns of the surface point from one buffer
of floats, and writes its answer to another. Every line knows the place from which it came, so that an error of the
compiler is one of the user's file or snippet. Names of this module's own begin with ``crescent_``.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

from . import BadInput
from .request import CONTEXT, Constant, Request, read_preludes

OPERATIONS = ("sample", "pdf", "f")
SET, IN, OUT = 3, 0, 1  # the binding group of the buffers, which files rarely use, and their bindings
ROWS_IN_GROUP = 64
OWN = "crescent"  # the label of generated lines


@dataclass(frozen=True)
class Line:
    """A line with its place."""

    text: str
    label: str = OWN
    number: int = 0


@dataclass(frozen=True)
class Program:
    """One operation of a shader, to be compiled."""

    operation: str
    columns_in: int
    columns_out: int
    lines: tuple[Line, ...]

    def plain(self) -> str:
        """The text without places."""
        return "\n".join(line.text for line in self.lines) + "\n"

    def with_places(self) -> str:
        """The text with a `#line` wherever the place is not that of the line after the last one."""
        out: list[str] = []
        label, number = OWN, 0
        for line in self.lines:
            if line.label != OWN and (line.label, line.number) != (label, number):
                out.append(f'#line {line.number} "{quoted(line.label)}"')
            elif line.label == OWN and label != OWN:
                out.append(f'#line 1 "{OWN}"')
            label, number = line.label, line.number + 1
            out.append(line.text)
        return "\n".join(out) + "\n"


def quoted(label: str) -> str:
    """A label within quotes of a preprocessor."""
    return label.replace("\\", "/").replace('"', "'").replace("\n", " ")


def placed(text: str, label: str) -> list[Line]:
    """The lines of a text, from line 1 of a label."""
    return [Line(line, label, at) for at, line in enumerate(text.splitlines() or [""], 1)]


def mentions(text: str, name: str) -> bool:
    """Whether the name of a variable occurs: not a member of something, and not a call."""
    return re.search(rf"(?<![\w.]){name}\b(?!\s*\()", without_comments(text)) is not None


def without_comments(text: str) -> str:
    """The text with comments blanked, each character in its place."""

    def blank(match: re.Match[str]) -> str:
        return re.sub(r"[^\n]", " ", match[0])

    return re.sub(r"//[^\n]*|/\*.*?\*/", blank, text, flags=re.S)


# ---- The notation of each language.


@dataclass(frozen=True)
class Notation:
    """How a language writes a vector, a variable, a constant and an entry."""

    vector: Callable[[int, str], str]  # the type of so many floats, ints or bools
    variable: Callable[[str, str, str], str]  # type, name, value
    constant: Callable[[str, str, str], str]


def _c_vector(glsl: bool) -> Callable[[int, str], str]:
    def name(count: int, kind: str) -> str:
        if count == 1:
            return kind
        return {"float": "vec", "int": "ivec", "bool": "bvec"}[kind] + str(count) if glsl else f"{kind}{count}"

    return name


def _wgsl_vector(count: int, kind: str) -> str:
    scalar = {"float": "f32", "int": "i32", "bool": "bool"}[kind]
    return scalar if count == 1 else f"vec{count}<{scalar}>"


def _typed(kind: str, name: str, value: str) -> str:
    return f"{kind} {name} = {value};"


_C = (_typed, lambda kind, name, value: f"const {kind} {name} = {value};")
NOTATIONS = {
    "wgsl": Notation(
        _wgsl_vector,
        lambda kind, name, value: f"var {name}: {kind} = {value};",
        lambda kind, name, value: f"let {name}: {kind} = {value};",
    ),
    "glsl": Notation(_c_vector(True), *_C),
    "hlsl": Notation(_c_vector(False), *_C),
    "slang": Notation(_c_vector(False), *_C),
}


def _value(notation: Notation, constant: Constant) -> tuple[str, str]:
    """The type of a constant, and its value."""
    kind = notation.vector(len(constant.values), constant.kind)
    return kind, constant.values[0] if len(constant.values) == 1 else f"{kind}({', '.join(constant.values)})"


# ---- The user's file.


def _closing(text: str, start: int) -> int:
    """The place of the parenthesis that closes the one at `start`, or -1."""
    depth = 0
    for at in range(start, len(text)):
        depth += {"(": 1, ")": -1}.get(text[at], 0)
        if depth == 0:
            return at
    return -1


_RESULT = {"float": 1, "f32": 1, "half": 1, "vec2": 2, "float2": 2, "vec2f": 2, "vec3": 3, "float3": 3, "vec3f": 3}
_RESULT |= {"vec2<f32>": 2, "vec3<f32>": 3}


def _random_count(code: str, name: str, language: str) -> int:
    """The numbers of a call, by the type of the function's result; 1 if it is not in this file."""
    pattern = (
        rf"\bfn\s+{name}\s*\([^{{]*?->\s*([\w<>]+)\s*\{{"
        if language == "wgsl"
        else rf"\b(\w+)\s+{name}\s*\([^;{{)]*\)\s*\{{"
    )
    found = re.search(pattern, code)
    return _RESULT.get(found[1], 1) if found else 1


def _take_random(text: str, name: str, count: int) -> str:
    """The text with each call of a function replaced by the next of u; its definition has another name."""
    out, last = [], 0
    code = without_comments(text)
    for match in re.finditer(rf"(?<![\w.]){name}\s*\(", code):
        if match.start() < last:
            continue
        opening = match.end() - 1
        end = _closing(code, opening)
        if end < 0:
            continue
        defines = re.match(r"\s*(->[^{;]*)?\{", code[end + 1 :]) or re.search(
            r"(?:\bfn\s+|\b(?!return\b|else\b)[A-Za-z_]\w*\s+)$", code[: match.start()]
        )
        out.append(text[last : match.start()])
        if defines:
            out.append("crescent_users_" + text[match.start() : opening])
            last = opening
        else:
            out.append(f"crescent_random{count}()" + "\n" * text.count("\n", match.start(), end))
            last = end + 1
    return "".join(out) + text[last:]


def _set_uniforms(text: str, constants: Iterable[Constant], notation: Notation, language: str) -> str:
    """The text with the uniforms, overrides and specialisation constants that --set names as constants."""
    for one in constants:
        kind, value = _value(notation, one)
        if language == "wgsl":
            pattern, put = rf"\boverride\s+{one.name}\b[^;]*;", f"const {one.name}: {kind} = {value};"
        else:
            start = r"(?:layout\s*\([^)]*\)\s*(?:uniform|const)|\b(?:uniform|extern))"
            pattern = rf"{start}\s+(?:\w+\s+)?\w+\s+{one.name}\s*(?:=[^;]*)?;"
            put = ("const" if language == "glsl" else "static const") + f" {kind} {one.name} = {value};"
        text = re.sub(pattern, lambda match: put + "\n" * match[0].count("\n"), text, count=1)
    return text


def _condition(words: str, macros: dict[str, str]) -> bool:
    """`NAME`, `NAME == VALUE` or `NAME != VALUE` of a `#if`."""
    left, comparison, right = re.match(r"\s*(\w+)\s*(==|!=)?\s*(\w*)", words).groups()  # type: ignore[union-attr]
    value = macros.get(left, "0" if comparison is None else left)
    if comparison is None:
        return value not in ("0", "false")
    return (value == macros.get(right, right)) == (comparison == "==")


def wgsl_lines(text: str, label: str, folders: list[Path], macros: dict[str, str], depth: int = 0) -> list[Line]:
    """The lines of a WGSL file after a small preprocessor: #define, #ifdef, #ifndef, #if, #else, #endif, #include and
    #{NAME}, as many engines write; #import of naga_oil is left out, and its names are then unknown."""
    out: list[Line] = []
    active = [True]
    for number, line in enumerate(text.splitlines(), 1):
        directive = re.match(r"\s*#\s*(\w+)\s*(.*)", line)
        if not directive:
            line = re.sub(r"#\{(\w+)\}", lambda m: macros.get(m[1], m[0]), line)
            out.append(Line(line if all(active) else "", label, number))
            continue
        word, rest = directive[1], directive[2].partition("//")[0].strip()
        if word in ("ifdef", "ifndef"):
            active.append((rest in macros) == (word == "ifdef"))
        elif word == "if":
            active.append(bool(rest) and re.match(r"\s*\w", rest) is not None and _condition(rest, macros))
        elif word == "else" and len(active) > 1:
            again = re.match(r"\s*(ifdef|ifndef|if)\s+(.*)", rest)
            if again and again[1] != "if":
                active[-1] = not active[-1] and (again[2] in macros) == (again[1] == "ifdef")
            else:
                active[-1] = not active[-1] and (not again or _condition(again[2], macros))
        elif word == "endif" and len(active) > 1:
            active.pop()
        elif word == "define" and all(active):
            name, _, value = rest.partition(" ")
            macros[name] = value.strip() or "1"
        elif word == "include" and all(active):
            out += _wgsl_include(rest, f"{label}:{number}", folders, macros, depth)
            continue
        out.append(Line("", label, number))
    return out


def _wgsl_include(rest: str, place: str, folders: list[Path], macros: dict[str, str], depth: int) -> list[Line]:
    name = rest.strip('"<> ')
    if depth > 32:
        raise BadInput(f"{place}: '{name}' includes itself")
    for folder in folders:
        if (path := folder / name).is_file():
            return wgsl_lines(path.read_text("utf-8", "replace"), str(path), [path.parent, *folders], macros, depth + 1)
    raise BadInput(f"{place}: no file '{name}' in {', '.join(map(str, folders))}: -I DIR names a folder")


def _users_lines(request: Request) -> tuple[list[Line], list[Line]]:
    """Lines that must come first, such as extensions; and the preludes and the file."""
    notation, language = NOTATIONS[request.language], request.language
    texts = [*read_preludes(request), (str(request.path), request.text)]
    first: list[Line] = []
    out: list[Line] = []
    macros = dict(request.define)
    everything = "\n".join(without_comments(text) for _, text in texts)
    for label, text in texts:
        text = _set_uniforms(text, request.constants, notation, language)
        for name in request.random:
            text = _take_random(text, name, _random_count(everything, name, language))
        if language == "wgsl":
            folders = [Path(label).parent, *request.include]
            lines = wgsl_lines(text, label, folders, macros)
            leading = re.compile(r"\s*(enable|requires|diagnostic)\b[^;]*;\s*(//.*)?$")
        else:
            lines = placed(text, label)
            leading = re.compile(r"\s*#\s*extension\b" if language == "glsl" else r"(?!)")
        for line in lines:
            if leading.match(line.text):
                first.append(line)
                line = Line("", line.label, line.number)
            elif language == "glsl" and re.match(
                r"\s*#\s*version\b|\s*#\s*pragma\s+(?!once)|precision\s+\w+\s+\w+\s*;", line.text
            ):
                line = Line("", line.label, line.number)
            out.append(line)
    return first, out


# ---- The entries.

_TURN = {  # local to the user's axes, and back, by component
    "z": ("{0}.x, {0}.y, {0}.z", "{0}.x, {0}.y, {0}.z"),
    "y": ("{0}.x, {0}.z, -{0}.y", "{0}.x, -{0}.z, {0}.y"),
    "x": ("{0}.z, {0}.x, {0}.y", "{0}.y, {0}.z, {0}.x"),
}
# Rows of a rotation whose elements have no common pattern, for --frame world: t, b and n.
_WORLD = (
    ("t", (0.7529878480, 0.3579041957, -0.5522089768)),
    ("b", (-0.5887398080, 0.7315060670, -0.3441873389)),
    ("n", (0.2806786690, 0.5842747600, 0.7614661900)),
)


def _orthonormal() -> list[tuple[str, tuple[float, float, float]]]:
    """t, b and n exactly orthonormal in double precision (Gram and Schmidt)."""

    def dot(a: tuple[float, ...], b: tuple[float, ...]) -> float:
        return sum(x * y for x, y in zip(a, b))

    out: list[tuple[str, tuple[float, float, float]]] = []
    for name, v in reversed(_WORLD):
        for _, w in out:
            overlap = dot(v, w)
            v = tuple(x - overlap * y for x, y in zip(v, w))  # type: ignore[assignment]
        length = dot(v, v) ** 0.5
        out.append((name, tuple(x / length for x in v)))  # type: ignore[arg-type]
    return out


def columns(request: Request, operation: str, weights: int = 0) -> tuple[int, int]:
    """Floats of a row of a request, and of its answer."""
    context = sum(CONTEXT[name] for name in request.uses)
    wo, point = 3 if request.has_wo else 0, request.coordinates or 3
    if operation == "sample":
        return wo + request.numbers + context, point + 1 + weights + (1 if request.random else 0)
    return wo + point + context, 1 if operation == "pdf" else 4


class _Entry:
    """The lines of one entry's body."""

    def __init__(self, request: Request, operation: str) -> None:
        self.request, self.notation = request, NOTATIONS[request.language]
        self.texts = " ".join((request.sample, request.pdf, request.f, *request.let))
        self.lines: list[Line] = []
        self.operation = operation

    def add(self, text: str) -> None:
        self.lines.append(Line("    " + text))

    def paste(self, text: str, option: str, first: int = 0) -> None:
        """Lines of a snippet, which is that of a comment of the file from its line `first` on, or of an option."""
        numbers = dict(self.request.places).get(option, ())[first:]
        for at, line in enumerate(placed(text, option)):
            own = at < len(numbers)
            self.lines.append(Line(line.text, str(self.request.path), numbers[at]) if own else line)

    def column(self, at: int) -> str:
        return f"crescent_in[crescent_i + {at}{'u' if self.request.language in ('wgsl', 'glsl', 'hlsl') else ''}]"

    def floats(self, first: int, count: int) -> str:
        parts = ", ".join(self.column(first + k) for k in range(count))
        return parts if count == 1 else f"{self.notation.vector(count, 'float')}({parts})"

    def constant(self, name: str, count: int, value: str) -> None:
        self.add(self.notation.constant(self.notation.vector(count, "float"), name, value))

    def variable(self, name: str, count: int) -> None:
        kind = self.notation.vector(count, "float")
        zero = "0.0" if count == 1 else f"{kind}({', '.join(['0.0'] * count)})"
        self.add(self.notation.variable(kind, name, zero))

    def write(self, at: int, value: str) -> None:
        self.add(f"crescent_out[crescent_o + {at}{'u' if self.request.language != 'slang' else ''}] = {value};")

    def direction(self, name: str, first: int) -> None:
        """A direction of the row, in the user's frame."""
        vec3 = self.notation.vector(3, "float")
        self.constant(f"crescent_{name}", 3, self.floats(first, 3))
        if self.request.frame == "world":
            parts = " + ".join(f"crescent_{axis} * crescent_{name}.{of}" for axis, of in zip("tbn", "xyz"))
            self.add(self.notation.constant(vec3, name, parts))
        else:
            turned = _TURN[self.request.up][0].format(f"crescent_{name}")
            self.add(self.notation.constant(vec3, name, f"{vec3}({turned})"))

    def point(self, first: int) -> None:
        """A point of the domain."""
        if self.request.is_set:
            kind = self.notation.vector(1, "int")
            self.add(self.notation.constant(kind, "x", f"{kind}({self.column(first)})"))
        else:
            self.constant("x", self.request.coordinates, self.floats(first, self.request.coordinates))

    def frame(self) -> None:
        if self.request.frame != "world":
            return
        vec3 = self.notation.vector(3, "float")
        for axis, v in _orthonormal():
            self.constant(f"crescent_{axis}", 3, f"{vec3}({', '.join(repr(x) for x in v)})")
            if mentions(self.texts, axis):
                self.constant(axis, 3, f"crescent_{axis}")

    def surroundings(self, context: int) -> None:
        """The names of the surface point, and the constants."""
        for name in sorted(self.request.uses, key=list(CONTEXT).index):
            self.constant(name, CONTEXT[name], self.floats(context, CONTEXT[name]))
            context += CONTEXT[name]
        for one in self.request.constants:
            if mentions(self.texts, one.name):
                kind, value = _value(self.notation, one)
                if self.request.language == "wgsl" and len(one.values) == 1:  # 3 is then also a float, as in the others
                    self.add(f"const {one.name} = {value};")
                else:
                    self.add(self.notation.constant(kind, one.name, value))
        for at, text in enumerate(self.request.let, 1):  # those of the file come first
            self.paste(closed(text), "--let", at - 1)

    def result(self, text: str, name: str, option: str, count: int) -> None:
        """Assigns `name` the value of an expression, or what its statements assign to it."""
        self.add("{")
        if _is_statements(text, name):
            self.paste(closed(text), option)
        else:
            kind = self.notation.vector(count, "float")
            cast = "" if count == 1 else f"({kind})" if self.request.language in ("hlsl", "slang") else kind
            opening = len(self.lines)
            self.paste(text, option)
            first, last = self.lines[opening], self.lines[-1]  # an assignment of the wrong type has their places
            self.lines.insert(opening, Line(f"    {name} = {cast}(", first.label, first.number))
            self.lines.append(Line("    );", last.label, last.number))
        self.add("}")


def _is_statements(text: str, name: str) -> bool:
    """Whether a snippet assigns to the variable, in place of being its value."""
    return ";" in without_comments(text) or re.search(rf"(?<![\w.]){name}\s*=[^=]", text) is not None


def closed(text: str) -> str:
    """Statements with the last semicolon, which an initialiser list needs too and a block may have."""
    code = without_comments(text).rstrip()
    return text if not code or code[-1] == ";" else text[: len(code)] + ";" + text[len(code) :]


def _body(request: Request, operation: str, channels: int, weights: int) -> list[Line]:
    entry = _Entry(request, operation)
    u = "u" if request.language in ("wgsl", "glsl", "hlsl") else ""
    columns_in, columns_out = columns(request, operation, weights)
    integer = {"wgsl": "let crescent_{0} = {1};", "glsl": "uint crescent_{0} = {1};"}.get(
        request.language, "uint crescent_{0} = {1};"
    )
    row = {"glsl": "gl_GlobalInvocationID.x"}.get(request.language, "crescent_id.x")
    entry.add(integer.format("i", f"{row} * {columns_in}{u}"))
    entry.add(integer.format("o", f"{row} * {columns_out}{u}"))
    entry.frame()
    if request.has_wo:
        entry.direction("wo", 0)
    second = 3 if request.has_wo else 0  # the first column after w_o
    if operation == "sample":
        _sample_body(entry, second, weights)
        return entry.lines
    if request.coordinates:
        entry.point(second)
    else:
        entry.direction("wi", second)
    entry.surroundings(second + (request.coordinates or 3))
    if operation == "pdf":
        entry.variable("pdf", 1)
        entry.result(request.pdf, "pdf", "--pdf", 1)
        entry.write(0, "pdf")
        return entry.lines
    option = "--f-cos" if request.f_has_cosine else "--f"
    entry.variable("f", channels)
    entry.result(request.f, "f", option, channels)
    for k in range(3):
        entry.write(k, "f" if channels == 1 else f"f.{'xyz'[k]}")
    if request.language in ("hlsl", "slang") and channels == 3 and not _is_statements(request.f, "f"):
        # these languages shorten a vector where a number is expected, so the type is asked for
        entry.add("crescent_out[crescent_o + 3] = crescent_channels(")
        entry.paste(request.f, option)
        entry.add(");")
    else:
        entry.write(3, f"{channels}.0")
    return entry.lines


def _sample_body(entry: _Entry, second: int, weights: int) -> None:
    """Draws a direction or a point from the numbers that begin in the column `second`."""
    request, wgsl = entry.request, entry.request.language == "wgsl"
    numbers = request.numbers
    if mentions(entry.texts, "u"):
        entry.constant("u", min(numbers, 2), entry.floats(second, min(numbers, 2)))
    for k in range(numbers):
        if mentions(entry.texts, f"u{k + 1}"):
            entry.constant(f"u{k + 1}", 1, entry.floats(second + k, 1))
    if request.random:
        for k in range(numbers):
            entry.add(f"crescent_u[{k}] = {entry.floats(second + k, 1)};")
        entry.add("crescent_taken = 0;")
    entry.surroundings(second + numbers)
    if request.is_set:
        entry.add(entry.notation.variable(entry.notation.vector(1, "int"), "x", "0"))
    else:
        entry.variable("x" if request.coordinates else "wi", request.coordinates or 3)
    has_pdf = assigns(request.sample, "pdf") or bool(request.pdf)
    if has_pdf:
        entry.variable("pdf", 1)
    if weights:
        entry.variable("weight", weights)
    if assigns(request.sample, "delta"):
        entry.variable("delta", 1)
    entry.add("{")
    entry.paste(closed(request.sample), "--sample")
    entry.add("}")
    if not assigns(request.sample, "pdf") and request.pdf:
        entry.result(request.pdf, "pdf", "--pdf", 1)
    number = "f32" if wgsl else "float"
    if request.is_set:
        parts = [f"{number}(x)"]
    elif request.coordinates:
        parts = ["x"] if request.coordinates == 1 else [f"x.{'xyzw'[k]}" for k in range(request.coordinates)]
    elif request.frame == "world":
        parts = [f"dot(wi, crescent_{axis})" for axis in "tbn"]
    else:
        parts = _TURN[request.up][1].format("wi").split(", ")
    value = "pdf" if has_pdf else "1.0"
    if assigns(request.sample, "delta"):
        value = f"select({value}, -delta, delta > 0.0)" if wgsl else f"(delta > 0.0 ? -delta : {value})"
    values = [value] + ["weight" if weights == 1 else f"weight.{'xyz'[k]}" for k in range(weights)]
    if request.domain == "hemisphere":  # a draw below the surface is no sample, for any pdf
        below = f"({parts[2]} <= 0.0)"
        values = [f"select({v}, 0.0, {below})" if wgsl else f"({below} ? 0.0 : {v})" for v in values]
    for k, value in enumerate(parts + values):
        entry.write(k, value)
    if request.random:
        entry.write(len(parts + values), f"{number}(crescent_taken)")


def assigns(text: str, name: str) -> bool:
    """Whether a snippet has this variable, to assign it or to pass it as a result."""
    return mentions(text, name)


def _random_functions(request: Request) -> list[str]:
    """crescent_random1 to 3: the next of u. After the last one the count goes on, and the host reports it."""
    if not request.random:
        return []
    n = request.numbers
    if request.language == "wgsl":
        return [
            f"var<private> crescent_u: array<f32, {n}>; var<private> crescent_taken: u32;",
            "fn crescent_random1() -> f32 { let k = crescent_taken; crescent_taken = k + 1u; "
            f"return crescent_u[min(k, {n - 1}u)]; }}",
            "fn crescent_random2() -> vec2<f32> { let a = crescent_random1(); return vec2(a, crescent_random1()); }",
            "fn crescent_random3() -> vec3<f32> { let a = crescent_random2(); return vec3(a, crescent_random1()); }",
        ]
    static = "" if request.language == "glsl" else "static "
    two, three = NOTATIONS[request.language].vector(2, "float"), NOTATIONS[request.language].vector(3, "float")
    return [
        f"{static}float crescent_u[{n}]; {static}uint crescent_taken;",
        f"float crescent_random1() {{ uint k = crescent_taken; crescent_taken = k + 1u; "
        f"return crescent_u[min(k, {n - 1}u)]; }}",
        f"{two} crescent_random2() {{ float a = crescent_random1(); return {two}(a, crescent_random1()); }}",
        f"{three} crescent_random3() {{ {two} a = crescent_random2(); return {three}(a, crescent_random1()); }}",
    ]


def _opening(request: Request) -> list[str]:
    """The buffers and the head of an entry."""
    if request.language == "wgsl":
        return [
            f"@group({SET}) @binding({IN}) var<storage, read> crescent_in: array<f32>;",
            f"@group({SET}) @binding({OUT}) var<storage, read_write> crescent_out: array<f32>;",
            f"@compute @workgroup_size({ROWS_IN_GROUP}) "
            "fn crescent_main(@builtin(global_invocation_id) crescent_id: vec3<u32>) {",
        ]
    if request.language == "glsl":
        return [
            f"layout(local_size_x = {ROWS_IN_GROUP}) in;",
            f"layout(std430, set = {SET}, binding = {IN}) readonly buffer crescent_In {{ float crescent_in[]; }};",
            f"layout(std430, set = {SET}, binding = {OUT}) buffer crescent_Out {{ float crescent_out[]; }};",
            "void main() {",
        ]
    vk = request.language == "slang"
    return [
        ("[[vk::binding(0, 3)]] " if vk else "")
        + "StructuredBuffer<float> crescent_in"
        + ("" if vk else f" : register(t{IN}, space{SET})")
        + ";",
        ("[[vk::binding(1, 3)]] " if vk else "")
        + "RWStructuredBuffer<float> crescent_out"
        + ("" if vk else f" : register(u{OUT}, space{SET})")
        + ";",
        ('[shader("compute")] ' if vk else "") + f"[numthreads({ROWS_IN_GROUP}, 1, 1)]",
        "void crescent_main(uint3 crescent_id : SV_DispatchThreadID) {",
    ]


def program(request: Request, operation: str, channels: int, weights: int) -> Program:
    """The text of one operation, with f and weight in so many channels."""
    first, users = _users_lines(request)
    lines: list[Line] = []
    if request.language == "glsl":
        lines += [Line("#version 460")]
        extensions = ["GL_GOOGLE_cpp_style_line_directive", "GL_GOOGLE_include_directive"]
        lines += [Line(f"#extension {name} : require") for name in extensions]
    lines += first
    if request.language != "wgsl":
        lines += [Line(f"#define {name} {value}") for name, value in request.define]
    lines += [Line(text) for text in _random_functions(request)]
    if request.language == "glsl":  # a file may have a main of its own, which is then not called
        lines += [Line("#define main crescent_users_main")]
    lines += users
    if request.language == "glsl":
        lines += [Line("#undef main")]
    if operation == "f" and request.language in ("hlsl", "slang"):
        kinds = [("float", 1), ("float3", 3), ("float4", 3)]
        lines += [Line(f"float crescent_channels({kind} v) {{ return {count}.0; }}") for kind, count in kinds]
    lines += [Line(text) for text in _opening(request)]
    lines += _body(request, operation, channels, weights)
    lines += [Line("}")]
    return Program(operation, *columns(request, operation, weights), tuple(lines))
