"""Sampling functions of a shader behind the block protocol of ``crescent check --exec``.

``python -m crescent_shader FILE.wgsl --sample '...' --pdf '...'`` compiles the file with three small entry points,
evaluates them on a device of WebGPU, and answers requests on stdin. It needs NumPy and wgpu; GLSL and HLSL need
glslangValidator, Slang needs slangc. The compiled part of crescent is not needed.
"""

GREETING_OF_PYTHON = b"hello 2 python"


class BadInput(ValueError):
    """The file, a snippet or an option cannot be used; the text begins with the place."""


class MissingPart(RuntimeError):
    """A program, package or driver is not installed; the text names its package."""
