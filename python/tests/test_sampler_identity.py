"""The identity of a sampler changes with whatever it computes from, wherever that is, and is stable else."""

import abc
import collections
import dataclasses
import enum
import functools
import importlib
import importlib.metadata
import sys
import threading
import types

import numpy as np
import pytest
from tiny import TINY

import crescent

pytest.importorskip("cloudpickle")

from crescent._sweep.identity import arms_of, python_sources, unhashable_of  # noqa: E402
from crescent._sweep.state import library, state_of, versions_of  # noqa: E402


def cosine(wo, u):
    r, phi, z = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1], np.sqrt(1 - u[:, 0])
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], -1), z / np.pi


def scaling(factor):
    """A function that is found by its name, as pickle stores it, with a constant in its code."""
    names = {"cosine": cosine, "__name__": __name__}
    exec(f"def scaled(wo, u):\n    wi, pdf = cosine(wo, u)\n    return wi, {factor} * pdf", names)
    globals()["scaled"] = names["scaled"]
    return names["scaled"]


class Kind(enum.Enum):
    ONE = 1.0
    OTHER = 1.5


@dataclasses.dataclass
class Data:
    factor: float
    parts: list = dataclasses.field(default_factory=list)

    def sample(self, wo, u):
        return cosine(wo, self.factor * u)


class Abstract(abc.ABC):
    @abc.abstractmethod
    def sample(self, wo, u): ...


class Concrete(Abstract):
    def __init__(self, factor):
        self.factor = factor

    def sample(self, wo, u):
        return cosine(wo, self.factor * u)


class Private:
    __slots__ = ("__factor",)

    def __init__(self, factor):
        self.__factor = factor

    def sample(self, wo, u):
        return cosine(wo, self.__factor * u)


class Wrapping:
    def __init__(self, call, factor):
        functools.update_wrapper(self, call)
        self.factor = factor

    def __call__(self, wo, u):
        return self.__wrapped__(wo, self.factor * u)


def calling(inside, at=lambda found: found):
    """A sampler that reaches another one through an object."""
    return lambda wo, u: at(inside)(wo, u)


def mapping(factor):
    kind = type("Mapping", (dict,), {"__missing__": lambda self, key: factor})
    values = kind()
    return lambda wo, u: cosine(wo, values["factor"] * u)


def masked(factor):
    array = np.ma.array([1.0, 2.0], mask=[factor > 1, False])
    return lambda wo, u: cosine(wo, array.sum() * u)


MAKERS = {
    "sample of an adapter": lambda f: crescent.adapters.numpy(scaling(f), lambda wo, wi: wi[:, 2]),
    "eval of an adapter": lambda f: crescent.adapters.numpy(cosine, lambda wo, wi: f * wi[:, 2]),
    "pdf of an adapter": lambda f: crescent.adapters.numpy(cosine, pdf=lambda wo, wi: f * wi[:, 2]),
    "radiance": lambda f: crescent.Sampler(lambda u: cosine(u, u), radiance=lambda wi: f * wi[:, 2]),
    "device": lambda f: crescent.Sampler(cosine, device="cpu" if f == 1 else "cuda"),
    "np.vectorize": lambda f: calling(np.vectorize(scaling(f))),
    "a namespace": lambda f: calling(types.SimpleNamespace(call=scaling(f)), lambda found: found.call),
    "a deque": lambda f: calling(collections.deque([scaling(f)]), lambda found: found[0]),
    "an array of objects": lambda f: calling(np.array([scaling(f), None]), lambda found: found[0]),
    "an object in a deque": lambda f: calling(collections.deque([Data(f)]), lambda found: found[0].sample),
    "a read-only mapping": lambda f: calling(types.MappingProxyType({"a": scaling(f)}), lambda found: found["a"]),
    "a mapping of the user": mapping,
    "a mask": masked,
    "a member of an enumeration": lambda f: (lambda member: lambda wo, u: cosine(wo, member.value * u))(
        Kind.ONE if f == 1 else Kind.OTHER
    ),
    "a named tuple": lambda f: (lambda values: lambda wo, u: cosine(wo, values.factor * u))(
        collections.namedtuple("Values", "factor")(f)
    ),
    "a data class": lambda f: Data(f).sample,
    "an abstract class": lambda f: Concrete(f).sample,
    "a private slot": lambda f: Private(f).sample,
    "an object around a function": lambda f: Wrapping(cosine, f),
    "a partial method": lambda f: type(
        "Partial", (), {"sample": functools.partialmethod(lambda self, k, wo, u: cosine(wo, k * u), f)}
    )().sample,
}  # fmt: skip


def identity(sampler):
    e = crescent.parse(TINY)
    e.samplers["mine"] = sampler
    return arms_of(e, {})["mine"].id, e.hash


@pytest.mark.parametrize("name", MAKERS)
def test_what_a_sampler_reaches_is_part_of_it(name):
    make = MAKERS[name]
    same, again, other = (identity(make(factor)) for factor in (1.0, 1.0, 1.5))
    assert same == again and same[0] != other[0] and same[1] != other[1]
    e = crescent.parse(TINY)
    e.samplers["mine"] = make(1.0)
    assert unhashable_of(e.samplers["mine"]) == []


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """write(NAME, TEXT): a file in a folder of sys.path, whose modules are read again."""
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(sys, "dont_write_bytecode", True)

    def write(name, text):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
        for module in [m for m in sys.modules if m.startswith("users_")]:
            del sys.modules[module]
        importlib.invalidate_caches()
        return str(tmp_path / name)

    yield write
    write("end.py", "")


def test_modules_that_code_imports_when_it_runs_are_part_of_it(folder):
    def module(wo, u):
        import users_factor

        return cosine(wo, users_factor.scale(u))

    def name(wo, u):
        from users_factor import scale

        return cosine(wo, scale(u))

    def by_text(wo, u):
        import users_factor

        return cosine(wo, getattr(users_factor, "FACTOR") * u)  # noqa: B009

    for sample in (module, name, by_text):
        found = []
        for factor in (1.0, 1.0, 1.5):
            folder("users_factor.py", f"FACTOR = {factor}\ndef scale(u):\n    return FACTOR * u\n")
            found.append(identity(sample))
        assert found[0] == found[1] and found[0][0] != found[2][0] and found[0][1] != found[2][1]


@pytest.mark.parametrize(
    ("sampler", "factor", "imports"),
    [
        ("users_sampler.py", "users_factor.py", "from users_factor import FACTOR"),
        ("users_sampler.py", "users_parts/factor.py", "from users_parts.factor import FACTOR"),
        ("users_sampler.py", "users_parts/factor.py", "from users_parts import factor; FACTOR = factor.FACTOR"),
        ("users_package/sampler.py", "users_package/factor.py", "from .factor import FACTOR"),
        ("users_package/inner/sampler.py", "users_package/factor.py", "from ..factor import FACTOR"),
    ],
)
def test_files_that_the_file_of_an_arm_imports_are_part_of_it(folder, tmp_path, sampler, factor, imports):
    for package in ("users_parts", "users_package", "users_package/inner"):
        folder(f"{package}/__init__.py", "")
    at = folder(sampler, f"{imports}\ndef sample(wo, u):\n    return wo, FACTOR * u[:, 0]\n")
    found, results = [], []
    for value in (1.0, 1.0, 1.5):
        folder(factor, f"FACTOR = {value}\n")
        e = crescent.parse(TINY)
        e["arms.mine"] = {"python": at, "n": [4]}
        found.append((arms_of(e, {})["mine"].id, e.hash))
        results.append(crescent.run(e, seeds=(1, 1)))
    assert found[0] == found[1] and found[0][0] != found[2][0] and found[0][1] != found[2][1]
    assert results[0].samplers == results[1].samplers != results[2].samplers
    assert f"sampler mine {results[2].samplers['mine']}" in results[2].provenance
    assert sampler in python_sources(tmp_path / sampler)[0]


def test_a_module_of_another_folder_of_the_path_is_part_of_a_file(folder, tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(tmp_path / "far")
    at = folder("users_sampler.py", "import users_far\ndef sample(wo, u):\n    return wo, users_far.FACTOR * u[:, 0]\n")
    folder("far/users_far.py", "FACTOR = 1.0\n")
    assert sorted(python_sources(tmp_path / at)[0]) == ["users_far.py", "users_sampler.py"]


def test_a_program_is_identified_by_the_files_of_its_command(tmp_path):
    found = []
    for text in ("print(1)", "print(1)", "print(2)"):
        (tmp_path / "program.py").write_text(text)
        e = crescent.parse(TINY)
        e["arms.mine"] = {"exec": f"python3 '{tmp_path / 'program.py'}'", "n": [4]}
        found.append((arms_of(e, {})["mine"].id, e.hash))
    assert found[0] == found[1] and found[0][0] != found[2][0] and found[0][1] != found[2][1]


class Locked:
    def __init__(self):
        self.lock = threading.Lock()

    def __getstate__(self):
        return {}

    def sample(self, wo, u):
        return cosine(wo, u)


def reading_globals(wo, u):
    return cosine(wo, globals()["NUMBER"] * u)


@pytest.mark.parametrize(
    ("make", "said"), [(lambda: Locked().sample, "_thread.lock"), (lambda: reading_globals, "globals()")]
)
def test_what_cannot_be_hashed_is_said_and_another_sampler_in_each_call(make, said):
    e = crescent.parse(TINY)
    e.samplers["mine"] = make()
    assert unhashable_of(e.samplers["mine"]) == [said]
    assert arms_of(e, {}, "first")["mine"].id != arms_of(e, {}, "second")["mine"].id
    assert arms_of(e, {"mine": "1"}, "first")["mine"].id == arms_of(e, {"mine": "1"}, "second")["mine"].id


def test_a_sampler_that_cannot_be_sent_is_named():
    lock = threading.Lock()
    e = crescent.parse(TINY)
    e.samplers["mine"] = lambda wo, u: (lock, cosine(wo, u))[1]
    with pytest.raises(ValueError, match="samplers.mine: cannot be sent to the workers of a sweep: cannot pickle"):
        arms_of(e, {})


def test_the_state_of_a_random_generator_is_stable():
    assert state_of(np.random.default_rng(3)) == state_of(np.random.default_rng(3)) != state_of(np.random.default_rng(4))


def test_installed_packages_are_not_all_read_for_an_identity(monkeypatch, folder):
    def read():
        raise AssertionError("takes seconds")

    monkeypatch.setattr(importlib.metadata, "packages_distributions", read)
    versions_of.cache_clear()
    library.cache_clear()
    at = folder("users_sampler.py", "import numpy, crescent\ndef sample(wo, u):\n    return wo, u[:, 0]\n")
    e = crescent.parse(TINY)
    e["arms.mine"] = {"python": at, "n": [4]}
    e.samplers["other"] = lambda wo, u: cosine(wo, u)
    assert e.hash
    assert library("numpy") == ("numpy", f"numpy {np.__version__}") and library("users_sampler") is None
