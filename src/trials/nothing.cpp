// How many samples draw nothing: of a density that integrates to less than one it is what is missing. Sixteen random
// shifts of an even cover of u tell it, with a standard error.
#include <algorithm>
#include <cmath>

#include "simd/random.h"
#include "subjects/numbers.h"
#include "trials/delta.h"
#include "trials/densities.h"

namespace crescent::inline trials {

/// What is not of the density: delta parts, whose draws say how often they come, and draws of nothing. These are looked
/// for at more points as long as it hangs on them whether p and they come to one.
void Densities::share_nothing(int technique, Density& d) const {
    const SampleBatch& b = first(technique);
    const double n = static_cast<double>(b.draws.size());
    const DeltaParts parts = delta_parts(*this, b);
    const std::optional<double> told =
        parts.parts.empty() || parts.scattered ? std::nullopt : std::optional<double>(parts.q());
    d.delta = told ? *told : static_cast<double>(b.deltas) / n;
    d.nothing = d.delta + static_cast<double>(b.nothing - b.deltas) / n;
    d.nothing_se = std::sqrt((d.nothing - d.delta) * (1 - d.nothing + d.delta) / n);
    if (!subject.draws_at_will()) return;
    const auto off = [&] { return std::fabs(d.mass.value + d.nothing - 1) - 5e-5; };
    const bool met = b.nothing > (told ? b.deltas : 0);
    if (!met && !(d.mass.value + d.nothing < 1 - 5e-5)) return;
    const std::uint64_t most = settings.full ? 65536 : thrifty() ? 8192 : 32768;
    for (std::uint64_t points = !met ? most : settings.full ? 16384 : 2048; points <= most; points *= 4) {
        estimate_null_fraction(technique, d, points, told);
        if (off() < 3 * d.nothing_se || off() > 12 * d.nothing_se) break;  // no doubt of one, or surely not
    }
}

/// Whether p is positive at every draw under the horizon, or at none: then those of the lattice need not be asked
/// about.
bool Densities::all_alike_below(int technique) const {
    const SampleBatch& b = first(technique);
    std::size_t below = 0, positive = 0;
    for (std::size_t i = 0; i < b.draws.size(); ++i)
        if (b.draws[i].pdf > 0 && b.draws[i].wi.z <= 0) ++below, positive += b.pdf[i] > 0;
    return below >= 1000 && (positive == 0 || positive == below);
}

/// Sixteen random shifts of an even cover give the share of u that draws nothing and its standard error.
void Densities::estimate_null_fraction(
    int technique, Density& d, std::uint64_t wanted, std::optional<double> told) const {
    constexpr int shifts = 16;
    const SampleBatch& b = first(technique);
    const bool alike = scatter().pdf() || all_alike_below(technique);
    bool reaches = false;
    for (std::size_t i = 0; i < b.draws.size(); ++i) reaches = reaches || (b.draws[i].wi.z <= 0 && b.pdf[i] > 0);
    const int each = alike ? 1 : 2;  // a draw, and p at it
    const std::uint64_t n = affordable(each * shifts * wanted, for_later()) / (each * shifts);
    if (n < std::min<std::uint64_t>(wanted, 1024)) return;  // the draws themselves know it better
    double sum = 0, square = 0, deltas = 0;
    std::vector<Numbers> u(n);
    std::vector<Draw> draws(n);
    for (int k = 0; k < shifts; ++k) {
        const Numbers shift = drawn_numbers(seed_of(settings.seed, 0x51f7u), index_, static_cast<std::uint64_t>(k),
            8u + static_cast<std::uint32_t>(technique), traits.numbers);
        for (std::uint64_t i = 0; i < n; ++i) u[i] = even_cover(i, shift, traits.numbers);
        subject.sample(technique, trial.wo, u, draws);
        const std::vector<double> p =
            alike ? std::vector<double>(n, reaches ? 1.0 : 0.0) : pdf_of_drawn(technique, draws);
        double none = 0;
        for (std::size_t i = 0; i < n; ++i)
            if (is_null_sample(draws[i], p[i])) {
                const bool delta = draws[i].delta > 0;
                deltas += delta;
                none += !(delta && told);
            }
        sum += none / static_cast<double>(n);
        square += sqr(none / static_cast<double>(n));
    }
    d.nothing_se = std::sqrt(std::max(square / shifts - sqr(sum / shifts), 0.0) / (shifts - 1));
    d.delta = told ? *told : deltas / (shifts * static_cast<double>(n));
    d.nothing = sum / shifts + told.value_or(0);
}

}  // namespace crescent::inline trials
