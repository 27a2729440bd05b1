// bad: samples that are NaN, infinite or negative.
#pragma once

#include "render/film_metrics/measure.h"

namespace crescent::inline render {

struct BadMetric {
    static constexpr MetricInfo info = {
        .means = "samples that are not a number, infinite or negative; the arm's highest rung unless n is said",
        .in_tables = false,
        .of_single_samples = true};
    void add(const FilmPixel&, const FilmFacts&) {}
    std::uint64_t value(const FilmFacts& f) const { return f.bad; }
};

}  // namespace crescent::inline render
