"""Plants a bias of 1 % in the albedo of one wall of Mitsuba's Cornell box, and tests whether `crescent compare` detects
it: the false-alarm rate and the power of `--expect same`, measured on renders.

    pip install mitsuba
    python plant.py OUT [--crescent crescent] [--repeats 100] [--write docs/compare.md]

Each repeat renders three sets of seeds: two of the unchanged scene, one with the bias. `crescent compare --expect same`
must exit with code 0 for the two equal sets, and with 1 for the third and the first. With --write, the measured rates
are put between the two lines of the file that say "measured by plant.py" and "end of plant.py".
"""
import argparse
import os
import re
import shutil
import subprocess

import mitsuba as mi

from render import INTEGRATORS, scene

WALL = (52, 6, 61, 57)  # of 64 x 64 pixels, origin bottom-left: the green wall


def render_set(world, out, seeds, spp):
    os.makedirs(out, exist_ok=True)
    for seed in seeds:
        mi.Bitmap(mi.render(world, spp=spp, seed=seed)).write(f"{out}/{seed:06}.exr")


def same(args, a, b, where):
    """Returns the exit code of `crescent compare --expect same` on two folders."""
    box = ",".join(str(x * args.size // 64) for x in WALL)
    command = [args.crescent, "compare", "--arm", f"a={a}/*.exr", "--arm", f"b={b}/*.exr", "--region", f"wall={box}",
               "--expect", "same", "--alpha", str(args.alpha), "--smallest", "1%", "--out", where, "--quiet"]
    return subprocess.run(command, stdout=subprocess.DEVNULL, check=False).returncode


def rate(hits, of):
    """Returns a rate and its 95 % interval, Wilson 1927."""
    z, p = 1.96, hits / of
    middle = (p + z * z / (2 * of)) / (1 + z * z / of)
    half = z / (1 + z * z / of) * (p * (1 - p) / of + z * z / (4 * of * of)) ** 0.5
    return f"{hits} of {of} (95 %: {max(0, middle - half):.3f} to {min(1, middle + half):.3f})"


def measured(args, right, wrong):
    told = subprocess.run([args.crescent, "version"], capture_output=True, text=True, check=True)
    crescent = told.stdout.split(" (")[0]
    rows = [f"Mitsuba {mi.__version__}, {crescent}: {args.repeats} repeats with {args.seeds} seeds per set, "
            f"{args.size} x {args.size} pixels, {args.spp} samples, direct light, alpha {args.alpha}.", "",
            "| sets | exit 0: no difference | exit 1: difference | exit 4: undecided |", "|---|---|---|---|"]
    biased = f"green wall's albedo {100 * args.bias:g} % higher in one set"
    for name, codes in (("two sets of one scene", right), (biased, wrong)):
        rows.append(f"| {name} | " + " | ".join(rate(codes.count(code), len(codes)) for code in (0, 1, 4)) + " |")
    return "\n".join(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out")
    parser.add_argument("--crescent", default="crescent")
    parser.add_argument("--repeats", type=int, default=100)
    parser.add_argument("--seeds", type=int, default=8)
    parser.add_argument("--spp", type=int, default=256)
    parser.add_argument("--size", type=int, default=64)
    parser.add_argument("--bias", type=float, default=0.01)
    parser.add_argument("--alpha", type=float, default=0.05)
    parser.add_argument("--keep", action="store_true", help="keep the renders of every repeat")
    parser.add_argument("--write", metavar="FILE")
    args = parser.parse_args()
    as_it_is, biased = (scene(INTEGRATORS["both"], args.size, bias) for bias in (0, args.bias))
    right, wrong = [], []
    for repeat in range(args.repeats):
        folder = f"{args.out}/{repeat:03}"
        for k, (name, world) in enumerate((("a", as_it_is), ("b", as_it_is), ("c", biased))):
            first = (3 * repeat + k) * args.seeds
            render_set(world, f"{folder}/{name}", range(first, first + args.seeds), args.spp)
        right.append(same(args, f"{folder}/a", f"{folder}/b", f"{folder}/equal"))
        wrong.append(same(args, f"{folder}/a", f"{folder}/c", f"{folder}/biased"))
        if not args.keep:
            shutil.rmtree(folder)
    text = measured(args, right, wrong)
    print(text)
    if args.write:
        with open(args.write, encoding="utf-8") as file:
            page = file.read()
        lines = r"(<!-- measured by plant.py -->\n).*?(<!-- end of plant.py -->)"
        page, found = re.subn(lines, lambda m: m[1] + text + "\n" + m[2], page, flags=re.S)
        if not found:
            raise SystemExit(f"{args.write}: no lines 'measured by plant.py' and 'end of plant.py'")
        with open(args.write, "w", encoding="utf-8") as file:
            file.write(page)


if __name__ == "__main__":
    main()
