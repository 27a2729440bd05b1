#!/usr/bin/env python3
"""A sampler for `crescent check --exec 'python3 cosine.py'`: the cosine-weighted hemisphere and a Lambert BRDF of 0.5.

One request per line, one response per line, in order; n = +z; end of input ends it."""
import math
import os


def answer(words):
    verb, numbers = words[0], words[1:]
    if verb == "hello":
        return "hello 2 cosine.py"
    x = [float(w) for w in numbers]
    if verb == "sample":
        r, phi = math.sqrt(x[3]), 2 * math.pi * x[4]
        z = math.sqrt(1 - x[3])
        return f"{r * math.cos(phi)!r} {r * math.sin(phi)!r} {z!r} {z / math.pi!r}"
    if verb == "pdf":
        return repr(max(x[5], 0.0) / math.pi)
    if verb == "f":
        return repr(0.5 / math.pi if x[5] > 0 else 0.0)
    return "?"


rest = ""
while chunk := os.read(0, 1 << 16):  # many requests may be pending: respond to all of them with one write
    *lines, rest = (rest + chunk.decode()).split("\n")
    out = "".join(answer(line.split()) + "\n" for line in lines).encode()
    while out:
        out = out[os.write(1, out):]
