"""What a user says about a shader: the words of the command line and the comments ``// crescent: KEY = VALUE`` of the
file, in one form. A word of the command line replaces the comment of the same key."""

from __future__ import annotations

import argparse
import difflib
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NoReturn

from . import BadInput

LANGUAGES = {  # by the suffix of a file
    ".wgsl": "wgsl",
    ".glsl": "glsl",
    ".frag": "glsl",
    ".comp": "glsl",
    ".rgen": "glsl",
    ".rchit": "glsl",
    ".hlsl": "hlsl",
    ".hlsli": "hlsl",
    ".slang": "slang",
}
CONTEXT = {"s": 1, "alpha": 1, "rho_d": 3, "rho_s": 1, "side": 1, "eta": 1}  # columns of each name of `uses`
_COORDINATES = {"hemisphere": 3, "sphere": 3, "disk": 2, "square": 2, "cube": 3, "triangle": 2, "line": 1, "set": 1}
LARGEST_FILE = 16 << 20  # bytes; a limit on the memory of a compiler, far above any source text


@dataclass(frozen=True)
class Constant:
    """A value of ``--set``; the form of its text gives the type."""

    name: str
    kind: str  # "float", "int" or "bool"
    values: tuple[str, ...]  # one, or two to four of a vector


@dataclass(frozen=True)
class Request:
    """A shader and what is pasted around its functions."""

    path: Path
    language: str
    text: str  # of the file
    sample: str
    pdf: str = ""
    f: str = ""
    f_has_cosine: bool = False
    constants: tuple[Constant, ...] = ()
    let: tuple[str, ...] = ()
    numbers: int = 2
    include: tuple[Path, ...] = ()
    define: tuple[tuple[str, str], ...] = ()
    prelude: tuple[Path, ...] = ()
    random: tuple[str, ...] = ()  # names of functions that return random numbers
    up: str = "z"
    frame: str = "local"
    domain: str = "hemisphere"
    sides: str = "upper"
    channels: int = 0  # 0: by the type of f
    eta: str = ""
    uses: tuple[str, ...] = ()
    reciprocal: bool = True
    transport: str = "radiance"
    name: str = ""
    device: str = ""
    #: the lines of the file from which a snippet comes, by option; a snippet of the command line has none
    places: tuple[tuple[str, tuple[int, ...]], ...] = ()

    @property
    def coordinates(self) -> int:
        """Numbers of a point of the domain; 0: it is of directions."""
        if self.domain in ("hemisphere", "sphere"):
            return 0
        return sum(_COORDINATES[part.partition(":")[0].strip()] for part in self.domain.split(" x "))

    @property
    def has_wo(self) -> bool:
        """Whether rows begin with w_o; those of directions always do."""
        return self.coordinates == 0 or self.sides != "none"

    @property
    def is_set(self) -> bool:
        """Whether a point is the number of an entry."""
        return self.domain.startswith("set:") and self.coordinates == 1


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        raise BadInput(message)


def _parser() -> argparse.ArgumentParser:
    out = _Parser(prog="crescent-shader", description=__doc__, allow_abbrev=False)
    out.add_argument("file", nargs="?", help="a shader: " + ", ".join(LANGUAGES))
    out.add_argument("--sample", help="statements that assign wi, and pdf or weight if they know it")
    out.add_argument("--pdf", help="an expression of wo and wi, or statements that assign pdf")
    out.add_argument("--f", help="f without the cosine, one number or three")
    out.add_argument("--f-cos", help="f with the cosine")
    out.add_argument("--set", action="append", metavar="NAME=VALUE", help="a constant: 0.3, 3, true or 1,2,3")
    out.add_argument("--let", action="append", metavar="STATEMENT", help="declarations before the snippets")
    out.add_argument("--numbers", type=int, help="random numbers of a sample, 1 to 8, default 2")
    out.add_argument("-I", dest="include", action="append", metavar="DIR", help="a folder of included files")
    out.add_argument("-D", dest="define", action="append", metavar="NAME[=VALUE]", help="a macro")
    out.add_argument("--prelude", action="append", metavar="FILE", help="text before the file: what it expects")
    out.add_argument("--random", action="append", metavar="FUNCTION", help="its calls return the next numbers of u")
    out.add_argument("--up", choices=("x", "y", "z"), help="the axis of the normal, default z")
    out.add_argument("--frame", choices=("local", "world"), help="world: about a normal n with tangents t and b")
    out.add_argument(
        "--domain", help="where wi may be, hemisphere (default) or sphere; or that of x: disk, line:0,1, ..."
    )
    out.add_argument("--sides", choices=("upper", "both", "none"), help="which wo it accepts, default upper")
    out.add_argument("--channels", type=int, choices=(1, 3), help="of f and weight; default: by the type of f")
    out.add_argument("--eta", help="index below over above, one number or three")
    out.add_argument("--uses", help="names of the surface point: " + ", ".join(CONTEXT))
    out.add_argument("--no-reciprocal", action="store_const", const="no", help="f is known not to be reciprocal")
    out.add_argument("--transport", choices=("radiance", "importance"), help="how f scales with eta²")
    out.add_argument("--name", help="in reports, default the name of the file")
    out.add_argument("--device", help="a part of an adapter's name; list: print the adapters")
    return out


_LISTS = ("set", "let", "include", "define", "prelude", "random")
_SNIPPETS = ("sample", "pdf", "f", "f-cos", "let")
_KEYS = [action.dest.replace("_", "-") for action in _parser()._actions if action.dest not in ("help", "file")]
_COMMENT = re.compile(r"^\s*//\s*crescent:(.*)$")


def _comments(path: Path, text: str) -> tuple[dict[str, list[str]], dict[str, list[int]]]:
    """The keys of the comments, each with its values in order and their lines."""
    found: dict[str, list[str]] = {}
    lines: dict[str, list[int]] = {}
    for number, line in enumerate(text.splitlines(), 1):
        if not (match := _COMMENT.match(line)):
            continue
        key, equals, value = (part.strip() for part in match[1].partition("="))
        if not equals or not value:
            raise BadInput(f"{path}:{number}: expected '// crescent: KEY = VALUE', got '{line.strip()}'")
        if key not in _KEYS:
            near = difflib.get_close_matches(key, _KEYS, 1)
            hint = f"; did you mean '{near[0]}'?" if near else ""
            raise BadInput(f"{path}:{number}: no key '{key}': expected one of {', '.join(_KEYS)}{hint}")
        if key in ("include", "prelude"):  # relative to the file that says it
            value = str(path.parent / value)
        if key in _SNIPPETS:  # at its own column, for the compiler's messages
            value = " " * line.index(value, line.index("=")) + value
        found.setdefault(key, []).append(value)
        lines.setdefault(key, []).append(number)
        if len(found[key]) > 1 and key not in _LISTS and key not in ("sample",):
            raise BadInput(f"{path}:{number}: the key '{key}' is given twice")
    return found, lines


def _as_words(comments: dict[str, list[str]]) -> list[str]:
    """The comments as words of the command line; several lines of `sample` are one text."""
    out = []
    for key, values in comments.items():
        option = {"include": "-I", "define": "-D"}.get(key, "--" + key)
        out += [
            f"{option}={value}" if option.startswith("--") else option + value
            for value in (["\n".join(values)] if key == "sample" else values)
        ]
    return out


_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?$")
_NAME = re.compile(r"[A-Za-z_]\w*$")


def constant(word: str) -> Constant:
    """NAME=VALUE: an int of digits alone, a float with a point or an exponent, true or false, or a vector of them."""
    name, _, text = word.partition("=")
    name, parts = name.strip(), tuple(part.strip() for part in text.split(","))
    expected = f"--set {word}: expected NAME=VALUE with 0.3 (float), 3 (int), true (bool), or 2 to 4 of them: 1,2,3"
    if not _NAME.match(name) or not 1 <= len(parts) <= 4:
        raise BadInput(expected)
    if all(part in ("true", "false") for part in parts):
        return Constant(name, "bool", parts)
    if not all(_NUMBER.match(part) for part in parts):
        raise BadInput(expected)
    whole = all(re.fullmatch(r"[-+]?\d+", part) for part in parts)
    if whole and len(parts) == 1:
        return Constant(name, "int", (str(int(parts[0])),))
    return Constant(name, "float", tuple(repr(float(part)) for part in parts))


def _read(path: Path, what: str) -> str:
    try:
        if path.exists() and not path.is_file():
            raise BadInput(f"{path}: expected a regular file")
        size = path.stat().st_size
        if size > LARGEST_FILE:
            raise BadInput(f"{path}: has {size} bytes: expected at most {LARGEST_FILE}")
        return path.read_text("utf-8-sig")
    except UnicodeDecodeError:
        raise BadInput(f"{path}: expected UTF-8 text") from None
    except OSError as error:
        raise BadInput(f"{what}{path}: {(error.strerror or 'cannot be read').lower()}") from None


def language_of(path: Path) -> str:
    """By the suffix."""
    if path.suffix not in LANGUAGES:
        raise BadInput(f"{path}: expected a shader, by its suffix one of {', '.join(LANGUAGES)}")
    return LANGUAGES[path.suffix]


def _macro(word: str) -> tuple[str, str]:
    name, _, value = word.partition("=")
    if not _NAME.match(name):
        raise BadInput(f"-D {word}: expected NAME or NAME=VALUE")
    return name, value or "1"


def _random_name(word: str) -> str:
    """`rand(seed)` and `rand` name the same function."""
    name = word.partition("(")[0].strip()
    if not _NAME.match(name):
        raise BadInput(f"--random {word}: expected the name of a function, or a call of it")
    return name


def _checked(request: Request) -> Request:
    """What several options decide together."""
    if request.coordinates > 4:
        raise BadInput(
            f"--domain {request.domain}: has {request.coordinates} coordinates: expected at most 4 of a shader"
        )
    if request.coordinates and (request.frame, request.up) != ("local", "z"):
        raise BadInput(f"--domain {request.domain}: --frame and --up are for directions")
    if request.f_has_cosine and request.coordinates:
        raise BadInput(f"--domain {request.domain}: --f-cos is for directions: expected --f")
    return request


def wants_list(words: Sequence[str]) -> bool:
    """Whether the adapters are asked for."""
    return bool(_parser().parse_args(list(words)).device == "list")


def read_request(words: Sequence[str]) -> Request:
    """Reads the command line and the file; raises BadInput."""
    given = _parser().parse_args(list(words))
    if not given.file:
        raise BadInput("expected a shader: FILE.wgsl, FILE.glsl, FILE.hlsl or FILE.slang")
    path = Path(given.file)
    language, text = language_of(path), _read(path, "")
    comments, lines = _comments(path, text)
    for key in list(comments):  # what the command line says of a key replaces the file's; constants by name
        said = getattr(given, key.replace("-", "_"))
        if said is None:
            continue
        if key == "set":
            names = {word.partition("=")[0].strip() for word in said}
            comments[key] = [word for word in comments[key] if word.partition("=")[0].strip() not in names]
        else:
            del comments[key]
    if given.f is not None:
        comments.pop("f-cos", None)
    if given.f_cos is not None:
        comments.pop("f", None)
    places = tuple(("--" + key, tuple(lines[key])) for key in comments if key in _SNIPPETS)
    try:
        merged = _parser().parse_args(_as_words(comments))
    except BadInput as error:
        raise BadInput(f"{path}: {error}") from None
    for key in vars(merged):
        said = getattr(given, key)
        if key in _LISTS:
            setattr(merged, key, (getattr(merged, key) or []) + (said or []))
        elif said is not None:
            setattr(merged, key, said)
    if not merged.sample or not merged.sample.strip():
        raise BadInput(f"{path}: expected --sample 'STATEMENTS' that assign wi, or a line '// crescent: sample = ...'")
    if merged.f and merged.f_cos:
        raise BadInput("--f-cos: f is given without the cosine by --f already")
    numbers = 2 if merged.numbers is None else merged.numbers
    if not 1 <= numbers <= 8:
        raise BadInput(f"--numbers {numbers}: expected 1 to 8")
    uses = tuple(word.strip() for word in merged.uses.split(",")) if merged.uses else ()
    for word in uses:
        if word not in CONTEXT:
            raise BadInput(f"--uses {merged.uses}: expected names from {', '.join(CONTEXT)}, not '{word}'")
    constants = tuple(constant(word) for word in merged.set)
    for at, one in enumerate(constants):
        if one.name in uses or any(other.name == one.name for other in constants[:at]):
            raise BadInput(f"--set {one.name}: the name is given twice")
    for part in (merged.domain or "sphere").split(" x "):
        if part.partition(":")[0].strip() not in _COORDINATES:
            raise BadInput(
                f"--domain {merged.domain}: expected one of {', '.join(_COORDINATES)}, or a product with ' x '"
            )
    for folder in merged.include:
        if not Path(folder).is_dir():
            raise BadInput(f"-I {folder}: expected a folder")
    request = Request(
        path=path,
        language=language,
        text=text,
        sample=merged.sample,
        pdf=merged.pdf or "",
        f=merged.f or merged.f_cos or "",
        f_has_cosine=bool(merged.f_cos),
        constants=constants,
        let=tuple(merged.let),
        numbers=numbers,
        include=tuple(Path(folder) for folder in merged.include),
        define=tuple(_macro(word) for word in merged.define),
        prelude=tuple(Path(file) for file in merged.prelude),
        random=tuple(_random_name(word) for word in merged.random),
        up=merged.up or "z",
        frame=merged.frame or "local",
        domain=merged.domain or "hemisphere",
        sides=merged.sides or ("upper" if merged.domain in (None, "hemisphere", "sphere") else "none"),
        channels=merged.channels or 0,
        eta=merged.eta or "",
        uses=uses,
        reciprocal=not merged.no_reciprocal,
        transport=merged.transport or "radiance",
        name=merged.name or path.stem,
        device=merged.device or "",
        places=places,
    )
    return _checked(request)


def read_preludes(request: Request) -> list[tuple[str, str]]:
    """Each file of --prelude with its text."""
    return [(str(path), _read(path, "--prelude ")) for path in request.prelude]
