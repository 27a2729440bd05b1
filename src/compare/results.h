// What a comparison found, as plain data: metrics with their doubt, whether arms differ, where the noise moved.
#pragma once

#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compare/file_warnings.h"
#include "compare/renders.h"
#include "compare/noise.h"
#include "math/hypotheses.h"
#include "metrics/metrics.h"

namespace crescent::inline comparison {

inline constexpr const char* the_reference = "the reference";
inline constexpr double confidence = 0.95;  // of every interval
inline constexpr double heavy_share = 0.5;  // one squared error that is half of their sum decides a mean by itself

/// A metric of one arm in one region. `why` says why there is no value or no interval.
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
    std::optional<double> stated_ratio;    // the variance that the renderer wrote over that over renders
    std::optional<double> renders_needed;  // where the tail is heavy: renders from which an interval could be said
    const MetricValue& metric(const std::string& name) const;
    /// The tail is too heavy for an interval of a mean of squares to mean anything.
    bool heavy() const;
    /// The same for a mean of the errors themselves: their squares' index is twice theirs.
    bool mean_heavy() const;
};

struct ArmResult {
    std::string name;
    std::size_t renders = 0;
    std::optional<double> spp, seconds;
    std::vector<RegionResult> regions;
    const RegionResult& region(const std::string& name) const;
};

/// One test of equal means of a region: of Y, and of each channel where renders are in colour.
struct MeanTest {
    std::string region;   // of a channel's test: its name
    double a = 0, b = 0;  // means
    Welch welch;
    bool differs = false;            // in this quantity
    bool paired = false;             // over differences of pairs of renders
    double smallest = 0;             // the relative difference that would have been seen nine times out of ten
    std::string why;                 // why it was not tested; "" where it was
    std::string doubt;               // p is small, and what else than a bias may be the reason; "" where nothing is
    std::vector<MeanTest> channels;  // R, G, B
    double joint_p = std::nan("");   // of no difference in any of them, see quantities.h
    /// Names of the quantities that differ, Y first.
    std::vector<std::string> differs_in() const;
};

/// Tests of many places at once, their false discoveries controlled.
struct PlaceTests {
    std::vector<double> p;                        // a place, of all its quantities; NaN: not tested
    std::vector<std::size_t> quantity;            // a place: which that p is from
    std::vector<std::vector<double>> difference;  // [quantity][place]: mean of a less that of b
    std::vector<bool> differs;
    std::size_t tested = 0, left_out = 0, different = 0;
};

/// A place that differs: pixels, both ends inside, and the means of both there of the quantity that differs the most.
struct Found {
    Box box;
    double a = 0, b = 0, p = 0;
    std::size_t quantity = 0;
};

/// How two single files differ; whether that is noise, they do not say.
struct SingleDifference {
    std::uint64_t pixels = 0, different = 0;  // finite ones
    double rms = 0;                           // of the difference of Y
    double largest = 0;                       // difference of a channel
    Box at;                                   // the pixel where that is
};

/// What else than a bias could have made a difference: events of the darker side that none of its renders met, with the
/// probability of a false alarm.
struct MissedEvents {
    std::string arm;
    double size = 0;     // at least so bright a pixel
    double of_mean = 0;  // the same over the mean Y of the place
    double one_in = 0;   // at most one pixel of so many meets one
};

/// Two arms, or an arm and the reference: are their expectations the same?
struct BiasResult {
    std::string a, b;
    std::size_t arm_a = 0, arm_b = 0;  // their places; the number of arms stands for the reference
    double place_alpha = 0;            // what tiles have, and pixels
    bool identical = false;            // every render of one side has the same pixels as one of the other
    bool paired = false;
    std::vector<SeedPair> shared;  // renders that share their random numbers, as their residuals show
    bool all_shared = false;       // each render of either side is one of those
    NonFinite non_finite;
    std::optional<SingleDifference> single;  // of one file a side
    bool dependent = false;                  // neighbouring pixels' noise is correlated: Benjamini-Yekutieli
    std::string reference_error;             // how the reference's own error is known; "" between arms
    std::vector<MeanTest> regions;
    PlaceTests tiles;
    std::vector<Found> tiles_found, pixels_found;  // the most certain first, a few of them
    std::uint64_t pixels_tested = 0, pixels_different = 0;
    std::vector<std::uint32_t> different_pixels;     // rising
    std::vector<std::uint64_t> tiles_by, pixels_by;  // of those that differ, by the quantity that differs the most
    std::vector<std::uint64_t> pixel_p;              // histogram of the p of Y over pixels, in twentieths
    double p = std::nan("");  // of no difference at all, over every test of these two; NaN: nothing was tested
    bool differs() const;
    /// The quantity to show where the sides differ: Y where it differs at all, else the channel that differs the most.
    std::size_t shown() const;
    std::optional<MissedEvents> unless;  // of the place that is hardest to explain by them; where something differs
    std::string sentence;
};

/// Where the noise moved from b to a: log2(variance a / variance b) a tile.
struct NoiseResult {
    std::string a, b;
    std::vector<double> log2_ratio;   // NaN: no variance
    std::vector<bool> distinguished;  // from 1
    struct Histogram {
        std::string region;
        std::vector<std::uint64_t> describe, rest;  // tiles by log2_ratio, noise_bins of them, ends open
    };
    std::vector<Histogram> regions;
    std::string sentence;
};
inline constexpr int noise_bins = 16;       // of half a unit each
inline constexpr double noise_range = 4.0;  // log2 from -4 to 4

/// Who is better in one region, by one measure; arms whose intervals overlap are not ranked.
struct Ranking {
    std::string region, measure;
    std::vector<std::string> order;  // best first
    std::string sentence;
};

/// One arm at several samples a pixel.
struct SppLadder {
    std::string name;
    std::vector<std::size_t> arms;                            // by rising spp
    std::vector<std::pair<std::string, MetricValue>> slopes;  // of log RMSE (else log sd) over log spp, a region each
};

struct CompareResult {
    std::vector<ArmResult> arms;
    std::vector<BiasResult> bias;
    std::vector<NoiseResult> noise;
    std::vector<Ranking> rankings;
    std::vector<SppLadder> ladders;
    std::vector<AssertionResult> assertions;
    std::vector<std::string> warnings;
    std::string reference_error_from;               // how it is known
    std::map<std::string, double> reference_error;  // region -> rms standard error of the reference's Y; NaN: not known
    /// Some pair of arms, or an arm and the reference, differs.
    bool differs() const;
    enum class State { holds, fails, inconclusive } state = State::holds;
    std::string sentence;  // one for the state
};

}  // namespace crescent::inline comparison
