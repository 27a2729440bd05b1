// Where the noise moved: log2 of the ratio of two arms' variances a tile, told apart from 1 by Welch's test of what
// each render spreads, false discoveries controlled.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "compare/judge.h"
#include "math/functions.h"
#include "pages/numbers.h"

namespace crescent::inline comparing {

namespace {

MeanInterval spread_of(const ArmReadings& arm, std::size_t tile) {
    const double k = static_cast<double>(arm.files.size());
    std::vector<double> each;
    for (const auto& render : arm.quantities[0].tiles) each.push_back(render[tile].spread * k / (k - 1));
    return mean_interval(each, confidence);
}

/// Tiles of a region: those of which it holds half the pixels or more.
std::vector<std::size_t> tiles_in(const Readings& all, const PixelSet& set) {
    std::vector<std::size_t> inside(all.tiles.count());
    for (const std::uint32_t i : set.pixels)
        ++inside[all.tiles.of(static_cast<int>(i) % all.width, static_cast<int>(i) / all.width)];
    std::vector<std::size_t> out;
    for (std::size_t t = 0; t < inside.size(); ++t) {
        const Box box = all.tiles.box(t, all.width, all.height);
        if (2 * inside[t] >= static_cast<std::size_t>(box.width()) * static_cast<std::size_t>(box.height()))
            out.push_back(t);
    }
    return out;
}

NoiseResult::Histogram histogram(const Readings& all, const PixelSet& set, const NoiseResult& noise) {
    NoiseResult::Histogram out{
        set.name, std::vector<std::uint64_t>(noise_bins), std::vector<std::uint64_t>(noise_bins)};
    for (const std::size_t t : tiles_in(all, set)) {
        if (std::isnan(noise.log2_ratio[t])) continue;
        const double at = (noise.log2_ratio[t] + noise_range) / (2 * noise_range) * noise_bins;
        const auto bin = static_cast<std::size_t>(std::clamp(std::floor(at), 0.0, noise_bins - 1.0));
        ++(noise.told_apart[t] ? out.told : out.rest)[bin];
    }
    return out;
}

std::string sentence(const NoiseResult& n, std::size_t tested) {
    if (!tested)
        return fmt::format(
            "Where the noise of {} and {} differs could not be told: three renders of each are needed.", n.a, n.b);
    std::size_t less = 0, more = 0;
    for (std::size_t t = 0; t < n.log2_ratio.size(); ++t)
        if (n.told_apart[t]) ++(n.log2_ratio[t] < 0 ? less : more);
    if (less + more == 0)
        return fmt::format("The variances of {} and {} are told apart in none of {} tiles.", n.a, n.b, tested);
    return fmt::format(
        "Of {} tiles, {} has less variance than {} in {} and more in {}; in the others they are not told apart.",
        tested, n.a, n.b, less, more);
}

}  // namespace

NoiseResult judge_noise(const ComparePlan& plan, const Readings& all, std::size_t a, std::size_t b, double alpha) {
    NoiseResult out;
    out.a = plan.arms[a].name, out.b = plan.arms[b].name;
    std::vector<double> p;
    for (std::size_t t = 0; t < all.tiles.count(); ++t) {
        const MeanInterval va = spread_of(all.arms[a], t), vb = spread_of(all.arms[b], t);
        const bool both = va.mean > 0 && vb.mean > 0;
        out.log2_ratio.push_back(both ? math::log(va.mean / vb.mean) / std::numbers::ln2 : std::nan(""));
        p.push_back(both && va.n > 2 && vb.n > 2 ? welch_test(va, vb).p : std::nan(""));
    }
    out.told_apart = discoveries(p, alpha, false);
    for (const PixelSet& set : all.regions) out.regions.push_back(histogram(all, set, out));
    out.sentence = sentence(
        out, static_cast<std::size_t>(std::count_if(p.begin(), p.end(), [](double x) { return !std::isnan(x); })));
    return out;
}

}  // namespace crescent::inline comparing
