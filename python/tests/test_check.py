"""check: correct samplers pass, faults are found, and errors name the first bad row."""

import copy
import dataclasses
import inspect
import json
import os
import pickle
import shutil
import signal
import subprocess
import sys
import threading

import numpy as np
import pytest
from samplers import cosine, cosine_pdf, lambert, mirror, sphere, sphere_pdf

import crescent


def test_a_right_sampler_is_right_and_a_pdf_that_is_1_percent_off_is_wrong():
    assert crescent.check(cosine, cosine_pdf, lambert, name="cosine").state == "right"
    off = crescent.check(cosine, lambda wo, wi: 1.01 * cosine_pdf(wo, wi), lambert)
    assert off.state == "wrong"
    assert {"normalised", "identity"} <= set(off.broken())


def test_a_verdict_has_its_sentences_and_what_each_states():
    result = crescent.check(cosine, lambda wo, wi: 1.5 * cosine_pdf(wo, wi), lambert, wo_deg=[(30, 90)])
    (normalised,) = result.of("normalised")
    assert [what for what, _ in normalised.sentences] == ["integral", "expected"]
    assert " ".join(text for _, text in normalised.sentences) == normalised.message
    assert normalised.states("integral") and not normalised.states("p-value") and normalised.wo_deg == (30, 90)
    (stored,) = [v for v in json.loads(result.json())["verdicts"] if v["name"] == "normalised"]
    assert [(s["what"], s["text"]) for s in stored["sentences"]] == list(normalised.sentences)
    nan = crescent.check(lambda wo, u: (cosine(wo, u)[0], np.where(u[:, 0] == 0, np.nan, cosine(wo, u)[1])), cosine_pdf)
    (valid, *_) = [v for v in nan.of("valid") if v.state == "wrong"]
    assert valid.states("pdf is NaN") and valid.evidence["first_u"][0] == 0


def test_describe_says_what_distribution_the_draws_have():
    d = crescent.describe(cosine, cosine_pdf, name="cosine", wo_deg=30)
    assert "mean direction" in str(d) and len(d.cases) == 1
    case = d.cases[0]
    mean_z = case["mean"][2]
    assert mean_z["low"] < mean_z["value"] < mean_z["high"] and abs(mean_z["value"] - 2 / 3) < 0.01
    assert case["share_above"]["value"] == 1 and case["share_below"]["value"] == 0
    with pytest.raises(TypeError, match="no keyword"):
        crescent.describe(cosine, colour=3)


def test_what_evaluates_a_sampler_is_in_its_result():
    result = crescent.check(cosine, cosine_pdf, name="mine", wo_deg=30, evaluator=("a device", "a driver", "double"))
    named = {"arm": "mine", "name": "a device", "driver": "a driver", "precision": "double"}
    assert json.loads(result.json())["devices"] == [named]
    assert "devices" not in json.loads(crescent.check(cosine, cosine_pdf, wo_deg=30).json())


def test_a_judgement_is_data_files_and_no_truth_value(tmp_path):
    j = crescent.check(cosine, cosine_pdf, lambert, name="mine", wo_deg=[30, (60, 250)])
    assert {v.case for v in j.verdicts} == {"w_o 30 deg az 0", "w_o 60 deg az 250"}
    assert all(v.sampler == "mine" for v in j) and j.of("density")[0].evidence
    data = json.loads(j.json())
    assert data["format"] == "crescent check 3" and len(data["verdicts"]) == len(j.verdicts)
    j.junit(tmp_path / "j.xml")
    j.html(tmp_path / "j.html")
    assert (tmp_path / "j.xml").read_text().startswith("<?xml") and "<html" in (tmp_path / "j.html").read_text()
    assert "srcdoc=" in j._repr_html_() and "density: right" in str(j) and "mine" in j.text(all=True)
    other = pickle.loads(pickle.dumps(j))  # as from another process
    assert other.verdicts == j.verdicts and other.json() == j.json() and str(other) == str(j)
    assert other._repr_html_() == j._repr_html_() and repr(other) == repr(j)
    assert copy.deepcopy(j).verdicts == copy.copy(j).verdicts == pickle.loads(pickle.dumps(j.verdicts)) == j.verdicts
    with pytest.raises(TypeError, match="compare .state"):
        bool(j)
    with pytest.raises(OSError):
        j.junit(tmp_path / "no such folder" / "j.xml")


def test_equal_calls_give_equal_bytes_whatever_the_threads():
    one = crescent.check(cosine, cosine_pdf, lambert, wo_deg=[45, 85], threads=1).json()
    assert one == crescent.check(cosine, cosine_pdf, lambert, wo_deg=[45, 85]).json()
    assert one != crescent.check(cosine, cosine_pdf, lambert, wo_deg=[45, 85], seed=2).json()


def test_a_sampler_without_w_o_and_one_with_a_delta_part():
    assert crescent.check(sphere, sphere_pdf, wo="none").state == "right"
    j = crescent.check(
        mirror, lambda wo, wi: 0.75 * cosine_pdf(wo, wi), lambda wo, wi: 0.5 * lambert(wo, wi), u=3, wo_deg=[30]
    )
    assert j.state == "right", str(j)


def test_three_channels_and_a_weight_that_is_not_f_cos_over_p():
    def colour(wo, wi):
        return lambert(wo, wi)[:, None] * [0.2, 0.5, 0.8]

    def weighed(wo, u):
        return *cosine(wo, u), np.tile([0.2, 0.5, 0.8], (len(u), 1))

    def wrong(wo, u):
        return *cosine(wo, u), np.tile([0.8, 0.5, 0.2], (len(u), 1))

    assert crescent.check(weighed, cosine_pdf, colour, wo_deg=[30]).state == "right"
    assert "identity" in crescent.check(wrong, cosine_pdf, colour, wo_deg=[30]).broken()


def test_a_plugin_runs_beside_the_module(tmp_path):
    cc = shutil.which("cc")
    if not cc:
        pytest.skip("no C compiler")
    source = tmp_path / "plugin.c"
    source.write_text(
        """#include <math.h>
#include <stddef.h>
#include <stdlib.h>
unsigned crescent_sampler_abi(void) { return 2; }
int crescent_sampler_sample(size_t n, const double* wo, const double* u, const double* s, double* wi, double* p) {
    if (getenv("PLUGIN_ENDS")) _Exit(3);
    for (size_t i = 0; i < n; ++i) {
        double c = sqrt(u[2 * i]), r = sqrt(1 - u[2 * i]), a = 6.283185307179586 * u[2 * i + 1];
        wi[3 * i] = r * cos(a), wi[3 * i + 1] = r * sin(a), wi[3 * i + 2] = c, p[i] = c / 3.141592653589793;
    }
    return 0;
}
int crescent_sampler_pdf(size_t n, const double* wo, const double* wi, const double* s, double* p) {
    for (size_t i = 0; i < n; ++i) p[i] = wi[3 * i + 2] > 0 ? wi[3 * i + 2] / 3.141592653589793 : 0;
    return 0;
}
"""
    )
    library = tmp_path / "libplugin.so"
    subprocess.run([cc, "-O2", "-shared", "-fPIC", source, "-o", library, "-lm"], check=True)
    command = [sys.executable, "-m", "crescent", "check", "--plugin", str(library), "--wo", "45"]
    assert subprocess.run(command).returncode == 0
    ended = subprocess.run(command, env={**os.environ, "PLUGIN_ENDS": "1"}, capture_output=True, text=True)
    assert ended.returncode == 3
    assert "exit code 3 in crescent_sampler_sample" in " ".join((ended.stdout + ended.stderr).split())


def test_domain_hemisphere_needs_no_guard_at_the_horizon():
    def unguarded(wo, wi):
        return wi[:, 2] / np.pi

    assert crescent.check(cosine, unguarded, lambert, wo_deg=[30]).state == "wrong"
    assert crescent.check(cosine, unguarded, lambert, wo_deg=[30], domain="hemisphere").state == "right"


@pytest.mark.parametrize(
    "pdf, said",
    [
        (lambda wo, wi: cosine_pdf(wo, wi)[:-1], "row 7 is the first missing one"),
        (lambda wo, wi: cosine_pdf(wo, wi)[:, None], r"row 0 has shape \(1,\)"),
        (lambda wo, wi: [[1.0], [1.0, 2.0]] * 4, "row 1 has shape"),
        (lambda wo, wi: cosine_pdf(wo, wi) * 1j, "dtype complex128"),
        (lambda wo, wi: [0.1] * 3 + [None] + [0.1] * 4, "row 3 has NoneType"),
        (lambda wo, wi: None, "pdf is NoneType"),
    ],
)
def test_a_pdf_of_another_shape_is_told_with_its_first_bad_row(pdf, said):
    with pytest.raises(ValueError, match=said):
        crescent.check(cosine, pdf, name="mine")


@pytest.mark.parametrize(
    "sample, said",
    [
        (lambda wo, u: cosine(wo, u)[0], "expected .wi, pdf."),
        (lambda wo, u: (cosine(wo, u)[0][:, :2], cosine(wo, u)[1]), r"expected \(8, 3\): row 0 has shape \(2,\)"),
        (lambda wo, u: {"wi": cosine(wo, u)[0], "p": 1}, "keys"),
        (lambda wo, u: (cosine(wo, u)[0], cosine(wo, u)[1][1:]), "row 7"),
        (lambda wo, u: ([[0, 0, 1]] * 4 + [[0, 0, None]] * 4, 1), "row 4 has NoneType"),
        (lambda wo, u: (cosine(wo, u)[0], None), "sample's pdf is NoneType"),
        (lambda wo, u: (*cosine(wo, u), 1, [True] * 7), "sample's delta: 7 rows"),
        (lambda wo, u: (*cosine(wo, u), 1, np.ones((8, 1), bool)), r"delta: shape \(8, 1\)"),
    ],
)
def test_a_sample_of_another_shape_is_told(sample, said):
    with pytest.raises(ValueError, match=said):
        crescent.check(sample, cosine_pdf)


def test_a_length_that_goes_wrong_later_is_told_too_and_so_is_what_a_callable_raises():
    def short(wo, wi):
        return cosine_pdf(wo, wi)[: max(len(wi) - 1, 8)]

    with pytest.raises(ValueError, match="is the first missing one"):
        crescent.check(cosine, short)

    class Mine(Exception):
        pass

    def raises(wo, wi):
        if len(wi) > 8:
            raise Mine("at my place")
        return cosine_pdf(wo, wi)

    with pytest.raises(Mine, match="at my place"):
        crescent.check(cosine, raises)


@pytest.mark.parametrize("serial", [False, True])
def test_ctrl_c_ends_a_judgement(serial, interruptible):
    began = threading.Event()

    def slow(wo, wi):
        if len(wi) > 8 and not began.is_set():
            began.set()
            os.kill(os.getpid(), signal.SIGINT)
        return cosine_pdf(wo, wi)

    with pytest.raises(KeyboardInterrupt):
        crescent.check(cosine, slow, lambert, full=True, serial=serial)
    assert began.is_set()


def test_progress_is_told_and_what_it_raises_ends_the_judgement():
    told = []
    crescent.check(cosine, cosine_pdf, lambert, progress=lambda *at: told.append(at))
    assert told and told[-1][0] == "verdicts"

    def stop(what, done, total):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        crescent.check(cosine, cosine_pdf, lambert, progress=stop)


def test_a_sampler_is_asked_as_often_as_is_told():
    rows = {"sample": 0, "pdf": 0, "f": 0}

    def counting(name, function):
        def counted(wo, second):
            rows[name] += len(second)
            return function(wo, second)

        return counted

    counted = [counting(name, f) for name, f in (("sample", cosine), ("pdf", cosine_pdf), ("f", lambert))]
    j = crescent.check(*counted, wo_deg=[30, 85], serial=True)
    assert 100_000 < j.questions <= sum(rows.values()) < j.questions + 1000  # some rows test the arrays returned
    assert j.questions <= 1_000_000 and json.loads(j.json())["questions"] == j.questions


def test_a_serial_sampler_is_called_by_the_callers_thread_alone():
    threads = set()

    def noted(wo, wi):
        threads.add(threading.get_ident())
        return cosine_pdf(wo, wi)

    assert crescent.check(cosine, noted, lambert, wo_deg=[30], serial=True).state == "right"
    assert threads == {threading.get_ident()}


def test_other_threads_run_while_the_bench_works():
    over, turns = threading.Event(), []

    def turning():
        while not over.wait(0.001):
            turns.append(threading.get_ident())

    beside = threading.Thread(target=turning)
    beside.start()
    try:
        crescent.check("ggx-vndf")  # without a callable: the interpreter's lock is released for the whole call
        alone = len(turns)
        crescent.check(cosine, cosine_pdf, lambert)
    finally:
        over.set()
        beside.join()
    assert alone > 20 and len(turns) - alone > 20


def test_built_in_arms_alone_and_against_each_other():
    assert crescent.check("cosine").as_expected
    assert crescent.check(cosine, cosine_pdf, lambert, against="cosine", expect_same=True, wo_deg=[30]).state == "right"
    j = crescent.check(cosine, cosine_pdf, lambert, against="uniform", expect_same=True, wo_deg=[30])
    assert "same_distribution" in j.broken()
    with pytest.raises(ValueError, match="did you mean 'cosine'"):
        crescent.check("cosin")


def test_flags_of_delta_parts_may_be_whole_numbers():
    def flagged(wo, u):
        return *mirror(wo, u)[:3], mirror(wo, u)[3].astype(int)

    j = crescent.check(flagged, lambda wo, wi: 0.75 * cosine_pdf(wo, wi), lambda wo, wi: 0.5 * lambert(wo, wi), u=3)
    assert j.state == "right", str(j)


def test_a_sampler_that_draws_random_numbers_of_its_own_says_so():
    rng = np.random.default_rng(1)

    def own(wo, u):
        return cosine(wo, rng.random(u.shape))

    known = {"wo_deg": 30, "serial": True}  # a NumPy generator belongs to one thread
    assert "identity" in crescent.check(own, cosine_pdf, lambert, **known).broken()
    assert crescent.check(own, cosine_pdf, lambert, own_random=True, **known).state == "right"


def test_w_o_may_be_a_number_or_an_array():
    one, array = (crescent.check(cosine, cosine_pdf, wo_deg=w) for w in (30, np.array([[30, 0], [60, 250]])))
    assert {v.case for v in one} == {"w_o 30 deg az 0"}
    assert {v.case for v in array} == {"w_o 30 deg az 0", "w_o 60 deg az 250"}


@pytest.mark.parametrize(
    "known",
    [
        *({"u": 9}, {"channels": 2}, {"domain": "disc"}, {"wo": "left"}, {"alpha": 2}, {"seed": -1}, {"threads": -1}),
        *({"eta": -1}, {"eta": [1.5, 1.6]}, {"eta": float("nan")}, {"against": "cosin"}),
        *({"wo_deg": at} for at in (90, [(30, float("nan"))], [(30, 2, 3)], ["x"], 120)),
        {"wo": "none", "wo_deg": 30},
        {"evaluator": ("a device", "a driver", "half")},
    ],
)
def test_what_is_declared_wrongly_is_a_value_error(known):
    with pytest.raises(ValueError, match=next(reversed(known))):
        crescent.check(cosine, cosine_pdf, **known)


@pytest.mark.parametrize(
    "known, said",
    [
        ({"u": 2.0}, "u is 2.0"),
        ({"name": 3}, "name is int"),
        ({"f": 3}, "f is int"),
        ({"against": cosine}, "against is function"),
        ({"progress": 3}, "progress is int"),
        ({"wo_dg": 30}, "did you mean 'wo_deg'"),
    ],
)
def test_what_is_of_another_kind_is_a_type_error(known, said):
    with pytest.raises(TypeError, match=said):
        crescent.check(cosine, cosine_pdf, **known)


def test_callables_beside_a_sampler_are_not_dropped_and_numbers_that_are_missing_are_told():
    with pytest.raises(TypeError, match="holds its own pdf"):
        crescent.check(crescent.Sampler(cosine, cosine_pdf), cosine_pdf)
    with pytest.raises(IndexError) as told:
        crescent.check(mirror, cosine_pdf)
    assert "u=K" in told.value.__notes__[0]
    for bad in (float("nan"), "32"):
        with pytest.raises(ValueError, match="s is"):
            crescent.check("phong", settings={"s": bad})


def test_every_keyword_of_check_is_told_by_its_signature():
    told = inspect.signature(crescent.check).parameters
    known = {at.name for at in dataclasses.fields(crescent.Sampler)} - {"sample", "pdf", "f", "n"}
    assert known | {"wo_deg", "alpha", "seed", "full", "against", "progress"} <= set(told)
    assert all(p.kind != p.VAR_KEYWORD for p in told.values())
