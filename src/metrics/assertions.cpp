// Both sides of an assertion are looked up in the measurements. What was not measured is NaN, and no comparison with
// NaN holds. An RMSE dominated by the reference's own error cannot prove an assertion.
#include "metrics/assertions.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/errors.h"
#include "math/statistics.h"
#include "metrics/metrics.h"
#include "output/format.h"

namespace crescent {

namespace {

double square_of(double x) { return x * x; }

constexpr double unmeasured = std::numeric_limits<double>::quiet_NaN();

double of_run(const ParsedQuantity& q, const RunMetrics* run) {
    if (!run) return unmeasured;
    if (q.region.empty()) return metric_value(*run, q.word);
    const RegionMetrics* region = run->region(q.region);
    if (!region) return unmeasured;
    if (q.word == "tail") return region->tail ? region->tail->k : unmeasured;
    if (q.word == "flip") return region->flip;
    return metric_value(*run, q.word + "." + q.region);
}

double of_furnace(const ParsedQuantity& q, const Metrics& metrics) {
    for (const FurnaceResult& furnace : metrics.furnaces)
        if (furnace.name == q.adapter)
            return q.word == "furnace" ? furnace.measured : std::abs(furnace.measured - furnace.expected);
    return unmeasured;
}

QuantityOf make_adapter(const std::string& word) {
    for (const QuantityWord& quantity : quantity_words())
        if (quantity.word == word) return quantity.adapter;
    throw Bug(std::source_location::current(), "a quantity is parsed before it is looked up");
}

/// find(key): the run of that key, for quantities of one run.
template <class Find> double value_of(const ParsedQuantity& q, const Metrics& metrics, const Experiment& experiment,
    std::uint32_t seed, const PlateBytes& plate_bytes, const Find& find) {
    if (q.number) return *q.number;
    switch (make_adapter(q.word)) {
        case QuantityOf::none: return static_cast<double>(metrics.geometry_pixels);
        case QuantityOf::run:
            return of_run(
                q, find(RunKey{.arm = q.adapter, .n = q.n, .s = q.s > 0 ? q.s : experiment.s(), .seed = seed}));
        case QuantityOf::furnace: return of_furnace(q, metrics);
        case QuantityOf::compared: break;
        case QuantityOf::shape: {
            const auto it = metrics.shape_pixels.find(q.adapter);
            return it == metrics.shape_pixels.end() ? 0 : static_cast<double>(it->second);
        }
        case QuantityOf::region: {
            const Region* region = experiment.find_region(q.adapter);
            if (!region) return unmeasured;
            if (region->surface == any_surface) return static_cast<double>(region->box.width()) * region->box.height();
            const RegionMetrics* m = metrics.runs.empty() ? nullptr : metrics.runs.front().region(q.adapter);
            return m ? static_cast<double>(m->pixels) : unmeasured;
        }
        case QuantityOf::plate: {
            const auto it = plate_bytes.find(q.adapter);
            return it == plate_bytes.end() ? 0 : static_cast<double>(it->second);
        }
    }
    return unmeasured;
}

/// "its error is 0.1, at most 0.03125 is needed, ...": why an RMSE is not large against the reference's own error in
/// its region, and what to change; "" if it is large, or is no RMSE.
std::string fault_of_reference(
    const ParsedQuantity& q, double value, const Metrics& metrics, const Experiment& experiment) {
    if (q.word != "rmse") return "";
    const double s = q.s > 0 ? q.s : experiment.s();
    const ReferencePlan& reference = experiment.reference;
    const auto need_of = [](std::uint64_t samples, double factor) {  // an experiment takes at most 2^24 samples
        const double sample_count = std::ceil(static_cast<double>(samples) * factor);
        return sample_count < 0x1p24 ? fmt::format("about {:.0f} is needed", sample_count)
                                     : "more than can be set is needed";
    };
    if (reference.kind == ReferenceKind::paired) {
        const double limit = most_error_share * most_error_share * value * value;
        double error = 0;  // half of the 95 % interval of the mean squared error
        for (const RunMetrics& run : metrics.runs)
            if (const RegionMetrics* region = run.region(q.region);
                region && run.key.arm == q.adapter && run.key.n == q.n && run.key.s == s)
                error = std::max(error, 1.96 * region->mse_error);
        if (!(error > limit)) return "";
        const std::uint64_t n = reference.n > 0 ? reference.n : paired_samples;
        std::string out = fmt::format(
            "the squared error {} in region {} has the error {}, and at most {} is needed, 1/16 "
            "of it; next: reference.n is {}",
            compact(value * value), q.region, compact(error), compact(limit), n);
        // Its error is that of the mean of n samples.
        return out + (limit > 0 ? ", " + need_of(n, square_of(error / limit)) : ", raise it");
    }
    const bool is_quadrature = reference.kind == ReferenceKind::quadrature;
    for (const ReferenceQuality& r : metrics.references) {
        const double error = (is_quadrature ? r.quadrature_error : r.rms_standard_error).value_or(0);
        const double limit = most_error_share * value;
        if (r.s != s || r.region != q.region || !(error > limit)) continue;
        std::string out = fmt::format(
            "its error in region {} is {}, and at most {} is needed, a quarter of the RMSE {}; next: ", q.region,
            compact(error), compact(limit), compact(value));
        if (is_quadrature)
            return out + "reference.kind = \"paired\", whose error does not add to the RMSE, or a smaller n of the arm";
        const double factor = limit > 0 ? square_of(error / limit) : 0;
        return out +
            (factor > 0
                    ? fmt::format("reference.disk_spp is {}, {}, and lobe_spp is {}, {}", reference.disk_spp,
                          need_of(reference.disk_spp, factor), reference.lobe_spp, need_of(reference.lobe_spp, factor))
                    : "raise reference.disk_spp and reference.lobe_spp");
    }
    return "";
}

/// The values that assertions are compared with.
struct Measurements {
    const Experiment& experiment;
    const Metrics& metrics;
    RunIndex runs;
    const PlateBytes& plate_bytes;
    bool has_plates;  // whether plates were requested

    std::uint32_t own_seed() const { return metrics.series.empty() ? experiment.seed : metrics.series.front(); }
    /// Returns the seeds at which an assertion is evaluated.
    std::vector<std::uint32_t> seeds(bool median) const {
        if (!median || runs.seeds().empty()) return {own_seed()};
        return metrics.series.empty() ? runs.seeds() : metrics.series;
    }
};

bool is_of_a_run(const ParsedQuantity& q) { return !q.number && make_adapter(q.word) == QuantityOf::run; }

/// Returns which seeds of the series an assertion needs and this run does not have; "" if none is missing.
std::string seeds_missing(const AssertionPlan& plan, const Measurements& measurements) {
    const auto& series = measurements.metrics.series;
    if (!is_of_a_run(plan.check.left) && !is_of_a_run(plan.check.right)) return "";
    const auto was_run = [&](std::uint32_t seed) {
        return std::ranges::find(measurements.runs.seeds(), seed) != measurements.runs.seeds().end();
    };
    if (series.empty() || measurements.runs.seeds().empty() ||
        std::ranges::all_of(measurements.seeds(plan.median), was_run))
        return "";
    return plan.median && series.size() > 1 ? "needs seeds 1 to " + std::to_string(series.size()) : "needs seed 1";
}

/// Evaluates one side of an assertion: its value and remarks.
double side(ParsedQuantity q, bool over_seeds, const Measurements& measurements, AssertionResult& out) {
    (void)resolve_quantity(q, measurements.experiment);  // an experiment built in code may omit n
    std::vector<double> values;
    for (const std::uint32_t seed : measurements.seeds(over_seeds))
        values.push_back(value_of(q, measurements.metrics, measurements.experiment, seed, measurements.plate_bytes,
            [&](const RunKey& key) { return measurements.runs.find(key); }));
    const double value = quantile(values, 0.5);
    if (!out.skipped.empty()) return value;
    const std::string fault = fault_of_reference(q, value, measurements.metrics, measurements.experiment);
    if (out.reference_good && !fault.empty()) {
        out.reference_good = false;
        out.reference_fault = fault;
    }
    if (q.number) return value;
    const QuantityOf source = make_adapter(q.word);
    if (!measurements.has_plates && source == QuantityOf::plate) out.skipped = "no plates were drawn";
    if (!measurements.metrics.has_studies && (source == QuantityOf::furnace || q.word == "tail"))
        out.skipped = "tails and furnaces were left out";
    return value;
}

/// "plate_bytes(hero) > 0": always true for a run that completes.
bool cannot_fail(const ParsedQuantity& value, const std::string& op, const ParsedQuantity& right) {
    const bool is_always_positive = value.word == "plate_bytes" || value.word == "region_pixels";
    return !value.number && is_always_positive && right.number && *right.number <= 0 && (op == ">" || op == ">=");
}

}  // namespace

double quantity(const ParsedQuantity& q, const Metrics& metrics, const Experiment& experiment, std::uint32_t seed,
    const PlateBytes& plate_bytes) {
    return value_of(q, metrics, experiment, seed, plate_bytes,
        [&](const RunKey& key) { return metrics.find(key.arm, key.n, key.s, key.seed); });
}

std::vector<AssertionResult> evaluate_assertions(
    const Experiment& experiment, const Metrics& metrics, const PlateBytes& plate_bytes, bool has_plates) {
    const Measurements measurements{.experiment = experiment,
        .metrics = metrics,
        .runs = RunIndex(metrics.runs),
        .plate_bytes = plate_bytes,
        .has_plates = has_plates};
    std::vector<AssertionResult> results;
    for (const AssertionPlan& plan : experiment.assertions) {
        AssertionResult r;
        const auto& [left, right, op] = plan.check;
        r.name = plan.name;
        r.op = op;
        r.skipped = seeds_missing(plan, measurements);
        r.measured = side(left, plan.median, measurements, r);
        r.bound = side(right, plan.median, measurements, r);
        r.cannot_fail = cannot_fail(left, op, right);
        r.pass = r.skipped.empty() && r.reference_good && holds(r.measured, r.op, r.bound);
        r.text = to_string(plan.check) + (plan.median ? " (medians over seeds)" : "");
        if (!r.reference_good) r.text += fmt::format(" (the reference is not good enough: {})", r.reference_fault);
        results.push_back(std::move(r));
    }
    return results;
}

}  // namespace crescent
