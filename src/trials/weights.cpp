// What the weights X = f L cos / p say: their spread, their tail, and whether their mean is the integral, where the
// tail allows the question.
#include "trials/weights.h"

#include <algorithm>
#include <cmath>

#include "math/functions.h"
#include "stats/moments.h"
#include "stats/p_values.h"
#include "stats/tail.h"
#include "trials/trial_context.h"
#include "trials/unmet.h"

namespace crescent::inline trials {

std::optional<double> told_z(const Spread& s, const Integral& expected) {
    constexpr double alike = 1e-4, far_out = 8;
    if (!(s.sd > alike * std::fabs(expected.value))) return {};
    const double plain = (s.mean - expected.value) * std::sqrt(s.n) / s.sd;
    return std::fabs(plain) > far_out ? plain : johnson_t(s, expected.value);
}

std::size_t times_largest(std::span<const double> x) {
    constexpr double alike = 1e-5;  // relative, as in the fit of a tail
    if (x.empty()) return 0;
    const double largest = *std::max_element(x.begin(), x.end());
    return static_cast<std::size_t>(
        std::count_if(x.begin(), x.end(), [&](double v) { return v >= largest * (1 - alike); }));
}

namespace {

/// Few values that come again and again are no tail that a fit knows: it takes the steps between them for one.
bool is_of_few_values(std::span<const double> falling) {
    constexpr double alike = 1e-5;
    constexpr std::size_t few = 8;
    std::size_t values = 0;
    for (std::size_t i = 0; i < falling.size() && values <= few; ++values) {
        const double top = falling[i];
        while (i < falling.size() && falling[i] >= top * (1 - alike)) ++i;
    }
    return values <= few;
}

}  // namespace

std::optional<Tail> tail_of(std::span<const double> x) {
    constexpr std::size_t often = 20;  // what lies beyond comes a fifth as often at most, by 98 of 100
    constexpr std::size_t part = 8, least = 40;
    const std::size_t length = std::min(tail_length(x.size()) + 1, x.size());
    std::vector<double> largest(x.begin(), x.end());
    std::partial_sort(
        largest.begin(), largest.begin() + static_cast<std::ptrdiff_t>(length), largest.end(), std::greater<>());
    const std::span<const double> falling = std::span<const double>(largest).first(length);
    const std::optional<Tail> tail = fit_tail(falling);
    const auto may_be_heavy = [](const Tail& t) { return t.k + 2 * t.se >= 0.5; };
    if (!tail) return tail;
    if (times_largest(falling) >= often) return is_of_few_values(falling) || may_be_heavy(*tail) ? std::nullopt : tail;
    // A lobe that is seldom chosen and weighs more than the rest is a step up, not a tail: what lies on it tells.
    if (!may_be_heavy(*tail) || length <= part * least) return tail;
    const std::optional<Tail> upper = fit_tail(falling.first(1 + (length - 1) / part));
    return upper && !may_be_heavy(*upper) ? upper : tail;
}

bool is_bounded(const Spread& s) { return s.n >= 1000 && s.largest <= std::min(4.0, 0.1 * std::sqrt(s.n)) * s.mean; }

bool mean_is_testable(const Spread& s, const std::optional<Tail>& tail, const ExpectedBehaviour& theory) {
    const bool infinite = theory.tail_k && *theory.tail_k >= 0.5;
    // Rare large weights have been met often enough, or are so little larger that they move no mean.
    const bool seen = s.skew < 0 || s.skew / std::sqrt(s.n) < 0.1 || s.largest <= 1.1 * s.mean;
    if (s.sd <= 1e-7 * std::fabs(s.mean)) return !infinite;  // rounding has no tail
    return !infinite && seen && (!tail || tail->k + 2 * tail->se < 0.5 || is_bounded(s));
}

double mean_p(const Spread& s, const Integral& expected) {
    constexpr double allowed =
        1e-4;  // relative: what normalised and identity allow p itself, float rounding of a sharp lobe included
    // A cubature that ran out of questions is known to its error as an estimate, not as a bound: as in `normalised`.
    // Points at random have three standard errors.
    const bool bounded = expected.settled || expected.sampled;
    const double doubt = (bounded ? 1 : 2) * expected.error + allowed * std::fabs(expected.value);
    const double off = std::max(std::fabs(s.mean - expected.value) - doubt, 0.0);
    if (!(s.sd > 1e-7 * std::fabs(expected.value))) return off > 0 ? 0 : 1;  // every sample alike: no chance is in it
    if (std::fabs(s.skew) / std::sqrt(s.n) > 0.1)
        return std::min(2 * math::exp(-0.5 * s.n * off * off / (sqr(s.sd) + s.largest * off / 3 + 1e-300)), 1.0);
    const double z = std::fabs(johnson_t(s, expected.value)) - doubt / std::max(s.sd / std::sqrt(s.n), 1e-300);
    return normal_p(std::max(z, 0.0));
}

bool mean_fails(const TrialContext& work, double p, const Integral& expected, bool even) {
    return work.fails(p, [&](int round) {
        std::vector<SampleBatch> fresh;
        for (int t = 0; t < work.subject.techniques(); ++t) fresh.push_back(work.draw(t, round));
        const std::vector<double> x = work.weights(fresh, even);
        const double p_fresh = mean_p(spread(x), expected);
        return p_fresh < work.settings.confirm && look_for_unmet(work, x, even).heavy ? 1.0 : p_fresh;
    });
}

}  // namespace crescent::inline trials
