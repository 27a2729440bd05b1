// Who is better, where: arms in the order of a meter, and which neighbours in that order are told apart by their
// intervals. Ladders: one arm at several samples a pixel.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "compare/judge.h"
#include "math/functions.h"
#include "pages/numbers.h"

namespace crescent::inline comparing {

namespace {

struct Measure {
    const char* meter;
    const char* words;
};
/// The first that every arm of a region has is what it is ranked by.
constexpr Measure at_equal_time[] = {{"unit_time", "at equal time"}};
constexpr Measure at_equal_samples[] = {{"sample_var", "at equal samples"}, {"var", "render by render"}};

struct Ranked {
    std::string arm;
    MeterValue value;
};

bool apart(const MeterValue& better, const MeterValue& worse) {
    return better.interval && worse.interval && better.interval->second < worse.interval->first;
}

std::string told(const std::vector<Ranked>& order) {
    std::vector<std::string> out;
    for (std::size_t k = 0; k + 1 < order.size(); ++k) {
        const MeterValue &better = order[k].value, &worse = order[k + 1].value;
        if (apart(better, worse))
            out.push_back(fmt::format("{} before {} ({} times the variance)", order[k].arm, order[k + 1].arm,
                figures(*worse.value / *better.value, 3)));
        else out.push_back(fmt::format("{} and {} not told apart", order[k].arm, order[k + 1].arm));
    }
    return fmt::format("{}", fmt::join(out, "; "));
}

std::optional<Ranking> ranking(const CompareResult& result, std::size_t region, const Measure& by) {
    std::vector<Ranked> order;
    for (const ArmResult& arm : result.arms) {
        const MeterValue& value = arm.regions[region].meter(by.meter);
        if (!value.value) return {};
        order.push_back({arm.name, value});
    }
    std::sort(order.begin(), order.end(), [](const Ranked& a, const Ranked& b) {
        return *a.value.value != *b.value.value ? *a.value.value < *b.value.value : a.arm < b.arm;
    });
    Ranking out;
    out.region = result.arms[0].regions[region].region, out.measure = by.words;
    for (const Ranked& r : order) out.order.push_back(r.arm);
    out.sentence = fmt::format("In {}, {}: {}.", out.region, by.words, told(order));
    return out;
}

}  // namespace

std::vector<Ranking> rank(const CompareResult& result) {
    std::vector<Ranking> out;
    if (result.arms.size() < 2) return out;
    for (std::size_t r = 0; r < result.arms[0].regions.size(); ++r) {
        for (const auto measures :
            {std::span<const Measure>(at_equal_time), std::span<const Measure>(at_equal_samples)}) {
            for (const Measure& by : measures) {
                std::optional<Ranking> found = ranking(result, r, by);
                if (!found) continue;
                out.push_back(std::move(*found));
                break;
            }
        }
    }
    return out;
}

namespace {

/// "path-64" at 64 samples a pixel is a rung of "path"; "" where a name does not end with its spp.
std::string ladder_name(const ArmResult& arm) {
    const std::string spp = arm.spp ? fmt::format("{:.0f}", *arm.spp) : "";
    if (spp.empty() || !arm.name.ends_with(spp)) return {};
    const std::string rest = arm.name.substr(0, arm.name.size() - spp.size());
    const std::size_t end = rest.find_last_not_of("-_.");
    const bool apart = end != std::string::npos && (end + 1 < rest.size() || !(rest[end] >= '0' && rest[end] <= '9'));
    return apart ? rest.substr(0, end + 1) : "";
}

/// Least squares of the logarithms, each rung's interval carried along: the slope of the line is a sum of weights times
/// logarithms, whose half-widths add in squares.
MeterValue slope_of(const CompareResult& result, const SppLadder& ladder, std::size_t region) {
    std::vector<double> x, y, half;
    for (const std::size_t a : ladder.arms) {
        const RegionResult& r = result.arms[a].regions[region];
        const MeterValue &rmse = r.meter("rmse"), &var = r.meter("var"), &meter = rmse.value ? rmse : var;
        if (!meter.value || !(*meter.value > 0)) return {{}, {}, "a rung has no value"};
        const double root = rmse.value ? 1 : 0.5;
        x.push_back(math::log(*result.arms[a].spp)), y.push_back(root * math::log(*meter.value));
        const bool known = meter.interval && meter.interval->first > 0;
        half.push_back(known ? root * math::log(meter.interval->second / meter.interval->first) / 2 : std::nan(""));
    }
    const double n = static_cast<double>(x.size());
    const double middle = std::accumulate(x.begin(), x.end(), 0.0) / n;
    double squares = 0, slope = 0, doubt = 0;
    for (const double v : x) squares += (v - middle) * (v - middle);
    if (!(squares > 0)) return {{}, {}, "all rungs have the same samples a pixel"};
    for (std::size_t k = 0; k < x.size(); ++k) {
        const double weight = (x[k] - middle) / squares;
        slope += weight * y[k], doubt += weight * weight * half[k] * half[k];
    }
    MeterValue out{slope, {}, std::isnan(doubt) ? "a rung has no interval" : ""};
    if (out.why.empty()) out.interval = {slope - std::sqrt(doubt), slope + std::sqrt(doubt)};
    return out;
}

}  // namespace

MeterValue rung_of(const RegionResult& region) {
    const MeterValue& rmse = region.meter("rmse");
    if (rmse.value) return rmse;
    MeterValue out = region.meter("var");
    const auto root = [](double v) { return std::sqrt(std::max(0.0, v)); };
    if (out.value) out.value = root(*out.value);
    if (out.interval) out.interval = {root(out.interval->first), root(out.interval->second)};
    return out;
}

const char* rung_words(const RegionResult& region) {
    return region.meter("rmse").value ? "RMSE" : "standard deviation";
}

std::vector<SppLadder> ladders_of(const CompareResult& result) {
    std::vector<SppLadder> out;
    for (std::size_t a = 0; a < result.arms.size(); ++a) {
        const ArmResult& arm = result.arms[a];
        const std::string name = ladder_name(arm);
        if (name.empty()) continue;
        auto at = std::find_if(out.begin(), out.end(), [&](const SppLadder& l) { return l.name == name; });
        if (at == out.end()) at = out.insert(at, {name, {}, {}});
        at->arms.push_back(a);
    }
    std::erase_if(out, [](const SppLadder& l) { return l.arms.size() < 2; });
    for (SppLadder& l : out)
        std::sort(l.arms.begin(), l.arms.end(), [&](std::size_t a, std::size_t b) {
            return *result.arms[a].spp != *result.arms[b].spp ? *result.arms[a].spp < *result.arms[b].spp : a < b;
        });
    for (SppLadder& l : out)
        for (std::size_t r = 0; r < result.arms[0].regions.size(); ++r)
            l.slopes.emplace_back(result.arms[0].regions[r].region, slope_of(result, l, r));
    return out;
}

}  // namespace crescent::inline comparing
