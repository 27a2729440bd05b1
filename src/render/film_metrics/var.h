// var: mean over the pixels of a region of the variance of the mean of Y.
#pragma once

#include <limits>

#include "render/film_metrics/measure.h"

namespace crescent::inline render {

struct VarMetric {
    static constexpr MetricInfo info = {
        .means = "mean over a region of the variance of the mean of Y", .from_two_samples = true};
    double sum = 0;
    void add(const FilmPixel& p, const FilmFacts&) { sum += p.var; }
    double value(const FilmFacts& f) const {
        return f.n < 2 ? std::numeric_limits<double>::quiet_NaN() : sum / f.pixels;
    }
};

}  // namespace crescent::inline render
