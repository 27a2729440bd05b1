#!/usr/bin/env python3
"""Tests of other projects on the same samples: Mitsuba 3's chi-square and ArviZ's k-hat next to crescent's verdicts.

    python3 -m venv v && v/bin/pip install mitsuba numpy 'arviz<1'
    v/bin/python tests/calibration/peers/peers.py build/crescent

Each draw is made once, by the sampling function of Mitsuba's ChiSquareTest, and passed to `crescent check --samples`.
Densities in 1/sr, w_o = n. Prints a table in Markdown; the exit code is 0 if all agree, 1 if they do not, and 77
(skipped) if a module is missing."""
import json
import os
import subprocess
import sys
import tempfile
import warnings

warnings.filterwarnings("ignore")
try:
    import arviz
    import mitsuba as mi
    import numpy as np

    mi.set_variant("llvm_ad_rgb")
    from mitsuba.chi2 import ChiSquareTest, SphericalDomain
except ImportError as missing:
    print(f"skipped: {missing}; pip install mitsuba numpy 'arviz<1'")
    sys.exit(77)

N = 400_000
TAU = 2 * np.pi


def sphere(z, turns):
    r = np.sqrt(np.maximum(1 - z * z, 0))
    return np.stack([r * np.cos(TAU * turns), r * np.sin(TAU * turns), z], 1)


def cosine(w):
    return np.maximum(w[:, 2], 0) / np.pi


def power(s):
    return lambda w: (s + 1) / TAU * np.maximum(w[:, 2], 0) ** s


def draw_power(s):
    return lambda u: sphere(u[:, 0] ** (1 / (s + 1)), u[:, 1])


def even(w):
    return np.where(w[:, 2] >= 0, 1 / TAU, 0)


# name, u -> w, w -> p; "wrong" samplers do not draw from p
CASES = [
    ("cosine", lambda u: sphere(np.sqrt(1 - u[:, 0]), u[:, 1]), cosine),
    ("power s=8", draw_power(8), power(8)),
    ("power s=32", draw_power(32), power(32)),
    ("whole sphere", lambda u: sphere(1 - 2 * u[:, 0], u[:, 1]), lambda w: np.full(len(w), 1 / (2 * TAU))),
    ("hemisphere", lambda u: sphere(u[:, 0], u[:, 1]), even),
    ("wrong: sqrt forgotten", lambda u: sphere(u[:, 0], u[:, 1]), cosine),
    ("wrong: s=33 for s=32", draw_power(32), power(33)),
    ("wrong: s=8.1 for s=8", draw_power(8), power(8.1)),
    ("wrong: phi uneven by 6 %",
     lambda u: sphere(np.sqrt(1 - u[:, 0]), u[:, 1] + 0.01 * np.sin(TAU * u[:, 1])), cosine),
    ("wrong: phi over 358 deg", lambda u: sphere(np.sqrt(1 - u[:, 0]), u[:, 1] * 358 / 360), cosine),
]


def mitsuba_p(draw, p, kept):
    """p-value of Mitsuba's test before its correction for several tests; stores the draws in `kept`."""
    def sample(u):
        v = np.stack([np.array(u[0]), np.array(u[1])], 1).astype(np.float64)
        w = draw(v)
        if len(v) == N:
            kept["u"], kept["w"] = v, w
        return mi.Vector3f(*(mi.Float(np.ascontiguousarray(w[:, k], dtype=np.float32)) for k in range(3)))

    def density(w, *_):
        return mi.Float(p(np.stack([np.array(w[k]) for k in range(3)], 1).astype(np.float64)).astype(np.float32))

    test = ChiSquareTest(domain=SphericalDomain(), sample_func=sample, pdf_func=density, sample_dim=2,
                         sample_count=N, res=101, ires=8)
    test.run(significance_level=0.001, quiet=True)
    return float(test.p_value)


def crescent(program, folder, kept, p):
    f = np.full(N, 0.5 / np.pi)
    rows = np.column_stack([np.minimum(kept["u"], 1 - 2**-24), kept["w"], p(kept["w"]), f])
    np.save(f"{folder}/s.npy", rows)
    c, phi = np.meshgrid((np.arange(512) + 0.5) / 256 - 1, (np.arange(256) + 0.5) * TAU / 256, indexing="ij")
    w = sphere(c.ravel(), phi.ravel() / TAU)
    np.save(f"{folder}/t.npy", np.column_stack([c.ravel(), phi.ravel(), p(w)]))
    subprocess.run([program, "check", "--quiet", "--samples", f"{folder}/s.npy", "--pdf-table",
                    f"{folder}/t.npy", "--wo", "0,0,1", "--json", f"{folder}/j.json"],
                   stdout=subprocess.DEVNULL, check=False)
    with open(f"{folder}/j.json", encoding="utf-8") as file:
        return {v["name"]: v for v in json.load(file)["verdicts"]}


def arviz_k(kept, p, draws):
    """k-hat of the rows that crescent uses: the first `draws` odd rows. f is constant, below the surface too."""
    w = kept["w"][1::2][:draws]
    x = np.abs(w[:, 2]) / p(w)
    with np.errstate(divide="ignore"):
        return float(arviz.psislw(np.log(x))[1])


def shown(k):
    return "-" if k is None or np.isnan(k) else f"{k:.3f}"


def main():
    program = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else "build/crescent")
    agree = True
    print("| draws | Mitsuba's p | crescent's density | least p | ArviZ's k-hat | crescent's k-hat |")
    print("|---|---|---|---|---|---|")
    for name, draw, p in CASES:
        kept = {}
        theirs = mitsuba_p(draw, p, kept)
        with tempfile.TemporaryDirectory() as folder:
            ours = crescent(program, folder, kept, p)
        density, tail = ours["density"], ours["tail"]
        e, k = density["evidence"], tail["evidence"].get("k")
        k_theirs = float("nan") if k is None else arviz_k(kept, p, int(tail["evidence"]["draws"]))
        # If Mitsuba's test rejects, crescent's must too. Crescent may detect more, but only for wrong samplers.
        missed = theirs < 1e-6 and density["state"] != "wrong"
        false_positive = density["state"] == "wrong" and not name.startswith("wrong")
        alike = not missed and not false_positive
        alike = alike and (k is None or abs(k - k_theirs) <= 0.02)
        agree = agree and alike
        p_ours = min([*e.get("p", {}).values(), *(t["p_first"] for t in e.get("tests", {}).values())])
        print(f"| {name} | {theirs:.3g} | {density['state']} | {p_ours:.3g} | {shown(k_theirs)} | {shown(k)} |"
              f"{'' if alike else ' DIFFERS'}", flush=True)
    return 0 if agree else 1


sys.exit(main())
