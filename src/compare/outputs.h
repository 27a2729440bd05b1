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

namespace crescent::inline comparison {

// ---- The two sides of a test of the means of one quantity: an arm, and another arm or the reference; what is known of
// their noise. Where renders are paired, it is that of their differences.

/// Mean and standard error over renders; without the ends of an interval, whose quantile takes longer than the rest.
MeanInterval mean_and_error(std::span<const double> values);

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
    bool count_pixel_p = true;   // see ComparePlan
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

// ---- Pictures of a comparison, by file name without .png.

namespace crescent::plates {

// ---- What the plates of a comparison are put together from: header and caption, blocks of pixels, colour bars.

inline constexpr double bar_room = 116;

/// The header of a sheet; finish() sets caption and footer.
void header(Canvas& c, bool backend, const std::string& label);
void finish(Canvas& c, const std::string& caption, const std::string& note);
/// The same, and what was drawn.
Picture finished(Canvas& c, const std::string& caption, const std::string& note);

/// Blue below, orange above, towards the ground in the middle; t in [-1, 1], NaN: the ground.
Srgb8 diverging(double t, Theme theme);

/// value(x, y) of the box through diverging(); where it is reduced, means of what a pixel covers.
Block diverging_block(const Box& box, const Fit& fit, Theme theme, const std::function<double(int, int)>& value);
/// colour(x, y) of the box, the nearest pixel's.
Block nearest_block(const Box& box, const Fit& fit, const std::function<Srgb8(int, int)>& colour);

/// Painted at the top of the slot, in its middle, with a frame; where it came to stand.
Rect framed(Canvas& c, const Block& block, const Rect& slot);

using Ticks = std::vector<std::pair<double, std::string>>;  // share of the bar, words
/// A vertical bar of colour(t), t from 0 below to 1 above.
void bar(Canvas& c, const Rect& at, const std::function<Srgb8(double)>& colour, const Ticks& ticks);
/// diverging() over such a bar.
std::function<Srgb8(double)> signed_colours(Theme theme);

}  // namespace crescent::plates

namespace crescent::inline comparison {

/// renders, errors, ladders, bias-A-B, noise-A-B: those that there is something to show for. Throws OutputError without
/// the font.
std::map<std::string, Picture> compare_plates(
    const ComparePlan& plan, const RenderStats& all, const CompareResult& result);

struct BiasPair;
/// Signed difference of two means, tiles and pixels in which it is told, and the ratio of two variances.
Picture difference_plate(const BiasPair& sides, const std::string& a, const std::string& b, Theme theme);
Picture bias_plate(const BiasPair& sides, const BiasResult& found, Theme theme);
Picture noise_plate(const RenderStats& all, const NoiseResult& noise, Theme theme);
/// Needs a ladder.
Picture ladders_plate(const CompareResult& result, Theme theme);
std::string ladders_svg(const CompareResult& result, Theme theme);

}  // namespace crescent::inline comparison

namespace crescent::inline comparison {

// ---- The sections of a comparison's page, as HTML; "" where there is nothing to say.

/// The tables of the page: every metric by arm and region, with its interval.
std::string numbers_section(const ComparePlan& plan, const RenderStats& all, const CompareResult& result);
std::string rankings_section(const CompareResult& result);
std::string means_section(const CompareResult& result);
std::string noise_section(const CompareResult& result);
std::string ladders_section(const CompareResult& result);
std::string spectra_section(const RenderStats& all, const CompareResult& result);
std::string files_section(const RenderStats& all, const CompareResult& result);

/// docs/compare.schema.json says what stands in it; equal inputs give equal bytes.
std::string compare_json(
    const ComparePlan& plan, const RenderStats& all, const CompareResult& result, const Provenance& provenance);
/// One metric a row, RFC 4180.
std::string compare_csv(const CompareResult& result);
std::string compare_junit(const ComparePlan& plan, const CompareResult& result);
std::string compare_summary(
    const ComparePlan& plan, const RenderStats& all, const CompareResult& result, const std::string& out_dir);
/// One page that opens offline; `plates` are PNG bytes by name.
std::string compare_html(const ComparePlan& plan, const RenderStats& all, const CompareResult& result,
    const Provenance& provenance, const std::map<std::string, std::vector<unsigned char>>& plates);

}  // namespace crescent::inline comparison
