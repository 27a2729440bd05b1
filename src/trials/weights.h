// What the weights f L cos / p of a trial say: their tail, and whether their mean may be and is the integral.
#pragma once

#include <algorithm>
#include <optional>
#include <span>

#include "stats/moments.h"
#include "stats/tail.h"
#include "trials/trial_context.h"

namespace crescent::inline trials {

inline constexpr const char* no_weights =
    "There is neither a pdf nor a weight with the draws, hence nothing to weigh them by.";

/// The pdf with a draw may be a random estimate too: the mean of one over it is not one over the mean.
inline bool weighs_by_estimates(const Draws& work) {
    const auto& draws = work.first(0).draws;
    return work.scatter().pdf() &&
        std::none_of(draws.begin(), draws.end(), [](const Draw& d) { return d.weight.has_value(); });
}
inline constexpr const char* weight_of_estimates =
    "A weight, f |cos| / p, with each draw: where pdf is a random estimate, f over it is biased and tells nothing of "
    "the draws.";

/// What a reader is told of that: Johnson's t, or the plain one where it is far out, for which Johnson's correction is
/// not made. None where the weights are alike to what p itself is granted: their spread is no measure of chance.
std::optional<double> told_z(const Spread& s, const Integral& expected);
/// How often the largest weight was drawn, to the rounding of floats. One with a tail has a largest that comes once.
std::size_t times_largest(std::span<const double> x);
/// Of the largest of these weights; none where the largest was drawn so often that there is nothing beyond it.
std::optional<Tail> tail_of(std::span<const double> x);
/// A tail with k >= 1/2 has a largest weight of the order of sqrt(n) means; one of a few means among thousands is
/// bounded, whatever a fit to the few weights that stand out may say.
bool is_bounded(const Spread& s);
/// k-hat surely below 1/2 and theory does not say otherwise.
bool mean_is_testable(const Spread& s, const std::optional<Tail>& tail, const ExpectedBehaviour& theory);
/// Two-sided p-value of the mean, the quadrature's own error granted, and the two-stage test. Where |skew| / sqrt(n) >
/// 0.1 the normal law is too far off: Bernstein's inequality between 0 and the largest weight, which never accuses too
/// often.
double mean_p(const Spread& s, const Integral& expected);
bool mean_fails(const TrialContext& work, double p, const Integral& expected, bool even);

}  // namespace crescent::inline trials
