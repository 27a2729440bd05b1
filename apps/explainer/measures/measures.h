// Measurements of single pixels and densities, taken once for the whole video. Radiance in W/(sr m^2) of luminance Y, f
// and densities in 1/sr, angles in degrees.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "data.h"

namespace crescent::explainer {

/// One arm at the selected pixel.
struct ArmAtPixel {
    std::string arm, sampler;
    std::vector<PixelSample> samples;           // the N that the film used
    std::vector<double> mean;                   // over the first 1, 2, ... N
    double film = 0;                            // the film's own Y, equal to mean.back()
    std::size_t largest = 0;                    // index of the largest X
    std::uint64_t hits = 0, below_horizon = 0;  // samples that hit a light, and samples below the horizon
    double hit_share = 0;                       // of a long series of draws of the same pixel
    std::uint64_t long_series = 0;              // their number

    const PixelSample& largest_sample() const { return samples[largest]; }
};

/// The pixel of the highlight region in which the cosine arm is farthest from the reference.
struct PixelStory {
    std::shared_ptr<const OpenPixel> pixel;
    double reference = 0;  // Y
    ArmAtPixel cosine, phong;
    PixelSample by_phong;    // the largest of the cosine arm with phong's density; 0: none
    int disk = -1;           // the light of the largest sample, else the first; -1: none
    double solid_angle = 0;  // of all lights that face the pixel, sr
    double disk_share = 0;   // share of the pixel's light that does not come from the fill
    double top_f = 0;        // largest f over the hemisphere
};

/// Weights (n.w)/(pi p) of the lobe's sampler on a Lambert surface seen from directly above, R = n, under constant
/// light: their mean is 1, their distribution X = smallest u^-k for u in (0, 1): Pareto's if k > 0.
struct WeightTail {
    double s = 0, k = 0, smallest = 0;  // k = (s-1)/(s+1), smallest = 2/(s+1)
    std::optional<Tail> fit;            // k-hat of the draws
    std::uint64_t n = 0;
    double median = 0, largest = 0;
    double decade_parts = 4;  // bins per decade
    double first_log10 = 0;   // lower edge of bins[0]
    std::vector<std::uint64_t> bins;
    /// Returns how many of n draws Pareto's distribution puts into a bin.
    double expected(std::size_t bin) const;
    double edge(std::size_t bin) const;  // lower
};

struct Measures {
    PixelStory story;
    WeightTail tail;
    std::vector<Vec3d> cosine_directions;  // the first of those by which the lost part of the hemisphere is measured
    LostSupport surround_lost;             // at the median tilt of R in the surround region
};

Measures take_measures(const Data& data, const std::string& isa, ProgressMonitor& monitor);

/// Returns the pixel of a box with the largest |Y - Y_ref| that shows geometry; of equal ones, the first in storage
/// order.
std::pair<int, int> worst_pixel(
    const Film& film, const ReferenceFilm& reference, const ShapeMap& shapes, const Box& box);
WeightTail weight_tail(double s, std::uint64_t n, std::uint32_t seed);

}  // namespace crescent::explainer
