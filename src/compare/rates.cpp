#include "compare/rates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "compare/made.h"
#include "compare/schema.h"
#include "simd/random.h"
#include "verdicts/error_rates.h"

namespace crescent::inline comparing {

namespace {

using Kind = MadeNoise::Kind;

const std::vector<CompareFlag> costs{
    {{"arms", "a", "seconds"}, "2", true, "seconds"}, {{"arms", "a", "spp"}, "16", true, "spp"}};

std::vector<CompareResult> calls(
    const MadeWorld& world, std::uint32_t repeats, std::uint32_t seed, ProgressMonitor& watch) {
    std::vector<CompareResult> out(repeats);
    parallel_for(std::uint32_t{0}, repeats, [&](std::uint32_t k) {
        watch.check();
        out[k] = compare_made(world, seed_of(seed, k), costs);
        watch.advance(1);
    });
    return out;
}

template <class Is> std::uint64_t count(const std::vector<CompareResult>& all, Is is) {
    return static_cast<std::uint64_t>(std::count_if(all.begin(), all.end(), is));
}

bool told(const CompareResult& r) {
    return std::any_of(r.bias.begin(), r.bias.end(), [](const BiasResult& b) { return b.differs(); });
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

std::string false_alarms(const std::vector<std::pair<MadeWorld, std::vector<CompareResult>>>& worlds) {
    std::string out =
        "| noise of A | of B | renders | calls that tell of a difference (alpha 0.05) | heavy tail said "
        "|\n|---|---|---|---|---|\n";
    for (const auto& [world, all] : worlds)
        out += fmt::format("| {} | {} | {} | {} | {} |\n", to_string(world.a), to_string(world.b), world.renders,
            rate_text(count(all, told), all.size()),
            rate_text(
                count(all, [](const CompareResult& r) { return r.arms[0].region(whole_frame).heavy(); }), all.size()));
    return out;
}

std::string covered(const std::vector<std::pair<MadeWorld, std::vector<CompareResult>>>& worlds) {
    const std::vector<std::string> meters{
        "y_mean", "var", "rmse", "bias2", "relmse", "mape", "fireflies", "efficiency", "unit_time", "sample_var"};
    std::string out = "| noise | renders |";
    for (const std::string& m : meters) out += fmt::format(" {} |", m);
    out += "\n|---|---|";
    for (std::size_t k = 0; k < meters.size(); ++k) out += "---|";
    out += "\n";
    for (const auto& [world, all] : worlds) {
        out += fmt::format("| {} | {} |", to_string(world.a), world.renders);
        for (const std::string& m : meters) out += fmt::format(" {} |", coverage(all, m));
        out += "\n";
    }
    return out;
}

}  // namespace

std::string compare_error_rates(std::uint32_t repeats, std::uint32_t seed, ProgressMonitor& watch) {
    const MadeNoise normal{Kind::normal, 0.2}, coarse{Kind::normal, 0.5}, skewed{Kind::lognormal, 1};
    std::vector<std::pair<MadeWorld, std::vector<CompareResult>>> right, biased;
    for (const MadeNoise& noise :
        {coarse, skewed, MadeNoise{Kind::events, 0.01}, MadeNoise{Kind::events, 1e-3}, MadeNoise{Kind::events, 1e-4}})
        for (const int renders : {4, 16}) right.push_back({{noise, normal, renders, 32}, {}});
    for (const double bias : {0.01, 0.02, 0.05})
        for (const int renders : {4, 8, 16}) biased.push_back({{coarse, {Kind::normal, 0.2, bias}, renders, 32}, {}});
    watch.begin("comparisons", static_cast<double>(repeats) * static_cast<double>(right.size() + biased.size()));
    for (auto* worlds : {&right, &biased})
        for (auto& [world, all] : *worlds) all = calls(world, repeats, seed, watch);
    std::string out = fmt::format(
        "{} calls each, of two arms of 32 x 32 pixels whose mean is 1 and a reference without error: three comparisons "
        "a call.\n\n",
        repeats);
    out += "### How often equal arms are told apart\n\n" + false_alarms(right);
    out +=
        "\n### How often a bias is found\n\nB is brighter by so much everywhere; its noise is 20 %, A's 50 % a "
        "pixel.\n\n"
        "| bias | renders | found | would have been, as calls without it say |\n|---|---|---|---|\n";
    for (const auto& [world, all] : biased) {
        double smallest = 0;
        for (const CompareResult& r : all)
            smallest += r.bias[1].regions.back().smallest / static_cast<double>(all.size());
        out += fmt::format("| {:g} % | {} | {} | {:.2g} % |\n", 100 * world.b.bias, world.renders,
            rate_text(count(all, [](const CompareResult& r) { return r.bias[1].differs(); }), all.size()),
            100 * smallest);
    }
    out +=
        "\n### How often a 95 % interval holds the truth\n\nStudent's t over renders, bias2 by the jackknife; of arm "
        "A, over the frame. Where a heavy tail "
        "is said there is no interval.\n\n" +
        covered(right);
    return out;
}

}  // namespace crescent::inline comparing
