// Variances of means over k renders are a pixel's over k. Where one file says nothing of its noise, half the mean
// square difference of neighbours stands in for it, less the other side's noise, times how much more there is at low
// frequencies than at high ones.
#include "compare/sides.h"

#include <algorithm>
#include <numeric>

#include "color/rgb.h"
#include "compare/judge.h"
#include "compare/quantities.h"
#include "compare/schema.h"
#include "math/functions.h"
#include "stats/tail.h"

namespace crescent::inline comparing {

namespace {

/// Sums over pixels that are visited row by row, from the left.
class Visit {
public:
    explicit Visit(const Sides& sides) : Visit(sides.all, sides.a, sides.b, sides.quantity) {
        if (sides.differences) paired_ = &sides.differences->film;
    }
    Visit(const Readings& all, const ArmReadings& a, const ArmReadings& b, std::size_t quantity)
        : all_(all), a_(a.film), b_(b.film), quantity_(quantity) {}

    void pixel(std::size_t i) {
        if (all_.bad[i]) return;
        const double a = a_.of(quantity_).mean[i], b = b_.of(quantity_).mean[i], d = a - b;
        out_.pixels += 1, out_.mean_a += a, out_.mean_b += b;
        const double own_a = a_.variance(i, quantity_), own_b = b_.variance(i, quantity_);
        out_.a += paired_ ? paired_->variance(i, quantity_) : own_a, out_.b += paired_ ? 0 : own_b;
        out_.own += own_a + own_b;
        const bool neighbours = pairs_started_ && last_ + 1 == i && i % static_cast<std::size_t>(all_.width) != 0;
        if (neighbours) rough_ += (d - before_) * (d - before_) / 2, pairs_ += 1;
        last_ = i, before_ = d, pairs_started_ = true;
    }
    /// `low`: how much more noise there is over a whole set than between neighbours.
    SetNoise done(double low) const {
        SetNoise out = out_;
        for (double* sum : {&out.a, &out.b, &out.own, &out.mean_a, &out.mean_b}) *sum /= out.pixels;
        const double of_a = std::isnan(out.a) ? 0 : out.a / static_cast<double>(a_.count);
        if (std::isnan(out.b)) out.b = pairs_ > 0 ? std::max(0.0, rough_ / pairs_ - of_a) * low : 0;
        if (!paired_) out.own = out.a + out.b;
        return out;
    }

private:
    const Readings& all_;
    const MeanFilm &a_, &b_;
    const MeanFilm* paired_ = nullptr;
    const std::size_t quantity_;
    SetNoise out_;
    std::size_t last_ = 0;
    bool pairs_started_ = false;
    double before_ = 0, rough_ = 0, pairs_ = 0;
};

MeanInterval floored_at(MeanInterval m, double variance_of_one) {
    if (m.n > 1 && variance_of_one > 0) m.se = std::max(m.se, std::sqrt(variance_of_one / static_cast<double>(m.n)));
    return m;
}

/// One file: its error is what its pixels' errors make of it, and counts as known, not as estimated.
MeanInterval one_file(double mean, const SetNoise& noise) {
    return {mean, 0, 0, std::sqrt(noise.b / noise.pixels), 1000000};
}

double low_over_high(const std::vector<double>& power) {
    if (power.empty()) return 1;
    const auto half = power.begin() + spectrum_bins / 2;
    const double high = std::accumulate(half, power.end(), 0.0) / static_cast<double>(power.end() - half);
    return high > 0 ? std::max(1.0, power.front() / high) : 1;
}

/// 0 where one file says nothing of them.
std::vector<double> tile_variances(const ArmReadings& arm, std::size_t quantity) {
    const auto& tiles = arm.quantities[quantity].tiles;
    std::vector<double> out(tiles[0].size());
    const double k = static_cast<double>(arm.files.size());
    for (const auto& render : tiles)
        for (std::size_t t = 0; t < out.size(); ++t) out[t] += k > 1 ? render[t].spread / (k - 1) : 0;
    return out;
}

/// The same rule as RegionResult::mean_heavy, of the deviations from the mean of one quantity.
bool heavy_deviations(const Readings& all, const ArmReadings& arm, std::size_t quantity, std::size_t region) {
    const std::vector<float>& largest = arm.quantities[quantity].largest[region];
    const auto tail = fit_pooled_tail(std::span<const float>(largest));
    double sum = 0;
    for (const std::uint32_t i : all.regions[region].pixels) sum += arm.film.of(quantity).m2[i];
    const double share = sum > 0 && !largest.empty() ? static_cast<double>(largest.front()) / sum : 0;
    return (tail && tail->k >= 1) || share > heavy_share;
}

bool one_pixel_decides(const ArmReadings& arm, std::size_t quantity, std::size_t tile) {
    double sum = 0, largest = 0;
    for (const auto& render : arm.quantities[quantity].tiles)
        sum += render[tile].spread, largest = std::max(largest, render[tile].largest);
    return sum > 0 && largest > heavy_share * sum;
}

}  // namespace

Sides::Sides(const ComparePlan& plan, const Readings& readings, const CompareResult& measured, std::size_t first,
    std::size_t second, std::size_t of, const PairedRenders* paired)
    : all(readings),
      a(readings.arms[first]),
      b(second < readings.arms.size() ? readings.arms[second] : *readings.reference),
      arm(measured.arms[first]),
      quantity(of) {
    const Rgb weights = luminance_weights_of(all.primaries);  // a channel may be 1 / weight times as bright as Y
    referred = second >= readings.arms.size();
    brightest = plan.brightest.value_or(0);
    if (const double weight = quantity > 0 ? weights[quantity - 1] : 1; weight > 0) brightest /= weight;
    if (!referred) other = &measured.arms[second];
    const RegionResult& frame = arm.region(whole_frame);
    dependent = frame.colour == NoiseColour::correlated;
    if (other) dependent |= other->region(whole_frame).colour == NoiseColour::correlated;
    if (dependent) low_frequencies = low_over_high(frame.power);
    tile_a = tile_variances(a, quantity), tile_b = tile_variances(b, quantity);
    if (!paired) return;
    pairs = &paired->pairs, differences = &paired->differences;
    tile_paired = tile_variances(*differences, quantity);
}

std::vector<double> Sides::region_means(const ArmReadings& side, std::size_t region) const {
    std::vector<double> out;
    for (const auto& render : side.quantities[quantity].regions) out.push_back(render[region]);
    return paired_of(side, std::move(out));
}

std::vector<double> Sides::tile_means(const ArmReadings& side, std::size_t tile) const {
    std::vector<double> out;
    for (const auto& render : side.quantities[quantity].tiles) out.push_back(render[tile].mean);
    return paired_of(side, std::move(out));
}

std::vector<double> Sides::paired_of(const ArmReadings& side, std::vector<double> each) const {
    if (!pairs) return each;
    std::vector<double> out;
    for (const auto& [i, j] : *pairs) out.push_back(each[&side == &a ? i : j]);
    return out;
}

double Sides::renders_of(const ArmReadings& side) const {
    return static_cast<double>(pairs ? pairs->size() : side.files.size());
}

std::string Sides::heavy_in(std::size_t region) const {
    if (differences) return heavy_deviations(all, *differences, quantity, region) ? "the differences of the pairs" : "";
    for (const ArmResult* result : {&arm, other}) {
        if (!result) continue;
        const bool heavy = quantity == 0 ? result->regions[region].mean_heavy()
                                         : heavy_deviations(all, result == &arm ? a : b, quantity, region);
        if (heavy) return result->name;
    }
    return "";
}

bool Sides::lone_pixel_in(std::size_t tile) const {
    if (differences) return one_pixel_decides(*differences, quantity, tile);
    return one_pixel_decides(a, quantity, tile) || (other && one_pixel_decides(b, quantity, tile));
}

SetNoise Sides::noise_of(const Box& box) const {
    Visit visit(*this);
    for (int j = box.y0; j <= box.y1; ++j)
        for (int i = box.x0; i <= box.x1; ++i)
            visit.pixel(
                static_cast<std::size_t>(j) * static_cast<std::size_t>(all.width) + static_cast<std::size_t>(i));
    return visit.done(low_frequencies);
}

SetNoise Sides::noise_of(const PixelSet& set) const {
    Visit visit(*this);
    for (const std::uint32_t i : set.pixels) visit.pixel(i);
    return visit.done(low_frequencies);
}

Welch Sides::test(
    const std::vector<double>& va, const std::vector<double>& vb, const SetNoise& noise, bool floored) const {
    if (pairs) {
        std::vector<double> each;
        for (std::size_t k = 0; k < pairs->size(); ++k) each.push_back(va[k] - vb[k]);
        const MeanInterval mean = mean_interval(each, confidence);
        return paired_test(floored ? floored_at(mean, noise.a / noise.pixels) : mean);
    }
    MeanInterval ours = mean_interval(va, confidence);
    MeanInterval theirs = vb.size() > 1 ? mean_interval(vb, confidence) : one_file(vb[0], noise);
    if (floored) ours = floored_at(ours, noise.a / noise.pixels);
    if (floored && vb.size() > 1) theirs = floored_at(theirs, noise.b / noise.pixels);
    return welch_test(ours, theirs);
}

double Sides::rare_event(double difference) const {
    const QuantityReadings& read = (difference < 0 ? a : b).quantities[quantity];
    if (!differences) return std::max(brightest, read.rise);
    const QuantityReadings& paired = differences->quantities[quantity];  // what b meets and a does not is a fall
    return std::max(brightest, difference < 0 ? paired.rise : paired.fall);
}

double Sides::unseen(double difference, double pixels, double level) const {
    const ArmReadings& lower = difference < 0 ? a : b;
    if (lower.files.size() < 2) return 0;
    return -math::log(level) * rare_event(difference) / (pixels * renders_of(lower));
}

std::optional<MissedEvents> Sides::needed(const Found& place, double pixels, double level) const {
    const bool ours = place.a < place.b;
    const ArmReadings& lower = ours ? a : b;
    if (lower.files.size() < 2) return {};
    MissedEvents out{ours ? arm.name : other ? other->name : the_reference, 0, 0, 0};
    out.one_in = pixels * renders_of(lower) / -math::log(level);
    out.size = std::fabs(place.a - place.b) * out.one_in;
    const double mean = std::min(place.a, place.b);
    out.of_mean = mean > 0 ? out.size / mean : 0;
    return out;
}

double Sides::blind(double mean_a, double mean_b, double pixels, double variance, double level) const {
    constexpr double roundings = 4;
    constexpr double reordered = 0x1p-18;  // of a float sum of up to 64 like terms, each rounded to 2^-24
    const double rounded = a.film.rounding * std::fabs(mean_a) + b.film.rounding * std::fabs(mean_b);
    const double left = variance > 0 ? std::min(1.0, rounded / std::sqrt(variance)) : 1;
    const double arithmetic = differences ? reordered * (std::fabs(mean_a) + std::fabs(mean_b)) : 0;
    return std::max({unseen(mean_a - mean_b, pixels, level),
        roundings * rounded * std::max(left, 1 / std::sqrt(pixels)), arithmetic});
}

double roughness(const Readings& all, const ArmReadings& arm, const PixelSet& set) {
    Visit visit(all, arm, *all.reference, 0);
    for (const std::uint32_t i : set.pixels) visit.pixel(i);
    return visit.done(1).b;
}

}  // namespace crescent::inline comparing
