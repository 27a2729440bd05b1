#!/usr/bin/env python3
"""The rate of a plugin arm: plugin.py CRESCENT [SAMPLES [ROUNDS [OTHER]]] runs examples/plugin/cosine.c as an arm of a
small scene and prints millions of samples per second of each round, and of processor time with all children. OTHER
is another build of the program, which alternates with the first."""

import json
import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def scene(samples: int) -> str:
    text = (ROOT / "tests/system/tiny.toml").read_text()
    head, _, arms = text.partition("[arms.uniform]")
    _, _, rest = arms.partition("[regions.ball]")
    region, _, _ = rest.partition("[plates")
    head = head.replace("width = 96", "width = 320").replace("height = 54", "height = 180")
    return f'{head}[arms.mine]\nplugin = "libcosine.so"\nn = [{samples}]\n[regions.ball]{region}'


def round_of(program: str, folder: str) -> str:
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([program, "run", "scene.toml", "--only", "metrics", "--quiet"], cwd=folder, check=True, stdout=-3)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    busy = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    arm = json.loads(Path(folder, "out/scene/timing.json").read_text())["arms"][0]
    return f"{arm['msamples_per_s']:.1f} M/s, {arm['samples'] / busy * 1e-6:.1f} M/s of processor time"


def main() -> None:
    programs = [os.path.abspath(p) for p in sys.argv[1:2] + sys.argv[4:5]]
    samples, rounds = (int(w) for w in (sys.argv[2:4] + ["1024", "5"][len(sys.argv[2:4]) :]))
    with tempfile.TemporaryDirectory() as folder:
        source = ROOT / "examples/plugin/cosine.c"
        cc = ["cc", "-O3", "-shared", "-fPIC", f"-I{ROOT}/src", source, "-o", f"{folder}/libcosine.so", "-lm"]
        subprocess.run(cc, check=True)
        Path(folder, "scene.toml").write_text(scene(samples))
        for _ in range(rounds):
            print(*(round_of(program, folder) for program in programs), sep=" | ", flush=True)


if __name__ == "__main__":
    main()
