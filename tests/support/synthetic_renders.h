// Synthetic renders with known true values: for the tests, and for docs/error-rates.md.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compare/plan.h"
#include "compare/renders.h"
#include "compare/results.h"

namespace crescent {

/// Noise of mean 1 + bias. normal: `size` is the standard deviation. lognormal: that of the logarithm. events: 0.9, and
/// with this probability a bright event with exponential distribution, which contributes the rest, as a caustic or a
/// missed area light does. The rules were chosen with these three. The next three measure the chosen rules: pareto:
/// `size` is the tail index (> 1; the variance is infinite up to 2). hits: the mean of 16 samples, each of which hits
/// an area light with this probability. sparks: 0.9, and in a sixteenth of the frame with this probability per pixel a
/// spark of constant size, which contributes the rest there. gamma: `size` is the standard deviation.
struct SyntheticNoise {
    /// The distribution of a pixel's noise, see above.
    enum class Kind { normal, lognormal, events, pareto, hits, sparks, gamma } kind = Kind::normal;
    double size = 0;  // standard deviation, that of the logarithm, tail index, or probability
    double bias = 0;
    double hue = 0;      // red is brighter by this share, and blue darker so that Y is unchanged
    double failing = 0;  // probability that a pixel of a render is NaN
    int filter = 1;      // width in pixels of a box filter over independent noise
};
/// Returns "normal, 20 %", for tables.
std::string to_string(const SyntheticNoise& noise);

/// Two arms "a" and "b" of `renders` renders with width x width pixels, and a reference without error.
struct SyntheticScene {
    SyntheticNoise a, b;
    int renders = 8, width = 32;
    bool referred = true;  // false: without the reference
    double own = 0;        // share of each channel's noise that is its own; the rest is common to all three; 0: grey
    int shared = 0;        // number of renders of b with the random numbers of renders of a, in reverse order
};

/// One pixel of a grey render `width` pixels wide: a pure function of its arguments.
double synthetic_pixel(const SyntheticNoise& noise, std::uint32_t seed, std::uint32_t pixel, int width);
/// A whole render: grey, or in colour if the channels of the scene have noise of their own; `scene` states its size.
Render synthetic_render(
    const std::string& path, const SyntheticNoise& noise, std::uint32_t seed, const SyntheticScene& scene);
/// Returns whether each arm with events or sparks has one in some pixel of some render.
bool have_events(const SyntheticScene& scene, std::uint32_t seed);
/// Returns the mean brightness of an event or a spark; 0 for noise without them.
double event_size(const SyntheticNoise& noise);

/// Compares the scene's renders as files are compared; equal seeds give equal renders. `more` flags override the
/// defaults.
CompareResult compare_synthetic(
    const SyntheticScene& scene, std::uint32_t seed, const std::vector<CompareFlag>& more = {});

}  // namespace crescent
