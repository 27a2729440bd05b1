// rays: the directions that one sample estimates, each with one ray: 1, or more for samplers that join several.
#pragma once

#include "render/film_metrics/measure.h"

namespace crescent::inline render {

struct RaysMetric {
    static constexpr MetricInfo info = {.means = "rays of one sample, one for each direction that it estimates",
        .label = "rays a sample",
        .of_combinations = true};
    void add(const FilmPixel&, const FilmFacts&) {}
    std::uint64_t value(const FilmFacts& f) const { return f.directions; }
};

}  // namespace crescent::inline render
