#!/usr/bin/env python3
"""Time and memory of `crescent compare SUITE.toml`: views of 8 renders on each side, 1920 x 1080, float, ZIP.

    python3 bench/suite_speed.py --crescent build/crescent --read build/bench/crescent_read_exr [--views 10]
        [--write docs/suites.md]

The renders of the first view are written into a temporary folder; the other views are links to them. Time is compared
with that of OpenEXR alone (bench/read_exr.cpp) reading each file once, in turn, --repeats times. With --write the table
goes between the two lines of the page that say "measured by suite_speed.py" and "end of suite_speed.py". Needs NumPy.
"""
import argparse
import glob
import os
import statistics
import struct
import subprocess
import tempfile
import time
import zlib

import numpy as np

from measured_part import print_measured

WIDTH, HEIGHT, LINES, RENDERS = 1920, 1080, 16, 8


def attribute(name, kind, value):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value


def header():
    """Of a scanline file with channels B, G, R of floats and ZIP compression (OpenEXR file layout)."""
    channels = b"".join(c + b"\0" + struct.pack("<iBBBBii", 2, 0, 0, 0, 0, 1, 1) for c in (b"B", b"G", b"R")) + b"\0"
    window = struct.pack("<4i", 0, 0, WIDTH - 1, HEIGHT - 1)
    return (b"\x76\x2f\x31\x01\x02\0\0\0" + attribute("channels", "chlist", channels)
            + attribute("compression", "compression", b"\3") + attribute("dataWindow", "box2i", window)
            + attribute("displayWindow", "box2i", window) + attribute("lineOrder", "lineOrder", b"\0")
            + attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
            + attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
            + attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0")


def packed(raw):
    """ZIP: even bytes, then odd ones, each the difference from the one before, deflated."""
    data = np.frombuffer(raw, np.uint8)
    data = np.concatenate([data[0::2], data[1::2]])
    out = data.copy()
    out[1:] = data[1:] - data[:-1] + np.uint8(128)
    small = zlib.compress(out.tobytes(), 4)
    return small if len(small) < len(raw) else raw


def write(path, planes):
    """planes: HEIGHT x 3 x WIDTH floats, a row's B, G, R one after another, as the file has them."""
    blocks = [(y, packed(planes[y:y + LINES].tobytes())) for y in range(0, HEIGHT, LINES)]
    head = header()
    at = len(head) + 8 * len(blocks)
    offsets = []
    for _, block in blocks:
        offsets.append(at)
        at += 8 + len(block)
    with open(path, "wb") as file:
        file.write(head + struct.pack(f"<{len(offsets)}Q", *offsets))
        for y, block in blocks:
            file.write(struct.pack("<ii", y, len(block)) + block)


def write_views(work, views):
    rng = np.random.default_rng(1)
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    mean = (0.2 + 0.8 * np.sin(x / 200) ** 2 * np.cos(y / 150) ** 2).astype(np.float32)[:, None, :]
    for side in ("baseline", "out"):
        os.mkdir(f"{work}/{side}")
        for k in range(RENDERS):
            path = f"{work}/{side}/view0-{k}.exr"
            write(path, mean * rng.gamma(4, 0.25, (HEIGHT, 3, WIDTH)).astype(np.float32))
            for v in range(1, views):
                os.link(path, f"{work}/{side}/view{v}-{k}.exr")
    with open(f"{work}/suite.toml", "w", encoding="utf-8") as file:
        file.write('[suite]\nbaseline = "baseline/{view}-*.exr"\ncandidate = "out/{view}-*.exr"\n')


def measured(command):
    """Seconds, processor seconds and peak memory in bytes of a program."""
    start = time.monotonic()
    with subprocess.Popen(command, stdout=subprocess.DEVNULL) as process:
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise SystemExit(f"{' '.join(command[:3])}: exit {process.returncode}")
    return time.monotonic() - start, used.ru_utime + used.ru_stime, used.ru_maxrss * 1024


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--crescent", default="crescent")
    parser.add_argument("--read", default="crescent_read_exr")
    parser.add_argument("--views", type=int, default=10)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--write", metavar="FILE")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as work:
        write_views(work, args.views)
        files = sorted(glob.glob(f"{work}/*/*.exr"))
        calls = {"OpenEXR alone": [args.read, *files],
                 "crescent compare": [args.crescent, "compare", f"{work}/suite.toml", "--out", f"{work}/report",
                                      "--quiet"]}
        runs = {name: [] for name in calls}
        measured(calls["OpenEXR alone"])  # fills the cache
        for _ in range(args.repeats):
            for name, command in calls.items():
                runs[name].append(measured(command))
        median = {name: [statistics.median(v) for v in zip(*of)] for name, of in runs.items()}
        alone, ours = median["OpenEXR alone"], median["crescent compare"]
        text = "\n".join([
            f"{os.cpu_count()} processors; {args.views} views, {len(files)} renders of {WIDTH} x {HEIGHT}, float, ZIP, "
            f"{sum(os.path.getsize(f) for f in files) / 1e9:.1f} GB in the cache; median of {args.repeats} runs in turn:",
            "", "| program | time | processor time | peak memory |", "|---|---|---|---|",
            *(f"| {name} | {m[0]:.1f} s | {m[1]:.1f} s | {m[2] / 1e9:.2f} GB |" for name, m in median.items()), "",
            f"`crescent compare` reaches {alone[1] / ours[1]:.2f} of the rate of OpenEXR alone in processor time and "
            f"{alone[0] / ours[0]:.2f} in time."])
    print_measured(text, args.write, "suite_speed.py")


if __name__ == "__main__":
    main()
