// The measurements of a run, as plain data: printed by the report and read by the assertions.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "experiment/assertion.h"
#include "experiment/experiment.h"
#include "experiment/published.h"
#include "math/statistics.h"
#include "render/area_pixels.h"
#include "render/film.h"
#include "render/film_metrics.h"

namespace crescent {

inline constexpr double not_paired = std::numeric_limits<double>::quiet_NaN(), not_measured = not_paired;

#define CRESCENT_FIELD(name, Type) MetricOf<Type> name{};
/// The metrics of one film in one region: a field for each metric of the list.
struct RegionMetrics {
    std::string region;
    CRESCENT_REGION_METRICS(CRESCENT_FIELD)
    std::uint64_t pixels = 0;    // of its area: without an object, geometry pixels and misses count the same
    std::optional<Tail> tail{};  // of the samples X of the region; published seed only
    // Against a paired reference, else NaN: the estimate of the squared error of Y, which may be negative, and its
    // standard error, from that of the reference; the reference's own root mean square error.
    double mse = not_paired, mse_error = not_paired, reference_error = not_paired;
    bool is_paired() const { return mse == mse; }
    double flip = not_measured;  // mean HDR-FLIP against the reference, of the seeds that it is measured of; else NaN
    bool has_flip() const { return flip == flip; }
    /// The 95 % interval of the squared error.
    double mse_low() const { return mse - 1.96 * mse_error; }
    double mse_high() const { return mse + 1.96 * mse_error; }
};

/// The metrics of one film; for the whole frame a field for each metric of the list.
struct RunMetrics {
    RunKey key;
    std::vector<RegionMetrics> regions;
    CRESCENT_FRAME_METRICS(CRESCENT_FIELD)

    /// Returns null if no region has that name.
    const RegionMetrics* region(const std::string& name) const;
};
#undef CRESCENT_FIELD

/// Calls f(name, info, value) for each metric of a region, or of the frame, in the order of the list.
template <class F> void for_each_metric(const RegionMetrics& metrics, F&& f) {
#define CRESCENT_CALL(name, Type) f(std::string_view(#name), Type::info, metrics.name);
    CRESCENT_REGION_METRICS(CRESCENT_CALL)
}
template <class F> void for_each_metric(const RunMetrics& metrics, F&& f) {
    CRESCENT_FRAME_METRICS(CRESCENT_CALL)
#undef CRESCENT_CALL
}

/// Spread of one number over seeds: quantiles 5 %, 50 %, 95 % (linear between order statistics).
struct Band {
    double q05 = 0, median = 0, q95 = 0;
    int seeds = 0;
    bool heavy = false;  // the tail is too heavy for a meaningful interval
};

/// One number of one run over all seeds: "rmse.H" of "cosine n=64 s=32".
struct SeedSpread {
    RunKey key;           // seed: the published one
    std::string metric;   // rmse.<region>, ..., fireflies, ...: see metric_names()
    double measured = 0;  // at the published seed
    Band band;
    std::optional<double> published;
    std::optional<double> published_rank;  // fraction of seeds below the published value
};

/// Least squares of log RMSE against log N at the published seed: RMSE ~ N^slope. Interval: 5-95 % of the same fit over
/// seeds, or the fit's own 90 % with one seed. NaN: no interval, for example if an RMSE is 0, or two sample counts with
/// one seed.
struct Ladder {
    std::string arm, region;
    double s = 0;
    std::vector<std::uint64_t> n;
    std::vector<double> rmse;  // at the published seed
    double slope = 0, low = 0, high = 0;
    bool heavy = false;
};

/// One white furnace: an arm's value, and the expected one.
struct FurnaceResult {
    std::string name, arm, part;
    std::uint64_t n = 0;
    double measured = 0, expected = 0;  // Y
    double se = 0;                      // standard error from the samples
    std::optional<Tail> tail{};
    std::uint64_t bad = 0;
    std::optional<double> published;
};

/// The result of one assertion of the file.
struct AssertionResult {
    std::string name;
    bool pass = false;
    double measured = 0, bound = 0;
    std::string op, text;  // text: "rmse.H(phong, n=64) < rmse.H(cosine, n=64)"
    // False if an RMSE in it is not larger than a few errors of the reference; the assertion then does not pass.
    bool reference_good = true;
    std::string reference_fault{};  // its error, the one that is needed, and what to change; "": it is good
    bool cannot_fail = false;       // true for every run that completes: a plate that was drawn has bytes
    std::string skipped{};          // why it was skipped, so that it neither holds nor fails; "": it was evaluated
    bool failed() const { return !pass && skipped.empty(); }
};

/// The quality of the references in a region at an exponent, and the difference of the article's from the quadrature.
struct ReferenceQuality {
    double s = 0;
    std::string region;
    std::optional<double> rms_difference;      // of Y; here and below: none if the article's was not computed
    std::optional<double> rms_standard_error;  // stated by the article's reference
    std::optional<double> quadrature_error;    // rms of the quadrature's own stated error; none if it was not computed
    std::optional<double>
        max_relative_rmse_change;  // largest relative change of any arm's RMSE if the article's reference is used
    // Of the reference that the metrics use: its own error over the smallest RMSE here. Of a paired one, whose error
    // does not add to an RMSE: the root of the half width of the interval of the squared error over it. In squares,
    // both are the part of the mean squared error that may be the reference's.
    double error_share = 0;
    std::optional<double> paired_error{};  // rms of a paired reference's own error
};

/// The largest share of an RMSE that the reference's own error may have: at a quarter the RMSE is up to 3 % too large,
/// in squares 1/16.
inline constexpr double most_error_share = 0.25;

/// The numbers of a run, as in metrics.json.
struct Metrics {
    std::vector<RunMetrics> runs;       // every arm, n, s, seed
    std::vector<std::uint32_t> series;  // every seed of the experiment, of which `runs` may have a part; empty: those
    std::vector<SeedSpread> bands;
    std::vector<Ladder> ladders;
    std::vector<FurnaceResult> furnaces;
    std::vector<ReferenceQuality> references;
    std::vector<AssertionResult> assertions;
    std::map<std::string, std::uint64_t> shape_pixels;
    std::map<std::string, std::string> film_hashes;  // "phong n=64 s=32" -> hash
    std::uint64_t geometry_pixels = 0;
    std::optional<std::uint32_t> published_seed;  // of the published values, if known
    bool has_studies = true;                      // false: tails, furnaces and article checks were left out

    /// Returns null if there is no such run.
    const RunMetrics* find(const std::string& arm, std::uint64_t n, double s, std::uint32_t seed) const;
    /// Returns whether no assertion failed; skipped ones do not fail.
    bool all_hold() const;
};

// ---- An index of runs by key, for many look-ups.

/// Built once; the runs must not move.
class RunIndex {
public:
    /// The runs must outlive it.
    explicit RunIndex(const std::vector<RunMetrics>& runs);
    /// Returns null if there is no such run.
    const RunMetrics* find(const RunKey& key) const;
    /// Returns the seeds that were run, in the order of the runs.
    const std::vector<std::uint32_t>& seeds() const { return seeds_; }

private:
    struct Hash {
        std::size_t operator()(const RunKey& key) const;
    };
    std::unordered_map<RunKey, const RunMetrics*, Hash> runs_;
    std::vector<std::uint32_t> seeds_;
};

// ---- Computes metrics of films. Every sum runs in double over pixels in storage order, so equal films give equal
// numbers.

/// Returns all metrics of one film against the reference, without tails.
RunMetrics measure(const Experiment& experiment, const RunKey& key, const Film& film, const ReferenceFilm& reference,
    const ShapeMap& shapes);

/// Returns the root mean square of the difference of two Y planes over an area, and of one plane.
double rms_difference(const std::vector<float>& a, const std::vector<float>& b, const AreaPixels& pixels);
double rms(const std::vector<float>& a, const AreaPixels& pixels);

/// Compares two references of one exponent in a region, and the effect on the RMSE of any of the films; only the
/// quadrature's part if the article's reference is missing. `kind`: of the one that the metrics use.
ReferenceQuality compare(const ReferenceFilm& quadrature, const ReferenceFilm* note, const Region& region,
    const std::vector<std::pair<RunKey, Film>>& films, ReferenceKind kind, const ShapeMap& shapes);

/// Returns the quality of a paired reference in every region at every exponent, one film for each.
std::vector<ReferenceQuality> paired_quality(const std::vector<ReferenceFilm>& references, const Experiment& experiment,
    const std::vector<RunMetrics>& runs, const ShapeMap& shapes);
/// Returns the part that the reference's error may have in the RMSE of a region, see ReferenceQuality::error_share.
double share_of_reference(const RegionMetrics& region);

/// The name of a metric of the list in a band: rmse.<region>, ..., fireflies, ...
struct MetricName {
    std::string name;
    const MetricInfo* info;
};
/// Returns those that have a spread over seeds, those of the regions first.
std::vector<MetricName> metric_names(const Experiment& experiment);
/// Returns the value of any metric of the list by its name. Throws Bug if there is none.
double metric_value(const RunMetrics& run, const std::string& metric);

/// Returns the spread over seeds of every metric of every run at the published seed.
std::vector<SeedSpread> bands(
    const Experiment& experiment, const std::vector<RunMetrics>& runs, const Published* published);

/// Returns ladders of RMSE for every arm with at least two sample counts, in every region.
std::vector<Ladder> ladders(const Experiment& experiment, const std::vector<RunMetrics>& runs);

}  // namespace crescent
