# Prepares for plugins.md: crescent in ~/crescent, and samplers: a program, a library and a Python file next to an experiment.
cmake --install build --prefix ~/crescent >/dev/null
cc -O2 -shared -fPIC -I ~/crescent/include examples/plugin/cosine.c -o libmine.so -lm
cp examples/pipe_samplers/cosine.py theirs.py
cat >mine.py <<'PY'
import crescent
import numpy as np


def sample(wo, u):
    r, phi = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1]
    wi = np.column_stack((r * np.cos(phi), r * np.sin(phi), np.sqrt(1 - u[:, 0])))
    return wi, wi[:, 2] / np.pi


def pdf(wo, wi):
    return np.maximum(wi[:, 2], 0) / np.pi


sampler = crescent.Sampler(sample, pdf)
PY
