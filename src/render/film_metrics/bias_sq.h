// bias_sq: squared bias of Y against the reference, over a region: the mean of (Y - R)^2 minus the variance of the mean
// of Y. Its expectation is the mean of (E[Y] - R)^2, so that of an unbiased sampler is around 0, on either side.
#pragma once

#include <limits>

#include "render/film_metrics/measure.h"

namespace crescent::inline render {

struct BiasSqMetric {
    static constexpr MetricInfo info = {
        .means = "mean over a region of (Y - R)^2 minus the variance of the mean of Y, R the reference",
        .label = "bias²",
        .in_tables = false,
        .from_two_samples = true};
    double sum = 0;
    void add(const FilmPixel& p, const FilmFacts&) { sum += p.squared_error() - p.var; }
    double value(const FilmFacts& f) const {
        return f.n < 2 ? std::numeric_limits<double>::quiet_NaN() : sum / f.pixels;
    }
};

}  // namespace crescent::inline render
