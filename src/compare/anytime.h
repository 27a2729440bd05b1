// Tests that may be repeated after every render: their p holds at any time, so stopping when it is small enough is no
// cheating.
#pragma once

namespace crescent {

/// Returns p of a t statistic with `df` degrees of freedom that is computed again as renders are added: the probability
/// that it is ever at most x is at most x. `information`: the variance of one render over that of the estimate, which
/// is n for n renders, and n m / (n + m) for the difference of two sides.
double anytime_p(double t, double df, double information);
/// Returns |t| with this p; infinite if none has it. The values of a mean within this many standard errors are a
/// confidence sequence.
double anytime_quantile(double p, double df, double information);

/// Returns the factor of p for a test at the look of this number, 1, 2, ...: those of all looks share one level,
/// because the sum of 6 / (pi k)^2 over k is 1.
double look_factor(unsigned look_number);

}  // namespace crescent
