"""Samplers of `tests/known_samplers/shaders` in each language: right ones with random parameters, and planted faults.

    python shaders.py right --crescent build/crescent --seed 71 --cases 0:300 --out right.jsonl
    python shaders.py table right.jsonl
    python shaders.py faults --crescent build/crescent [--each]

`faults` plants faults of `tests/known_samplers/faulty` and expects the cause that they have in C++; exit code 1 if one is
missed. With --each in every language, else in one of them each.

Alpha is log-uniform from 0.002 to 1, w_o uniform over the directions that the sampler accepts; with --whole they are those
of a quick check. Needs NumPy, SciPy, wgpu and a driver; GLSL and HLSL need glslangValidator, Slang needs slangc.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from fresh_pipe import Rng, log_uniform, print_table

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))

from crescent_shader import MissingPart  # noqa: E402
from crescent_shader.compilers import slangc  # noqa: E402


def has_slangc() -> bool:
    try:
        return bool(slangc())
    except MissingPart:
        return False


LOBES = ROOT / "tests" / "known_samplers" / "shaders"
LANGUAGES = ("wgsl", *(["glsl", "hlsl"] if shutil.which("glslangValidator") else []))
LANGUAGES += ("slang",) if has_slangc() else ()


@dataclass(frozen=True)
class Case:
    """Options of `crescent check` for a file of lobes."""

    options: dict[str, str]
    parameters: dict[str, float]

    def words(self) -> list[str]:
        constants = [word for name, value in self.parameters.items() for word in ("--set", f"{name}={value!r}")]
        return [word for pair in self.options.items() for word in pair] + constants


def alpha_of(rng: Rng) -> float:
    return log_uniform(rng, 0.002, 1)


def ggx(rng: Rng) -> Case:
    options = {"--sample": "wi = ggx_sample(wo, u, alpha)", "--pdf": "ggx_pdf(wo, wi, alpha)"}
    if rng.random() < 0.7:
        options["--f"] = "ggx_f(wo, wi, alpha)"
    return Case(options, {"alpha": alpha_of(rng)})


def mixture(rng: Rng) -> Case:
    options = {
        "--sample": "wi = mixture_sample(wo, u3, u, alpha)",
        "--pdf": "mixture_pdf(wo, wi, alpha)",
        "--f": "mixture_f(wo, wi, alpha)",
        "--numbers": "3",
    }
    return Case(options, {"alpha": alpha_of(rng)})


def glass(rng: Rng) -> Case:
    n = round(rng.uniform(1.1, 2.4), 4)
    options = {
        "--sample": "wi = glass_sample(wo, u3, u, alpha, n)",
        "--pdf": "glass_pdf(wo, wi, alpha, n)",
        "--f-cos": "glass_f_cos(wo, wi, alpha, n)",
        "--numbers": "3",
        "--domain": "sphere",
        "--sides": "both",
        "--eta": repr(n),
    }
    return Case(options, {"alpha": alpha_of(rng), "n": n})


def phong(rng: Rng) -> Case:
    """The exponent whose lobe is as narrow as that alpha."""
    options = {"--sample": "wi = phong_sample(wo, u, s)", "--pdf": "phong_pdf(wo, wi, s)"}
    alpha = alpha_of(rng)
    return Case(options, {"s": max(2 / alpha**2 - 2, 1.0)})


def henyey_greenstein(rng: Rng) -> Case:
    options = {
        "--sample": "wi = hg_sample(wo, u, g)",
        "--pdf": "hg(wo, wi, g)",
        "--f-cos": "hg(wo, wi, g)",
        "--domain": "sphere",
        "--sides": "both",
    }
    return Case(options, {"g": float(rng.uniform(0.05, 0.95) * rng.choice([-1, 1]))})


FAMILIES: dict[str, Callable[[Rng], Case]] = {  # three of five have an alpha; these come more often
    "GGX": ggx,
    "GGX and cosine": mixture,
    "rough glass": glass,
    "Phong": phong,
    "GGX again": ggx,
    "rough glass again": glass,
    "Henyey-Greenstein": henyey_greenstein,
}


@dataclass(frozen=True)
class Fault:
    """A planted fault of C++ by its name there, with the words of its cause; snippets that mean the same in each language."""

    name: str
    cause: str
    sample: str
    pdf: str
    f: str = ""
    parameters: tuple[str, ...] = ()

    def words(self) -> list[str]:
        out = ["--sample", f"wi = {self.sample}", "--pdf", self.pdf]
        if "glass" in self.sample:
            out += ["--f-cos", self.f, "--domain", "sphere", "--sides", "both", "--eta", "1.5", "--set", "n=1.5"]
        elif self.f:
            out += ["--f", self.f]
        if "u3" in self.sample:
            out += ["--numbers", "3"]
        return out + [word for parameter in self.parameters for word in ("--set", parameter)]


COSINE, PHONG = "cosine_sample(u)", "phong_sample(wo, u, s)"
GGX, GGX_PDF = "ggx_sample(wo, u, alpha)", "ggx_pdf(wo, wi, alpha)"
GLASS, GLASS_PDF = "glass_sample(wo, u3, u, alpha, n)", "glass_pdf(wo, wi, alpha, n)"
S, ALPHA = ("s=20",), ("alpha=0.4",)
FAULTS = (
    Fault("cosine folded in twice", "cos theta_i", COSINE, "cosine_pdf(wi) * wi.z"),
    Fault("cosine left out of the pdf", "cos theta_i", COSINE, "1.0 / PI"),
    Fault("swapped w_o and w_i in pdf(w)", "cos theta_i", COSINE, "cosine_pdf(wo)"),
    Fault("sqrt forgotten", "square root", "at_angle(sqrt(1.0 - u.x * u.x), 2.0 * PI * u.y)", "cosine_pdf(wi)"),
    Fault("one u used twice", "", "cosine_sample(u.xx)", "cosine_pdf(wi)"),
    Fault("s+2 for s+1 in the pdf", "a constant", PHONG, "phong_pdf(wo, wi, s) * (s + 2.0) / (s + 1.0)", "", S),
    Fault("exponent s+1 for s in the pdf", "w_i.R", PHONG, "phong_pdf(wo, wi, s + 1.0)", "", S),
    Fault("1/(s+2) for 1/(s+1) in the warp", "w_i.R", "phong_sample(wo, u, s + 1.0)", "phong_pdf(wo, wi, s)", "", S),
    Fault("missing 4(w.h)", "w_o.m", GGX, f"{GGX_PDF} * 4.0 * dot(wo, normalize(wo + wi))", "", ALPHA),
    Fault("n.h for w.h in the Jacobian", "(n.m) / (w_o.m)", GGX,
          f"{GGX_PDF} * dot(wo, normalize(wo + wi)) / normalize(wo + wi).z", "", ALPHA),
    Fault("missing G1 in the density of visible normals", "a constant", GGX, f"{GGX_PDF} / ggx_G1(wo, alpha)", "", ALPHA),
    Fault("lobe chosen by one weight, weighed by another", "chooser's probability",
          "mixture_sample(wo, u3, u, alpha)", f"0.5 * cosine_pdf(wi) + 0.5 * {GGX_PDF}", "", ALPHA),
    Fault("eta^2 left out of f", "eta^2", GLASS, GLASS_PDF, f"{GLASS_PDF} * ggx_G1(wi, alpha)", ALPHA),
)  # fmt: skip


def missed(number: int, language: str, crescent: str) -> str:
    """Why a fault is not found with its cause; "" if it is."""
    fault = FAULTS[number]
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.json"
        command = [crescent, "check", str(LOBES / f"lobes.{language}"), *fault.words(), "--quiet"]
        done = subprocess.run([*command, "--json", str(report)], capture_output=True, text=True, check=False)
        if not report.exists():
            return done.stdout + done.stderr
        verdicts = json.loads(report.read_text())["verdicts"]
    wrong = [v for v in verdicts if v["state"] == "wrong"]
    if wrong and (not fault.cause or any(fault.cause in json.dumps(v, ensure_ascii=False) for v in wrong)):
        return ""
    return f"expected the cause '{fault.cause}'\n{done.stdout}"


def direction(rng: Rng, both_sides: bool) -> str:
    z, phi = rng.random(), rng.uniform(0, 2 * np.pi)
    r = np.sqrt(1 - z * z)
    side = -1 if both_sides and rng.random() < 0.5 else 1
    return ",".join(repr(float(v)) for v in (r * np.cos(phi), r * np.sin(phi), side * z))


def check(number: int, seed: int, crescent: str, whole: bool) -> dict[str, Any]:
    name = list(FAMILIES)[number % len(FAMILIES)]
    language = LANGUAGES[number // len(FAMILIES) % len(LANGUAGES)]
    rng = np.random.default_rng([seed, number, zlib.crc32(name.encode())])
    case = FAMILIES[name](rng)
    words = case.words()
    if not whole:
        words += ["--wo", direction(rng, case.options.get("--sides") == "both")]
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.json"
        start = time.monotonic()
        command = [crescent, "check", str(LOBES / f"lobes.{language}"), *words, "--seed", str(seed * 100_000 + number)]
        command += ["--quiet", "--patience", "1200", "--timeout", "60", "--json", str(report)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        record = {
            "family": name.removesuffix(" again"),
            "language": language,
            "case": number,
            "seed": seed,
            "whole": whole,
            "words": words,
            "fault": "",
            "wall": round(time.monotonic() - start, 2),
        }
        if not report.exists():
            return {**record, "state": "error", "text": done.stdout + done.stderr}
        found = json.loads(report.read_text())
    failed = [v for v in found["verdicts"] if v["state"] not in ("right", "skipped")]
    return {
        **record,
        "state": found["state"],
        "failed": [{k: v.get(k) for k in ("case", "name", "state", "message", "cause")} for v in failed],
        "text": done.stdout if failed else "",
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("task", choices=["right", "table", "faults"])
    parser.add_argument("files", nargs="*", type=Path, help="of table")
    parser.add_argument("--crescent", default="crescent")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--cases", default="0:21", metavar="FROM:TO")
    parser.add_argument("--whole", action="store_true", help="all w_o of a quick check, not one")
    parser.add_argument("--each", action="store_true", help="of faults: in every language")
    parser.add_argument("--out", type=Path, help="file to which a line for each check is appended")
    given = parser.parse_args()
    os.environ.setdefault("CRESCENT_PYTHON", sys.executable)
    os.environ.setdefault("PYTHONPATH", str(ROOT / "python"))
    if given.task == "faults":
        failed = 0
        for number, fault in enumerate(FAULTS):
            for language in LANGUAGES if given.each else (LANGUAGES[number % len(LANGUAGES)],):
                why = missed(number, language, given.crescent)
                failed += bool(why)
                print(f"{fault.name}, {language}: {why or 'found'}", flush=True)
        sys.exit(failed > 0)
    records = [json.loads(line) for file in given.files for line in file.read_text().splitlines()]
    if given.task == "right":
        for number in range(*(int(v) for v in given.cases.split(":"))):
            records.append(check(number, given.seed, given.crescent, given.whole))
            if given.out:
                with given.out.open("a") as file:
                    file.write(json.dumps(records[-1]) + "\n")
    for key in ("family", "language"):
        print_table(records, key)


if __name__ == "__main__":
    main()
