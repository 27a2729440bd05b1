// The variance of a mean over k renders is that of a pixel over k. If one file states no variance, it is estimated as
// half the mean squared difference of neighbours, minus the other side's noise, times the ratio of noise at low to that
// at high frequencies.
#include "compare/wording.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <fmt/format.h>
#include <numeric>

#include "base/vec.h"
#include "compare/anytime.h"
#include "compare/plan.h"
#include "compare/renders.h"
#include "compare/shared_seeds.h"
#include "math/functions.h"
#include "math/statistics.h"
#include "output/format.h"

namespace crescent {

namespace {

/// Sums over pixels that are visited row by row, from the left.
class Visit {
public:
    explicit Visit(const BiasPair& sides) : Visit(sides.stats, sides.a, sides.b, sides.quantity) {
        if (sides.differences) paired_ = &sides.differences->film;
    }
    Visit(const RenderStats& stats, const ArmStats& a, const ArmStats& b, std::size_t quantity)
        : stats_(stats), a_(a.film), b_(b.film), quantity_(quantity) {}

    void pixel(std::size_t i) {
        if (stats_.bad[i]) return;
        const double a = a_.of(quantity_).mean[i], b = b_.of(quantity_).mean[i], d = a - b;
        out_.pixels += 1;
        out_.mean_a += a;
        out_.mean_b += b;
        const double variance_a = a_.variance(i, quantity_), variance_b = b_.variance(i, quantity_);
        out_.a += paired_ ? paired_->variance(i, quantity_) : variance_a;
        out_.b += paired_ ? 0 : variance_b;
        out_.unpaired_variance += variance_a + variance_b;
        const bool are_neighbours = pairs_started_ && last_ + 1 == i && i % static_cast<std::size_t>(stats_.width) != 0;
        if (are_neighbours) {
            roughness_ += (d - last_difference_) * (d - last_difference_) / 2;
            pair_count_ += 1;
        }
        last_ = i;
        last_difference_ = d;
        pairs_started_ = true;
    }
    /// `low`: the noise over a whole set relative to that between neighbours.
    SetVariance result(double low) const {
        SetVariance out = out_;
        for (double* sum : {&out.a, &out.b, &out.unpaired_variance, &out.mean_a, &out.mean_b}) *sum /= out.pixels;
        const double variance_of_a = std::isnan(out.a) ? 0 : out.a / static_cast<double>(a_.count);
        if (std::isnan(out.b))
            out.b = pair_count_ > 0 ? std::max(0.0, roughness_ / pair_count_ - variance_of_a) * low : 0;
        if (!paired_) out.unpaired_variance = out.a + out.b;
        return out;
    }

private:
    const RenderStats& stats_;
    const MeanFilm &a_, &b_;
    const MeanFilm* paired_ = nullptr;
    const std::size_t quantity_;
    SetVariance out_;
    std::size_t last_ = 0;
    bool pairs_started_ = false;
    double last_difference_ = 0, roughness_ = 0, pair_count_ = 0;
};

MeanInterval floored_at(MeanInterval m, double variance_of_one) {
    if (m.n > 1 && variance_of_one > 0) m.se = std::max(m.se, std::sqrt(variance_of_one / static_cast<double>(m.n)));
    return m;
}

/// One file: its error follows from those of its pixels and counts as known, not as estimated.
MeanInterval one_file(double mean, const SetVariance& noise) {
    return {.mean = mean, .low = 0, .high = 0, .se = std::sqrt(noise.b / noise.pixels), .n = 1000000};
}

double low_over_high(const std::vector<double>& power) {
    if (power.empty()) return 1;
    const auto half = power.begin() + spectrum_bins / 2;
    const double high = std::accumulate(half, power.end(), 0.0) / static_cast<double>(power.end() - half);
    return high > 0 ? std::max(1.0, power.front() / high) : 1;
}

/// Returns the variance of a pixel's mean over each tile; 0 for a single file.
std::vector<double> tile_variances(const ArmStats& arm, std::size_t quantity) {
    const auto& tiles = arm.quantities[quantity].tiles;
    std::vector<double> out(tiles[0].size());
    const double k = static_cast<double>(arm.files.size());
    for (const auto& render : tiles)
        for (std::size_t t = 0; t < out.size(); ++t) out[t] += k > 1 ? render[t].spread / (k - 1) : 0;
    return out;
}

/// The rule of RegionResult::mean_heavy, for deviations from the mean of one quantity.
bool heavy_deviations(const RenderStats& stats, const ArmStats& arm, std::size_t quantity, std::size_t region) {
    const std::vector<float>& largest = arm.quantities[quantity].largest[region];
    const auto tail = fit_pooled_tail(std::span<const float>(largest));
    double sum = 0;
    for (const std::uint32_t i : stats.regions[region].pixels) sum += arm.film.of(quantity).m2[i];
    const double share = sum > 0 && !largest.empty() ? static_cast<double>(largest.front()) / sum : 0;
    return (tail && tail->k >= 1) || share > heavy_share;
}

bool one_pixel_decides(const ArmStats& arm, std::size_t quantity, std::size_t tile) {
    double sum = 0, largest = 0;
    for (const auto& render : arm.quantities[quantity].tiles) {
        sum += render[tile].spread;
        largest = std::max(largest, render[tile].largest);
    }
    return sum > 0 && largest > heavy_share * sum;
}

}  // namespace

MeanInterval mean_and_error(std::span<const double> values) {
    MeanInterval out;
    out.n = values.size();
    const double n = static_cast<double>(out.n);
    out.mean = out.n ? std::accumulate(values.begin(), values.end(), 0.0) / n : std::nan("");
    out.low = out.high = out.se = std::nan("");
    if (out.n < 2) return out;
    double squares = 0;
    for (const double v : values) squares += (v - out.mean) * (v - out.mean);
    out.se = std::sqrt(squares / (n - 1) / n);
    return out;
}

BiasPair::BiasPair(const ComparePlan& plan, const RenderStats& readings, const CompareResult& result, std::size_t first,
    std::size_t second, std::size_t quantity_count, const PairedRenders* paired)
    : stats(readings),
      a(readings.arms[first]),
      b(second < readings.arms.size() ? readings.arms[second] : *readings.reference),
      arm(result.arms[first]),
      quantity(quantity_count) {
    const Rgb weights = luminance_weights_of(stats.primaries);  // a channel may be 1 / weight times as bright as Y
    referred = second >= readings.arms.size();
    brightest = plan.brightest.value_or(0);
    count_pixel_p = plan.count_pixel_p;
    shared_noise = plan.shared_noise;
    look_number = plan.look_number;
    if (const double weight = quantity > 0 && quantity < colour_quantities ? weights[quantity - 1] : 1; weight > 0)
        brightest /= weight;
    if (!referred) other = &result.arms[second];
    const RegionResult& frame = arm.region(whole_frame);
    dependent = frame.colour == NoiseColour::correlated;
    if (other) dependent |= other->region(whole_frame).colour == NoiseColour::correlated;
    if (dependent) low_frequencies = low_over_high(frame.power);
    tile_a = tile_variances(a, quantity);
    tile_b = tile_variances(b, quantity);
    if (!paired) return;
    pairs = &paired->pairs;
    differences = &paired->differences;
    tile_paired = tile_variances(*differences, quantity);
}

std::vector<double> BiasPair::region_means(const ArmStats& side, std::size_t region) const {
    std::vector<double> out;
    for (const auto& render : side.quantities[quantity].regions) out.push_back(render[region]);
    return paired_of(side, std::move(out));
}

std::vector<double> BiasPair::tile_means(const ArmStats& side, std::size_t tile) const {
    std::vector<double> out;
    for (const auto& render : side.quantities[quantity].tiles) out.push_back(render[tile].mean);
    return paired_of(side, std::move(out));
}

std::vector<double> BiasPair::paired_of(const ArmStats& side, std::vector<double> values) const {
    if (!pairs) return values;
    std::vector<double> out;
    for (const auto& [i, j] : *pairs) out.push_back(values[&side == &a ? i : j]);
    return out;
}

double BiasPair::renders_of(const ArmStats& side) const {
    return static_cast<double>(pairs ? pairs->size() : side.files.size());
}

std::string BiasPair::heavy_in(std::size_t region) const {
    if (differences)
        return heavy_deviations(stats, *differences, quantity, region) ? "the differences of the pairs" : "";
    for (const ArmResult* result : {&arm, other}) {
        if (!result) continue;
        const bool heavy = quantity == 0 ? result->regions[region].mean_heavy()
                                         : heavy_deviations(stats, result == &arm ? a : b, quantity, region);
        if (heavy) return result->name;
    }
    return "";
}

bool BiasPair::lone_pixel_in(std::size_t tile) const {
    if (differences) return one_pixel_decides(*differences, quantity, tile);
    return one_pixel_decides(a, quantity, tile) || (other && one_pixel_decides(b, quantity, tile));
}

SetVariance BiasPair::noise_of(const Box& box) const {
    Visit visit(*this);
    for (int j = box.y0; j <= box.y1; ++j)
        for (int i = box.x0; i <= box.x1; ++i)
            visit.pixel(
                static_cast<std::size_t>(j) * static_cast<std::size_t>(stats.width) + static_cast<std::size_t>(i));
    return visit.result(low_frequencies);
}

SetVariance BiasPair::noise_of(const PixelSet& set) const {
    Visit visit(*this);
    for (const std::uint32_t i : set.pixels) visit.pixel(i);
    return visit.result(low_frequencies);
}

bool BiasPair::pools() const {
    const std::size_t ours = a.files.size(), theirs = b.files.size();
    return shared_noise && !pairs && !referred && std::max(ours, theirs) > 1 &&
        2 * std::min(ours, theirs) <= std::max(ours, theirs);
}

std::optional<Welch> BiasPair::pooled_test(
    const std::vector<double>& va, const std::vector<double>& vb, const SetVariance& noise, bool floored) const {
    if (!pools()) return {};
    const double na = static_cast<double>(va.size()), nb = static_cast<double>(vb.size());
    const double ratio = na > 1 && nb > 1 ? noise.a / noise.b : 1;  // of the variances of one render
    if (!std::isfinite(ratio) || !(ratio > 0)) return {};
    const MeanInterval ours = mean_and_error(va), theirs = mean_and_error(vb);
    double squares = 0;  // in units of the variance of b
    if (na > 1) squares += ours.se * ours.se * na * (na - 1) / ratio;
    if (nb > 1) squares += theirs.se * theirs.se * nb * (nb - 1);
    double variance = squares / (na + nb - 2);
    if (const double pixels = nb > 1 ? noise.b : noise.a; floored && pixels > 0)
        variance = std::max(variance, pixels / noise.pixels);
    Welch out;
    out.df = na + nb - 2;
    out.se = std::sqrt(variance * (ratio / na + 1 / nb));
    out.difference = ours.mean - theirs.mean;
    if (out.se > 0) out.p = two_sided_p(out.difference / out.se, out.df);
    else out.p = out.difference == 0 ? 1 : 0;
    return out;
}

Welch BiasPair::test(
    const std::vector<double>& va, const std::vector<double>& vb, const SetVariance& noise, bool floored) const {
    if (pairs) {
        std::vector<double> pair_differences;
        for (std::size_t k = 0; k < pairs->size(); ++k) pair_differences.push_back(va[k] - vb[k]);
        const MeanInterval mean = mean_and_error(pair_differences);
        return with_p(paired_test(floored ? floored_at(mean, noise.a / noise.pixels) : mean));
    }
    if (const auto pooled = pooled_test(va, vb, noise, floored)) return with_p(*pooled);
    MeanInterval ours = mean_and_error(va);
    MeanInterval theirs = vb.size() > 1 ? mean_and_error(vb) : one_file(vb[0], noise);
    if (floored) ours = floored_at(ours, noise.a / noise.pixels);
    if (floored && vb.size() > 1) theirs = floored_at(theirs, noise.b / noise.pixels);
    return with_p(welch_test(ours, theirs));
}

double BiasPair::information() const {
    if (look_number == 0) return 0;
    if (pairs) return static_cast<double>(pairs->size());
    const double n = static_cast<double>(a.files.size()), m = static_cast<double>(b.files.size());
    return n * m / (n + m);
}

Welch BiasPair::with_p(Welch test) const {
    if (look_number > 0 && test.se > 0) test.p = anytime_p(test.difference / test.se, test.df, information());
    return test;
}

double BiasPair::detectable_difference(const Welch& test, double level) const {
    if (look_number == 0) return detectable(test, level);
    if (!(test.df > 0) || !std::isfinite(test.se)) return HUGE_VAL;
    return test.se * (anytime_quantile(level, test.df, information()) + student_quantile(0.9, test.df));
}

double BiasPair::rare_event(double difference) const {
    const QuantityReadings& readings = (difference < 0 ? a : b).quantities[quantity];
    if (pools() && (difference < 0 ? a : b).files.size() < 2)  // one render has no outliers among its values
        return std::max({brightest, a.quantities[quantity].rise, b.quantities[quantity].rise});
    if (!differences) return std::max(brightest, readings.rise);
    const QuantityReadings& paired = differences->quantities[quantity];  // an event in b alone is a fall of a - b
    return std::max(brightest, difference < 0 ? paired.rise : paired.fall);
}

double BiasPair::missable_difference(double difference, double pixels, double level) const {
    const ArmStats& lower = difference < 0 ? a : b;
    if (lower.files.size() < 2 && !pools()) return 0;
    return -math::log(level) * rare_event(difference) / (pixels * renders_of(lower));
}

std::optional<MissedEvents> BiasPair::events_for(const Found& place, double pixels, double level) const {
    const bool is_a_darker = place.a < place.b;
    const ArmStats& lower = is_a_darker ? a : b;
    if (lower.files.size() < 2) return {};
    MissedEvents out{is_a_darker ? arm.name : other ? other->name : the_reference, 0, 0, 0};
    out.one_in = pixels * renders_of(lower) / -math::log(level);
    out.size = std::fabs(place.a - place.b) * out.one_in;
    const double mean = std::min(place.a, place.b);
    out.of_mean = mean > 0 ? out.size / mean : 0;
    return out;
}

double BiasPair::undetectable_difference(
    double mean_a, double mean_b, double pixels, double variance, double level) const {
    constexpr double roundings = 4;
    constexpr double reordering = 0x1p-18;  // of a float sum of up to 64 similar terms, each rounded to 2^-24
    const double rounding = a.film.rounding * std::fabs(mean_a) + b.film.rounding * std::fabs(mean_b);
    const double left_over = variance > 0 ? std::min(1.0, rounding / std::sqrt(variance)) : 1;
    const double steps = quantised_difference(mean_a, mean_b, pixels, variance);
    const double arithmetic = differences ? reordering * (std::fabs(mean_a) + std::fabs(mean_b)) : 0;
    return std::max({missable_difference(mean_a - mean_b, pixels, level),
        roundings * rounding * std::max(left_over, 1 / std::sqrt(pixels)), steps, arithmetic});
}

double BiasPair::quantised_difference(double mean_a, double mean_b, double pixels, double variance) const {
    // Two values that differ by nothing may be rounded to neighbouring numbers, a step apart; half a step more for the
    // curve of the encoding.
    constexpr double safety = 1.5;
    const double steps = quantity == most_quantities - 1
        ? 0.5 / std::max(1.0, a.film.steps.levels - 1) + 0.5 / std::max(1.0, b.film.steps.levels - 1)
        : a.film.steps.half_step(mean_a) + b.film.steps.half_step(mean_b);
    if (a.film.steps.levels == 0 && b.film.steps.levels == 0) return 0;
    // Noise dithers (Widrow & Kollar 2008, "Quantization Noise", 2): the mean of values rounded to steps of q is wrong
    // by at most q / pi times their characteristic function at 2 pi / q, which is 1 / sqrt(1 + (2 pi sigma / q)^2) for
    // exponential noise and smaller for smoother noise.
    const double relative_noise = steps > 0 ? 2 * std::numbers::pi * std::sqrt(variance) / steps : 0;
    const double share = std::min(1.0, 1 / std::sqrt(1 + relative_noise * relative_noise));
    return safety * steps * (variance > 0 ? std::max(share / std::numbers::pi, 1 / std::sqrt(pixels)) : 1);
}

double roughness(const RenderStats& stats, const ArmStats& arm, const PixelSet& set) {
    Visit visit(stats, arm, *stats.reference, 0);
    for (const std::uint32_t i : set.pixels) visit.pixel(i);
    return visit.result(1).b;
}

// ---- The results about means, in one sentence.

namespace {

std::string relative(double a, double b) {
    if (!(b > 0)) return fmt::format("{} against {}", figures(a, 2), figures(b, 2));
    if (a / b >= 2) return fmt::format("{} times", figures(a / b, 2));
    return (a < b ? "−" : "+") + percent(std::fabs(a / b - 1), 2);
}

std::string place(const Found& f) {
    if (f.box.x0 == f.box.x1 && f.box.y0 == f.box.y1) return fmt::format("({}, {})", f.box.x0, f.box.y0);
    return fmt::format("x {}–{} y {}–{}", f.box.x0, f.box.x1, f.box.y0, f.box.y1);
}

/// Returns "R " for a channel, "" for Y.
std::string of_channel(std::size_t quantity) {
    return quantity == 0 ? "" : fmt::format("{} ", quantity_names[quantity]);
}

std::string places(const std::vector<Found>& entries, std::uint64_t total) {
    std::vector<std::string> out;
    for (const Found& f : entries)
        out.push_back(fmt::format("{} ({}{})", place(f), of_channel(f.quantity), relative(f.a, f.b)));
    return fmt::format("{}{}", fmt::join(out, ", "), total > entries.size() ? " and more" : "");
}

/// Returns " in R", or " (12 most in R, 4 in B)": the quantities in which places differ the most; "" if only Y.
std::string by_quantity(const std::vector<std::uint64_t>& counts) {
    std::vector<std::string> out;
    for (std::size_t q = 0; q < counts.size(); ++q)
        if (counts[q])
            out.push_back(fmt::format("{} {}in {}", counts[q], out.empty() ? "most " : "", quantity_names[q]));
    if (out.empty() || (out.size() == 1 && counts[0])) return "";
    if (out.size() > 1) return fmt::format(" ({})", fmt::join(out, ", "));
    const auto q = std::find_if(counts.begin(), counts.end(), [](std::uint64_t n) { return n > 0; }) - counts.begin();
    return fmt::format(" in {}", quantity_names[q]);
}

void mean_difference(const BiasResult& b, const std::string& region, const std::string& name, const MeanTest& t,
    std::vector<std::string>& out) {
    if (t.differs)
        out.push_back(fmt::format("mean {} in {} is {} where {} has {} ({}, p = {:.2g})", name, region, figures(t.a),
            b.b, figures(t.b), relative(t.a, t.b), t.welch.p));
}

std::vector<std::string> differences(const RenderStats& stats, const BiasResult& b) {
    std::vector<std::string> out;
    if (b.non_finite.differs()) out.push_back(failing_pixels(stats, b));
    for (const MeanTest& t : b.regions) {
        mean_difference(b, t.region, quantity_names[0], t, out);
        for (const MeanTest& channel : t.channels) mean_difference(b, t.region, channel.region, channel, out);
    }
    if (b.tiles.different)
        out.push_back(fmt::format("{} of {} tiles differ{}: {}", b.tiles.different, b.tiles.test_count,
            by_quantity(b.tiles_by), places(b.tiles_found, b.tiles.different)));
    if (b.pixels_different)
        out.push_back(fmt::format("{} of {} pixels differ{}: {}", b.pixels_different, b.pixels_tested,
            by_quantity(b.pixels_by), places(b.pixels_found, b.pixels_different)));
    return out;
}

std::string counted(std::size_t count, const char* what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string renders_of(std::uint32_t smallest, std::uint32_t greatest, std::size_t renders) {
    if (greatest == 0) return "in none";
    if (smallest == renders) return renders == 1 ? "in its render" : fmt::format("in all {} renders", renders);
    if (smallest == greatest) return fmt::format("in {} of {} renders", greatest, renders);
    return fmt::format("in {} to {} of {} renders", smallest, greatest, renders);
}

std::string failing(const FailingPixels& pixels, const std::string& name, std::size_t renders, const std::string& other,
    std::size_t other_renders, int width) {
    return fmt::format("{} of {} {} not finite {}, and {} of {}: {}", counted(pixels.pixels.size(), "pixel"), name,
        pixels.pixels.size() == 1 ? "is" : "are", renders_of(pixels.least_renders, pixels.most_renders, renders),
        renders_of(pixels.least_other_renders, pixels.most_other_renders, other_renders), other,
        places_of(pixels, width));
}

/// Describes pixels that are not finite without a difference between the sides.
std::string excluded(const BiasResult& b) {
    std::string out;
    if (b.non_finite.two_sided)
        out += fmt::format(" {} not finite on both sides {} left out.", counted(b.non_finite.two_sided, "pixel"),
            b.non_finite.two_sided == 1 ? "is" : "are");
    if (b.non_finite.one_sided)
        out += fmt::format(" {} not finite on one side, in so few renders that the rates may be equal, {} left out.",
            counted(b.non_finite.one_sided, "pixel"), b.non_finite.one_sided == 1 ? "is" : "are");
    if (b.non_finite.undecided)
        out += fmt::format(
            " {} of those not finite in half of the renders of one side or more and in none of the other: more "
            "renders are needed to test whether the rates are equal.",
            b.non_finite.undecided == 1 ? "1 is" : fmt::format("{} are", b.non_finite.undecided));
    return out;
}

/// Describes renders that share their random numbers, and how they were compared.
std::string seeds(const BiasResult& b) {
    if (b.shared.empty()) return "";
    const auto smaller = [](const SeedPair& x, const SeedPair& y) { return x.correlation < y.correlation; };
    const auto [lowest, highest] = std::minmax_element(b.shared.begin(), b.shared.end(), smaller);
    const std::string low = figures(lowest->correlation, 2), high = figures(highest->correlation, 2);
    const std::string sentence = fmt::format(" {} of {} and {} share random numbers (their noise correlates by {}): ",
        b.all_shared ? "The renders" : counted(b.shared.size(), "pair") + " of renders", b.a, b.b,
        low == high ? low : low + " to " + high);
    if (b.paired && b.all_shared) return sentence + "they were compared in pairs.";
    if (b.paired) return sentence + "these were compared, in pairs.";
    return sentence + "a test of pairs would be no sharper, so all were compared as if independent.";
}

/// A t-test cannot detect events that are in no render. States how rare and bright they would have to be, so that the
/// reader can decide.
std::string missed_events_sentence(const BiasResult& b) {
    if (!b.missed_events) return {};
    const std::string times = b.missed_events->of_mean > 0
        ? fmt::format(", {} times its mean there,", figures(b.missed_events->of_mean, 2))
        : "";
    return fmt::format(
        " If there is no bias, {} has events brighter than {}{} in fewer than one of {:.0f} pixels, and its renders "
        "contain none.",
        b.missed_events->arm, figures(b.missed_events->size, 2), times, std::max(1.0, b.missed_events->one_in));
}

}  // namespace

std::string failing_pixels(const RenderStats& stats, const BiasResult& b) {
    const std::size_t renders_a = stats.arms[b.arm_a].files.size(),
                      renders_b = (b.arm_b < stats.arms.size() ? stats.arms[b.arm_b] : *stats.reference).files.size();
    std::vector<std::string> out;
    if (!b.non_finite.a.pixels.empty())
        out.push_back(failing(b.non_finite.a, b.a, renders_a, b.b, renders_b, stats.width));
    if (!b.non_finite.b.pixels.empty())
        out.push_back(failing(b.non_finite.b, b.b, renders_b, b.a, renders_a, stats.width));
    const bool is_everywhere = (b.non_finite.a.pixels.empty() || b.non_finite.a.least_renders == renders_a) &&
        (b.non_finite.b.pixels.empty() || b.non_finite.b.least_renders == renders_b);
    for (const FailedGroups& g : b.non_finite.groups)
        if (g.differs && !is_everywhere)
            out.push_back(
                fmt::format("in {} {} of such pixels over all renders of {} and {} over those of {} (p = {:.2g})",
                    g.region, counted(g.a, "group"), b.a, g.b, b.b, g.p));
    return fmt::format("{}", fmt::join(out, "; "));
}

namespace {

std::string smallest_seen(const MeanTest& t) {
    double channel = 0;
    for (const MeanTest& c : t.channels) channel = std::max(channel, c.why.empty() ? c.smallest : 0);
    return channel > 0
        ? fmt::format("{} of mean Y or {} of a channel in {}", percent(t.smallest, 2), percent(channel, 2), t.region)
        : fmt::format("{} of mean Y in {}", percent(t.smallest, 2), t.region);
}

std::string single(const BiasResult& b) {
    const SingleDifference& s = *b.single;
    return fmt::format(
        "{} and {} are one render each: {} of {} pixels differ, the RMS of the difference of Y is {}, the largest "
        "difference of a channel is {} at ({}, {}); whether that is noise cannot be tested with fewer than two renders "
        "of each",
        b.a, b.b, s.different, s.pixels, figures(s.rms, 3), figures(s.largest, 3), s.place.x0, s.place.y0);
}

}  // namespace

std::string sentence_of(const RenderStats& stats, const BiasResult& b, double alpha) {
    if (b.identical)
        return fmt::format(
            "{} and {} have the same R, G and B in every pixel of every render; other channels are not compared.{}",
            b.a, b.b, excluded(b));
    const std::string notes = excluded(b) + seeds(b);
    if (b.differs())
        return fmt::format("{} differs from {}: {}.{}{}", b.a, b.b, fmt::join(differences(stats, b), "; "),
            missed_events_sentence(b), notes);
    if (b.single) return single(b) + "." + notes;
    std::vector<std::string> sizes, not_tested;
    for (const MeanTest& t : b.regions) {
        if (!t.caveat.empty()) not_tested.push_back(fmt::format("{}: {}", t.region, t.caveat));
        else if (t.why.empty()) sizes.push_back(smallest_seen(t));
        else not_tested.push_back(fmt::format("{}: {}{}", t.region, t.why, t.requirement));
        for (const MeanTest& c : t.channels)
            if (t.why.empty() && !c.why.empty())
                not_tested.push_back(fmt::format("{} in {}: {}{}", c.region, t.region, c.why, c.requirement));
    }
    std::string out = sizes.empty() ? fmt::format("{} and {} could not be compared", b.a, b.b)
                                    : fmt::format(
                                          "No difference between {} and {} was found; one of {} would have been, "
                                          "nine times out of ten (alpha {})",
                                          b.a, b.b, fmt::join(sizes, ", "), figures(alpha, 2));
    if (!not_tested.empty()) out += fmt::format("; not tested: {}", fmt::join(not_tested, "; "));
    return out + "." + notes;
}

std::vector<std::string> found_about_means(const CompareResult& result, bool with_stated_pair) {
    constexpr std::size_t most_pairs = 6;
    const auto is_quiet = [](const BiasResult& b) {
        return !b.differs() && !b.identical && !b.non_finite.any() && b.shared.empty() &&
            std::all_of(b.regions.begin(), b.regions.end(),
                [](const MeanTest& t) { return t.why.empty() && t.caveat.empty(); });
    };
    std::vector<std::string> out;
    std::size_t quiet_pairs = 0;
    double smallest = 0;
    for (std::size_t k = 0; k < result.bias.size(); ++k) {
        const BiasResult& b = result.bias[k];
        if (result.bias.size() > most_pairs && is_quiet(b)) {
            ++quiet_pairs;
            smallest = std::max(smallest, b.regions.back().smallest);
        } else if (with_stated_pair || result.stated_pair != k) {
            out.push_back(b.sentence);
        }
    }
    if (quiet_pairs)
        out.push_back(
            fmt::format("In {} of {} pairs no difference was found; one of {} of mean Y in {} would have been in each "
                        "of them, nine "
                        "times out of ten.",
                quiet_pairs, result.bias.size(), percent(smallest, 2), result.bias[0].regions.back().region));
    return out;
}

}  // namespace crescent
