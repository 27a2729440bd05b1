// crescent_compare_rates [--calls 100] [--seed S]: false alarms, power, and coverage of the intervals of `crescent
// compare --arm`. Prints tests/calibration/results/compare.md. Each kind of noise is compared `--calls` times, each
// call with its own seed; the true value of a metric is its mean over all calls of the kind. Rates have exact binomial
// intervals.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <numbers>
#include <set>

#include "base/parallel.h"
#include "base/progress.h"
#include "compare/results.h"
#include "math/simd/random.h"
#include "math/statistics.h"
#include "rate_cell.h"
#include "tests/support/synthetic_renders.h"

namespace {

using namespace crescent;

using NoiseKind = SyntheticNoise::Kind;

const std::vector<CompareFlag> noise_costs{
    {{"arms", "a", "seconds"}, "2", true, "seconds"}, {{"arms", "a", "spp"}, "16", true, "spp"}};

/// Calls of one kind: their results, and which of them have a rare event in some render of each arm.
struct Calls {
    SyntheticScene scene;
    std::vector<CompareResult> results;
    std::vector<bool> have_events;
    std::vector<CompareFlag> more;
};

void call(Calls& to, std::uint32_t repeats, std::uint32_t seed, ProgressMonitor& monitor) {
    std::vector<CompareFlag> flags = noise_costs;
    flags.insert(flags.end(), to.more.begin(), to.more.end());
    to.results.resize(repeats);
    parallel_for(std::uint32_t{0}, repeats, [&](std::uint32_t k) {
        monitor.check();
        to.results[k] = compare_synthetic(to.scene, seed_of(seed, k), flags);
        monitor.advance(1);
    });
    for (std::uint32_t k = 0; k < repeats; ++k) to.have_events.push_back(have_events(to.scene, seed_of(seed, k)));
}

template <class Is> std::uint64_t count(const std::vector<CompareResult>& all, Is is) {
    return static_cast<std::uint64_t>(std::count_if(all.begin(), all.end(), is));
}

bool differs(const CompareResult& r) { return r.differs(); }
/// Some mean was not tested, or its difference not reported, because of a heavy tail.
bool heavy(const CompareResult& r) {
    const auto message = [](const MeanTest& t) {
        return t.why.starts_with("heavy tail") || t.caveat.starts_with("heavy tail");
    };
    return std::any_of(r.bias.begin(), r.bias.end(),
        [&](const BiasResult& b) { return std::any_of(b.regions.begin(), b.regions.end(), message); });
}

/// The coverage of one metric's intervals for the noisy arm: how many contain the true value, which is the average of
/// the metric over all calls (of its square for a root, of its inverse for an inverse).
std::string coverage(const std::vector<CompareResult>& all, const std::string& metric) {
    const bool root = metric == "rmse", inverse = metric == "efficiency";
    double sum = 0;
    std::uint64_t values = 0, stated = 0, containing = 0;
    for (const CompareResult& r : all) {
        const MetricValue& m = r.arms[0].region(whole_frame).metric(metric);
        if (!m.value) continue;
        sum += root ? *m.value * *m.value : inverse ? 1 / *m.value : *m.value;
        ++values;
    }
    if (!values) return "–";
    const double mean = sum / static_cast<double>(values), truth = root ? std::sqrt(mean) : inverse ? 1 / mean : mean;
    for (const CompareResult& r : all) {
        const MetricValue& m = r.arms[0].region(whole_frame).metric(metric);
        if (!m.interval) continue;
        ++stated;
        containing += m.interval->first <= truth && truth <= m.interval->second;
    }
    if (!stated) return "–";
    const std::string share = fmt::format("{:.3f}", static_cast<double>(containing) / static_cast<double>(stated));
    return stated == values ? share : fmt::format("{}/{}", share, stated);
}

/// The noise of the first arm, "" below a line of the same.
std::string kind_if_new(const std::vector<Calls>& scenes, const Calls& c) {
    const std::string kind = to_string(c.scene.a);
    return &c != scenes.data() && to_string((&c - 1)->scene.a) == kind ? "" : kind;
}

std::string false_alarms(const std::vector<Calls>& scenes) {
    std::string out =
        "| noise | renders | all calls | calls in which each arm contains its rare events | others | heavy tail |\n"
        "|---|---|---|---|---|---|\n";
    for (const Calls& c : scenes) {
        std::uint64_t with_events = 0, alarms = 0;
        for (std::size_t k = 0; k < c.have_events.size(); ++k)
            if (c.have_events[k]) {
                ++with_events;
                alarms += c.results[k].differs();
            }
        const std::uint64_t of = c.results.size(), found_differences = count(c.results, differs);
        out += fmt::format("| {} | {} | {} | {} | {} | {} |\n", kind_if_new(scenes, c), c.scene.renders,
            rate_cell(found_differences, of),
            with_events == of ? "all"
                : with_events ? rate_cell(alarms, with_events)
                              : "–",
            with_events == of ? "–" : fmt::format("{} of {}", found_differences - alarms, of - with_events),
            count(c.results, heavy));
    }
    return out;
}

std::string covered(const std::vector<Calls>& scenes) {
    const std::vector<std::string> metrics{
        "y_mean", "var", "rmse", "bias2", "relmse", "mape", "fireflies", "efficiency", "unit_time", "sample_var"};
    std::string out = "| noise | renders |";
    for (const std::string& m : metrics) out += fmt::format(" {} |", m);
    out += "\n|---|---|";
    for (std::size_t k = 0; k < metrics.size(); ++k) out += "---|";
    out += "\n";
    for (const Calls& c : scenes) {
        out += fmt::format("| {} | {} |", kind_if_new(scenes, c), c.scene.renders);
        for (const std::string& m : metrics) out += fmt::format(" {} |", coverage(c.results, m));
        out += "\n";
    }
    return out;
}

constexpr SyntheticNoise moderate{NoiseKind::normal, 0.2}, coarse{NoiseKind::normal, 0.5};

/// Why one column of the table may exceed alpha.
const std::string indistinguishable_text =
    "No test can distinguish an arm whose light comes from bright events that none of its renders contains from a "
    "darker "
    "arm: their renders agree with at least the probability q that no event occurs, so a test that is wrong about one "
    "arm in at most alpha of all calls is right about the other in at most alpha + 1 - q. Such calls are counted "
    "separately. `brightest`, a bound on a pixel of one render, helps.\n\n";

std::vector<Calls> scenes_of(const std::vector<SyntheticNoise>& noises, bool both, const std::vector<int>& renders,
    const std::vector<CompareFlag>& more = {}) {
    std::vector<Calls> out;
    for (const SyntheticNoise& noise : noises)
        for (const int k : renders) out.push_back({{noise, both ? noise : moderate, k, 32, !both, 0, 0}, {}, {}, more});
    return out;
}

/// Each channel has a quarter of its noise of its own; the noise of two channels has a correlation of 0.9.
constexpr double own_share = 0.25;

/// Calls of one kind, and the condition whose rate is a cell of a table.
struct Counted {
    std::string kind;
    const Calls* calls;
    std::function<bool(const CompareResult&)> condition;
};
/// Those rates: a line for each kind, a column for each number of renders.
std::string counts(const std::string& kinds, const std::vector<Counted>& all) {
    std::set<int> renders;
    for (const Counted& c : all) renders.insert(c.calls->scene.renders);
    std::vector<std::string> lines;
    std::map<std::string, std::map<int, std::string>> rates;
    for (const Counted& c : all) {
        if (!rates.contains(c.kind)) lines.push_back(c.kind);
        rates[c.kind][c.calls->scene.renders] =
            rate_cell(count(c.calls->results, c.condition), c.calls->results.size());
    }
    std::string out = fmt::format("| {} |", kinds), rule = "|---|";
    for (const int k : renders) {
        out += fmt::format(" {} renders |", k);
        rule += "---|";
    }
    out += '\n' + rule + '\n';
    for (const std::string& kind : lines) {
        out += fmt::format("| {} |", kind);
        for (const int k : renders) out += fmt::format(" {} |", rates[kind].contains(k) ? rates[kind][k] : "–");
        out += '\n';
    }
    return out;
}

/// Returns the result for the two arms.
const BiasResult& arms_of(const CompareResult& r) {
    return *std::find_if(r.bias.begin(), r.bias.end(), [](const BiasResult& b) { return b.b != the_reference; });
}
bool arms_differ(const CompareResult& r) { return arms_of(r).differs(); }
bool some_seeds_found(const CompareResult& r) { return !arms_of(r).shared.empty(); }
bool all_seeds_found(const CompareResult& r) { return arms_of(r).all_shared; }

std::vector<Counted> lines_of(
    const std::vector<Calls>& scenes, auto first, std::function<bool(const CompareResult&)> condition) {
    std::vector<Counted> out;
    for (const Calls& c : scenes) out.push_back({first(c.scene), &c, condition});
    return out;
}

/// Scenes with gamma noise in colour, equal in both arms except for `change`.
std::vector<Calls> gamma_scenes(const std::vector<double>& sizes, const std::vector<int>& renders, auto change) {
    std::vector<Calls> out;
    for (const double size : sizes)
        for (const int k : renders) {
            SyntheticScene scene{{NoiseKind::gamma, 0.2}, {NoiseKind::gamma, 0.2}, k, 32, false, own_share, 0};
            change(scene, size);
            out.push_back({scene, {}, {}, {}});
        }
    return out;
}

/// The measurements besides those of grey renders with independent seeds.
struct ColourRates {
    std::vector<Calls> alike, bias, hue, failing_alike, failing, same_seeds, some_seeds, other_noise;

    ColourRates() {
        const std::vector<SyntheticNoise> kinds{{NoiseKind::gamma, 0.2}, {NoiseKind::lognormal, 1},
            {NoiseKind::pareto, 2.5}, {NoiseKind::hits, 0.02}, {.kind = NoiseKind::gamma, .size = 0.2, .filter = 4}};
        alike = scenes_of(kinds, true, {4, 16});
        for (Calls& c : alike) c.scene.own = own_share;
        bias = gamma_scenes({0.01, 0.02}, {4, 8, 16}, [](SyntheticScene& w, double size) { w.b.bias = size; });
        hue = gamma_scenes({0.0025, 0.005, 0.01}, {4, 8, 16}, [](SyntheticScene& w, double size) { w.b.hue = size; });
        failing_alike = gamma_scenes(
            {1e-4, 1e-2}, {4, 16}, [](SyntheticScene& w, double size) { w.a.failing = w.b.failing = size; });
        failing = gamma_scenes({1e-3, 1e-2}, {4, 16}, [](SyntheticScene& w, double size) { w.b.failing = size; });
        const auto shared = [](SyntheticScene& w, double size) {
            w.b.bias = size;
            w.shared = w.renders;
        };
        same_seeds = gamma_scenes({0.001, 0.002}, {4, 8}, shared);
        some_seeds = gamma_scenes({0}, {4, 8}, [](SyntheticScene& w, double) { w.shared = w.renders / 2; });
        for (const auto& [a, b] :
            {std::pair(SyntheticNoise{NoiseKind::normal, 0.2}, SyntheticNoise{NoiseKind::normal, 0.3}),
                {SyntheticNoise{NoiseKind::lognormal, 0.5}, SyntheticNoise{NoiseKind::lognormal, 1}}})
            for (const int k : {4, 8, 16}) other_noise.push_back({{a, b, k, 32, false, own_share, k}, {}, {}, {}});
    }
    std::vector<std::vector<Calls>*> all() {
        return {&alike, &bias, &hue, &failing_alike, &failing, &same_seeds, &some_seeds, &other_noise};
    }
    std::string text() const;
};

std::string ColourRates::text() const {
    const auto kind = [](const SyntheticScene& w) { return to_string(w.a); };
    const auto percent_of = [](double SyntheticNoise::* of) {
        return [of](const SyntheticScene& w) { return fmt::format("{:g} %", 100 * (w.b.*of)); };
    };
    const auto chance = [](const SyntheticScene& w) { return fmt::format("{:g}", w.b.failing); };
    std::string out =
        "### In colour\n\nTwo arms, no reference. Three quarters of a channel's noise are common to all three, a "
        "quarter "
        "is its own: the correlation of two channels is 0.9.\n\nEqual arms:\n\n";
    out += counts("noise of both", lines_of(alike, kind, arms_differ));
    out += "\nB is brighter by this share, gamma noise of 20 %:\n\n" +
        counts("bias", lines_of(bias, percent_of(&SyntheticNoise::bias), arms_differ));
    out += "\nRed of B is brighter by this share and blue darker by 2.94 times as much, so Y is equal:\n\n" +
        counts("red", lines_of(hue, percent_of(&SyntheticNoise::hue), arms_differ));
    out += "\n### Values that are not finite\n\nA pixel of a render is NaN with this probability in both arms:\n\n" +
        counts("probability", lines_of(failing_alike, chance, arms_differ));
    out += "\nIn B only:\n\n" + counts("probability", lines_of(failing, chance, arms_differ));
    out +=
        "\n### Renders with shared seeds\n\nRenders with independent seeds that are taken for renders with shared "
        "seeds:\n\n" +
        counts("noise of both", lines_of(alike, kind, some_seeds_found));
    std::vector<Counted> seen = lines_of(
        same_seeds, [](const SyntheticScene& w) { return fmt::format("bias {:g} %, all recognised", 100 * w.b.bias); },
        all_seeds_found);
    const auto more = [&](const std::vector<Counted>& lines) { seen.insert(seen.end(), lines.begin(), lines.end()); };
    more(lines_of(
        same_seeds,
        [](const SyntheticScene& w) { return fmt::format("bias {:g} %, a difference is found", 100 * w.b.bias); },
        arms_differ));
    more(lines_of(some_seeds, [](auto&) { return "half of the seeds are shared, some recognised"; }, some_seeds_found));
    more(lines_of(
        some_seeds, [](auto&) { return "half of the seeds are shared, all taken for shared"; }, all_seeds_found));
    more(
        lines_of(some_seeds, [](auto&) { return "half of the seeds are shared, a difference is found"; }, arms_differ));
    const auto pair = [](const char* what) {
        return [what](const SyntheticScene& w) {
            return fmt::format("{} and {}, equal means, {}", to_string(w.a), to_string(w.b), what);
        };
    };
    more(lines_of(other_noise, pair("all recognised"), all_seeds_found));
    more(lines_of(other_noise, pair("a difference is found"), arms_differ));
    return out + "\nThe same seeds in another order; gamma noise of 20 % unless stated otherwise:\n\n" +
        counts("", seen);
}

std::string powers(const std::vector<Calls>& biased) {
    std::string out = "| bias | renders | found | stated without bias |\n|---|---|---|---|\n";
    for (const Calls& c : biased) {
        double smallest = 0;
        for (const CompareResult& r : c.results)
            smallest += r.bias[1].regions.back().smallest / static_cast<double>(c.results.size());
        out += fmt::format("| {:g} % | {} | {} | {:.2g} % |\n", 100 * c.scene.b.bias, c.scene.renders,
            rate_cell(count(c.results, [](const CompareResult& r) { return r.bias[1].differs(); }), c.results.size()),
            100 * smallest);
    }
    return out;
}

/// The section as Markdown. `repeats`: calls for each kind of noise; equal arguments give equal text.
std::string error_rates(std::uint32_t repeats, std::uint32_t seed, ProgressMonitor& monitor) {
    const std::vector<int> few_and_many{4, 16};
    const std::vector<SyntheticNoise> chosen{coarse, {NoiseKind::lognormal, 1}, {NoiseKind::events, 0.01},
        {NoiseKind::events, 1e-3}, {NoiseKind::events, 1e-4}};
    const std::vector<SyntheticNoise> held_out{{NoiseKind::pareto, 2.5}, {NoiseKind::pareto, 1.5},
        {NoiseKind::hits, 0.02}, {NoiseKind::sparks, 0.02}, {NoiseKind::sparks, 2e-3}};
    std::vector<Calls> right = scenes_of(chosen, false, few_and_many), other = scenes_of(held_out, false, few_and_many),
                       alike =
                           scenes_of({{NoiseKind::lognormal, 1}, {NoiseKind::events, 1e-3}, {NoiseKind::events, 1e-4},
                                         {NoiseKind::pareto, 1.5}, {NoiseKind::hits, 0.02}, {NoiseKind::sparks, 2e-3}},
                               true, few_and_many),
                       bounded = scenes_of({{NoiseKind::events, 1e-4}, {NoiseKind::sparks, 2e-3}}, false, few_and_many,
                           {{{"brightest"}, "10000", true, ""}});
    std::vector<Calls> biased;
    for (const double bias : {0.01, 0.02, 0.05})
        for (const int renders : {4, 8, 16})
            biased.push_back({{coarse, {NoiseKind::normal, 0.2, bias}, renders, 32, true, 0, 0}, {}, {}, {}});
    ColourRates colour;
    std::vector<std::vector<Calls>*> all{&right, &other, &alike, &bounded, &biased};
    for (std::vector<Calls>* scenes : colour.all()) all.push_back(scenes);
    std::size_t kinds = 0;
    for (const auto* scenes : all) kinds += scenes->size();
    monitor.begin("comparisons", static_cast<double>(repeats) * static_cast<double>(kinds));
    for (auto* scenes : all)
        for (Calls& c : *scenes) call(c, repeats, seed, monitor);
    std::string out = fmt::format(
        "{} calls each, with two arms of 32 x 32 pixels and mean 1 and a reference without error: three comparisons "
        "per call, which share alpha = 0.05. Cells are the calls in which a difference is found, with the 95 % "
        "interval of their rate.\n\n",
        repeats);
    out += "### False alarms\n\n" + indistinguishable_text;
    out += "Kinds of noise of A with which the rules were chosen; that of B is normal, 20 %:\n\n" + false_alarms(right);
    out += "\nOther kinds of noise:\n\n" + false_alarms(other);
    out += "\nTwo arms with the same noise, as in two versions of a renderer, without a reference:\n\n" +
        false_alarms(alike);
    out += "\nWith `brightest = 10000`, a bound on a pixel of one render:\n\n" + false_alarms(bounded);
    out +=
        "\n### Power\n\nB is brighter by this share everywhere; the noise of a pixel is 20 % in B "
        "and 50 % in A.\n\n" +
        powers(biased) + "\n" + colour.text();
    out +=
        "\n### Coverage of 95 % intervals\n\nStudent's t over renders, bias2 by the jackknife; for arm A, over the "
        "frame. 0.900/10: of the 10 calls that state an interval; after a heavy tail there is none.\n\n";
    right.insert(right.end(), other.begin(), other.end());
    return out + covered(right);
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"Measures crescent compare on synthetic renders."};
    std::uint32_t calls = 100, seed = 1;
    app.add_option("--calls", calls, "of each kind of noise")->capture_default_str();
    app.add_option("--seed", seed, "of their noise")->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    ProgressMonitor monitor;
    const std::string text = error_rates(calls, seed, monitor);
    fmt::print(
        "\n## Error rates of compare\n\nTo reproduce:\n\n"
        "```sh\nninja -C build crescent_compare_rates && build/tests/calibration/crescent_compare_rates --calls {} "
        "--seed {}\n```\n\nNot run in the tests: needs minutes of every core.\n\n{}",
        calls, seed, text);
}
