// fireflies: geometry pixels whose error is larger than firefly_k times the reference.
#pragma once

#include <cmath>

#include "render/film_metrics/measure.h"

namespace crescent::inline render {

struct FirefliesMetric {
    static constexpr MetricInfo info = {.means = "geometry pixels with |Y - Y_ref| > firefly_k Y_ref"};
    std::uint64_t count = 0;
    void add(const FilmPixel& p, const FilmFacts& f) {
        if (p.geometry && std::fabs(p.difference()) > f.firefly_k * p.reference) ++count;
    }
    std::uint64_t value(const FilmFacts&) const { return count; }
};

}  // namespace crescent::inline render
