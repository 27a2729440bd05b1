// A comparison as text: for machines, build servers and the terminal.
#pragma once

#include <cmath>
#include <functional>
#include <map>
#include <span>
#include <string>

#include "compare/plan.h"
#include "compare/results.h"
#include "report/plates/plates.h"
#include "report/plates/raster.h"
#include "report/plates/sheet.h"
#include "report/report.h"

namespace crescent {

// ---- The two sides of a test of the means of one quantity: an arm, and another arm or the reference; and their noise.
// If renders are paired, it is the noise of their differences.

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

}  // namespace crescent

// ---- Pictures of a comparison, by file name without .png.

namespace crescent::plates {

// ---- Parts of the plates of a comparison: header and caption, blocks of pixels, colour bars.

inline constexpr double bar_room = 116;

/// The header of a sheet; finish() sets caption and footer.
void header(Canvas& c, bool backend, const std::string& label);
void finish(Canvas& c, const std::string& caption, const std::string& note);
/// The same; returns the picture.
Picture finished(Canvas& c, const std::string& caption, const std::string& note);

/// Blue for t < 0, orange for t > 0, grey in the middle; t in [-1, 1]. NaN: the ground, which is another grey.
Srgb8 diverging(double t, Theme theme);

/// Draws value(x, y) of the box through diverging(); if it is reduced, the mean over the pixels of each cell.
Block diverging_block(const Box& box, const Fit& fit, Theme theme, const std::function<double(int, int)>& value);
/// Draws colour(x, y) of the nearest pixel of the box.
Block nearest_block(const Box& box, const Fit& fit, const std::function<Srgb8(int, int)>& colour);

/// Paints the block at the top centre of the slot, with a frame, and returns its place.
Rect framed(Canvas& c, const Block& block, const Rect& slot);

using Ticks = std::vector<std::pair<double, std::string>>;  // share of the bar, label
/// Draws a vertical bar of colour(t), t from 0 at the bottom to 1 at the top.
void bar(Canvas& c, const Rect& rect, const std::function<Srgb8(double)>& colour, const Ticks& ticks);
/// Returns diverging() as colours of a bar.
std::function<Srgb8(double)> signed_colours(Theme theme);

}  // namespace crescent::plates

namespace crescent {

/// Returns the plates renders, errors, ladders, bias-A-B and noise-A-B that have data. Throws OutputError without the
/// font.
std::map<std::string, Picture> compare_plates(
    const ComparePlan& plan, const RenderStats& stats, const CompareResult& result);

struct BiasPair;
/// The signed difference of two means; the tiles and pixels in which it is significant; the ratio of two variances.
Picture difference_plate(const BiasPair& sides, const std::string& a, const std::string& b, Theme theme);
Picture bias_plate(const BiasPair& sides, const BiasResult& bias, Theme theme);
Picture noise_plate(const RenderStats& stats, const NoiseResult& noise, Theme theme);
/// Requires a ladder.
Picture ladders_plate(const CompareResult& result, Theme theme);
std::string ladders_svg(const CompareResult& result, Theme theme);

/// metrics.json, which docs/compare.schema.json describes; equal inputs give equal values.
Json compare_result_json(
    const ComparePlan& plan, const RenderStats& stats, const CompareResult& result, const Provenance& provenance);
/// One metric per row, RFC 4180.
std::string compare_csv(const CompareResult& result);
std::string compare_junit(const ComparePlan& plan, const CompareResult& result);
std::string compare_summary(
    const ComparePlan& plan, const RenderStats& stats, const CompareResult& result, const std::string& out_dir);
/// The method of places whose noise is correlated, as in the JSON.
inline constexpr const char* dependent_method = "Benjamini-Yekutieli";
/// One page that works offline, of compare_result_json() or of the file that it was stored in; `plates` are PNG bytes
/// by name. Throws StoredJsonError if the result is something else.
std::string compare_html(const Json& result, const std::map<std::string, std::vector<unsigned char>>& plates);

}  // namespace crescent
