// largest: the largest single sample of the frame.
#pragma once

#include <algorithm>

#include "measures/measure.h"

namespace crescent::inline measures {

struct LargestMeter {
    static constexpr MeterInfo info = {
        .means = "largest single sample of the frame; the arm's highest rung unless n is said",
        .in_tables = false,
        .of_single_samples = true};
    double most = 0;
    void add(const FilmPixel& p, const FilmFacts&) { most = std::max(most, p.largest); }
    double value(const FilmFacts&) const { return most; }
};

}  // namespace crescent::inline measures
