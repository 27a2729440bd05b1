// The two sides of a question about means: an arm, and another arm or the reference; what is known of their noise.
#pragma once

#include <cmath>

#include "compare/plan.h"
#include "compare/results.h"

namespace crescent::inline comparing {

/// Noise of a set of pixels: means over it of the variance of a pixel, of one render.
struct SetNoise {
    double pixels = 0;
    double a = 0, b = 0;  // NaN: not known
    double mean_a = 0, mean_b = 0;
};

struct Sides {
    Sides(
        const ComparePlan& plan, const Readings& readings, const CompareResult& measured, std::size_t a, std::size_t b);

    bool lone_reference() const { return referred && b.files.size() < 2; }
    std::size_t renders() const { return referred ? a.files.size() : std::min(a.files.size(), b.files.size()); }

    /// `next(i)` is called for every pixel of the set by the caller's loop; see noise_of().
    SetNoise noise_of(const Box& box) const;
    SetNoise noise_of(const PixelSet& set) const;

    /// Welch's test of a mean over a set, `va` and `vb` being the mean of each render; in pairs where there are some.
    /// A spread over few renders may be small by chance: with `floored` it is never taken to be less than what the
    /// pixels' own spread makes of it.
    Welch test(const std::vector<double>& va, const std::vector<double>& vb, const SetNoise& noise, bool floored) const;

    /// The difference of a mean that events as large as the rarest seen would make up, on the side that is lower, where
    /// they are so rare that its renders met none with a probability of `level`. Below it a t-test cannot see.
    double unseen(double difference, double pixels, double level) const;
    /// The events that would be needed for a difference of the means of so many pixels, and missed with a probability
    /// of `level`; nothing where the darker side is one file.
    std::optional<MissedEvents> needed(const Found& place, double pixels, double level) const;
    /// The larger of that and of what the files' rounding makes of two means: all of it where there is no noise to
    /// spread it, less and less under noise of this variance a pixel.
    double blind(double mean_a, double mean_b, double pixels, double variance, double level) const;

    const Readings& all;
    const ArmReadings &a, &b;
    const ArmResult& arm;
    const ArmResult* other = nullptr;  // none: the reference
    double brightest = 0;              // the most that a pixel of one render can be; 0: not known
    bool referred = false, dependent = false;
    double low_frequencies = 1;                              // of the noise's power, over that of its high ones
    std::vector<std::pair<std::size_t, std::size_t>> pairs;  // of renders; empty: independent
    std::vector<double> tile_a, tile_b;                      // variance of a pixel of one render, mean over a tile
};

/// What events that no render met would have to be to make up all that was found, of which the place that asks for the
/// brightest counts; `alpha` is that of regions.
std::optional<MissedEvents> missed_events(const Sides& sides, const BiasResult& found, double alpha);

/// The reference's own squared error a pixel where it is one file that does not say it: what the mean of an arm less
/// the reference varies from one pixel to the next, less the arm's own share; a bias is taken to be smooth.
double roughness(const Readings& all, const ArmReadings& arm, const PixelSet& set);

}  // namespace crescent::inline comparing
