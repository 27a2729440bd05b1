// The chooser's probability: p = x a + y b where a and b are what two lobes draw. Where nine of ten directions that
// both reach have one x and one y, and these are not 1, the lobes are chosen with other probabilities than p has.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "diagnosis/diagnosis.h"
#include "simd/scalar.h"
#include "warps/preimages.h"

namespace crescent::inline diagnosis {

namespace {

constexpr std::size_t least_pairs = 16;
constexpr double exact_share = 2e-3, most_pairs = 0.9;

/// x and y of p = x low + y high, by least squares of the relative difference.
struct LowAndHigh {
    double low = 1, high = 1;
    bool known = false;
};

LowAndHigh low_and_high_of(std::span<const Reached::Pair> pairs) {
    double aa = 0, ab = 0, bb = 0, a = 0, b = 0;
    for (const Reached::Pair& p : pairs)
        aa += sqr(p.low), ab += p.low * p.high, bb += sqr(p.high), a += p.low, b += p.high;
    const double det = aa * bb - ab * ab;
    if (!(det > 1e-3 * aa * bb)) return {};
    return {(bb * a - ab * b) / det, (aa * b - ab * a) / det, true};
}

/// Of a p that integrates to one, one lobe is drawn more often than it says and the other less: a lobe whose draws are
/// crowded into part of it looks like one that is drawn too often, and takes from no other.
bool take_from_each_other(const LowAndHigh& s, const Density& d) {
    constexpr double least_share = 1e-3;
    if (std::fabs(d.mass.value + d.nothing - 1) > 1e-3) return true;
    const double low = 1 / s.low - 1, high = 1 / s.high - 1;
    return low * high < 0 &&
        std::min(std::fabs(low), std::fabs(high)) > least_share * std::max(std::fabs(low), std::fabs(high));
}

double off(const LowAndHigh& s, const Reached::Pair& p) { return std::fabs(s.low * p.low + s.high * p.high - 1); }

}  // namespace

std::optional<Diagnosis> diagnose_lobes(const TrialContext& work, int technique) {
    if (!work.subject.draws_at_will() || work.traits.own_random) return {};
    const Reached& found = preimages_of(work, technique);
    const LowAndHigh s = low_and_high_of(found.pairs);
    const double wrong = std::max(std::fabs(s.low - 1), std::fabs(s.high - 1));
    if (found.pairs.size() < least_pairs || !s.known || !(s.low > 0.01) || !(s.high > 0.01)) return {};
    if (wrong < 2 * exact_share || std::fabs(s.low - s.high) < 2 * exact_share) return {};  // as it is, or a constant
    if (!take_from_each_other(s, work.density(technique))) return {};
    double all = 0, left = 0;
    std::size_t inside = 0;
    for (const Reached::Pair& p : found.pairs) {
        all += off({}, p), left += off(s, p);
        inside += off(s, p) <= std::min(exact_share, 0.1 * wrong);
    }
    if (static_cast<double>(inside) < most_pairs * static_cast<double>(found.pairs.size()) || !(left < 0.1 * all))
        return {};
    Diagnosis d{"the chooser's probability", 1, 1 - left / all,
        fmt::format(
            "of the lobes that u{} chooses, that of its lower values is drawn {:.4g} times as often as pdf(w) has "
            "it, the other {:.4g} times",
            found.chooser + 1, 1 / s.low, 1 / s.high),
        {}};
    return d;
}

}  // namespace crescent::inline diagnosis
