"""Samplers of other libraries: triples of NumPy, JAX and PyTorch, and Mitsuba's own."""

import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest

import crescent
from crescent import adapters
from crescent._libraries import Library, filled_length
from crescent.testing import mutants

WO = [(30.0, 0.0), (75.0, 310.0)]


def triple(xp, pi=np.pi):
    """Lambert of 0.5 in the form of renderers, in any array library: eval includes the cosine."""

    def sample(wo, u):
        r, phi = xp.sqrt(u[:, 0]), 2 * pi * u[:, 1]
        z = xp.sqrt(1 - u[:, 0])
        return xp.stack([r * xp.cos(phi), r * xp.sin(phi), z], -1), z / pi, 0.5 + 0 * z

    def pdf(wo, wi):
        return xp.where(wi[:, 2] > 0, wi[:, 2], 0 * wi[:, 2]) / pi

    def eval(wo, wi):
        return 0.5 * pdf(wo, wi)

    return sample, eval, pdf


def test_a_triple_in_numpy_is_right_and_one_whose_eval_lacks_the_cosine_is_not():
    sample, eval, pdf = triple(np)
    assert crescent.check(adapters.numpy(sample, eval, pdf), wo_deg=WO).state == "right"
    bare = adapters.numpy(sample, lambda wo, wi: eval(wo, wi) / np.maximum(wi[:, 2], 1e-6), pdf)
    assert "identity" in crescent.check(bare, wo_deg=WO).broken()


def test_a_triple_in_single_precision_is_right():
    assert crescent.check(adapters.numpy(*triple(np), dtype=np.float32), wo_deg=WO).state == "right"


def test_a_triple_in_jax_is_compiled_for_few_shapes():
    jax = pytest.importorskip("jax")
    compiled = []
    jax.monitoring.register_event_duration_secs_listener(
        lambda event, seconds, **more: event.endswith("backend_compile_duration") and compiled.append(event)
    )
    sample, eval, pdf = triple(jax.numpy)
    shapes = set()

    def noted(wo, wi):
        shapes.add(wi.shape)
        return pdf(wo, wi)

    jitted = [jax.jit(call) for call in (sample, eval, noted)]
    assert crescent.check(adapters.jax(*jitted), wo_deg=WO).state == "right"
    assert 1 < len(shapes) <= 6 and all(n & (n - 1) == 0 for n, _ in shapes)
    assert len(compiled) <= 3 * 6
    del compiled[:]
    assert crescent.check(adapters.jax(*jitted), wo_deg=[50], seed=2).state == "right"
    assert len(compiled) <= 3, "a length that the first check did not have"
    off = adapters.jax(*jitted[:2], lambda wo, wi: 1.02 * jitted[2](wo, wi))
    assert "normalised" in crescent.check(off, wo_deg=WO).broken()


class Compiling(Library):
    """NumPy as a library that compiles code for each shape."""

    def __init__(self):
        super().__init__(np)
        self._compiles = True


def test_batches_of_a_library_that_compiles_have_few_lengths():
    library, lengths = Compiling(), []

    def noted(call):
        def asked(*rows):
            lengths.append({len(row) for row in rows})
            return call(*rows)

        return library.asks(asked)

    sample, pdf, f = plain(np)
    checked = crescent.check(noted(sample), noted(pdf), noted(f), array_module=np, name="mine")
    assert all(len(of_one) == 1 for of_one in lengths)
    assert len(set().union(*lengths)) <= 6
    assert checked.json() == crescent.check(sample, pdf, f, array_module=np, name="mine").json()


@pytest.mark.parametrize("n", [1, 64, 65, 5000, 8192, 131072, 131073, 400000])
def test_a_batch_is_filled_to_one_of_few_lengths(n):
    assert n <= filled_length(n) < max(65, 9 * n)
    assert filled_length(n) in (64, 512, 2048, 8192, 32768, 131072, 262144, 524288)
    rows = np.arange(3.0 * n).reshape(n, 3)
    assert np.array_equal(Compiling().asks(lambda given: given + 0)(rows), rows)


def test_an_answer_with_other_rows_than_the_filled_batch_is_an_error():
    for rows in (3, 65):
        with pytest.raises(ValueError, match=f"{rows} rows for 64 requested"):
            Compiling().asks(lambda wo, wi: np.ones(rows))(np.ones((8, 3)), np.ones((8, 3)))
    assert Compiling().asks(lambda wo, wi: 0.25)(np.ones((8, 3)), np.ones((8, 3))) == 0.25


def test_a_triple_in_torch():
    torch = pytest.importorskip("torch")
    sample, eval, pdf = triple(torch)
    assert crescent.check(adapters.torch(sample, eval, pdf), wo_deg=WO).state == "right"


def test_callables_of_torch_compile_compile_for_few_lengths():
    torch = pytest.importorskip("torch")
    sample, pdf, f = plain(torch)
    lengths = set()

    def noted(wo, u):
        if not isinstance(u, np.ndarray):  # the first look is with NumPy's arrays
            lengths.add(len(u))
        return sample(wo, u)

    # Without generated code: what matters is the lengths, and that compiled callables are accepted.
    compiled = [torch.compile(call, backend="eager") for call in (noted, pdf, f)]
    found = crescent.check(*compiled, wo_deg=WO)
    assert found.state == "right"
    assert all(filled_length(n) == n for n in lengths) and len(lengths) <= 6, lengths
    wrong = crescent.check(compiled[0], torch.compile(lambda wo, wi: 1.05 * pdf(wo, wi), backend="eager"), wo_deg=WO)
    assert wrong.state == "wrong"


def plain(xp, pi=np.pi):
    """The same without the cosine in f, as crescent.check takes it."""
    sample, eval, pdf = triple(xp)
    return lambda wo, u: sample(wo, u)[:2], pdf, lambda wo, wi: xp.where(wi[:, 2] > 0, 0.5 / pi + 0 * wi[:, 2], 0.0)


@pytest.mark.parametrize("name, module", [("torch", "torch"), ("jax", "jax.numpy")])
def test_the_library_of_callables_is_seen_and_what_lies_there_stays(name, module):
    xp = pytest.importorskip(module)
    sample, pdf, f = plain(xp)
    if name == "jax":
        sample, pdf, f = map(pytest.importorskip("jax").jit, (sample, pdf, f))
    gave, handed = [], []

    def drawn(wo, u):
        parts = sample(wo, u)
        gave.append(parts[0])
        return parts

    def counted(wo, wi):
        handed.append(any(wi is mine for mine in gave))
        return pdf(wo, wi)

    for known in ({}, {"array_module": name}, {"array_module": xp}):
        assert crescent.check(drawn, counted, f, wo_deg=[30], **known).state == "right"
    assert sum(handed) >= 9 and not all(handed)


@pytest.fixture(scope="module")
def dr():
    library = pytest.importorskip("drjit")
    try:
        library.auto.ad.Float(1) + 1
    except Exception as e:
        pytest.skip(f"Dr.Jit has no backend: {e}")
    return library


def of_drjit(dr, form):
    """Lambert of 0.5 in Dr.Jit, written for vectors, for their indices, or for tensors."""
    vector = dr.auto.ad.Array3f
    parts = {
        "vectors": lambda v: [getattr(v, c) for c in "xyz"[: len(v)]],
        "indices": lambda v: [v[k] for k in range(len(v))],
        "tensors": lambda v: [v[:, k].array for k in range(v.shape[1])],
    }[form]

    def sample(wo, u):
        u1, u2 = parts(u)
        s, c = dr.sincos(2 * dr.pi * u2)
        r, z = dr.sqrt(u1), dr.sqrt(1 - u1)
        return vector(r * c, r * s, z), z / dr.pi

    def pdf(wo, wi):
        return dr.maximum(parts(wi)[2], 0) / dr.pi

    return sample, pdf, lambda wo, wi: dr.select(parts(wi)[2] > 0, 0.5 / dr.pi, 0)


@pytest.mark.parametrize("form", ["vectors", "indices", "tensors"])
def test_callables_of_drjit_are_handed_its_arrays(dr, form):
    sample, pdf, f = of_drjit(dr, form)
    handed = []

    def noted(wo, wi):
        handed.append(type(wi))
        return pdf(wo, wi)

    assert crescent.check(sample, noted, f, wo_deg=[30]).state == "right"
    assert {issubclass(kind, dr.ArrayBase) for kind in handed[1:]} == {True}
    assert {dr.is_tensor_v(kind) for kind in handed[1:]} == {form == "tensors"}
    off = crescent.check(sample, lambda wo, wi: 1.02 * pdf(wo, wi), f, wo_deg=[30], array_module="drjit")
    assert {"normalised", "identity"} <= set(off.broken())


def test_directions_that_drjit_drew_stay_its_own(dr):
    sample, pdf, f = of_drjit(dr, "vectors")
    gave, again = set(), []

    def drawn(wo, u):
        wi, p = sample(wo, u)
        dr.eval(wi)
        gave.add(wi.x.index)
        return wi, p

    def writes(wo, wi):
        again.append(wi.x.index in gave)
        out = pdf(wo, wi)
        wi *= 0.5  # into a copy
        return out

    assert crescent.check(drawn, writes, f, wo_deg=[30]).state == "right"
    assert sum(again) >= 3


def test_a_triple_in_drjit_and_one_entry_for_all_rows(dr):
    sample, pdf, f = of_drjit(dr, "vectors")
    mine = adapters.drjit(sample, lambda wo, wi: 0.5 * pdf(wo, wi), pdf)
    assert crescent.check(mine, wo_deg=[30]).state == "right"
    colour = dr.auto.ad.Array3f(0.2, 0.5, 0.8) / dr.pi
    j = crescent.check(sample, pdf, lambda wo, wi: colour, wo_deg=[30], domain="hemisphere")
    assert j.state == "right", str(j)


def test_what_a_callable_writes_into_its_tensors_is_not_handed_again():
    torch = pytest.importorskip("torch")
    sample, pdf, f = plain(torch)

    def writes(wo, wi):
        out = pdf(wo, wi)
        wi *= 0.5
        return out

    assert crescent.check(sample, writes, f, wo_deg=[30]).state == "right"


def test_any_module_with_asarray_is_a_library():
    class Rows:
        def __init__(self, rows):
            self.rows = rows

        def __array__(self, dtype=None, copy=None):
            return self.rows if dtype is None else self.rows.astype(dtype)

    mine = SimpleNamespace(__name__="mine", asarray=lambda rows, device: Rows(rows) if device == "here" else None)
    sample, pdf, f = plain(np)

    def of(call):
        return lambda *at: call(*(a.rows for a in at))

    bare = (of(sample), of(pdf), of(f))
    known = {"array_module": mine, "device": "here", "wo_deg": [30]}
    assert crescent.check(*bare, **known).state == "right"
    assert crescent.check(bare[0], lambda wo, wi: Rows(1.02 * pdf(wo.rows, wi.rows)), **known).state == "wrong"
    with pytest.raises(AttributeError, match="rows"):
        crescent.check(*bare)
    assert "wrong" == crescent.check(next(iter(mutants(crescent.Sampler(*bare, **known_of(known))))).sampler).state


def known_of(known):
    return {key: value for key, value in known.items() if key != "wo_deg"}


def test_adapters_load_on_first_use_and_their_libraries_when_they_are_called():
    script = """
import sys
import crescent
assert "crescent.adapters" not in sys.modules and {"adapters", "testing"} <= set(dir(crescent))
assert callable(crescent.adapters.mitsuba) and callable(crescent.testing.mutants)
assert not {"mitsuba", "drjit", "torch", "jax"} & set(sys.modules)
try:
    crescent.adapter
except AttributeError as e:
    assert "adapter" in str(e)
"""
    ended = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert ended.returncode == 0, ended.stderr


@pytest.fixture(scope="module")
def mi():
    library = pytest.importorskip("mitsuba")
    library.set_variant("llvm_ad_rgb")
    return library


@pytest.mark.parametrize("plugin", ["diffuse", "dielectric", "plastic", "conductor"])
def test_plugins_of_mitsuba_are_right(mi, plugin):
    sampler = adapters.mitsuba({"type": plugin})
    assert crescent.check(sampler, wo_deg=WO + ([(150.0, 0.0)] if sampler.wo == "both" else [])).state == "right"


def test_a_plugin_of_ones_own_with_a_fault_is_found(mi):
    class Doubled(mi.BSDF):
        def __init__(self, props):
            mi.BSDF.__init__(self, props)
            self.nested = mi.load_dict({"type": "diffuse"})
            self.m_components = [mi.BSDFFlags.DiffuseReflection | mi.BSDFFlags.FrontSide]
            self.m_flags = self.m_components[0]

        def sample(self, ctx, si, sample1, sample2, active=True):
            bs, weight = self.nested.sample(ctx, si, sample1, sample2, active)
            return bs, weight

        def eval(self, ctx, si, wo, active=True):
            return self.nested.eval(ctx, si, wo, active)

        def pdf(self, ctx, si, wo, active=True):
            return 1.05 * self.nested.pdf(ctx, si, wo, active)

    mi.register_bsdf("doubled", lambda props: Doubled(props))
    broken = crescent.check(adapters.mitsuba({"type": "doubled"}), wo_deg=WO).broken()
    assert {"normalised", "identity"} <= set(broken)


def test_an_emitter_of_mitsuba_is_right(mi):
    light = {"type": "sphere", "center": [0.0, 1.0, 2.0], "radius": 0.5, "emitter": {"type": "area"}}
    assert crescent.check(adapters.mitsuba_emitter(light)).state == "right"
    by_name = adapters.mitsuba(light)
    assert by_name.name == "sphere" and by_name.wo == "none" and crescent.check(by_name).state == "right"


def test_what_is_no_plugin_of_that_kind_is_told(mi):
    for other in (3, {"type": "hdrfilm"}):
        with pytest.raises(TypeError, match="neither a mi.BSDF nor an emitter"):
            adapters.mitsuba(other)
    with pytest.raises(TypeError, match="is not an emitter"):
        adapters.mitsuba_emitter({"type": "diffuse"})
    with pytest.raises(ValueError, match="has no emitter"):
        adapters.mitsuba_emitter({"type": "sphere"})
    for light in ({"type": "point", "position": [0, 0, 1]}, {"type": "directional", "direction": [0, 0, 1]}):
        with pytest.raises(ValueError, match="no density to check"):
            adapters.mitsuba_emitter(light)
