// Readings -> meters with their doubt. Intervals are t intervals over renders, 95 %; of the squared bias by the
// jackknife. docs/compare.md has the coverage that was measured.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/judge.h"
#include "meters/tail.h"

namespace crescent {

namespace {

constexpr double heavy_share = 0.5;  // one squared error that is half of their sum decides the mean by itself

using Values = std::vector<double>;

template <class Read> Values over_renders(const ArmReadings& arm, std::size_t region, Read read) {
    Values out;
    for (const auto& render : arm.regions) out.push_back(read(render[region]));
    return out;
}

/// A mean over renders; `transform` rises (sqrt for RMSE).
template <class Transform> MeterValue mean_of(const Values& values, bool heavy, Transform transform) {
    const MeanInterval m = mean_interval(values, confidence);
    MeterValue out{transform(m.mean), {}, ""};
    if (values.size() < 2) out.why = "one render has no interval";
    else if (heavy) out.why = "heavy tail";
    else out.interval = {transform(std::max(0.0, m.low)), transform(m.high)};
    return out;
}

MeterValue plain_mean(const Values& values) {
    const MeanInterval m = mean_interval(values, confidence);
    MeterValue out{m.mean, {}, values.size() < 2 ? "one render has no interval" : ""};
    if (values.size() >= 2) out.interval = {m.low, m.high};
    return out;
}

MeterValue missing(std::string why) { return {{}, {}, std::move(why)}; }

double mean_variance(const MeanFilm& film, const PixelSet& set) {
    double sum = 0;
    for (const std::uint32_t i : set.pixels) sum += film.variance(i);
    return sum / static_cast<double>(set.pixels.size());
}

MeterValue variance(const ArmReadings& arm, const PixelSet& set, std::size_t region, bool heavy) {
    const double k = static_cast<double>(arm.files.size());
    if (arm.files.size() >= 2) {
        Values each = over_renders(arm, region, [&](const RegionReading& r) { return r.spread * k / (k - 1); });
        MeterValue out = mean_of(each, heavy, [](double v) { return v; });
        if (arm.files.size() == 2) out.interval.reset(), out.why = "two renders spread alike: no interval";
        return out;
    }
    const double told = mean_variance(arm.film, set);
    if (std::isnan(told)) return missing("one render without a variance channel has no variance");
    return {told, {}, "as the renderer wrote it; one render has no interval"};
}

/// Mean over pixels of the squared error of the reference itself.
double reference_variance(const ArmReadings& reference, const PixelSet& set) {
    return mean_variance(reference.film, set) / static_cast<double>(reference.film.count);
}

/// Squared bias without the variance: the mean of e_k e_l over pairs of renders, less the reference's own error.
MeterValue squared_bias(const ArmReadings& arm, std::size_t region, double reference, bool heavy) {
    const double k = static_cast<double>(arm.files.size());
    if (arm.files.size() < 2) return missing("bias and variance part from two renders on");
    double sum = 0, squares = 0;
    for (const auto& render : arm.regions) sum += render[region].with_sum, squares += render[region].mse;
    const double own = std::isnan(reference) ? 0 : reference;
    const auto statistic = [&](double all, double each, double n) { return (all - each) / (n * (n - 1)) - own; };
    MeterValue out{statistic(sum, squares, k), {}, ""};
    if (heavy) out.why = "heavy tail";
    else if (arm.files.size() < 3) out.why = "three renders or more have an interval";
    if (!out.why.empty()) return out;
    Values pseudo;
    for (const auto& render : arm.regions) {
        const RegionReading& r = render[region];
        const double without = statistic(sum - 2 * r.with_sum + r.mse, squares - r.mse, k - 1);
        pseudo.push_back(k * *out.value - (k - 1) * without);
    }
    const MeanInterval m = mean_interval(pseudo, confidence);
    out.interval = {*out.value + m.low - m.mean, *out.value + m.high - m.mean};
    return out;
}

MeterValue efficiency(const MeterValue& variance, const std::optional<double>& seconds) {
    if (!seconds) return missing("no render time: give --seconds");
    if (!variance.value || !(*variance.value > 0)) return missing(variance.value ? "the variance is 0" : variance.why);
    MeterValue out{1 / (*variance.value * *seconds), {}, variance.why};
    if (variance.interval && variance.interval->first > 0)
        out.interval = {1 / (variance.interval->second * *seconds), 1 / (variance.interval->first * *seconds)};
    return out;
}

void tail_of(const ArmReadings& arm, std::size_t region, RegionResult& out) {
    out.tail = fit_pooled_tail(std::span<const float>(arm.largest[region]));
    double sum = 0;
    for (const auto& render : arm.regions) sum += render[region].mse > 0 ? render[region].mse : render[region].spread;
    sum *= static_cast<double>(out.pixels);
    if (sum > 0 && !arm.largest[region].empty())
        out.largest_share = static_cast<double>(arm.largest[region].front()) / sum;
}

}  // namespace

const MeterValue& RegionResult::meter(const std::string& name) const {
    static const MeterValue none;
    for (const auto& [key, value] : meters)
        if (key == name) return value;
    return none;
}

bool RegionResult::heavy() const { return (tail && tail->k - 2 * tail->se >= 0.5) || largest_share > heavy_share; }

const RegionResult& ArmResult::region(const std::string& wanted) const {
    const auto it =
        std::find_if(regions.begin(), regions.end(), [&](const RegionResult& r) { return r.region == wanted; });
    ensure(it != regions.end(), "a region that was measured");
    return *it;
}

double reference_error(const Readings& all, std::size_t region) {
    return all.reference ? std::sqrt(reference_variance(*all.reference, all.regions[region])) : std::nan("");
}

RegionResult measure_region(const Readings& all, const ArmReadings& arm, std::size_t region,
    const std::optional<double>& seconds, const std::optional<double>& flip) {
    const PixelSet& set = all.regions[region];
    RegionResult out;
    out.region = set.name, out.pixels = set.pixels.size();
    tail_of(arm, region, out);
    const bool heavy = out.heavy(), referred = all.reference.has_value();
    const auto root = [](double v) { return std::sqrt(v); };
    const auto same = [](double v) { return v; };
    const auto against = [&](const char* name, auto read, auto transform) {
        out.meters.emplace_back(
            name, referred ? mean_of(over_renders(arm, region, read), heavy, transform) : missing("no reference"));
    };
    against("rmse", [](const RegionReading& r) { return r.mse; }, root);
    const MeterValue var = variance(arm, set, region, heavy);
    out.meters.emplace_back("var", var);
    out.meters.emplace_back("bias2",
        referred ? squared_bias(arm, region, reference_variance(*all.reference, set), heavy) : missing("no reference"));
    against("relmse", [](const RegionReading& r) { return r.relmse; }, same);
    against("mape", [](const RegionReading& r) { return r.mape; }, same);
    against("fireflies", [](const RegionReading& r) { return r.fireflies; }, same);
    out.meters.emplace_back(
        "y_mean", plain_mean(over_renders(arm, region, [](const RegionReading& r) { return r.y; })));
    out.meters.emplace_back("flip", flip ? MeterValue{*flip, {}, "of the first render"} : missing("no reference"));
    out.meters.emplace_back("efficiency", efficiency(var, seconds));
    out.power = arm.power[region];
    out.colour = noise_colour(out.power);
    return out;
}

}  // namespace crescent
