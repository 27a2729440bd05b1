// Variances of means over k renders are a pixel's over k. Where one file says nothing of its noise, half the mean
// square difference of neighbours stands in for it, less the other side's noise, times how much more there is at low
// frequencies than at high ones.
#include "compare/sides.h"

#include <algorithm>
#include <numeric>

#include "compare/judge.h"
#include "compare/schema.h"
#include "math/functions.h"

namespace crescent::inline comparing {

namespace {

/// Sums over pixels that are visited row by row, from the left.
class Visit {
public:
    Visit(const Readings& all, const ArmReadings& a, const ArmReadings& b) : all_(all), a_(a.film), b_(b.film) {}

    void pixel(std::size_t i) {
        if (all_.bad[i]) return;
        const double d = a_.y[i] - b_.y[i];
        out_.pixels += 1, out_.a += a_.variance(i), out_.b += b_.variance(i);
        out_.mean_a += a_.y[i], out_.mean_b += b_.y[i];
        const bool neighbours = pairs_started_ && last_ + 1 == i && i % static_cast<std::size_t>(all_.width) != 0;
        if (neighbours) rough_ += (d - before_) * (d - before_) / 2, pairs_ += 1;
        last_ = i, before_ = d, pairs_started_ = true;
    }
    /// `low`: how much more noise there is over a whole set than between neighbours.
    SetNoise done(double low) const {
        SetNoise out = out_;
        for (double* sum : {&out.a, &out.b, &out.mean_a, &out.mean_b}) *sum /= out.pixels;
        const double own = std::isnan(out.a) ? 0 : out.a / static_cast<double>(a_.count);
        if (std::isnan(out.b)) out.b = pairs_ > 0 ? std::max(0.0, rough_ / pairs_ - own) * low : 0;
        return out;
    }

private:
    const Readings& all_;
    const MeanFilm &a_, &b_;
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
std::vector<double> tile_variances(const ArmReadings& arm) {
    std::vector<double> out(arm.tiles[0].size());
    const double k = static_cast<double>(arm.files.size());
    for (const auto& render : arm.tiles)
        for (std::size_t t = 0; t < out.size(); ++t) out[t] += k > 1 ? render[t].spread / (k - 1) : 0;
    return out;
}

}  // namespace

Sides::Sides(const ComparePlan& plan, const Readings& readings, const CompareResult& measured, std::size_t first,
    std::size_t second)
    : all(readings),
      a(readings.arms[first]),
      b(second < readings.arms.size() ? readings.arms[second] : *readings.reference),
      arm(measured.arms[first]) {
    referred = second >= readings.arms.size();
    brightest = plan.brightest.value_or(0);
    if (!referred) other = &measured.arms[second];
    if (plan.pair && !referred) pairs = pairs_of(a, b);
    const RegionResult& frame = arm.region(whole_frame);
    dependent = frame.colour == NoiseColour::correlated;
    if (other) dependent |= other->region(whole_frame).colour == NoiseColour::correlated;
    if (dependent) low_frequencies = low_over_high(frame.power);
    tile_a = tile_variances(a), tile_b = tile_variances(b);
}

SetNoise Sides::noise_of(const Box& box) const {
    Visit visit(all, a, b);
    for (int j = box.y0; j <= box.y1; ++j)
        for (int i = box.x0; i <= box.x1; ++i)
            visit.pixel(
                static_cast<std::size_t>(j) * static_cast<std::size_t>(all.width) + static_cast<std::size_t>(i));
    return visit.done(low_frequencies);
}

SetNoise Sides::noise_of(const PixelSet& set) const {
    Visit visit(all, a, b);
    for (const std::uint32_t i : set.pixels) visit.pixel(i);
    return visit.done(low_frequencies);
}

Welch Sides::test(
    const std::vector<double>& va, const std::vector<double>& vb, const SetNoise& noise, bool floored) const {
    if (!pairs.empty()) {
        std::vector<double> differences;
        for (const auto& [i, j] : pairs) differences.push_back(va[i] - vb[j]);
        return paired_test(mean_interval(differences, confidence));
    }
    MeanInterval ours = mean_interval(va, confidence);
    MeanInterval theirs = vb.size() > 1 ? mean_interval(vb, confidence) : one_file(vb[0], noise);
    if (floored) ours = floored_at(ours, noise.a / noise.pixels);
    if (floored && vb.size() > 1) theirs = floored_at(theirs, noise.b / noise.pixels);
    return welch_test(ours, theirs);
}

double Sides::unseen(double difference, double pixels, double level) const {
    const ArmReadings& lower = difference < 0 ? a : b;
    if (lower.files.size() < 2) return 0;
    return -math::log(level) * std::max(brightest, lower.rare_event) /
        (pixels * static_cast<double>(lower.files.size()));
}

std::optional<MissedEvents> Sides::needed(const Found& place, double pixels, double level) const {
    const bool ours = place.a < place.b;
    const ArmReadings& lower = ours ? a : b;
    if (lower.files.size() < 2) return {};
    MissedEvents out{ours ? arm.name : other ? other->name : the_reference, 0, 0, 0};
    out.one_in = pixels * static_cast<double>(lower.files.size()) / -math::log(level);
    out.size = std::fabs(place.a - place.b) * out.one_in;
    const double mean = std::min(place.a, place.b);
    out.of_mean = mean > 0 ? out.size / mean : 0;
    return out;
}

double Sides::blind(double mean_a, double mean_b, double pixels, double variance, double level) const {
    constexpr double roundings = 4;
    const double rounded = a.film.rounding * std::fabs(mean_a) + b.film.rounding * std::fabs(mean_b);
    const double left = variance > 0 ? std::min(1.0, rounded / std::sqrt(variance)) : 1;
    return std::max(
        unseen(mean_a - mean_b, pixels, level), roundings * rounded * std::max(left, 1 / std::sqrt(pixels)));
}

double roughness(const Readings& all, const ArmReadings& arm, const PixelSet& set) {
    Visit visit(all, arm, *all.reference);
    for (const std::uint32_t i : set.pixels) visit.pixel(i);
    return visit.done(1).b;
}

}  // namespace crescent::inline comparing
