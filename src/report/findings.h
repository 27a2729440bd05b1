// Looks up and compares the numbers of a run: the roles of the arms, the headline run, and sentences made from two
// values, which follow the order of the values.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "metrics/metrics.h"
#include "report/report.h"

namespace crescent {

/// "3.1 times", "the same as", with what was compared; see compare().
struct RatioOfErrors {
    std::string larger, smaller;  // names; in the order given if the values are equal
    double high = 0, low = 0;
    double ratio = 1;  // high / low, >= 1; infinite if low is 0
    bool equal = false;
};
/// Returns which of two errors is larger, and by what factor.
RatioOfErrors compare(const std::string& a, double value_a, const std::string& b, double value_b);

/// The number of seeds with metric(a) > metric(b), and the number of seeds.
struct SeedCount {
    int larger = 0, total = 0;
};

/// Returns the probability that all values of one of two equal arms are above all of the other's, with this many seeds
/// each: how often bands are disjoint by chance.
double chance_of_parted_bands(int seeds);

class Findings {
public:
    explicit Findings(const ReportInputs& in) : in_(in), runs_(in.metrics.runs) {}

    /// Returns the largest n that every arm of `arms` has, 0 if there is none.
    std::uint64_t common_n(const std::vector<const ArmPlan*>& arms) const;
    /// Returns the n at which arms are compared: the experiment's own if an arm ran it, else the largest common to all,
    /// else the largest of the first arm.
    std::uint64_t headline_n() const;

    /// Defaults: the published seed and the experiment's own s.
    const RunMetrics* run(const std::string& arm, std::uint64_t n, std::optional<double> s = {}) const;
    /// Returns null if there is no such run.
    const RunMetrics* run(const RunKey& key) const { return runs_.find(key); }
    const SeedSpread* band(
        const std::string& arm, std::uint64_t n, const std::string& metric, std::optional<double> s = {}) const;
    /// Returns the RMSE in a region at the published seed.
    std::optional<double> rmse(const std::string& arm, std::uint64_t n, const std::string& region) const;
    /// Returns the tail of the region that a metric such as "rmse.H" names; empty for whole-frame metrics.
    std::optional<Tail> tail(const SeedSpread& band) const;
    SeedCount seeds_above(
        const std::string& arm_a, const std::string& arm_b, std::uint64_t n, const std::string& region) const;

    /// Returns the region in which rmse(a)/rmse(b) at n is largest, "" if there is none.
    std::string region_where_worst(const std::string& a, const std::string& b, std::uint64_t n) const;

    /// Returns the warnings of the experiment, and of what was left out of the run.
    std::vector<std::string> warnings() const;
    bool anything_published() const;
    double s() const { return in_.experiment.s(); }
    std::uint64_t bad_samples() const;

private:
    const ReportInputs& in_;
    RunIndex runs_;
};

/// Returns the metrics shown in tables, in their order: rmse.*, var.*, fireflies, ...
std::vector<std::string> headline_metrics(const Experiment& experiment);

}  // namespace crescent
