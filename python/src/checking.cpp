// Samplers and the results of their checks, for crescent/_check.py.
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "callables.h"
#include "module.h"

namespace crescent::python {

namespace {

using Adapter = std::shared_ptr<const SamplerAdapter>;

/// CheckCases over w_o, and the sampler in them.
struct CheckCases {
    std::vector<CheckCase> cases;
    Adapter adapter;                                             // null: a built-in sampler, or an arm of an experiment
    std::vector<std::shared_ptr<const CallableSampler>> arms{};  // of an experiment: those with callables
    std::size_t size() const {
        std::size_t count = 0;
        for (const CheckCase& t : cases) count += !t.baseline;
        return count;
    }
};

Traits::WoDomain wo_domain(const std::string& wo) {
    if (wo == "upper") return Traits::WoDomain::upper;
    if (wo == "both") return Traits::WoDomain::both;
    if (wo == "none") return Traits::WoDomain::none;
    throw nb::value_error(fmt::format("wo is '{}': expected 'upper', 'both' or 'none'", wo).c_str());
}

CheckCases of_callables(nb::object sample, nb::object pdf, nb::object f, const std::string& name, int numbers,
    int u_bits, int channels, const std::string& wo, bool delta, bool weighs, bool upper_only, bool serial,
    bool reciprocal, bool own_random, std::optional<std::vector<double>> eta, bool importance, bool full,
    const Grid& grid, std::shared_ptr<DomainChart> domain, bool number, bool reciprocal_weight, int neighbours,
    const std::tuple<std::string, std::string, std::string>& evaluator) {
    Callables c{.name = name,
        .sample = std::move(sample),
        .pdf = std::move(pdf),
        .f = std::move(f),
        .weights = nb::none(),
        .weighs = weighs,
        .upper_only = upper_only,
        .serial = serial};
    std::tie(c.device.name, c.device.driver, c.device.precision) = evaluator;
    c.traits.numbers = numbers;
    c.traits.u_bits = u_bits;
    c.traits.channels = channels;
    c.traits.wo = wo_domain(wo);
    c.traits.has_pdf = !c.pdf.is_none();
    c.traits.delta = delta;
    c.traits.reciprocal = reciprocal;
    c.traits.own_random = own_random;
    c.traits.importance = importance;
    c.traits.domain = std::move(domain);
    c.traits.number = number;
    c.traits.reciprocal_weight = reciprocal_weight;
    c.traits.neighbours = neighbours;
    if (eta) c.traits.eta = Vec3d{eta->at(0), eta->at(eta->size() / 2), eta->at(eta->size() - 1)};
    const auto adapter = std::make_shared<CallableSampler>(std::move(c));
    if (!number) return {make_user_cases(adapter, full, grid), adapter};
    CheckCase check_case;
    check_case.arm = adapter->name();
    check_case.adapter = adapter;
    return {{std::move(check_case)}, adapter};
}

CheckCases of_experiment(const Experiment& experiment, const std::string& sampler, int pixels, bool full,
    const CallableArms& callables, const Grid& grid, const std::string& keyword) {
    CheckCases out;
    ExternalSamplers samplers;
    for (const auto& [name, arm] : samplers_of(callables)) {
        samplers[name] = arm;
        out.arms.push_back(arm);
    }
    const Work work_scope;
    out.cases =
        arm_cases(experiment, sampler, open_external(with_arms_of(experiment, {sampler}), 0, std::move(samplers)),
            {pixels, full, grid, "--" + keyword});
    return out;
}

/// What was checked of what, in words and for files.
struct CheckRun {
    CheckResult result;
    ResultSource source;
    bool is_against = false;
};

TestSettings settings_of(double alpha, std::uint32_t seed, bool full, bool accept_few) {
    if (!(alpha > 0 && alpha < 1))
        throw nb::value_error(fmt::format("alpha is {:g}: expected a number between 0 and 1", alpha).c_str());
    TestSettings r = full ? TestSettings::thorough() : TestSettings::quick();
    r.alpha = alpha;
    r.seed = seed;
    r.pictures = true;
    r.accept_few = accept_few;
    return r;
}

void set_raised(const CheckCases& check_cases, Raised* raised) {
    if (const auto* callables = dynamic_cast<const CallableSampler*>(check_cases.adapter.get()))
        callables->set_raised(raised);
    for (const auto& arm : check_cases.arms) arm->set_raised(raised);
}

bool is_serial(const CheckCases& check_cases) {
    if (std::ranges::any_of(check_cases.arms, [](const auto& arm) { return arm->serial(); })) return true;
    return dynamic_cast<const CallableSampler*>(check_cases.adapter.get()) && check_cases.adapter->serial();
}

CheckRun checked(CheckCases& check_cases, CheckCases* other, double alpha, std::uint32_t seed, bool full,
    bool accept_few, bool expect_same, int threads, const std::string& command, const nb::object& progress,
    const std::optional<std::vector<double>>& estimates) {
    const TestSettings settings = settings_of(alpha, seed, full, accept_few);
    PolledMonitor monitor;
    Raised raised(monitor);
    CheckRun out{{}, {version(), commit(), command}, other != nullptr};
    const auto work = [&] {
        if (estimates || (check_cases.adapter && check_cases.adapter->traits().number)) {
            out.is_against = false;
            check::ExpectedMean expected;
            if (estimates)
                expected.value = {estimates->front(), estimates->at(estimates->size() / 2), estimates->back()};
            else expected.estimator = other->adapter;
            out.result = check::check_number(check_cases.adapter, expected, settings, monitor);
            return;
        }
        if (!other) {
            out.result = run_checks(check_cases.cases, settings, monitor);
            return;
        }
        std::vector<CheckCase> a = check_cases.cases, b = other->cases;
        for (std::vector<CheckCase>* side : {&a, &b})
            std::erase_if(*side, [](const CheckCase& t) { return t.baseline; });
        if (other->adapter) b = sampler_against(other->adapter, a);
        out.result = compare_samplers(a, b, settings, expect_same, monitor);
    };
    const bool needs_one_thread = is_serial(check_cases) || (other && is_serial(*other));
    set_raised(check_cases, &raised);
    if (other) set_raised(*other, &raised);
    const auto quiet = [&] {
        set_raised(check_cases, nullptr);
        if (other) set_raised(*other, nullptr);
    };
    try {
        watched(monitor, raised, progress, needs_one_thread, [&] { threads > 0 ? on_threads(threads, work) : work(); });
    } catch (...) {
        quiet();
        throw;
    }
    quiet();
    return out;
}

/// Describes the distribution of the draws, as text and as JSON.
std::pair<std::string, std::string> described(
    CheckCases& check_cases, std::uint32_t seed, bool full, int threads, const nb::object& progress) {
    check::DescribeSettings settings;
    settings.seed = seed;
    if (full) {
        settings.draws *= 16;
        settings.limited_draws *= 16;
    }
    PolledMonitor monitor;
    Raised raised(monitor);
    std::vector<check::Description> descriptions;
    const auto work = [&] { descriptions = check::describe(check_cases.cases, settings, monitor); };
    set_raised(check_cases, &raised);
    try {
        watched(monitor, raised, progress, is_serial(check_cases),
            [&] { threads > 0 ? on_threads(threads, work) : work(); });
    } catch (...) {
        set_raised(check_cases, nullptr);
        throw;
    }
    set_raised(check_cases, nullptr);
    std::string text;
    for (const check::Description& d : descriptions) text += check::description_text(d) + "\n";
    return {text, check::description_json(descriptions).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)};
}

/// Returns the cases of a built-in sampler on which `a` was checked.
CheckCases arm_beside(const std::string& arm, const CheckCases& a) {
    if (const std::vector<std::string> names = sampler_names(); std::ranges::find(names, arm) == names.end()) {
        const std::string suggestion = nearest(arm, names);
        throw nb::value_error(fmt::format("against is '{}': no built-in arm{}", arm,
            suggestion.empty() ? "" : fmt::format("; did you mean '{}'?", suggestion))
                .c_str());
    }
    std::vector<CheckCase> cases = a.cases;
    std::erase_if(cases, [](const CheckCase& t) { return t.baseline; });
    return {sampler_named_against(arm, cases), nullptr};
}

void draw_batches(const CheckCases& check_cases, std::uint32_t batches) {
    if (!check_cases.adapter) throw nb::value_error("an arm of the list has no callables");
    PolledMonitor monitor;
    Raised raised(monitor);
    set_raised(check_cases, &raised);
    const int count = check_cases.adapter->traits().numbers;
    const auto batch = [&](std::uint32_t b) {
        std::vector<PrimarySample> u(32768);
        std::vector<Draw> out(u.size());
        for (std::size_t i = 0; i < u.size(); ++i)
            for (int k = 0; k < count; k += 2) {
                const Vec2<float> pair = draw(1, b, i, static_cast<std::uint32_t>(k));
                u[i][k] = pair.x;
                if (k + 1 < count) u[i][k + 1] = pair.y;
            }
        check_cases.adapter->sample(0, check_cases.cases.front().wo, u, out);
    };
    watched(monitor, raised, nb::none(), check_cases.adapter->serial(), [&] {
        if (check_cases.adapter->serial())
            for (std::uint32_t b = 0; b < batches; ++b) batch(b);
        else parallel_for(std::uint32_t{0}, batches, batch);
    });
    set_raised(check_cases, nullptr);
}

using AsDict = nb::typed<nb::dict, std::string, nb::any>;

AsDict as_dict(const Verdict& v) {
    nb::dict out;
    out["arm"] = v.arm;
    out["case"] = v.check_case;
    out["name"] = v.name;
    out["state"] = std::string(word(v.state));
    out["message"] = v.message();
    nb::list sentences;
    for (const Sentence& sentence : v.sentences) sentences.append(nb::make_tuple(sentence.what, sentence.text));
    out["sentences"] = sentences;
    out["wo_deg"] = v.wo ? nb::object(nb::make_tuple(v.wo->first, v.wo->second)) : nb::none();
    out["cause"] = v.cause;
    out["status"] = next_step_text(v, FrontEnd::python);
    out["expected"] = v.expected;
    out["evidence"] = v.evidence.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    out["seconds"] = v.seconds;
    return out;
}

std::vector<AsDict> verdicts_of(const CheckRun& j) {
    std::vector<AsDict> out;
    for (const Verdict& v : j.result.verdicts) out.push_back(as_dict(v));
    return out;
}

void add_check_run(nb::module_& m) {
    nb::class_<CheckRun>(m, "CheckRun", "The result of a check: verdicts with their evidence, and its provenance.")
        .def_prop_ro("state", [](const CheckRun& j) { return std::string(word(j.result.state)); })
        .def_prop_ro("as_expected", [](const CheckRun& j) { return j.result.as_expected; })
        .def_prop_ro("tests", [](const CheckRun& j) { return j.result.tests; })
        .def_prop_ro("questions", [](const CheckRun& j) { return j.result.questions; })
        .def_prop_ro("verdicts", &verdicts_of)
        .def(
            "text",
            [](const CheckRun& j, bool shows_all) {
                if (j.is_against) return against_text(j.result);
                return shows_all || !one_sampler(j.result) ? verdict_table(j.result, shows_all)
                                                           : verdict_screen(j.result, FrontEnd::python);
            },
            nb::arg("all") = false)
        .def("json", [](const CheckRun& j) { return verdict_json(j.result, j.source); })
        .def("junit", [](const CheckRun& j) { return junit_text(verdict_report(j.result)); })
        .def("html", [](const CheckRun& j) { return verdict_html(j.result, j.source); });
}

}  // namespace

void add_checking(nb::module_& m) {
    using namespace nb::literals;
    nb::class_<CheckCases>(m, "CheckCases", "A sampler over a grid of w_o, ready to be checked.")
        .def("__len__", &CheckCases::size)
        .def_prop_ro("number", [](const CheckCases& t) { return t.adapter && t.adapter->traits().number; })
        .def_prop_ro(
            "draws",
            [](const CheckCases& t) {
                const auto* c = dynamic_cast<const CallableSampler*>(t.adapter.get());
                return c ? c->draws() : 0;
            },
            "Draws that the callables made so far.");
    m.def("cases_of_callables", &of_callables, "sample"_a, "pdf"_a.none(), "f"_a.none(), "name"_a, "numbers"_a,
        "u_bits"_a, "channels"_a, "wo"_a, "delta"_a, "weighs"_a, "upper_only"_a, "serial"_a, "reciprocal"_a,
        "own_random"_a, "eta"_a.none(), "importance"_a, "full"_a, "grid"_a, "domain"_a.none(), "number"_a,
        "reciprocal_weight"_a, "neighbours"_a, "evaluator"_a);
    m.def("cases_of_experiment", &of_experiment, "experiment"_a, "sampler"_a, "pixels"_a, "full"_a, "callables"_a,
        "grid"_a, "keyword"_a,
        "An arm of an experiment at pixels of its scene; 0: over the grid of w_o on each material.");
    m.def(
        "cases_of_arm",
        [](const std::string& arm, const Settings& settings, bool full, const Grid& grid) {
            return CheckCases{make_cases(arm, settings, full, grid), nullptr};
        },
        "arm"_a, "settings"_a, "full"_a, "grid"_a);
    m.def("draw", &draw_batches, "cases"_a, "batches"_a,
        "Draws this many batches of 32768 from the callables, on all cores, and drops them: the cost of the calls.");
    m.def("baseline_of", &arm_beside, "arm"_a, "cases"_a);
    m.def("run_checks", &checked, "cases"_a, "other"_a.none(), "alpha"_a, "seed"_a, "full"_a, "accept_few"_a,
        "expect_same"_a, "threads"_a, "command"_a, "progress"_a.none(), "estimates"_a.none());
    m.def("describe", &described, "cases"_a, "seed"_a, "full"_a, "threads"_a, "progress"_a.none());
    m.def("write_whole", &write_whole, "path"_a, "text"_a, "Writes a temporary file and renames it.");
    m.def("sampler_names", &sampler_names, "The built-in arms.");
    add_check_run(m);
}

}  // namespace crescent::python
