// Tails and quantiles of the distributions that verdicts and intervals speak of, on functions.h alone: the same bits on
// every machine. Relative error below 1e-12 for counts and degrees up to 1e6 (distributions_test.cpp, beside Boost's).
#pragma once

namespace crescent::inline stats {

/// Regularised incomplete gamma functions, a > 0, x >= 0: P(a, x) and Q(a, x) = 1 - P(a, x), neither by subtraction
/// where it is the small one.
double gamma_p(double a, double x);
double gamma_q(double a, double x);
/// Regularised incomplete beta function I_x(a, b), a, b > 0, for x in [0, 1] and y = 1 - x.
double beta_i(double a, double b, double x, double y);

/// P(chi^2 with so many degrees of freedom > x).
double chi_squared_tail(double degrees, double x);
/// P(|Z| > |z|), Z normal.
double normal_two_sided(double z);
/// P(|T| > |t|), Student's T with so many degrees of freedom, and the t > 0 that is exceeded with probability p.
double student_two_sided(double degrees, double t);
double student_two_sided_quantile(double degrees, double p);
/// P(N >= k), N Poisson of this mean.
double poisson_tail(double mean, double k);

struct ShareInterval {
    double low, high;
};
/// Clopper & Pearson 1934: what p can be when k of n came out, each end wrong with probability alpha.
ShareInterval binomial_interval(double n, double k, double alpha);

}  // namespace crescent::inline stats
