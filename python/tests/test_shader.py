"""Samplers in shaders: `crescent.shader`, and the text that is compiled. What evaluates needs wgpu and a driver."""

import json
import os
import pickle
import struct
import subprocess
import sys
import threading
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import crescent
from crescent_shader import BadInput, MissingPart
from crescent_shader.host import _serve
from crescent_shader.languages import mentions, program
from crescent_shader.request import constant, read_request

GGX = """// crescent: sample = wi = draw(wo, u, alpha)
// crescent: pdf = density(wi)
fn draw(wo: vec3<f32>, u: vec2<f32>, alpha: f32) -> vec3<f32> {
    let r = sqrt(u.x);
    return vec3<f32>(r * cos(6.2831853 * u.y), r * sin(6.2831853 * u.y), sqrt(1.0 - u.x));
}
fn density(wi: vec3<f32>) -> f32 { return wi.z / 3.14159265; }
"""


@pytest.fixture
def file(tmp_path: Path) -> str:
    path = tmp_path / "cosine.wgsl"
    path.write_text(GGX)
    return str(path)


def test_the_form_of_a_constant_gives_its_type() -> None:
    assert constant("alpha=0.3").kind == "float"
    assert constant("n=3").kind == "int"
    assert constant("k=1,2,3") == constant("k = 1.0, 2.0, 3.0")
    assert constant("on=true").kind == "bool"
    for word in ("alpha", "alpha=", "alpha=x", "1=2", "k=1,2,3,4,5"):
        with pytest.raises(BadInput, match="expected NAME=VALUE"):
            constant(word)


def test_the_command_line_replaces_comments_by_key(file: str) -> None:
    request = read_request([file, "--set=alpha=0.3"])
    assert request.sample.strip() == "wi = draw(wo, u, alpha)"
    assert read_request([file, "--sample=wi = wo"]).sample == "wi = wo"


def test_a_member_or_a_call_is_not_the_variable() -> None:
    assert mentions("wi = s.xyz; pdf = s.w", "pdf")
    assert mentions("wi = draw(wo, u, pdf)", "pdf")
    for text in ("weight = s.pdf", "p = pdf(wo, wi)", "pdfs = 1", "wi = wo // pdf"):
        assert not mentions(text, "pdf")


def test_every_line_of_the_file_keeps_its_number(file: str) -> None:
    request = read_request([file, "--set=alpha=0.3", "--random=draw"])
    lines = program(request, "sample", 1, 0).lines
    users = [line for line in lines if line.label == file and line.number == 4]
    assert [line.text.strip() for line in users] == ["let r = sqrt(u.x);"]


def test_an_extension_comes_first_and_keeps_its_number(tmp_path: Path) -> None:
    path = tmp_path / "own.glsl"
    path.write_text("// crescent: sample = wi = wo\n\n#extension GL_OWN : require\nfloat x;\n")
    text = program(read_request([str(path)]), "sample", 1, 0).with_places()
    assert f'#line 3 "{path}"\n#extension GL_OWN : require\n' in text
    assert text.index("GL_OWN") < text.index("float x;")


def made(file: str, **words: object) -> crescent.Sampler:
    try:
        return crescent.shader(file, **{"set": {"alpha": 0.3}, **words})  # type: ignore[arg-type]
    except MissingPart as error:
        pytest.skip(str(error))


def test_a_shader_is_a_sampler(file: str) -> None:
    s = made(file)
    wi, pdf = s.sample(np.array([[0.0, 0.0, 1.0]] * 3), np.array([[0.25, 0.5]] * 3))
    assert np.allclose(wi, [[-0.5, 0, 0.75**0.5]], atol=1e-6)
    assert np.allclose(pdf, 0.75**0.5 / np.pi, atol=1e-6)
    result = crescent.check(s, wo_deg=40)
    assert result.state == "right"
    (device,) = json.loads(result.json())["devices"]
    assert device["precision"] == "single" and device["name"] and device["driver"]
    assert crescent.check(made(file, pdf="density(wi) * 1.03"), wo_deg=40).state == "wrong"


def test_a_copy_of_it_starts_a_host_of_its_own(file: str) -> None:
    s = pickle.loads(pickle.dumps(made(file)))
    up = np.array([[0.0, 0.0, 1.0]])
    assert np.isclose(s.pdf(up, up)[0], 1 / np.pi)


def test_a_mistake_has_its_place(file: str) -> None:
    with pytest.raises(ValueError, match="^--sample:1:6: "):
        made(file, sample="wi = drew(wo, u, alpha)")


def served(file: str, sent: bytes, reads: bool) -> BaseException | None:
    """How the host of a shader ends that is sent these bytes by a client that reads its answers, or has gone."""
    shader = SimpleNamespace(
        request=read_request([file, "--set=alpha=0.3"]),
        operations={"pdf": lambda rows: np.ones((len(rows), 1))},
        channels=1,
        weights=0,
    )
    requests, answers = os.pipe(), os.pipe()
    ended: list[BaseException | None] = []

    def serve() -> None:
        host: Any = shader
        try:
            with os.fdopen(requests[0], "rb") as read, os.fdopen(answers[1], "wb", 0) as write:
                _serve(read, write, host, lambda seconds, what, call: call(), None)  # type: ignore[arg-type]
            ended.append(None)
        except (OSError, ValueError) as error:
            ended.append(error)

    if not reads:
        os.close(answers[0])
    thread = threading.Thread(target=serve, daemon=True)
    thread.start()
    with os.fdopen(requests[1], "wb") as write:
        write.write(sent)
    if reads:
        with os.fdopen(answers[0], "rb") as read:
            read.read()
    thread.join(30)
    assert ended, "the host waits for ever"
    return ended[0]


def test_memory_is_given_by_crescent_alone(file: str) -> None:
    words = [sys.executable, "-P", "-m", "crescent_shader", "--memory", "--set=alpha=0.3", file]
    done = subprocess.run(words, input="hello 2\n", capture_output=True, text=True, timeout=60)
    assert done.returncode == 2
    assert done.stdout.startswith("error --memory: descriptor 3 is no memory")
    assert "Traceback" not in done.stderr


def test_the_host_ends_with_its_client(file: str) -> None:
    block = b"pdf_" + struct.pack("<I", 2) + bytes(4 * 2 * 6)
    assert served(file, 3 * block, reads=True) is None
    assert isinstance(served(file, block[:-4], reads=True), ValueError)
    assert isinstance(served(file, 3 * block, reads=False), BrokenPipeError)
