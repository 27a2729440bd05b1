// compare is called on renders that made.cpp draws, `repeats` times a kind, each call from its own seed; what it says
// is counted. The truth of a meter is its mean over all calls of the kind. Rates with exact binomial intervals.
#include "compare/rates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/parallel.h"
#include "compare/made.h"
#include "compare/schema.h"
#include "simd/random.h"
#include "stats/rates.h"

namespace crescent::inline comparing {

namespace {

using Kind = MadeNoise::Kind;

const std::vector<CompareFlag> costs{
    {{"arms", "a", "seconds"}, "2", true, "seconds"}, {{"arms", "a", "spp"}, "16", true, "spp"}};

/// Calls of one kind: what came out, and in which of them some render of arm a met what is rare in it.
struct Calls {
    MadeWorld world;
    std::vector<CompareResult> results;
    std::vector<bool> met;
    std::vector<CompareFlag> more;
};

void call(Calls& to, std::uint32_t repeats, std::uint32_t seed, ProgressMonitor& monitor) {
    std::vector<CompareFlag> flags = costs;
    flags.insert(flags.end(), to.more.begin(), to.more.end());
    to.results.resize(repeats);
    parallel_for(std::uint32_t{0}, repeats, [&](std::uint32_t k) {
        monitor.check();
        to.results[k] = compare_made(to.world, seed_of(seed, k), flags);
        monitor.advance(1);
    });
    for (std::uint32_t k = 0; k < repeats; ++k) to.met.push_back(met_events(to.world, seed_of(seed, k)));
}

template <class Is> std::uint64_t count(const std::vector<CompareResult>& all, Is is) {
    return static_cast<std::uint64_t>(std::count_if(all.begin(), all.end(), is));
}

bool differs(const CompareResult& r) { return r.differs(); }
/// Some mean was not tested, or not judged, because of a heavy tail.
bool heavy(const CompareResult& r) {
    const auto said = [](const MeanTest& t) {
        return t.why.starts_with("heavy tail") || t.doubt.starts_with("heavy tail");
    };
    return std::any_of(r.bias.begin(), r.bias.end(),
        [&](const BiasResult& b) { return std::any_of(b.regions.begin(), b.regions.end(), said); });
}

/// The noisy arm's intervals of one meter: how many there were, and how many held the truth, which is what the meter is
/// on average over all calls (under the root where the meter is one, of the inverse where it is one).
std::string coverage(const std::vector<CompareResult>& all, const std::string& meter) {
    const bool root = meter == "rmse", inverse = meter == "efficiency";
    double sum = 0;
    std::uint64_t values = 0, stated = 0, held = 0;
    for (const CompareResult& r : all) {
        const MeterValue& m = r.arms[0].region(whole_frame).meter(meter);
        if (!m.value) continue;
        sum += root ? *m.value * *m.value : inverse ? 1 / *m.value : *m.value, ++values;
    }
    if (!values) return "–";
    const double mean = sum / static_cast<double>(values), truth = root ? std::sqrt(mean) : inverse ? 1 / mean : mean;
    for (const CompareResult& r : all) {
        const MeterValue& m = r.arms[0].region(whole_frame).meter(meter);
        if (!m.interval) continue;
        ++stated, held += m.interval->first <= truth && truth <= m.interval->second;
    }
    if (!stated) return "none stated";
    const std::string share = fmt::format("{:.3f}", static_cast<double>(held) / static_cast<double>(stated));
    return stated == values ? share : fmt::format("{} of {} stated", share, stated);
}

std::string false_alarms(const std::vector<Calls>& worlds) {
    std::string out =
        "| noise of A | of B | renders | calls with a difference found | of calls in which each arm contains its "
        "rare events | of the others | heavy tail reported |\n|---|---|---|---|---|---|---|\n";
    for (const Calls& c : worlds) {
        std::uint64_t met = 0, alarms = 0;
        for (std::size_t k = 0; k < c.met.size(); ++k)
            if (c.met[k]) ++met, alarms += c.results[k].differs();
        const std::uint64_t of = c.results.size(), told = count(c.results, differs);
        out += fmt::format("| {} | {} | {} | {} | {} | {} | {} of {} |\n", to_string(c.world.a), to_string(c.world.b),
            c.world.renders, rate_text(told, of),
            met == of ? "all"
                : met ? rate_text(alarms, met)
                      : "–",
            met == of ? "–" : fmt::format("{} of {}", told - alarms, of - met), count(c.results, heavy), of);
    }
    return out;
}

std::string covered(const std::vector<Calls>& worlds) {
    const std::vector<std::string> meters{
        "y_mean", "var", "rmse", "bias2", "relmse", "mape", "fireflies", "efficiency", "unit_time", "sample_var"};
    std::string out = "| noise | renders |";
    for (const std::string& m : meters) out += fmt::format(" {} |", m);
    out += "\n|---|---|";
    for (std::size_t k = 0; k < meters.size(); ++k) out += "---|";
    out += "\n";
    for (const Calls& c : worlds) {
        out += fmt::format("| {} | {} |", to_string(c.world.a), c.world.renders);
        for (const std::string& m : meters) out += fmt::format(" {} |", coverage(c.results, m));
        out += "\n";
    }
    return out;
}

constexpr MadeNoise normal{Kind::normal, 0.2}, coarse{Kind::normal, 0.5};

/// Why one column of the table is not at most alpha.
const std::string no_test_can =
    "If the light of an arm comes from bright events that none of its renders contains, its renders equal those of a "
    "darker arm, and no test can distinguish the two. (Their renders agree with at least the probability q that no "
    "event occurs, so a test that is wrong about one arm in at most alpha of all calls is right about the other in at "
    "most alpha + 1 - q.) Such calls are counted separately. Only knowledge from elsewhere helps, such as `brightest`, "
    "a bound on a pixel of one render.\n\n";

std::vector<Calls> worlds_of(const std::vector<MadeNoise>& noises, bool both, const std::vector<int>& renders,
    const std::vector<CompareFlag>& more = {}) {
    std::vector<Calls> out;
    for (const MadeNoise& noise : noises)
        for (const int k : renders) out.push_back({{noise, both ? noise : normal, k, 32, !both, 0, 0}, {}, {}, more});
    return out;
}

/// The same in colour, each channel with a quarter of its noise of its own: their noise correlates by 0.9.
constexpr double own_share = 0.25;

/// How often a call does what `is` says, a line each; `first` columns say what the world is.
struct Counted {
    std::string first;
    const Calls* calls;
    std::function<bool(const CompareResult&)> is;
};
std::string counts(const std::string& head, const std::vector<Counted>& lines) {
    std::string out = head;
    for (const Counted& l : lines)
        out += fmt::format("| {} | {} | {} |\n", l.first, l.calls->world.renders,
            rate_text(count(l.calls->results, l.is), l.calls->results.size()));
    return out;
}

/// Between the two arms.
const BiasResult& arms_of(const CompareResult& r) {
    return *std::find_if(r.bias.begin(), r.bias.end(), [](const BiasResult& b) { return b.b != the_reference; });
}
bool arms_differ(const CompareResult& r) { return arms_of(r).differs(); }
bool seeds_seen(const CompareResult& r) { return !arms_of(r).shared.empty(); }
bool all_seeds_seen(const CompareResult& r) { return arms_of(r).all_shared; }

std::vector<Counted> lines_of(
    const std::vector<Calls>& worlds, auto first, std::function<bool(const CompareResult&)> is) {
    std::vector<Counted> out;
    for (const Calls& c : worlds) out.push_back({first(c.world), &c, is});
    return out;
}

/// Both arms alike but for `change`, of gamma noise in colour.
std::vector<Calls> gamma_worlds(const std::vector<double>& sizes, const std::vector<int>& renders, auto change) {
    std::vector<Calls> out;
    for (const double size : sizes)
        for (const int k : renders) {
            MadeWorld world{{Kind::gamma, 0.2}, {Kind::gamma, 0.2}, k, 32, false, own_share, 0};
            change(world, size);
            out.push_back({world, {}, {}, {}});
        }
    return out;
}

/// What is measured beside grey renders of independent seeds.
struct ColourRates {
    std::vector<Calls> alike, bias, hue, failing_alike, failing, same_seeds, some_seeds, other_noise;

    ColourRates() {
        const std::vector<MadeNoise> kinds{{Kind::gamma, 0.2}, {Kind::lognormal, 1}, {Kind::pareto, 2.5},
            {Kind::hits, 0.02}, {.kind = Kind::gamma, .size = 0.2, .filter = 4}};
        alike = worlds_of(kinds, true, {4, 16});
        for (Calls& c : alike) c.world.own = own_share;
        bias = gamma_worlds({0.01, 0.02}, {4, 8, 16}, [](MadeWorld& w, double size) { w.b.bias = size; });
        hue = gamma_worlds({0.0025, 0.005, 0.01}, {4, 8, 16}, [](MadeWorld& w, double size) { w.b.hue = size; });
        failing_alike =
            gamma_worlds({1e-4, 1e-2}, {4, 16}, [](MadeWorld& w, double size) { w.a.failing = w.b.failing = size; });
        failing = gamma_worlds({1e-3, 1e-2}, {4, 16}, [](MadeWorld& w, double size) { w.b.failing = size; });
        const auto shared = [](MadeWorld& w, double size) { w.b.bias = size, w.shared = w.renders; };
        same_seeds = gamma_worlds({0.001, 0.002}, {4, 8}, shared);
        some_seeds = gamma_worlds({0}, {4, 8}, [](MadeWorld& w, double) { w.shared = w.renders / 2; });
        for (const auto& [a, b] : {std::pair(MadeNoise{Kind::normal, 0.2}, MadeNoise{Kind::normal, 0.3}),
                 {MadeNoise{Kind::lognormal, 0.5}, MadeNoise{Kind::lognormal, 1}}})
            for (const int k : {4, 8, 16}) other_noise.push_back({{a, b, k, 32, false, own_share, k}, {}, {}, {}});
    }
    std::vector<std::vector<Calls>*> all() {
        return {&alike, &bias, &hue, &failing_alike, &failing, &same_seeds, &some_seeds, &other_noise};
    }
    std::string text() const;
};

std::string ColourRates::text() const {
    const auto kind = [](const MadeWorld& w) { return to_string(w.a); };
    const auto percent_of = [](double MadeNoise::* of) {
        return [of](const MadeWorld& w) { return fmt::format("{:g} %", 100 * (w.b.*of)); };
    };
    const auto chance = [](const MadeWorld& w) { return fmt::format("{:g}", w.b.failing); };
    std::string out =
        "### In colour\n\nTwo arms, no reference. Three quarters of a channel's noise are common to all three, a "
        "quarter "
        "is its own: the correlation of two channels is 0.9.\n\nEqual arms:\n\n";
    out += counts("| noise of both | renders | calls with a difference found |\n|---|---|---|\n",
        lines_of(alike, kind, arms_differ));
    out += "\nB is brighter by this share, gamma noise of 20 %:\n\n" +
        counts(
            "| bias | renders | found |\n|---|---|---|\n", lines_of(bias, percent_of(&MadeNoise::bias), arms_differ));
    out += "\nRed of B is brighter by this share and blue darker by 2.94 times as much, so Y is equal:\n\n" +
        counts("| red | renders | found |\n|---|---|---|\n", lines_of(hue, percent_of(&MadeNoise::hue), arms_differ));
    out += "\n### Values that are not finite\n\nA pixel of a render is NaN with this probability in both arms:\n\n" +
        counts("| probability | renders | calls with a difference found |\n|---|---|---|\n",
            lines_of(failing_alike, chance, arms_differ));
    out += "\nIn B only:\n\n" +
        counts("| probability | renders | found |\n|---|---|---|\n", lines_of(failing, chance, arms_differ));
    out +=
        "\n### Renders with shared seeds\n\nRenders with independent seeds that are taken for renders with shared "
        "seeds:\n\n" +
        counts("| noise of both | renders | calls that take any two renders for such |\n|---|---|---|\n",
            lines_of(alike, kind, seeds_seen));
    const std::string head = "| | renders | calls |\n|---|---|---|\n";
    std::vector<Counted> seen = lines_of(
        same_seeds, [](const MadeWorld& w) { return fmt::format("bias {:g} %, all recognised", 100 * w.b.bias); },
        all_seeds_seen);
    const auto more = [&](const std::vector<Counted>& lines) { seen.insert(seen.end(), lines.begin(), lines.end()); };
    more(lines_of(
        same_seeds,
        [](const MadeWorld& w) { return fmt::format("bias {:g} %, a difference is found", 100 * w.b.bias); },
        arms_differ));
    more(lines_of(some_seeds, [](auto&) { return "half of the seeds are shared, some recognised"; }, seeds_seen));
    more(lines_of(
        some_seeds, [](auto&) { return "half of the seeds are shared, all taken for shared"; }, all_seeds_seen));
    more(
        lines_of(some_seeds, [](auto&) { return "half of the seeds are shared, a difference is found"; }, arms_differ));
    const auto pair = [](const char* what) {
        return [what](const MadeWorld& w) {
            return fmt::format("{} and {}, equal means, {}", to_string(w.a), to_string(w.b), what);
        };
    };
    more(lines_of(other_noise, pair("all recognised"), all_seeds_seen));
    more(lines_of(other_noise, pair("a difference is found"), arms_differ));
    return out + "\nThe same seeds in another order; gamma noise of 20 % unless stated otherwise:\n\n" +
        counts(head, seen);
}

std::string powers(const std::vector<Calls>& biased) {
    std::string out =
        "| bias | renders | found | smallest difference that would be found, as stated without bias "
        "|\n|---|---|---|---|\n";
    for (const Calls& c : biased) {
        double smallest = 0;
        for (const CompareResult& r : c.results)
            smallest += r.bias[1].regions.back().smallest / static_cast<double>(c.results.size());
        out += fmt::format("| {:g} % | {} | {} | {:.2g} % |\n", 100 * c.world.b.bias, c.world.renders,
            rate_text(count(c.results, [](const CompareResult& r) { return r.bias[1].differs(); }), c.results.size()),
            100 * smallest);
    }
    return out;
}

}  // namespace

std::string compare_error_rates(std::uint32_t repeats, std::uint32_t seed, ProgressMonitor& monitor) {
    const std::vector<int> few_and_many{4, 16};
    const std::vector<MadeNoise> chosen{
        coarse, {Kind::lognormal, 1}, {Kind::events, 0.01}, {Kind::events, 1e-3}, {Kind::events, 1e-4}};
    const std::vector<MadeNoise> held_out{
        {Kind::pareto, 2.5}, {Kind::pareto, 1.5}, {Kind::hits, 0.02}, {Kind::sparks, 0.02}, {Kind::sparks, 2e-3}};
    std::vector<Calls> right = worlds_of(chosen, false, few_and_many), other = worlds_of(held_out, false, few_and_many),
                       alike = worlds_of({{Kind::lognormal, 1}, {Kind::events, 1e-3}, {Kind::events, 1e-4},
                                             {Kind::pareto, 1.5}, {Kind::hits, 0.02}, {Kind::sparks, 2e-3}},
                           true, few_and_many),
                       bounded = worlds_of({{Kind::events, 1e-4}, {Kind::sparks, 2e-3}}, false, few_and_many,
                           {{{"brightest"}, "10000", true, ""}});
    std::vector<Calls> biased;
    for (const double bias : {0.01, 0.02, 0.05})
        for (const int renders : {4, 8, 16})
            biased.push_back({{coarse, {Kind::normal, 0.2, bias}, renders, 32, true, 0, 0}, {}, {}, {}});
    ColourRates colour;
    std::vector<std::vector<Calls>*> all{&right, &other, &alike, &bounded, &biased};
    for (std::vector<Calls>* worlds : colour.all()) all.push_back(worlds);
    std::size_t kinds = 0;
    for (const auto* worlds : all) kinds += worlds->size();
    monitor.begin("comparisons", static_cast<double>(repeats) * static_cast<double>(kinds));
    for (auto* worlds : all)
        for (Calls& c : *worlds) call(c, repeats, seed, monitor);
    std::string out = fmt::format(
        "{} calls each, with two arms of 32 x 32 pixels and mean 1 and a reference without error: three comparisons "
        "per call, which share alpha = 0.05.\n\n",
        repeats);
    out += "### False alarms\n\n" + no_test_can;
    out += "Kinds of noise with which the rules were chosen:\n\n" + false_alarms(right);
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
        "frame. If a heavy tail is reported there is no interval.\n\n";
    right.insert(right.end(), other.begin(), other.end());
    return out + covered(right);
}

}  // namespace crescent::inline comparing
