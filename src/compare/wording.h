// The two sides of a test of the means of one quantity: an arm, and another arm or the reference; what is known of
// their noise. Where renders are paired, it is that of their differences.
#pragma once

#include <cmath>

#include "compare/plan.h"
#include "compare/results.h"

namespace crescent::inline comparison {

/// Noise of a set of pixels: means over it of the variance of a pixel, of one render.
struct SetVariance {
    double pixels = 0;
    double a = 0, b = 0;  // NaN: not known; in pairs a is that of the difference
    double own = 0;       // of a and b by themselves, in pairs too: it spreads what files round
    double mean_a = 0, mean_b = 0;
};

struct BiasPair {
    BiasPair(const ComparePlan& plan, const RenderStats& readings, const CompareResult& measured, std::size_t a,
        std::size_t b, std::size_t quantity = 0, const PairedRenders* paired = nullptr);

    bool lone_reference() const { return referred && b.files.size() < 2; }
    bool in_pairs() const { return differences != nullptr; }
    double mean_a(std::size_t i) const { return a.film.of(quantity).mean[i]; }
    double mean_b(std::size_t i) const { return b.film.of(quantity).mean[i]; }
    /// The means of each render of a side over a region, or over a tile; of paired ones in the order of the pairs.
    std::vector<double> region_means(const ArmStats& side, std::size_t region) const;
    std::vector<double> tile_means(const ArmStats& side, std::size_t tile) const;
    /// The side whose mean is not to be tested, its errors' tail being so heavy that one of them decides it; "": none.
    std::string heavy_in(std::size_t region) const;
    /// One pixel of one render is half of a tile's spread.
    bool lone_pixel_in(std::size_t tile) const;

    /// `next(i)` is called for every pixel of the set by the caller's loop; see noise_of().
    SetVariance noise_of(const Box& box) const;
    SetVariance noise_of(const PixelSet& set) const;

    /// Welch's test of a mean over a set, `va` and `vb` being the mean of each render; in pairs where there are some.
    /// A spread over few renders may be small by chance: with `floored` it is never taken to be less than what the
    /// pixels' own spread makes of it.
    Welch test(
        const std::vector<double>& va, const std::vector<double>& vb, const SetVariance& noise, bool floored) const;

    /// The difference of a mean that events as large as the rarest seen would make up, on the side that is lower, where
    /// they are so rare that its renders met none with a probability of `level`. Below it a t-test cannot see.
    double unseen(double difference, double pixels, double level) const;
    /// The events that would be needed for a difference of the means of so many pixels, and missed with a probability
    /// of `level`; nothing where the darker side is one file.
    std::optional<MissedEvents> needed(const Found& place, double pixels, double level) const;
    /// The larger of that and of what the files' rounding makes of two means: all of it where there is no noise to
    /// spread it, less and less under noise of this variance a pixel. In pairs, where noise cancels, also what the
    /// renderer's own arithmetic makes of one sum in another order.
    double blind(double mean_a, double mean_b, double pixels, double variance, double level) const;

    const RenderStats& all;
    const ArmStats &a, &b;
    const ArmResult& arm;
    const ArmResult* other = nullptr;  // none: the reference
    double brightest = 0;              // the most that a pixel of one render can be; 0: not known
    bool referred = false, dependent = false;
    double low_frequencies = 1;  // of the noise's power, over that of its high ones
    std::size_t quantity = 0;    // see quantities.h
    const std::vector<RenderPair>* pairs = nullptr;
    const ArmStats* differences = nullptr;            // of the pairs; none: the renders are independent
    std::vector<double> tile_a, tile_b, tile_paired;  // variance of a pixel of one render, mean over a tile

private:
    std::vector<double> paired_of(const ArmStats& side, std::vector<double> each) const;
    /// The largest deviation that events of the side that is darker made, and over how many renders.
    double rare_event(double difference) const;
    double renders_of(const ArmStats& side) const;
};

/// The reference's own squared error a pixel where it is one file that does not say it: what the mean of an arm less
/// the reference varies from one pixel to the next, less the arm's own share; a bias is taken to be smooth.
double roughness(const RenderStats& all, const ArmStats& arm, const PixelSet& set);

}  // namespace crescent::inline comparison
