// rmse: root mean square error of Y against the reference, over a region.
#pragma once

#include <cmath>

#include "render/film_metrics/measure.h"

namespace crescent::inline render {

struct RmseMetric {
    static constexpr MetricInfo info = {
        .means = "root mean square error of Y against the reference over a region", .label = "RMSE"};
    double squares = 0;
    void add(const FilmPixel& p, const FilmFacts&) { squares += p.squared_error(); }
    /// NaN below the error of a paired reference: the estimate of the squared error is negative.
    double value(const FilmFacts& f) const { return std::sqrt(squares / f.pixels); }
};

}  // namespace crescent::inline render
