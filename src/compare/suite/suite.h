// A suite of views: each has renders of a baseline and of a candidate, and all tests of all views share one level of
// false alarms. The data of the file and of the result.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "compare/file_pattern.h"
#include "compare/results.h"
#include "compare/suite/exact.h"
#include "compare/suite/manifest.h"
#include "math/statistics.h"

namespace crescent {

/// The share of a view's level for the tests of equal means and of finite values; the rest is for the noise.
inline constexpr double share_of_means = 0.75;
/// The share of a view's level for an outlier render, if it is tested.
inline constexpr double share_of_render = 0.03;
/// The share of the level of a suite for the numbers of outlier pixels, if some view has enough of them; the views that
/// have share it. Ten outlier pixels against none, with as many renders of each side, have p = 0.00195: a change at
/// this share of a level of 0.01. What remains of the noise's share is for the variances.
inline constexpr double share_of_outliers = 0.2;

/// How --accept stores a baseline: its renders, or the mean and the variance of each pixel.
enum class BaselineStorage { renders, moments };

/// Whether renders are compared in pairs: if they share random numbers, or those with the same number in their names.
enum class Pairing { automatic, always, never };

/// What is required of the noise: that there is not more, that it is the same, or nothing.
enum class NoiseDemand { not_more, same, ignore };
/// Whether the numbers of outlier pixels of both sides are compared.
enum class OutlierDemand { test, ignore };

/// The table [suite] of a suite file.
struct SuiteOptions {
    std::string title = "golden images";
    double alpha = 0.01;                           // false alarms of the whole suite
    std::vector<std::string> baseline, candidate;  // patterns as in the file
    double smallest = 0.01;                        // relative difference of mean Y that must be found
    std::string layer;
    ImageEncoding encoding = ImageEncoding::automatic;  // of files of whole numbers
    ImageSpace space = ImageSpace::radiance;
    TestedChannels channels = TestedChannels::rgb;
    std::string channel;  // this one alone; "": `channels`
    double exposure = 1;
    std::optional<double> brightest;
    BaselineStorage store = BaselineStorage::renders;
    Pairing pair = Pairing::automatic;
    NoiseDemand noise = NoiseDemand::not_more;
    OutlierDemand outliers = OutlierDemand::test;
    std::string tolerance_text;          // of views without noise; "": none
    std::optional<Tolerance> tolerance;  // the same
    ReadingOptions reading() const {
        return {.encoding = encoding, .space = space, .channels = channels, .channel = channel};
    }
};

/// The file's statements about one view, and its renders.
struct SuiteView {
    std::string name;
    SourceLocation location;
    std::optional<double> smallest;  // none: that of the suite
    std::optional<Pairing> pair;
    std::optional<NoiseDemand> noise;
    std::optional<OutlierDemand> outliers;
    std::string tolerance_text;          // of a view without noise; "": that of the suite
    std::optional<Tolerance> tolerance;  // the same
    std::vector<Region> regions;
    std::vector<std::string> baseline, candidate;  // files, sorted
};

/// A suite file with the files that its patterns found.
struct Suite {
    std::string file;  // "": none
    SuiteOptions options;
    std::vector<FilePattern> baseline, candidate;  // with {view}, from the current folder
    std::vector<SuiteView> views;                  // by name
    std::optional<Manifest> manifest;              // of the baseline
    unsigned look_number = 0;                      // number of this look at its renders, see ComparePlan
    std::size_t compared() const;                  // views with renders of both sides
    double smallest(const SuiteView& view) const { return view.smallest.value_or(options.smallest); }
    Pairing pair(const SuiteView& view) const { return view.pair.value_or(options.pair); }
    NoiseDemand noise(const SuiteView& view) const { return view.noise.value_or(options.noise); }
    OutlierDemand outliers(const SuiteView& view) const { return view.outliers.value_or(options.outliers); }
    std::optional<Tolerance> tolerance(const SuiteView& view) const {
        return view.tolerance ? view.tolerance : options.tolerance;
    }
};

/// The results for a view, the most severe first.
enum class ViewState { unreadable, changed, noisier, missing, added, too_few, improved, same };
inline constexpr std::array<const char*, 8> view_state_names = {
    "unreadable", "changed", "noisier", "missing", "new", "too few renders", "improved", "same"};
/// Returns the state as in the outputs.
inline const char* name_of(ViewState state) { return view_state_names[static_cast<std::size_t>(state)]; }

/// Welch's test over renders of the variance of a pixel, mean over a region.
struct VarianceTest {
    std::string region;
    double baseline = 0, candidate = 0;
    Welch welch;
    std::string why;         // why it was not tested; "" if it was
    bool different = false;  // at the level of the view
    double smallest = 0;     // ratio to the baseline that would have been found with a probability of 90 %
};

/// The outlier pixels of both sides, and the test that their numbers are in proportion to the numbers of renders (exact
/// binomial test of groups).
struct ViewOutliers {
    /// One of them: its file, place and quantity, its value, and the mean of the other renders there.
    struct Place {
        std::string file;
        int x = 0, y = 0;
        std::size_t quantity = 0;
        double value = 0, others = 0;
    };
    std::uint64_t baseline = 0, candidate = 0;  // groups
    std::vector<Place> first;                   // the first few of the side with more for its renders
    bool set_apart = false;                     // left out of the tests of means and variances
    double p = std::nan("");                    // NaN: too few for any split to be a change
};

/// The render that deviates the most from the others of its side, and p of none; see outliers.h.
struct ViewOutlierRender {
    std::string file;  // "": not tested
    bool candidate = false;
    double ratio = 1, deviation = 0, p = std::nan("");
    std::uint64_t pixels = 0;  // its outlier pixels, if their number is what deviates
};

/// PNG files of one view, all of the same size.
struct ViewPictures {
    int width = 0, height = 0;
    std::vector<unsigned char> baseline, candidate, difference, significance, noise;  // empty: none
    double scale = 0;  // relative difference at the ends of the colours of `difference`
};

/// One view: its state, the sentence that states it, its tests and pictures.
struct ViewResult {
    std::string name;
    ViewState state = ViewState::same;
    std::string headline;            // the result in at most 160 characters
    std::string sentence;            // with the details
    std::vector<std::string> notes;  // copies, shared seeds, warnings about files
    int width = 0, height = 0;
    std::size_t baseline_renders = 0, candidate_renders = 0;  // different ones
    double smallest = 0;                                      // that must be found
    bool exact = false;                                       // both sides are deterministic
    std::optional<ExactDifference> exact_difference;          // if they are, and differ
    bool tolerated = false;                                   // it is within the tolerance
    std::string other_channels;                               // that differ and are not tested; "": none
    NoiseDemand noise = NoiseDemand::not_more;
    std::optional<double> spp_baseline, spp_candidate;  // as the files state them
    std::string noisiest;                               // where the noise grew the most; "": unknown
    bool moments = false;                               // the baseline is stored as moments
    std::optional<BiasResult> means;  // of the candidate against the baseline; without what grows with the pixels
    std::vector<VarianceTest> variances;
    ViewOutliers outliers;
    ViewOutlierRender outlier_render;
    double mean_p = std::nan(""), variance_p = std::nan("");  // of no difference in any region; NaN: not tested
    double level = 0;                                         // at which the view was decided
    double outlier_level = 0;                                 // at which the number of outlier pixels was
    double share_of_variances = 1 - share_of_means;           // of the level
    std::string too_few;                                      // why equality cannot be stated; "" if it can
    std::string untestable;  // why no number of such renders can show anything; "" if one can
    std::string remedy;      // what to do then, sentences
    std::vector<std::uint64_t> baseline_hashes, candidate_hashes;  // of the pixels of each file, as in the view
    bool uniform = false;                       // all renders of a side are equal, and their pixels have one colour
    std::string non_finite;                     // the pixels that are not finite on one side only; "" if there are none
    std::optional<std::size_t> renders_needed;  // of each side
    ViewPictures pictures;
};

/// All views of a suite.
struct SuiteResult {
    std::vector<ViewResult> views;
    std::size_t tested_views = 0;  // views that share alpha
    std::size_t count(ViewState state) const;
    std::string sentence;
};

inline constexpr std::size_t longest_headline = 160;  // characters

}  // namespace crescent
