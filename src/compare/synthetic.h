// Renders that are made up, so that the truth about them is known: for the tests, and for docs/error-rates.md.
#pragma once

#include <string>

#include "base/progress.h"
#include "compare/compare.h"

namespace crescent::inline comparison {

/// Noise of mean 1 + bias. normal: of this sd. lognormal: sd is that of the logarithm. events: 0.9, and with this
/// chance a bright event that is exponentially distributed and makes up the rest: what a caustic or a missed area light
/// does. Rules are chosen on these three. The next three stand by to measure what was chosen: pareto: of this tail
/// index (> 1; the variance is infinite up to 2). hits: the mean of 16 samples, each of which meets a area light with
/// this chance. sparks: 0.9, and in a sixteenth of the frame with this chance a pixel a spark of one size, which makes
/// up the rest there. gamma: of this sd.
struct SyntheticNoise {
    /// The distribution of a pixel's noise, see above.
    enum class Kind { normal, lognormal, events, pareto, hits, sparks, gamma } kind = Kind::normal;
    double size = 0;  // sd, sd of the logarithm, tail index, or chance
    double bias = 0;
    double hue = 0;      // red is brighter by this share, and blue darker by so much that Y is the same
    double failing = 0;  // chance that a pixel of a render is NaN
    int filter = 1;      // a pixel is the mean of so many by so many of independent noise
};
/// "normal noise", for tables.
std::string to_string(const SyntheticNoise& noise);

/// Two arms "a" and "b" of so many renders of width x width pixels, and a reference without error.
struct SyntheticScene {
    SyntheticNoise a, b;
    int renders = 8, width = 32;
    bool referred = true;  // false: the arms alone
    double own = 0;        // of each channel's noise this share is its own, the rest that of all three; 0: grey
    int shared = 0;        // so many renders of b have the random numbers of renders of a, in reverse order
};

/// One pixel of a grey render `width` pixels wide: a pure function of its arguments.
double made_pixel(const SyntheticNoise& noise, std::uint32_t seed, std::uint32_t pixel, int width);
/// Whether each arm whose noise is events or sparks met one in some pixel of some render.
bool met_events(const SyntheticScene& world, std::uint32_t seed);
/// How bright an event or a spark is on average; 0 of noise that has none.
double event_size(const SyntheticNoise& noise);

/// The world compared as files would be; equal seeds give equal renders. `more` flags stand over its own.
CompareResult compare_synthetic(
    const SyntheticScene& world, std::uint32_t seed, const std::vector<CompareFlag>& more = {});

// ---- How often compare errs, on renders whose truth is known: false alarms, power, and how often its intervals hold
// the truth; a section of docs/error-rates.md.

/// Markdown. `repeats` calls of each kind of noise; equal arguments give equal text but for the date in the caller's.
std::string compare_error_rates(std::uint32_t repeats, std::uint32_t seed, ProgressMonitor& monitor);

}  // namespace crescent::inline comparison
