// The two sides of a test of the means of one quantity, an arm and another arm or the reference, with their noise; and
// what a test found, in words. If renders are paired, it is the noise of their differences.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/plan.h"
#include "compare/renders.h"
#include "compare/results.h"
#include "math/statistics.h"
#include "scene/scene_data.h"

namespace crescent {

/// Returns mean and standard error over renders, without an interval, whose quantile takes most of the time.
MeanInterval mean_and_error(std::span<const double> values);

/// The noise of a set of pixels: means over it of the variance of a pixel of one render.
struct SetVariance {
    double pixels = 0;
    double a = 0, b = 0;           // NaN: unknown; in pairs a is that of the difference
    double unpaired_variance = 0;  // of a and b without pairing: determines how rounding errors average out
    double mean_a = 0, mean_b = 0;
};

struct BiasPair {
    BiasPair(const ComparePlan& plan, const RenderStats& readings, const CompareResult& result, std::size_t a,
        std::size_t b, std::size_t quantity = 0, const PairedRenders* paired = nullptr);

    /// Whether the noise of both sides is estimated together, see test().
    bool pools() const;
    bool lone_reference() const { return referred && b.files.size() < 2; }
    bool in_pairs() const { return differences != nullptr; }
    double mean_a(std::size_t i) const { return a.film.of(quantity).mean[i]; }
    double mean_b(std::size_t i) const { return b.film.of(quantity).mean[i]; }
    /// Returns the means of each render of a side over a region or tile, in the order of the pairs if there are any.
    std::vector<double> region_means(const ArmStats& side, std::size_t region) const;
    std::vector<double> tile_means(const ArmStats& side, std::size_t tile) const;
    /// Returns the side whose mean is not tested because its errors' tail is so heavy that one of them decides it; "":
    /// none.
    std::string heavy_in(std::size_t region) const;
    /// Returns whether one pixel of one render has half of a tile's spread.
    bool lone_pixel_in(std::size_t tile) const;

    /// Returns the noise of a set of pixels.
    SetVariance noise_of(const Box& box) const;
    SetVariance noise_of(const PixelSet& set) const;

    /// Welch's test of a mean over a set, where `va` and `vb` are the means of each render; the paired test if there
    /// are pairs. The spread over few renders may be small by chance: with `floored` it is at least the one that
    /// follows from the spread of the pixels.
    /// If `shared_noise` and one side has at most half as many renders as the other, Student's test with the noise of
    /// both sides: the ratio of their variances is that of their pixels, which is known well; 1 if a side is one
    /// render.
    Welch test(
        const std::vector<double>& va, const std::vector<double>& vb, const SetVariance& noise, bool floored) const;

    /// Returns p of a test, at any time if the plan asks for it.
    Welch with_p(Welch test) const;
    /// 1 / (1 / n + 1 / m), or the number of pairs; 0: the test is made once.
    double information() const;
    /// Returns the difference that the test detects with a probability of 90 %.
    double detectable_difference(const Welch& test, double level) const;
    /// Returns the difference of a mean that events as large as the rarest found would cause on the darker side if its
    /// renders contain none with a probability of `level`. A t-test cannot detect smaller differences.
    double missable_difference(double difference, double pixels, double level) const;
    /// Returns the events that would explain a difference of the means of this many pixels and be in no render with a
    /// probability of `level`; empty if the darker side is one file.
    std::optional<MissedEvents> events_for(const Found& place, double pixels, double level) const;
    /// Returns the larger of that difference and of the effect of the files' rounding on two means: all of it without
    /// noise, less with more noise of this variance per pixel. In pairs, whose noise cancels, also the effect of the
    /// renderer's own arithmetic with sums in another order.
    double undetectable_difference(double mean_a, double mean_b, double pixels, double variance, double level) const;

    const RenderStats& stats;
    const ArmStats &a, &b;
    const ArmResult& arm;
    const ArmResult* other = nullptr;  // null: the reference
    double brightest = 0;              // the largest possible value of a pixel of one render; 0: unknown
    bool referred = false, dependent = false, shared_noise = false;
    unsigned look_number = 0;    // see ComparePlan
    bool count_pixel_p = true;   // see ComparePlan
    double low_frequencies = 1;  // power of the noise at low frequencies over that at high ones
    std::size_t quantity = 0;    // see renders.h
    const std::vector<RenderPair>* pairs = nullptr;
    const ArmStats* differences = nullptr;            // of the pairs; null: the renders are independent
    std::vector<double> tile_a, tile_b, tile_paired;  // variance of a pixel of one render, mean over a tile

private:
    /// Returns the difference of two means that the steps of the files' whole numbers hide, see
    /// undetectable_difference().
    double quantised_difference(double mean_a, double mean_b, double pixels, double variance) const;
    std::vector<double> paired_of(const ArmStats& side, std::vector<double> values) const;
    /// Returns the largest deviation by events on the brighter side.
    double rare_event(double difference) const;
    double renders_of(const ArmStats& side) const;
    std::optional<Welch> pooled_test(
        const std::vector<double>& va, const std::vector<double>& vb, const SetVariance& noise, bool floored) const;
};

/// Estimates the squared error per pixel of a reference that is one file and does not state it: the variation between
/// neighbouring pixels of an arm's mean minus the reference, without the arm's own share. A bias is assumed to be
/// smooth.
double roughness(const RenderStats& stats, const ArmStats& arm, const PixelSet& set);

/// Returns the result as one sentence; `alpha` is the level of its regions.
std::string sentence_of(const RenderStats& stats, const BiasResult& bias, double alpha);
/// Describes the pixels of a pair that differ because they are not finite; "" if there are none.
std::string failing_pixels(const RenderStats& stats, const BiasResult& bias);

/// Returns the sentences of all pairs, or of all but that of the result; of many pairs, those without a difference
/// share one sentence.
std::vector<std::string> found_about_means(const CompareResult& result, bool with_stated_pair = true);

}  // namespace crescent
