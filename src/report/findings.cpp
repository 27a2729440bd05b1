// Look-ups by arm, N and s; the defaults of s and seed are the experiment's own. Bands of n seeds of two equal arms are
// disjoint with probability 2 / (2n choose n), at most 1, because every choice of n out of 2n is equally likely.
#include "report/findings.h"

#include <algorithm>
#include <limits>

#include "metrics/metrics.h"

namespace crescent {

RatioOfErrors compare(const std::string& a, double value_a, const std::string& b, double value_b) {
    RatioOfErrors c;
    const bool is_a_larger = value_a >= value_b;
    c.larger = is_a_larger ? a : b;
    c.smaller = is_a_larger ? b : a;
    c.high = is_a_larger ? value_a : value_b;
    c.low = is_a_larger ? value_b : value_a;
    c.equal = value_a == value_b;
    c.ratio = c.equal ? 1 : c.low > 0 ? c.high / c.low : std::numeric_limits<double>::infinity();
    return c;
}

double chance_of_parted_bands(int seeds) {
    double chance = 2;  // 2 / (2n choose n): each choice of n out of 2n values is equally likely
    for (int k = 1; k <= seeds; ++k) chance *= static_cast<double>(k) / (seeds + k);
    return std::min(chance, 1.0);
}

std::uint64_t Findings::common_n(const std::vector<const ArmPlan*>& arms) const {
    if (arms.empty()) return 0;
    const auto has = [](const ArmPlan* arm, std::uint64_t n) {
        return std::find(arm->n.begin(), arm->n.end(), n) != arm->n.end();
    };
    std::uint64_t best = 0;
    for (const std::uint64_t n : arms.front()->n)
        if (std::all_of(arms.begin(), arms.end(), [&](const ArmPlan* arm) { return has(arm, n); }))
            best = std::max(best, n);
    return best;
}

std::uint64_t Findings::headline_n() const {
    const std::uint64_t planned_n = in_.experiment.n;
    for (const ArmPlan& arm : in_.experiment.arms)
        if (planned_n > 0 && run(arm.name, planned_n)) return planned_n;
    std::vector<const ArmPlan*> arms;
    for (const ArmPlan& arm : in_.experiment.arms) arms.push_back(&arm);
    if (const std::uint64_t n = common_n(arms)) return n;
    return arms.empty() || arms.front()->n.empty() ? 0 : arms.front()->n.back();
}

const RunMetrics* Findings::run(const std::string& arm, std::uint64_t n, std::optional<double> s) const {
    return runs_.find({.arm = arm, .n = n, .s = s.value_or(this->s()), .seed = in_.experiment.seed});
}

const SeedSpread* Findings::band(
    const std::string& arm, std::uint64_t n, const std::string& metric, std::optional<double> s) const {
    const double exponent = s.value_or(this->s());
    for (const SeedSpread& b : in_.metrics.bands)
        if (b.metric == metric && b.key.arm == arm && b.key.n == n && b.key.s == exponent) return &b;
    return nullptr;
}

std::optional<double> Findings::rmse(const std::string& arm, std::uint64_t n, const std::string& region) const {
    const RunMetrics* run_metrics = run(arm, n);
    const RegionMetrics* metric = run_metrics ? run_metrics->region(region) : nullptr;
    return metric ? std::optional(metric->rmse) : std::nullopt;
}

std::optional<Tail> Findings::tail(const SeedSpread& band) const {
    const auto dot = band.metric.find('.');
    const RunMetrics* run_metrics = dot == std::string::npos ? nullptr : run(band.key.arm, band.key.n, band.key.s);
    const RegionMetrics* metric = run_metrics ? run_metrics->region(band.metric.substr(dot + 1)) : nullptr;
    return metric ? metric->tail : std::nullopt;
}

SeedCount Findings::seeds_above(
    const std::string& arm_a, const std::string& arm_b, std::uint64_t n, const std::string& region) const {
    SeedCount count;
    for (const RunMetrics& a : in_.metrics.runs) {
        if (a.key.arm != arm_a || a.key.n != n || a.key.s != s()) continue;
        const RunMetrics* b = runs_.find({.arm = arm_b, .n = n, .s = s(), .seed = a.key.seed});
        const RegionMetrics *in_a = a.region(region), *in_b = b ? b->region(region) : nullptr;
        if (!in_a || !in_b) continue;
        ++count.total;
        if (in_a->rmse > in_b->rmse) ++count.larger;
    }
    return count;
}

std::string Findings::region_where_worst(const std::string& a, const std::string& b, std::uint64_t n) const {
    std::string worst;
    double largest = 0;
    for (const Region& region : in_.experiment.regions) {
        const auto rmse_a = rmse(a, n, region.name), rmse_b = rmse(b, n, region.name);
        if (!rmse_a || !rmse_b) continue;
        const double ratio = *rmse_b > 0 ? *rmse_a / *rmse_b : std::numeric_limits<double>::infinity();
        if (worst.empty() || ratio > largest) {
            worst = region.name;
            largest = ratio;
        }
    }
    return worst;
}

std::vector<std::string> Findings::warnings() const {
    std::vector<std::string> out = warnings_of(in_.experiment);
    if (!in_.metrics.has_studies && in_.experiment.seeds > 1)
        out.emplace_back("tails were left out: intervals of heavy tails are not marked");
    return out;
}

bool Findings::anything_published() const {
    const auto has = [](const auto& x) { return x.published.has_value(); };
    const Metrics& m = in_.metrics;
    return std::any_of(m.bands.begin(), m.bands.end(), has) || std::any_of(m.furnaces.begin(), m.furnaces.end(), has);
}

std::uint64_t Findings::bad_samples() const {
    std::uint64_t bad = 0;
    for (const RunMetrics& run : in_.metrics.runs) bad += run.bad;
    for (const FurnaceResult& furnace : in_.metrics.furnaces) bad += furnace.bad;
    return bad;
}

std::vector<std::string> headline_metrics(const Experiment& experiment) {
    std::vector<std::string> metrics;
    const bool combined = std::ranges::any_of(experiment.arms, &ArmPlan::is_combination);
    for (const MetricName& metric : metric_names(experiment))
        if (metric.info->in_tables && (combined || !metric.info->of_combinations)) metrics.push_back(metric.name);
    return metrics;
}

}  // namespace crescent
