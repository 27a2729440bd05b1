// The results of a comparison as plain data: metrics with their confidence intervals, whether arms differ, where the
// noise differs.
#pragma once

#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compare/file_warnings.h"
#include "compare/noise.h"
#include "compare/shared_seeds.h"
#include "math/statistics.h"
#include "metrics/metrics.h"

namespace crescent {

inline constexpr const char* the_reference = "the reference";
inline constexpr double confidence = 0.95;     // of every interval
inline constexpr double renders_beyond = 1e6;  // larger numbers of renders are reported as this one
inline constexpr double heavy_share = 0.5;     // one squared error with half of their sum decides the mean

/// A metric of one arm in one region. `why`: the reason if there is no value or no interval.
struct MetricValue {
    std::optional<double> value;
    std::optional<std::pair<double, double>> interval;  // 95 %
    std::string why;
};

struct RegionResult {
    std::string region;
    std::uint64_t pixels = 0;
    std::vector<std::pair<std::string, MetricValue>> metrics;  // in the order of compare_words()
    std::optional<Tail> tail;                                  // of the squared errors of all pixels and renders
    double largest_share = 0;                                  // of the largest squared error in their sum
    std::vector<double> power;                                 // error spectrum, see noise.h
    NoiseColour colour = NoiseColour::unknown;
    std::optional<double> stated_ratio;    // the variance that the renderer stated over that over renders
    std::optional<double> renders_needed;  // if the tail is heavy: renders needed for an interval
    const MetricValue& metric(const std::string& name) const;
    /// Returns whether the tail is too heavy for an interval of a mean of squares.
    bool heavy() const;
    /// The same for a mean of the errors themselves: the tail index of their squares is twice theirs.
    bool mean_heavy() const;
};

struct ArmResult {
    std::string name;
    std::size_t renders = 0;
    std::optional<double> spp, seconds;
    std::vector<RegionResult> regions;
    const RegionResult& region(const std::string& region_name) const;
};

/// One test of equal means in a region: of Y, and of each channel if renders are in colour.
struct MeanTest {
    std::string region;   // in a test of a channel: its name
    double a = 0, b = 0;  // means
    Welch welch;
    bool differs = false;            // in this quantity
    bool paired = false;             // over the differences of pairs of renders
    bool pooled = false;             // with the noise of both sides together
    double information = 0;          // of a test that holds at any time, see anytime.h; 0: it is made once
    double smallest = 0;             // the relative difference that would have been found with a probability of 90 %
    std::string why;                 // why it was not tested; "" if it was
    std::string requirement;         // how many renders are needed for a test; "" if `why` says it
    std::string caveat;              // a cause other than a bias for a small p; "" if there is none
    std::vector<MeanTest> channels;  // R, G, B
    double joint_p = std::nan("");   // of "no difference in any of them", see renders.h
    /// Returns the names of the quantities that differ, Y first.
    std::vector<std::string> differs_in() const;
};

/// Tests of many places, with the false discovery rate controlled.
struct PlaceTests {
    std::vector<double> p;                        // per place, of all its quantities; NaN: not tested
    std::vector<std::size_t> quantity;            // per place: the quantity of that p
    std::vector<std::vector<double>> difference;  // [quantity][place]: mean of a minus that of b
    std::vector<bool> differs;
    std::size_t test_count = 0, left_out = 0, different = 0;
};

/// A place that differs: a box with both ends inclusive, and both means in it of the quantity that differs the most.
struct Found {
    Box box;
    double a = 0, b = 0, p = 0;
    std::size_t quantity = 0;
};

/// The difference of two single files; it cannot be compared with noise.
struct SingleDifference {
    std::uint64_t pixels = 0, different = 0;  // finite pixels
    double rms = 0;                           // of the difference of Y
    double largest = 0;                       // largest difference of a channel
    Box place;                                // the pixel with that difference
};

/// An explanation of a difference other than a bias: events on the darker side that are in none of its renders with the
/// probability of a false alarm.
struct MissedEvents {
    std::string arm;
    double size = 0;     // least brightness of such a pixel
    double of_mean = 0;  // the same relative to the mean Y of the place
    double one_in = 0;   // at most one in this many pixels has such an event
};

/// Whether two arms, or an arm and the reference, have the same expectation.
struct BiasResult {
    std::string a, b;
    std::size_t arm_a = 0, arm_b = 0;  // their indices; the number of arms represents the reference
    double place_alpha = 0;            // the level of tiles, and of pixels
    bool identical = false;            // every render of one side has the same pixels as one of the other
    bool paired = false;
    std::vector<SeedPair> shared;  // renders with shared random numbers, found by their residuals
    bool all_shared = false;       // each render of both sides is one of those
    NonFinite non_finite;
    std::optional<SingleDifference> single;  // if each side is one file
    bool dependent = false;                  // the noise of neighbouring pixels is correlated: Benjamini-Yekutieli
    std::string reference_error;             // the source of the reference's own error; "" between arms
    std::vector<MeanTest> regions;
    PlaceTests tiles;
    std::vector<Found> tiles_found, pixels_found;  // the first few, by ascending p
    std::uint64_t pixels_tested = 0, pixels_different = 0;
    std::vector<std::uint32_t> different_pixels;  // ascending
    std::vector<std::uint64_t> tiles_by,
        pixels_by;                       // number of those that differ, by the quantity that differs the most
    std::vector<std::uint64_t> pixel_p;  // histogram of the p of Y over pixels, in twentieths
    double p = std::nan("");             // of "no difference", over every test of these two; NaN: nothing was tested
    bool differs() const;
    /// Returns the quantity to show: Y if the sides differ in it, else the channel that differs the most.
    std::size_t shown() const;
    std::optional<MissedEvents>
        missed_events;  // for the place with the largest required events; only if something differs
    std::string sentence;
};

/// Where the noise differs: log2(variance a / variance b) per tile.
struct NoiseResult {
    std::string a, b;
    std::vector<double> log2_ratio;   // NaN: no variance
    std::vector<bool> distinguished;  // whether the ratio differs significantly from 1
    struct Histogram {
        std::string region;
        std::vector<std::uint64_t> different,
            undistinguished;  // tiles per bin of log2_ratio (noise_bins); the outermost bins are open
    };
    std::vector<Histogram> regions;
    std::string sentence;
};
inline constexpr int noise_bins = 16;       // of width 0.5
inline constexpr double noise_range = 4.0;  // log2 ratios from -4 to 4

/// The order of the arms in one region by one metric; arms with overlapping intervals are not ranked.
struct Ranking {
    std::string region, measure;
    std::vector<std::string> order;  // best first
    std::string sentence;
};

/// Arms that are one sampler at several samples per pixel.
struct SppLadder {
    std::string name;
    std::vector<std::size_t> arms;  // by ascending spp
    std::vector<std::pair<std::string, MetricValue>>
        slopes;  // of log RMSE (else log standard deviation) over log spp, per region
};

struct CompareResult {
    std::vector<ArmResult> arms;
    std::vector<BiasResult> bias;
    std::vector<NoiseResult> noise;
    std::vector<Ranking> rankings;
    std::vector<SppLadder> ladders;
    std::vector<AssertionResult> assertions;
    std::vector<std::string> warnings;
    std::string reference_error_from;               // the source of that error
    std::map<std::string, double> reference_error;  // region -> RMS standard error of the reference's Y; NaN: unknown
    /// Returns whether some pair of arms, or an arm and the reference, differs.
    bool differs() const;
    enum class State { holds, fails, inconclusive } state = State::holds;
    std::string sentence;                      // describes the state
    std::optional<std::size_t> stated_pair{};  // of `bias`, if the sentence is that of a pair
};

}  // namespace crescent
