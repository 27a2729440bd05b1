// What the numbers of a run say, looked up and compared: which arms play which part, which run is the headline, and
// sentences that are made from two values and so turn round when the values do. Nothing here is typed in.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "metrics/metrics.h"
#include "report/report.h"

namespace crescent::inline report {

/// "3.1 times", "the same as", with what was compared; see compare().
struct RatioOfErrors {
    std::string larger, smaller;  // names; as given where the values are equal
    double high = 0, low = 0;
    double ratio = 1;  // high / low, >= 1; infinite where low is 0
    bool equal = false;
};
/// Which of two errors is larger, and how many times.
RatioOfErrors compare(const std::string& a, double value_a, const std::string& b, double value_b);

/// How many seeds had metric(a) > metric(b), of how many.
struct SeedCount {
    int held = 0, of = 0;
};

/// How often all values of one of two equal arms are above all of the other's, at so many seeds each. Bands of so few
/// seeds lie apart by chance about as often.
double chance_of_parted_bands(int seeds);

class Findings {
public:
    explicit Findings(const ReportInputs& in) : in_(in), runs_(in.metrics.runs) {}

    /// The largest n that every arm of `arms` has, 0 where they share none.
    std::uint64_t common_n(const std::vector<const ArmPlan*>& arms) const;
    /// The n at which arms are set side by side: the experiment's own where one ran it, else common to all, else the
    /// largest of the first arm.
    std::uint64_t headline_n() const;

    /// At the published seed and the experiment's own s unless given.
    const RunMetrics* run(const std::string& arm, std::uint64_t n, std::optional<double> s = {}) const;
    /// Null where there is no such run.
    const RunMetrics* run(const RunKey& key) const { return runs_.find(key); }
    const SeedSpread* band(
        const std::string& arm, std::uint64_t n, const std::string& metric, std::optional<double> s = {}) const;
    /// RMSE in a region at the published seed.
    std::optional<double> rmse(const std::string& arm, std::uint64_t n, const std::string& region) const;
    /// Tail of the region that a metric such as "rmse.H" names; empty for whole-frame metrics.
    std::optional<Tail> tail(const SeedSpread& band) const;
    SeedCount seeds_above(
        const std::string& arm_a, const std::string& arm_b, std::uint64_t n, const std::string& region) const;

    /// Region in which rmse(a)/rmse(b) at n is largest, "" where there is none.
    std::string region_where_worst(const std::string& a, const std::string& b, std::uint64_t n) const;

    bool anything_published() const;
    double s() const { return in_.experiment.s(); }
    std::uint64_t bad_samples() const;

private:
    const ReportInputs& in_;
    RunIndex runs_;
};

/// Metrics that stand in tables, in their order: rmse.*, var.*, fireflies, ...
std::vector<std::string> headline_metrics(const Experiment& experiment);

}  // namespace crescent::inline report
