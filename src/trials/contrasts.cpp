// A value a bin, whose mean over the draws is held against the one over p; in standard errors, less what the integrals
// leave open.
#include "trials/contrasts.h"

#include <algorithm>
#include <cmath>

#include "math/functions.h"

namespace crescent::inline trials {

namespace {

/// What each bin counts for, contrast by contrast; 0 for bins that expect fewer than five draws.
std::vector<Contrasts> values_of(const Density& d, double draws) {
    const std::size_t sectors = static_cast<std::size_t>(d.sectors);
    std::vector<Contrasts> out(d.mass.bins.size());
    double nearer = 0;
    for (std::size_t ring = 0; ring + 1 < d.rings.size(); ++ring) {
        double of_ring = 0;
        for (std::size_t k = 0; k < sectors; ++k) of_ring += d.mass.bins[ring * sectors + k];
        for (std::size_t k = 0; k < sectors; ++k) {
            const double mass = d.mass.bins[ring * sectors + k], area = d.rings[ring + 1] - d.rings[ring],
                         phi = 2 * pi * (static_cast<double>(k) + 0.5) / static_cast<double>(sectors);
            if (!(mass * draws >= 5) || !(area > 0)) continue;
            out[ring * sectors + k] = {math::log(mass / area), nearer + 0.5 * of_ring, math::cos(phi), math::sin(phi)};
        }
        nearer += of_ring;
    }
    return out;
}

}  // namespace

Contrasts contrasts_of(const Densities& work, const Density& d, const SampleBatch& b) {
    constexpr double allowed = 1e-4;  // relative: what normalised and identity grant p
    std::vector<double> seen(d.mass.bins.size());
    double n = 0, total = 0;
    const std::vector<Vec2d>& at = work.coordinates_of(b, d.map);
    for (std::size_t i = 0; i < b.draws.size(); ++i)
        if (!is_null_sample(b.draws[i], b.pdf[i])) ++seen[d.bin_of(at[i])], ++n;
    for (double m : d.mass.bins) total += m;
    const std::vector<Contrasts> value = values_of(d, n);
    Contrasts out{};
    for (std::size_t c = 0; c < contrast_count; ++c) {
        double mean = 0, square = 0, sum = 0, doubt = 0, weight = 0;
        const auto counts = [&](std::size_t i) { return d.mass.bins[i] * n >= 5; };
        for (std::size_t i = 0; i < seen.size(); ++i)
            if (counts(i)) mean += d.mass.bins[i] * value[i][c], weight += d.mass.bins[i];
        if (!(weight > 0)) continue;
        mean /= weight;
        for (std::size_t i = 0; i < seen.size(); ++i) {
            if (!counts(i)) continue;
            const double v = value[i][c] - mean, share = d.mass.bins[i] / total;
            sum += seen[i] * v;
            square += share * v * v;
            doubt += std::fabs(v) * (d.mass.bin_errors[i] + allowed * share);
        }
        if (!(square > 1e-6)) continue;
        const double off = std::max(std::fabs(sum) - n * doubt, 0.0);
        out[c] = (sum < 0 ? -off : off) / std::sqrt(n * square);
    }
    return out;
}

std::optional<Contrasted> contrasted(const Densities& work) {
    if (!work.traits.has_pdf || !work.subject.draws_at_will() || work.scatter().pdf()) return {};
    Contrasted out;
    for (int t = 0; t < work.subject.techniques(); ++t) {
        const Density& d = work.density(t);
        if (!(d.mass.value > 0) || !std::isfinite(d.mass.value) || d.mass.sampled || !d.tabulation_errors.empty() ||
            d.mass.error > 1e-3)
            return {};
        out.densities.push_back(d);
        out.z.push_back(contrasts_of(work, d, work.first(t)));
    }
    return out;
}

}  // namespace crescent::inline trials
