// Tests whether two sets of renders have the same expectation: Welch's t-test over renders, of Y and each channel, per
// region, tile and pixel, after Jung, Hanika & Dachsbacher 2020, "Detecting Bias in Monte Carlo Renderers using Welch's
// t-test", JCGT 9(2). Renders that share their random numbers are compared by Student's t-test over their differences.
// The level is split: half for the regions (Holm), a quarter each for tiles and pixels (false discovery rate); within
// each, half for Y and a sixth for each channel (Bonferroni). If some values are not finite, half of the whole level is
// for them.
#include "compare/bias.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "base/parallel.h"
#include "compare/anytime.h"
#include "compare/noise.h"
#include "compare/renders.h"
#include "compare/shared_seeds.h"
#include "compare/wording.h"
#include "output/format.h"

namespace crescent {

// Tests of each pixel, defined below.

/// Sets the pixel results of `out` and returns p of "no pixel differs"; `sides` are of the same renders, one entry per
/// quantity. Sets nothing and returns NaN if the reference is one file that does not state its error at each pixel.
double test_pixels(std::span<const BiasPair> sides, const BiasLevel& level, BiasResult& out);

/// Returns the level that test_pixels() passes to BiasPair::missable_difference().
double pixel_level(const BiasPair& sides, double alpha);

namespace {

using Values = std::vector<double>;

constexpr std::size_t named_most = 5;  // largest number of places that are listed

/// The two sides, one entry per quantity: as independent renders, and in pairs if there are any.
struct AllSides {
    std::vector<BiasPair> independent_sides, paired_sides;

    const BiasPair& first() const { return independent_sides[0]; }
    /// Pairs, missed_events a few of their pixels decide the mean.
    const BiasPair& in_region(std::size_t quantity, std::size_t region) const {
        const bool pairs = !paired_sides.empty() && paired_sides[quantity].heavy_in(region).empty();
        return pairs ? paired_sides[quantity] : independent_sides[quantity];
    }
    const BiasPair& in_tile(std::size_t quantity, std::size_t tile) const {
        const bool pairs = !paired_sides.empty() && !paired_sides[quantity].lone_pixel_in(tile);
        return pairs ? paired_sides[quantity] : independent_sides[quantity];
    }
};

std::string why_not(const BiasPair& sides, std::size_t region) {
    if (sides.stats.regions[region].pixels.empty()) return "no pixel is finite in every render";
    if (!sides.pools() && (sides.a.files.size() < 2 || (sides.other && sides.b.files.size() < 2)))
        return "two renders or more of each arm are needed";
    if (sides.pairs && sides.pairs->size() < 2) return "two pairs or more are needed";
    const std::string heavy = sides.heavy_in(region);
    return heavy.empty() ? "" : "heavy tail: " + heavy;
}

/// Returns how many renders a region with a heavy tail needs; "" if its tail is not heavy.
std::string renders_needed_text(const BiasPair& sides, std::size_t region) {
    const std::string heavy = sides.heavy_in(region);
    for (const ArmResult* arm : {&sides.arm, sides.other}) {
        if (!arm || arm->name != heavy) continue;
        const auto& renders = arm->regions[region].renders_needed;
        if (!renders) return "; how many renders are needed is unknown";
        if (*renders >= renders_beyond) return "; more than a million renders are needed";
        return fmt::format("; about {:.0f} renders are needed", *renders);
    }
    return "";
}

MeanTest mean_test(const BiasPair& sides, std::size_t r, double level) {
    const Values a = sides.region_means(sides.a, r), b = sides.region_means(sides.b, r);
    const PixelSet& set = sides.stats.regions[r];
    MeanTest t;
    t.region = quantity_names[sides.quantity];
    t.paired = sides.in_pairs();
    t.pooled = sides.pools();
    t.a = mean_and_error(a).mean;
    t.b = mean_and_error(b).mean;
    t.why = why_not(sides, r);
    if (!t.why.empty()) {
        t.requirement = renders_needed_text(sides, r);
        return t;
    }
    const SetVariance noise = sides.noise_of(set);
    t.welch = sides.test(a, b, noise, false);
    t.information = sides.information();
    const double undetectable =
        std::max({sides.missable_difference(1, noise.pixels, level), sides.missable_difference(-1, noise.pixels, level),
            sides.undetectable_difference(t.a, t.b, noise.pixels, noise.unpaired_variance, level)});
    t.smallest = std::max(sides.detectable_difference(t.welch, level), undetectable) / std::max(std::fabs(t.b), 1e-300);
    if (std::isnan(t.welch.p)) t.why = "the noise of one side is not a finite number";
    return t;
}

/// Describes events that could explain a small p: no brighter than those of some render or than the bound of the files,
/// they may be in none of the renders of one side.
std::string missed_events_text(const BiasPair& sides, const MeanTest& t, double pixels, double level) {
    const auto events = sides.events_for({{}, t.a, t.b, t.welch.p, sides.quantity}, pixels, level);
    if (!events) return {};
    return fmt::format(
        "heavy tail: {} is darker by {}{}, which events brighter than {} in one of {:.0f} pixels would explain if "
        "its renders contain none",
        events->arm, percent(std::fabs(t.a - t.b) / std::max(t.a, t.b), 2),
        sides.quantity == 0 ? "" : fmt::format(" in {}", quantity_names[sides.quantity]), figures(events->size, 2),
        events->one_in);
}

/// The tests of one region, one per quantity; `p` is plain, `detectable_p` is 1 where the difference is smaller than
/// the tests can detect.
struct RegionTests {
    std::vector<MeanTest> quantity_tests;
    Values p, detectable_p;
};

RegionTests region_tests(const AllSides& sides_of_all, std::size_t r, double level) {
    RegionTests out;
    for (std::size_t q = 0; q < sides_of_all.independent_sides.size(); ++q) {
        const BiasPair& sides = sides_of_all.in_region(q, r);
        const double share = level * level_share(q, sides_of_all.independent_sides.size());
        const MeanTest t = mean_test(sides, r, share);
        const double p = t.why.empty() ? t.welch.p : std::nan("");
        out.p.push_back(p);
        out.detectable_p.push_back(p);
        out.quantity_tests.push_back(t);
        if (std::isnan(p)) continue;
        const SetVariance noise = sides.noise_of(sides.stats.regions[r]);
        if (std::fabs(t.a - t.b) <
            sides.undetectable_difference(t.a, t.b, noise.pixels, noise.unpaired_variance, share))
            out.detectable_p.back() = 1;
    }
    return out;
}

/// Returns why a small p of a region is not reported as a difference; "" if the tests can detect the difference.
std::string why_not_seen(const AllSides& sides_of_all, const RegionTests& tests, std::size_t r, double level) {
    const std::size_t q = joint_p(tests.p).quantity;
    const BiasPair& sides = sides_of_all.in_region(q, r);
    const MeanTest& t = tests.quantity_tests[q];
    const double pixels = static_cast<double>(sides.stats.regions[r].pixels.size()),
                 share = level * level_share(q, tests.quantity_tests.size());
    const bool is_missable = std::fabs(t.a - t.b) < sides.missable_difference(t.a - t.b, pixels, share);
    return is_missable ? missed_events_text(sides, t, pixels, share) : "";
}

/// Returns p of "no region differs" (Bonferroni).
double test_regions(const AllSides& sides_of_all, const BiasLevel& levels, BiasResult& out) {
    const auto& regions = sides_of_all.first().stats.regions;
    const double level = levels.power_level / static_cast<double>(regions.size()),
                 report_level = levels.report_level / static_cast<double>(regions.size());
    std::vector<RegionTests> tests;
    Values p, detectable_p;
    for (std::size_t r = 0; r < regions.size(); ++r) {
        tests.push_back(region_tests(sides_of_all, r, level));
        p.push_back(joint_p(tests[r].p).p);
        detectable_p.push_back(joint_p(tests[r].detectable_p).p);
    }
    const std::vector<bool> small = holm(p, levels.power_level), differs = holm(detectable_p, levels.report_level);
    for (std::size_t r = 0; r < regions.size(); ++r) {
        RegionTests& test = tests[r];
        for (std::size_t q = 0; q < test.quantity_tests.size() && differs[r]; ++q)
            test.quantity_tests[q].differs = test.detectable_p[q] / level_share(q, test.quantity_tests.size()) <=
                std::max(report_level, detectable_p[r]);
        MeanTest& t = out.regions.emplace_back(test.quantity_tests[0]);
        t.region = regions[r].name;
        t.joint_p = detectable_p[r];
        t.channels.assign(test.quantity_tests.begin() + 1, test.quantity_tests.end());
        if (small[r] && !differs[r]) t.caveat = why_not_seen(sides_of_all, tests[r], r, level);
    }
    double smallest = std::nan("");
    for (const double value : detectable_p) smallest = std::fmin(smallest, value);
    return std::fmin(1, smallest * static_cast<double>(regions.size()));
}

/// The test of one quantity in one tile; p is NaN if there is no test.
struct TileTest {
    double p = std::nan(""), difference = std::nan("");
    bool left_out = false;
};

TileTest test_tile(const BiasPair& sides, std::size_t t, double level) {
    TileTest out;
    const Values a = sides.tile_means(sides.a, t), b = sides.tile_means(sides.b, t);
    const SetVariance noise = sides.noise_of(sides.stats.tiles.box(t, sides.stats.width, sides.stats.height));
    if (noise.pixels == 0) return out;  // no pixel is finite
    const double d = out.difference = mean_and_error(a).mean - mean_and_error(b).mean;
    out.left_out = sides.lone_pixel_in(t);
    if (out.left_out) return out;
    const Welch w = sides.test(a, b, noise, true);
    if (w.se == 0 && d == 0 && !sides.in_pairs()) return out;  // the same constant on both sides
    const bool undetectable = std::fabs(d) <
        sides.undetectable_difference(noise.mean_b + d, noise.mean_b, noise.pixels, noise.unpaired_variance, level);
    out.p = undetectable ? 1 : w.p;
    out.left_out = std::isnan(out.p);
    return out;
}

void name_tiles(const AllSides& sides_of_all, BiasResult& result) {
    PlaceTests& out = result.tiles;
    std::vector<std::size_t> tiles;
    for (std::size_t t = 0; t < out.p.size(); ++t)
        if (out.differs[t]) {
            tiles.push_back(t);
            ++result.tiles_by[out.quantity[t]];
        }
    out.different = tiles.size();
    std::sort(tiles.begin(), tiles.end(),
        [&](std::size_t s, std::size_t t) { return out.p[s] != out.p[t] ? out.p[s] < out.p[t] : s < t; });
    for (std::size_t k = 0; k < std::min(tiles.size(), named_most); ++k) {
        const RenderStats& readings = sides_of_all.first().stats;
        const Box box = readings.tiles.box(tiles[k], readings.width, readings.height);
        const std::size_t q = out.quantity[tiles[k]];
        const double b = sides_of_all.independent_sides[q].noise_of(box).mean_b;
        result.tiles_found.push_back({box, b + out.difference[q][tiles[k]], b, out.p[tiles[k]], q});
    }
}

/// Returns p of "no tile differs".
double test_tiles(const AllSides& sides_of_all, const BiasLevel& levels, BiasResult& result) {
    PlaceTests& out = result.tiles;
    const std::size_t count = sides_of_all.first().stats.tiles.count(),
                      quantities = sides_of_all.independent_sides.size();
    out.difference.assign(quantities, Values(count, std::nan("")));
    result.tiles_by.assign(quantities, 0);
    for (std::size_t t = 0; t < count; ++t) {
        Values p;
        bool left_out = false;
        for (std::size_t q = 0; q < quantities; ++q) {
            const double level = levels.power_level / static_cast<double>(count) * level_share(q, quantities);
            const TileTest test = test_tile(sides_of_all.in_tile(q, t), t, level);
            p.push_back(test.p);
            out.difference[q][t] = test.difference;
            left_out |= test.left_out;
        }
        const JointP joint = joint_p(p);
        out.p.push_back(joint.p);
        out.quantity.push_back(joint.quantity);
        if (std::isnan(joint.p)) out.left_out += left_out;
        else ++out.test_count;
    }
    out.differs = discoveries(out.p, levels.report_level, sides_of_all.first().dependent);
    name_tiles(sides_of_all, result);
    std::vector<double> p;
    std::copy_if(out.p.begin(), out.p.end(), std::back_inserter(p), [](double x) { return !std::isnan(x); });
    std::sort(p.begin(), p.end());
    return simes_p(p, static_cast<double>(p.size()), sides_of_all.first().dependent);
}

std::optional<MissedEvents> missed_events(const AllSides& sides_of_all, const BiasResult& bias, double alpha) {
    std::optional<MissedEvents> hardest;
    const std::size_t quantities = sides_of_all.independent_sides.size();
    const auto consider = [&](const Found& place, double pixels, double level) {
        const auto events = sides_of_all.independent_sides[place.quantity].events_for(
            place, pixels, level * level_share(place.quantity, quantities));
        if (events && (!hardest || events->size > hardest->size)) hardest = events;
    };
    const auto& regions = sides_of_all.first().stats.regions;
    for (std::size_t r = 0; r < bias.regions.size(); ++r) {
        const double pixels = static_cast<double>(regions[r].pixels.size()),
                     level = alpha / static_cast<double>(regions.size());
        const MeanTest& y = bias.regions[r];
        if (y.differs) consider({.box = {}, .a = y.a, .b = y.b, .p = 0, .quantity = 0}, pixels, level);
        for (std::size_t c = 0; c < y.channels.size(); ++c)
            if (y.channels[c].differs) consider({{}, y.channels[c].a, y.channels[c].b, 0, c + 1}, pixels, level);
    }
    for (const Found& tile : bias.tiles_found)
        consider(tile, sides_of_all.first().noise_of(tile.box).pixels,
            bias.place_alpha / static_cast<double>(bias.tiles.p.size()));
    for (const Found& pixel : bias.pixels_found)
        consider(pixel, 1, pixel_level(sides_of_all.first(), bias.place_alpha));
    return hardest;
}

/// Returns whether the renders of the two sides have the same pixels, one for one.
bool same_renders(const ArmStats& a, const ArmStats& b) {
    const auto hashes = [](const ArmStats& arm) {
        std::vector<std::string> out;
        for (const RenderFile& file : arm.files) out.push_back(file.hash);
        std::sort(out.begin(), out.end());
        return out;
    };
    return hashes(a) == hashes(b);
}

SingleDifference single_difference(const BiasPair& sides) {
    SingleDifference out;
    const auto& pixels = sides.stats.regions.back().pixels;
    double squares = 0;
    for (const std::uint32_t i : pixels) {
        double largest = 0;
        for (std::size_t q = 0; q < sides.stats.quantities; ++q)
            largest = std::max(largest, std::fabs(sides.a.film.of(q).mean[i] - sides.b.film.of(q).mean[i]));
        const double y = sides.a.film.y()[i] - sides.b.film.y()[i];
        squares += y * y;
        out.different += largest > 0;
        if (largest <= out.largest) continue;
        const int x = static_cast<int>(i) % sides.stats.width, row = static_cast<int>(i) / sides.stats.width;
        out.largest = largest;
        out.place = {x, row, x, row};
    }
    out.pixels = pixels.size();
    out.rms = pixels.empty() ? 0 : std::sqrt(squares / static_cast<double>(pixels.size()));
    return out;
}

/// Returns pairs by file name if the plan requests them, else pairs with shared random numbers if these make the tests
/// more powerful; `level` is that of one region.
std::vector<RenderPair> pairs_for(const ComparePlan& plan, const BiasPair& sides, double level, BiasResult& out) {
    out.shared = shared_seeds(sides.stats, sides.a, sides.b);
    out.all_shared = all_paired(out.shared, sides.a, sides.b);
    if (plan.pair && !sides.referred) return pairs_of(sides.a, sides.b);
    if (!plan.find_pairs) return {};
    std::vector<RenderPair> pairs;
    if (sharper_in_pairs(out.shared, sides.a, sides.b, level))
        for (const SeedPair& p : out.shared) pairs.emplace_back(p.a, p.b);
    return pairs;
}

/// Tests the means of renders that are not identical.
void test_means(const ComparePlan& plan, const CompareResult& result, const RenderStats& stats, const BiasLevel& levels,
    BiasResult& out, ProgressMonitor& monitor) {
    AllSides sides;
    const auto add_sides = [&](std::vector<BiasPair>& to, const PairedRenders* paired) {
        for (std::size_t q = 0; q < stats.quantities; ++q)
            to.emplace_back(plan, stats, result, out.arm_a, out.arm_b, q, paired);
    };
    add_sides(sides.independent_sides, nullptr);
    const BiasPair& first = sides.first();
    const double region_level =
        levels.power_level / 2 / static_cast<double>(stats.regions.size()) * level_share(0, stats.quantities);
    std::optional<PairedRenders> paired;
    if (auto pairs = pairs_for(plan, first, region_level, out); !pairs.empty())
        paired = paired_renders(plan, stats, out.arm_a, out.arm_b, std::move(pairs), monitor);
    if (paired) add_sides(sides.paired_sides, &*paired);
    out.paired = paired.has_value();
    const BiasLevel half{levels.power_level / 2, levels.report_level / 2},
        quarter{levels.power_level / 4, levels.report_level / 4};
    out.p = 2 * test_regions(sides, half, out);
    const bool has_several_renders = first.a.files.size() >= 2 && (first.referred || first.b.files.size() >= 2);
    if (has_several_renders && !stats.regions.back().pixels.empty()) {
        out.p = std::fmin(out.p, 4 * test_tiles(sides, quarter, out));
        out.p = std::fmin(out.p, 4 * test_pixels(paired ? sides.paired_sides : sides.independent_sides, quarter, out));
    }
    out.p = std::fmin(out.p, 1);
    if (first.a.files.size() == 1 && first.b.files.size() == 1) {
        out.single = single_difference(first);  // equal values may differ in the bits of -0 and of NaN
        out.identical = out.single->pixels > 0 && out.single->different == 0 && !out.non_finite.differs();
    }
    if (out.differs()) out.missed_events = missed_events(sides, out, levels.power_level / 2);
}

}  // namespace

bool CompareResult::differs() const {
    return std::any_of(bias.begin(), bias.end(), [](const BiasResult& b) { return b.differs(); });
}

std::vector<std::string> MeanTest::differs_in() const {
    std::vector<std::string> out;
    if (differs) out.push_back(quantity_names[0]);
    for (const MeanTest& channel : channels)
        if (channel.differs) out.push_back(channel.region);
    return out;
}

bool BiasResult::differs() const {
    return non_finite.differs() || tiles.different > 0 || pixels_different > 0 ||
        std::any_of(regions.begin(), regions.end(), [](const MeanTest& t) { return !t.differs_in().empty(); });
}

std::size_t BiasResult::shown() const {
    std::vector<std::uint64_t> counts(most_quantities);
    for (const auto* counts_by_quantity : {&tiles_by, &pixels_by})
        for (std::size_t q = 0; q < counts_by_quantity->size(); ++q) counts[q] += (*counts_by_quantity)[q];
    for (const MeanTest& t : regions) {
        counts[0] += t.differs;
        for (std::size_t c = 0; c < t.channels.size(); ++c) counts[c + 1] += t.channels[c].differs;
    }
    return counts[0] ? 0 : static_cast<std::size_t>(std::max_element(counts.begin(), counts.end()) - counts.begin());
}

std::string reference_error_from(const ArmStats& reference) {
    if (reference.files.size() > 1) return fmt::format("over its {} files", reference.files.size());
    if (!reference.film.stated_variance.empty())
        return "as the file states it: " + reference.files[0].variance_channels;
    return "one file that does not state it: estimated from how its difference from the arms varies between "
           "neighbouring pixels";
}

BiasResult test_bias(const ComparePlan& plan, const RenderStats& stats, const CompareResult& result, std::size_t a,
    std::size_t b, const BiasLevel& level, ProgressMonitor& monitor) {
    const BiasPair sides(plan, stats, result, a, b);
    BiasResult out;
    out.a = plan.arms[a].name;
    out.b = sides.referred ? the_reference : plan.arms[b].name;
    out.arm_a = a;
    out.arm_b = b;
    out.dependent = sides.dependent;
    if (sides.referred) out.reference_error = reference_error_from(sides.b);
    const double looks =
        plan.look_number > 0 ? look_factor(plan.look_number) : 1;  // these tests do not hold at any time
    out.non_finite = compare_non_finite(stats, sides.a, sides.b, level.report_level / 2 / looks);
    const double share = out.non_finite.any() ? 0.5 : 1;
    const BiasLevel remainder{level.power_level * share, level.report_level * share};
    out.place_alpha = remainder.power_level / 4;
    out.identical = same_renders(sides.a, sides.b);
    if (out.identical)
        for (std::size_t r = 0; r < stats.regions.size(); ++r) {
            MeanTest& t = out.regions.emplace_back();
            t.region = stats.regions[r].name;
            t.joint_p = 1;
            t.a = t.b = mean_interval(sides.region_means(sides.a, r), confidence).mean;
        }
    else test_means(plan, result, stats, remainder, out, monitor);
    if (out.identical) out.p = 1;
    out.p /= share;
    if (out.non_finite.any()) out.p = std::fmin(out.p, 2 * looks * out.non_finite.p);
    out.sentence = sentence_of(stats, out, remainder.power_level / 2);
    return out;
}

// ---- Welch's t-test at each pixel over the renders (Student's of the differences of pairs), in parallel chunks, of Y
// and of each channel. There are two p: that of the histogram is plain and of Y. The p that selects pixels uses at
// least the spread of the tile, because a pixel may have the same value in every render by chance. Reported pixels have
// a false discovery rate of at most alpha.

namespace {

constexpr std::size_t bins = 20;                  // of the histogram of p
constexpr std::size_t pixels_at_once = 1u << 14;  // pixels
constexpr std::size_t table_from = 1u << 17;

/// Finds the histogram bin of a p from t and the degrees of freedom (rounded to an eighth): a search instead of an
/// incomplete beta function.
class Bins {
public:
    /// The table is faster only for many pixels; without it (largest_df = 0) each p is computed.
    explicit Bins(double largest_df) {
        for (double df = 1; largest_df > 0 && df <= largest_df + 1; df += 1.0 / 8) {
            std::array<double, bins> limits{};  // |t| at p = (k + 1)/bins
            for (std::size_t k = 0; k + 1 < bins; ++k)
                limits[k] = student_quantile(1 - static_cast<double>(k + 1) / (2.0 * bins), df);
            table_.push_back(limits);
        }
    }
    std::size_t of(double t, double df) const {
        if (table_.empty()) return std::min(bins - 1, static_cast<std::size_t>(two_sided_p(t, df) * bins));
        const auto row = std::min(table_.size() - 1, static_cast<std::size_t>(std::max(0.0, std::round((df - 1) * 8))));
        std::size_t k = 0;
        while (k + 1 < bins && std::fabs(t) < table_[row][k]) ++k;
        return k;
    }

private:
    std::vector<std::array<double, bins>> table_;
};

struct Moments {
    double difference = 0, se = 0, df = 1;
    bool is_known = false;
};

/// Returns a tile's variance scaled to a pixel's brightness, at most the tile's.
double scaled(const QuantityReadings& readings, std::size_t tile, double variance, double value) {
    double mean = 0;
    for (const auto& render : readings.tiles) mean += render[tile].mean / static_cast<double>(readings.tiles.size());
    const double share = mean > 0 ? std::min(1.0, std::fabs(value) / mean) : 1;
    return variance * share * share;
}

/// Returns the difference of one pixel, its standard error and degrees of freedom. A pixel may have the same value in
/// every render by chance, such as the same number of hits among its samples; with `floored`, its variance is at least
/// that of its tile, scaled to the pixel's brightness.
Moments moments(const BiasPair& s, std::size_t i, bool floored) {
    const auto x = static_cast<int>(i % static_cast<std::size_t>(s.stats.width)),
               y = static_cast<int>(i / static_cast<std::size_t>(s.stats.width));
    const std::size_t t = s.stats.tiles.of(x, y), q = s.quantity;
    const auto variance_of = [&](const ArmStats& side, const std::vector<double>& tiles, const ArmStats& bright) {
        const MeanFilm& film = side.film;
        double v = film.count >= 2 ? film.of(q).m2[i] / static_cast<double>(film.count - 1) : film.variance(i, q);
        if (floored) v = std::max(v, scaled(bright.quantities[q], t, tiles[t], bright.film.of(q).mean[i]));
        return v / static_cast<double>(side.files.size());
    };
    Moments m;
    m.difference = s.mean_a(i) - s.mean_b(i);
    double sum = 0, denominator = 0;
    const auto add = [&](double v, std::size_t renders) {
        sum += v;
        denominator += renders > 1 ? v * v / static_cast<double>(renders - 1) : 0;
    };
    if (s.in_pairs()) {
        m.difference = s.differences->film.of(q).mean[i];
        add(variance_of(*s.differences, s.tile_paired, s.a), s.differences->files.size());
    } else {
        add(variance_of(s.a, s.tile_a, s.a), s.a.files.size());
        add(variance_of(s.b, s.tile_b, s.b), s.b.files.size());
    }
    m.is_known = std::isfinite(sum) && (sum > 0 || m.difference != 0 || s.in_pairs());
    if (!m.is_known) return m;
    m.se = std::sqrt(sum);
    m.df = denominator > 0 ? sum * sum / denominator : 1;
    return m;
}

/// Returns p of one pixel: NaN if the pixel has no noise and no difference, or its noise is unknown; 1 if rare events
/// that are in no render could explain the difference (`level`, see BiasPair::missable_difference).
double pixel_p(const BiasPair& s, std::size_t i, double level) {
    const Moments m = moments(s, i, true);
    if (!m.is_known) return std::nan("");
    if (std::fabs(m.difference) < s.undetectable_difference(s.mean_b(i) + m.difference, s.mean_b(i), 1, 0, level))
        return 1;
    if (m.se > 0 && s.look_number > 0) return anytime_p(m.difference / m.se, m.df, s.information());
    return m.se > 0 ? two_sided_p(m.difference / m.se, m.df) : m.difference == 0 ? 1 : 0;
}

/// A pixel that may differ.
struct Candidate {
    JointP p;
    std::uint32_t pixel = 0;
    bool operator<(const Candidate& other) const { return p.p != other.p.p ? p.p < other.p.p : pixel < other.pixel; }
};

/// Counts of one chunk of pixels, so that threads share nothing.
struct PixelCounts {
    std::array<std::uint64_t, bins> histogram{};
    std::uint64_t test_count = 0;
    std::vector<Candidate> small;  // p <= alpha
};

double most_degrees(const BiasPair& s) { return static_cast<double>(s.a.files.size() + s.b.files.size()); }

/// Returns |t| of each quantity below which no p is <= alpha: the floor of the spread makes |t| smaller, and p is
/// smallest with the most degrees of freedom.
using LeastT = std::array<double, most_quantities>;
LeastT least_t(std::span<const BiasPair> sides, double alpha) {
    LeastT out{};
    for (const BiasPair& s : sides)
        out[s.quantity] = student_quantile(1 - alpha * level_share(s.quantity, sides.size()) / 2, most_degrees(s));
    return out;
}

/// `table`: for the histogram; null: the histogram is not counted.
PixelCounts part_of(std::span<const BiasPair> sides, std::size_t begin, double alpha, double level,
    const LeastT& thresholds, const Bins* table) {
    const auto& pixels = sides[0].stats.regions.back().pixels;
    PixelCounts out;
    for (std::size_t k = begin; k < std::min(pixels.size(), begin + pixels_at_once); ++k) {
        bool is_known = false, small = false;
        for (const BiasPair& s : sides) {
            const Moments m = moments(s, pixels[k], false);
            if (!m.is_known) continue;
            if (s.quantity == 0 && table)
                ++out.histogram[m.se > 0 ? table->of(m.difference / m.se, m.df) : m.difference == 0 ? bins - 1 : 0];
            is_known = true;
            small |= m.se > 0 ? !(std::fabs(m.difference) < thresholds[s.quantity] * m.se) : m.difference != 0;
        }
        out.test_count += is_known;
        if (!is_known || !small) continue;
        std::array<double, most_quantities> p{};
        for (const BiasPair& s : sides)
            p[s.quantity] = pixel_p(s, pixels[k], level * level_share(s.quantity, sides.size()));
        const JointP joint = joint_p(std::span(p).first(sides.size()));
        if (joint.p <= alpha) out.small.push_back({joint, pixels[k]});
    }
    return out;
}

}  // namespace

double pixel_level(const BiasPair& s, double alpha) {
    return alpha / static_cast<double>(s.stats.regions.back().pixels.size());
}

double test_pixels(std::span<const BiasPair> sides, const BiasLevel& levels, BiasResult& out) {
    const BiasPair& s = sides[0];
    if (s.lone_reference() && s.b.film.stated_variance.empty()) return std::nan("");
    const std::size_t count = s.stats.regions.back().pixels.size();
    const double level = pixel_level(s, levels.power_level);
    std::optional<Bins> table;
    if (s.count_pixel_p) table.emplace(count > table_from ? most_degrees(s) : 0);
    const LeastT thresholds = least_t(sides, levels.report_level);
    std::vector<PixelCounts> parts((count + pixels_at_once - 1) / pixels_at_once);
    parallel_for(std::size_t{0}, parts.size(), [&](std::size_t c) {
        parts[c] =
            part_of(sides, c * pixels_at_once, levels.report_level, level, thresholds, table ? &*table : nullptr);
    });
    out.pixel_p.assign(bins, 0);
    out.pixels_by.assign(sides.size(), 0);
    std::vector<Candidate> small;
    for (const PixelCounts& part : parts) {
        for (std::size_t k = 0; k < bins; ++k) out.pixel_p[k] += part.histogram[k];
        out.pixels_tested += part.test_count;
        small.insert(small.end(), part.small.begin(), part.small.end());
    }
    std::sort(small.begin(), small.end());
    std::vector<double> p;
    for (const Candidate& c : small) p.push_back(c.p.p);
    out.pixels_different = discovered(p, static_cast<double>(out.pixels_tested), levels.report_level, s.dependent);
    small.resize(out.pixels_different);
    for (const Candidate& c : small) {
        ++out.pixels_by[c.p.quantity];
        out.different_pixels.push_back(c.pixel);
        if (out.pixels_found.size() == named_most) continue;
        const int x = static_cast<int>(c.pixel) % s.stats.width, y = static_cast<int>(c.pixel) / s.stats.width;
        const BiasPair& pair = sides[c.p.quantity];
        const double b = pair.mean_b(c.pixel);
        out.pixels_found.push_back(
            {{x, y, x, y}, b + moments(pair, c.pixel, false).difference, b, c.p.p, c.p.quantity});
    }
    std::sort(out.different_pixels.begin(), out.different_pixels.end());
    return simes_p(p, static_cast<double>(out.pixels_tested), s.dependent);
}

}  // namespace crescent
