// Computes metrics of films. Every sum runs in double over pixels in storage order, so equal films give equal numbers.
#pragma once

#include <utility>
#include <vector>

#include "experiment/experiment.h"
#include "metrics/metrics.h"
#include "render/film.h"

namespace crescent::inline metrics {

/// Returns all metrics of one film against the reference, without tails.
RunMetrics measure(const Experiment& experiment, const RunKey& key, const Film& film, const ReferenceFilm& reference,
    const ShapeMap& shapes);

/// Returns the root mean square of the difference of two Y planes over a box, and of one plane.
double rms_difference(const std::vector<float>& a, const std::vector<float>& b, int width, const Box& box);
double rms(const std::vector<float>& a, int width, const Box& box);

/// Compares two references of one exponent in a region, and the effect on the RMSE of any of the films; only the
/// quadrature's part if the article's reference is missing. `used` is the one that the metrics use.
ReferenceQuality compare(const ReferenceFilm& quadrature, const ReferenceFilm* note, const Region& region,
    const std::vector<std::pair<RunKey, Film>>& films, ReferenceKind used);

/// Returns the quality of a paired reference in every region at every exponent, one film for each.
std::vector<ReferenceQuality> paired_quality(
    const std::vector<ReferenceFilm>& references, const Experiment& experiment, const std::vector<RunMetrics>& runs);
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

}  // namespace crescent::inline metrics
