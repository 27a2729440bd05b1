// horizon_frac: the share of the directions drawn at geometry pixels (two per sample for a sampler with two techniques)
// that are below the horizon.
#pragma once

#include "render/film_metrics/measure.h"

namespace crescent::inline render {

struct HorizonFracMetric {
    static constexpr MetricInfo info = {
        .means = "part of the directions drawn at geometry pixels that fall under the horizon",
        .label = "horizon share"};
    double under = 0, geometry = 0;
    void add(const FilmPixel& p, const FilmFacts&) {
        if (p.geometry) ++geometry, under += p.horizon;
    }
    double value(const FilmFacts& f) const {
        return geometry > 0 ? under / (geometry * static_cast<double>(f.n * f.directions)) : 0;
    }
};

}  // namespace crescent::inline render
