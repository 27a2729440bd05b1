#!/usr/bin/env python3
"""Time and memory of `crescent compare` on many large synthetic renders: 64 of 3840 x 2160, half floats.

    python3 bench/compare_memory.py --crescent build/crescent [--renders 64] [--zip] [--write docs/compare.md]

The renders are written into a temporary folder and deleted afterwards. The time is compared with that of reading the
same files and doing nothing with them. With --write the table goes between the two lines of the page that say "measured
by compare_memory.py" and "end of compare_memory.py". Needs NumPy.
"""
import argparse
import os
import struct
import subprocess
import tempfile
import time
import zlib

import numpy as np

from measured_part import print_measured

WIDTH, HEIGHT, LINES = 3840, 2160, 16


def attribute(name, kind, value):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value


def header(compressed):
    """Returns the header of a scanline file with channels B, G, R of half floats (OpenEXR file layout)."""
    channels = b"".join(c + b"\0" + struct.pack("<iBBBBii", 1, 0, 0, 0, 0, 1, 1) for c in (b"B", b"G", b"R")) + b"\0"
    window = struct.pack("<4i", 0, 0, WIDTH - 1, HEIGHT - 1)
    return (b"\x76\x2f\x31\x01\x02\0\0\0" + attribute("channels", "chlist", channels)
            + attribute("compression", "compression", b"\3" if compressed else b"\0")
            + attribute("dataWindow", "box2i", window) + attribute("displayWindow", "box2i", window)
            + attribute("lineOrder", "lineOrder", b"\0") + attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
            + attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
            + attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0")


def packed(raw):
    """ZIP: even bytes, then odd ones, each the difference from the one before, deflated."""
    data = np.frombuffer(raw, np.uint8)
    data = np.concatenate([data[0::2], data[1::2]])
    out = data.copy()
    out[1:] = data[1:] - data[:-1] + np.uint8(128)
    small = zlib.compress(out.tobytes(), 1)
    return small if len(small) < len(raw) else raw


def write(path, planes, compressed):
    """planes: HEIGHT x 3 x WIDTH half floats, a row's B, G, R one after another, in the order of the file."""
    step = LINES if compressed else 1
    blocks = []
    for y in range(0, HEIGHT, step):
        raw = planes[y:y + step].tobytes()
        blocks.append((y, packed(raw) if compressed else raw))
    head = header(compressed)
    at = len(head) + 8 * len(blocks)
    offsets = []
    for _, block in blocks:
        offsets.append(at)
        at += 8 + len(block)
    with open(path, "wb") as file:
        file.write(head + struct.pack(f"<{len(offsets)}Q", *offsets))
        for y, block in blocks:
            file.write(struct.pack("<ii", y, len(block)) + block)


def render(noise, size, seed):
    """Returns 1 + size * noise, with the noise rotated by the seed."""
    turned = np.roll(noise, (seed * 977 % HEIGHT, seed * 3301 % WIDTH), axis=(0, 2))
    return (1 + size * turned).astype(np.float16)


def read_alone(folder):
    start = time.monotonic()
    for name in sorted(os.listdir(folder)):
        with open(f"{folder}/{name}", "rb", buffering=0) as file:
            while file.read(1 << 24):
                pass
    return time.monotonic() - start


def row(args, folder, out, more, words):
    """Runs one call and returns a line of the table."""
    command = [args.crescent, "compare", "--arm", f"a={folder}/a*.exr", "--arm", f"b={folder}/b*.exr", "--out", out]
    start = time.monotonic()
    with subprocess.Popen(command + more + ["--quiet"], stdout=subprocess.DEVNULL) as process:
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise SystemExit(f"{' '.join(command)}: exit {process.returncode}")
    return (f"| {words} | {time.monotonic() - start:.0f} s | {used.ru_utime + used.ru_stime:.0f} s | "
            f"{used.ru_maxrss / 1e6:.2f} GB |")


def measured(args, folder, out):
    read = read_alone(folder)
    total = sum(os.path.getsize(f"{folder}/{name}") for name in os.listdir(folder))
    reference = f"{out}-reference.exr"
    write(reference, np.ones((HEIGHT, 3, WIDTH), np.float16), args.zip)
    plain = f"{out}.toml"
    with open(plain, "w", encoding="utf-8") as file:
        file.write("flip = false\n")
    referred = ["--reference", reference]
    return "\n".join([
        f"{os.cpu_count()} processors; {args.renders} renders of {WIDTH} x {HEIGHT}, half, "
        f"{'ZIP' if args.zip else 'uncompressed'}, {total / 1e9:.1f} GB; "
        f"reading them once from the cache takes {read:.1f} s:", "",
        "| call | time | processor time | peak memory |", "|---|---|---|---|",
        row(args, folder, out, [], "two arms"),
        row(args, folder, out, [plain] + referred, "with a reference, `flip = false`"),
        row(args, folder, out, referred, "with a reference and FLIP of the first render of each arm")])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--crescent", default="crescent")
    parser.add_argument("--renders", type=int, default=64)
    parser.add_argument("--zip", action="store_true")
    parser.add_argument("--write", metavar="FILE")
    args = parser.parse_args()
    noise = np.random.default_rng(1).standard_normal((HEIGHT, 3, WIDTH), np.float32)
    with tempfile.TemporaryDirectory() as work:
        os.mkdir(f"{work}/renders")
        for k in range(args.renders):
            write(f"{work}/renders/{'ab'[k % 2]}{k:02}.exr", render(noise, (0.2, 0.1)[k % 2], k + 1), args.zip)
        text = measured(args, f"{work}/renders", f"{work}/out")
    print_measured(text, args.write, "compare_memory.py")


if __name__ == "__main__":
    main()
