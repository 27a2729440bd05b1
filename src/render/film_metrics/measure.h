// The input of a metric and its description. A metric receives the pixels of a box, row by row from the bottom-left,
// and then returns its value; it sums in double, so that equal films give equal numbers.
#pragma once

#include <cstdint>
#include <string_view>
#include <utility>

namespace crescent::inline render {

/// One pixel of a film, with the reference. Y in W/(sr m^2).
struct FilmPixel {
    double y = 0, reference = 0;
    double var = 0;         // variance of the mean of Y
    double largest = 0;     // single sample
    double horizon = 0;     // directions drawn at or below the horizon
    bool geometry = false;  // whether the camera sees a shape there
    double pair_error = 0;  // e of a paired reference (render/reference/paired.h), else 0
    double difference() const { return y - reference; }
    /// An unbiased estimate of the squared error, below 0 in some pixels if the reference is paired.
    double squared_error() const { return difference() * difference() - pair_error * pair_error; }
};

/// Values that are the same for every pixel.
struct FilmFacts {
    double pixels = 0;  // of the box
    std::uint64_t n = 0;
    std::uint64_t directions = 1;   // drawn per sample
    std::uint64_t evaluations = 1;  // of f per sample
    std::uint64_t bad = 0;          // samples of the whole film
    double firefly_k = 0;
};

/// The description of a metric.
struct MetricInfo {
    std::string_view means;
    std::string_view label{};        // markup, if the report shows something else than the name
    bool in_tables = true;           // in the report and on the terminal
    bool of_combinations = false;    // in tables only if an arm combines samplers
    bool from_two_samples = false;   // unknown at one sample per pixel
    bool of_single_samples = false;  // the highest sample count includes the samples of all others; no spread over
                                     // seeds
};

/// The type of a metric's value: double, or an integer for a count.
template <class Metric> using MetricOf = decltype(std::declval<const Metric&>().value(FilmFacts{}));

}  // namespace crescent::inline render
