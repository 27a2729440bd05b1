// A suite of views: each has renders of a baseline and of a candidate, and all tests of all views share one level of
// false alarms. The data of the file and of the result.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compare/compare.h"
#include "compare/file_pattern.h"
#include "compare/plan.h"
#include "compare/results.h"
#include "compare/suite/exact.h"
#include "compare/suite/manifest.h"
#include "math/statistics.h"
#include "report/report.h"

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

/// Flags that replace or complete the keys of a suite file.
struct SuiteFlags {
    std::vector<CompareFlag> keys;    // of [suite]
    std::string baseline, candidate;  // folders with VIEW/*.exr, VIEW-SEED.exr or VIEW.exr; "": the file's patterns
    bool baseline_only = false;       // no renders of the candidate are needed
};

/// Returns whether the file is a suite: it has a table [suite].
bool is_suite(const std::string& file);
/// Reads a suite file ("": none, the folders of the flags) and finds the renders of each view. Throws InputError.
Suite read_suite(const std::string& file, const SuiteFlags& flags);
/// Returns the files of each pattern; a file that several match belongs to the first of them.
std::vector<std::vector<MatchedFile>> files_of_patterns(const std::vector<FilePattern>& patterns);
/// Returns the tables [suite] and [view.NAME] that flags alone make, without renders. Throws InputError.
Suite read_suite_flags(const std::vector<CompareFlag>& keys);
/// Returns the manual of a suite file.
std::string suite_schema_text();

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

/// Returns the exit code: 2 for unreadable views, 1 for changed, noisier or missing views and, unless `new_baseline`
/// allows them, new ones, 4 for too few renders, else 0.
int exit_code(const SuiteResult& result, bool new_baseline);

inline constexpr std::size_t longest_headline = 160;  // characters

/// Returns a hash of the pixels of a render, to find copies.
std::uint64_t pixel_hash(const Render& render);

/// Reads and tests one view. `compared`: the number of views that share alpha.
ViewResult measure_view(const Suite& suite, const SuiteView& view, std::size_t compared, ProgressMonitor& monitor,
    const RenderSource& source);

/// Decides all views together: Holm's method over their p-values.
void decide(const Suite& suite, SuiteResult& result);

/// Measures and decides every view, one view in memory at a time. A view whose files cannot be compared, or differ from
/// the manifest, is unreadable; the others are compared all the same.
SuiteResult compare_suite(const Suite& suite, ProgressMonitor& monitor, const RenderSource& source);
/// The same of files, read as the suite states.
SuiteResult compare_suite(const Suite& suite, ProgressMonitor& monitor);

// ---- --accept: the candidate of some views becomes the baseline, of all of them at once.

/// Which views of a candidate become the baseline, and the statements of the manifest about it.
struct Acceptance {
    std::vector<std::string> views;      // names; empty: all that have a candidate
    std::string because, date, program;  // for the manifest
};

/// Replaces the baseline's files of these views, stored as the suite states, and writes baseline.json next to them: the
/// files with their hashes, mean and variance of each region, program, date and reason of each view. A named view
/// without renders of the candidate is removed from the baseline. `read` returns the suite; it is called again with the
/// baseline locked against others that accept. What is stored is what was measured, also if candidates are rewritten
/// meanwhile. A kill leaves the old baseline or the new one. Returns a line for each view. Throws InputError,
/// OutputError, Interrupted.
std::vector<std::string> accept_views(
    const std::function<Suite()>& read, const Acceptance& acceptance, ProgressMonitor& monitor);

/// Returns the folder of the baseline: the part before the first wildcard of its first pattern. Throws InputError if
/// another pattern is not in it.
std::string baseline_folder(const Suite& suite);

// ---- The result of a suite as text: for machines, build servers, the summary page of a pull request and the terminal.

/// docs/suite.schema.json describes it; equal inputs give equal bytes.
std::string suite_json(const Suite& suite, const SuiteResult& result, bool new_baseline, const Provenance& provenance);
/// Results that are not "same" or "improved" in the Static Analysis Results Interchange Format 2.1.0, with the place of
/// the view in the suite file, for code hosts.
std::string suite_sarif(const Suite& suite, const SuiteResult& result, bool new_baseline, const Provenance& provenance);
/// One case for each view: changed, noisier, missing and new fail, unreadable and too few renders are errors; new is
/// skipped if `new_baseline` allows it.
std::string suite_junit(const Suite& suite, const SuiteResult& result, bool new_baseline);
/// One case: the call failed before there was a result.
std::string failure_junit(const std::string& file, const std::string& message);
/// The same in SARIF, with the places of an InputError that are in `file`. `version`: of crescent.
std::string failure_sarif(const std::string& version, const std::string& file, const std::exception& error);
/// A table of all views that are not the same, at most 60 kB.
std::string suite_markdown(const Suite& suite, const SuiteResult& result, const Provenance& provenance);
std::string suite_summary(const Suite& suite, const SuiteResult& result);
/// One page that works offline.
std::string suite_html(const Suite& suite, const SuiteResult& result, const Provenance& provenance);

/// The pictures of the views that are not the same or improved, as "plates/1-VIEW-difference.png", worst views first.
std::vector<std::pair<std::string, std::vector<unsigned char>>> suite_plates(const SuiteResult& result);

/// Views in the order of their states, changed first, then by the size of what changed, then by name.
std::vector<const ViewResult*> by_state(const SuiteResult& result);

// ---- The pictures of a view in the report: photographs of the means of both sides and a map of their relative
// difference.

/// For a view with renders of one side only.
void picture_one_side(const Suite& suite, const SuiteView& view, const RenderSource& source, ViewResult& out);
/// For a view with both. The size follows from the number of views, larger if the view may have changed.
void picture_both_sides(const Suite& suite, const RenderStats& stats, const BiasResult& means, ViewResult& out);
/// Adds the tiles in which the variance of the candidate differs from that of the baseline, if there are any. After the
/// other pictures, whose size it has.
void picture_noise(const RenderStats& stats, const NoiseResult& noise, ViewResult& out);

// ---- --plan: how many renders of each side, with how many samples, a view needs, from the variance of the baseline
// only.

// ---- The difference of means that a test finds with a probability of 90 %, and the renders that it needs.

/// Returns the difference that a repetition of the test finds with a probability of 90 % at this level, if the error of
/// a mean is known only from an estimate with `estimate_df` degrees of freedom. The estimate may be too small by
/// chance, and so may that of the repetition: the difference is larger than that of detectable() (by a fifth for 8
/// renders of each side), and infinite for too few degrees of freedom.
/// With `information`, of a test that holds at any time, see anytime.h.
double found_difference(const Welch& test, double estimate_df, double level, double information = 0);

/// The noise of the mean of a region, known before more renders exist.
struct RegionPower {
    double mean = 0;                        // of Y
    double variance_a = 0, variance_b = 0;  // of the mean of one render of each side; in pairs a: of a difference
    double estimate_df = 0;                 // degrees of freedom with which they are known
    bool paired = false;
    bool anytime = false;          // of a test that holds at any time
    double hidden_difference = 0;  // difference that rare events could hide, times the renders of a side
};

/// Returns the difference that a test with `renders` renders of each side finds with a probability of 90 %.
double detectable_with(const RegionPower& power, std::size_t renders, double level);

/// The smallest number of renders of each side with which a relative difference `smallest` is found; nothing above
/// 100 000.
std::optional<std::size_t> renders_needed(const RegionPower& power, double smallest, double level);

/// The samples of a render over those of a render of the baseline for which the plan states renders.
inline constexpr std::array<double, 3> plan_samples = {0.25, 1, 4};

/// The renders that a view needs to find its smallest difference, from the variance of its baseline.
struct ViewPlan {
    std::string name, region;  // the region that needs the most renders
    std::size_t renders = 0;   // of the baseline
    std::optional<double> spp;
    double smallest = 0, mean = 0;
    double deviation = 0;                                       // of the mean of one render
    std::array<std::optional<std::size_t>, 3> render_counts{};  // of each side, at plan_samples
    std::string why;                                            // why nothing can be stated; "" if it can
};

/// Returns the plan of each view, by name. Reads every baseline; throws InputError if a file cannot be compared.
std::vector<ViewPlan> plan_renders(const Suite& suite, ProgressMonitor& monitor);
/// Returns the plans as a table for the terminal.
std::string render_plan_text(const Suite& suite, const std::vector<ViewPlan>& plans);
/// Returns the plans as JSON.
std::string render_plan_json(const Suite& suite, const std::vector<ViewPlan>& plans);

}  // namespace crescent
