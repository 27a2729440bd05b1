// y_mean: mean of Y over the whole frame.
#pragma once

#include "render/film_metrics/measure.h"

namespace crescent::inline render {

struct YMeanMetric {
    static constexpr MetricInfo info = {.means = "mean Y of the whole frame", .label = "<i>Y</i><sub>mean</sub>"};
    double sum = 0;
    void add(const FilmPixel& p, const FilmFacts&) { sum += p.y; }
    double value(const FilmFacts& f) const { return sum / f.pixels; }
};

}  // namespace crescent::inline render
