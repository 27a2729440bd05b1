// smape: symmetric mean absolute percentage error of Y against the reference, over a region: the mean of
// |Y - R| / (|Y| + |R| + 0.01), between 0 and 1 (Vogels et al. 2018, "Denoising with Kernel Prediction and Asymmetric
// Loss Functions", eq. 4, with their epsilon).
#pragma once

#include <cmath>

#include "render/film_metrics/measure.h"

namespace crescent::inline render {

struct SmapeMetric {
    static constexpr MetricInfo info = {.means = "mean over a region of |Y - R| / (|Y| + |R| + 0.01), R the reference",
        .label = "SMAPE",
        .in_tables = false};
    static constexpr double epsilon = 0.01;  // [Y]
    double sum = 0;
    void add(const FilmPixel& p, const FilmFacts&) {
        sum += std::fabs(p.difference()) / (std::fabs(p.y) + std::fabs(p.reference) + epsilon);
    }
    double value(const FilmFacts& f) const { return sum / f.pixels; }
};

}  // namespace crescent::inline render
