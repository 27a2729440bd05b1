// What a metric sees of a film, and what it says of itself. A metric takes the pixels of a box, row by row from the
// bottom-left, and then tells its value; its sums run in double, so that equal films give equal numbers.
#pragma once

#include <cstdint>
#include <string_view>
#include <utility>

namespace crescent::inline render {

/// One pixel of a film beside the reference. Y in W/(sr m^2).
struct FilmPixel {
    double y = 0, reference = 0;
    double var = 0;         // variance of the mean of Y
    double largest = 0;     // single sample
    double horizon = 0;     // directions drawn at or under the horizon
    bool geometry = false;  // the camera sees a shape there
    double difference() const { return y - reference; }
};

/// What is the same for every pixel.
struct FilmFacts {
    double pixels = 0;  // of the box
    std::uint64_t n = 0;
    std::uint64_t directions = 1;  // drawn a sample
    std::uint64_t bad = 0;         // samples of the whole film
    double firefly_k = 0;
};

/// What a metric says of itself.
struct MetricInfo {
    std::string_view means;
    std::string_view label{};        // markup, where the report writes it otherwise than its name
    bool in_tables = true;           // of the report and the terminal
    bool from_two_samples = false;   // one sample a pixel leaves it unknown
    bool of_single_samples = false;  // the highest sample count holds those of all others; it has no spread over seeds
};

/// What a metric's value is: double, or an integer where it counts.
template <class Metric> using MetricOf = decltype(std::declval<const Metric&>().value(FilmFacts{}));

}  // namespace crescent::inline render
