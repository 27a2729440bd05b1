// f_evaluations: the evaluations of f of one sample: one for each direction, and of resampling one for each candidate.
#pragma once

#include "render/film_metrics/measure.h"

namespace crescent::inline render {

struct FEvaluationsMetric {
    static constexpr MetricInfo info = {
        .means = "evaluations of f of one sample", .label = "evaluations of f a sample", .of_combinations = true};
    void add(const FilmPixel&, const FilmFacts&) {}
    std::uint64_t value(const FilmFacts& f) const { return f.evaluations; }
};

}  // namespace crescent::inline render
