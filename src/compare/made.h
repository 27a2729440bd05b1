// Renders that are made up, so that the truth about them is known: for the tests, and for docs/error-rates.md.
#pragma once

#include "compare/judge.h"

namespace crescent::inline comparing {

/// Noise of mean 1 + bias. normal: of this sd. lognormal: sd is that of the logarithm. events: 0.9, and with this
/// chance a bright event that is exponentially distributed and makes up the rest: what a caustic or a missed lamp does.
struct MadeNoise {
    enum class Kind { normal, lognormal, events } kind = Kind::normal;
    double size = 0;  // sd, sd of the logarithm, or chance a pixel
    double bias = 0;
};
/// "normal noise", for tables.
std::string to_string(const MadeNoise& noise);

/// Two arms "a" and "b" of so many renders of width x width pixels, and a reference without error.
struct MadeWorld {
    MadeNoise a, b;
    int renders = 8, width = 32;
};

/// Luminance of one pixel of a render: a pure function of its arguments.
double made_pixel(const MadeNoise& noise, std::uint32_t seed, std::uint32_t pixel);

/// The world compared as files would be; equal seeds give equal renders. `more` flags stand over its own.
CompareResult compare_made(const MadeWorld& world, std::uint32_t seed, const std::vector<CompareFlag>& more = {});

}  // namespace crescent::inline comparing
