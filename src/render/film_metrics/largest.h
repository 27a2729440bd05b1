// largest: the largest single sample of the frame.
#pragma once

#include <algorithm>

#include "render/film_metrics/measure.h"

namespace crescent::inline render {

struct LargestMetric {
    static constexpr MetricInfo info = {
        .means = "largest single sample of the frame; the arm's highest rung unless n is said",
        .in_tables = false,
        .of_single_samples = true};
    double most = 0;
    void add(const FilmPixel& p, const FilmFacts&) { most = std::max(most, p.largest); }
    double value(const FilmFacts&) const { return most; }
};

}  // namespace crescent::inline render
