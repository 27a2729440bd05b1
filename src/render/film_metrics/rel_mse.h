// rel_mse: relative mean square error of Y against the reference, over a region: the mean of
// (Y - R)^2 / (R^2 + 0.01) (Rousselle, Knaus, Zwicker 2011, "Adaptive Sampling and Reconstruction using Greedy Error
// Minimization", sec. 5, with their epsilon).
#pragma once

#include "render/film_metrics/measure.h"

namespace crescent::inline render {

struct RelMseMetric {
    static constexpr MetricInfo info = {.means = "mean over a region of (Y - R)^2 / (R^2 + 0.01), R the reference",
        .label = "relMSE",
        .in_tables = false};
    static constexpr double epsilon = 0.01;  // [Y]^2
    double sum = 0;
    void add(const FilmPixel& p, const FilmFacts&) { sum += p.squared_error() / (p.reference * p.reference + epsilon); }
    double value(const FilmFacts& f) const { return sum / f.pixels; }
};

}  // namespace crescent::inline render
