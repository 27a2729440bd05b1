// The Bayes factor of a normal effect against none with Haar's prior of mean and scale is a martingale under "none" for
// normal noise of unknown variance, for any scale (Lai 1976, "On Confidence Sequences"; Pérez-Ortiz, Lardy, de
// Heide & Grünwald 2024, "E-statistics, group invariance and anytime-valid testing"). By Ville's inequality its inverse
// is such a p. For many degrees of freedom it is the normal mixture of Howard, Ramdas, McAuliffe & Sekhon 2021,
// "Time-uniform, nonparametric, nonasymptotic confidence sequences", equation (14).
#include "compare/anytime.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "math/functions.h"

namespace crescent {

namespace {

/// The variance of the effect, in variances of one render. The radius is smallest where information x this is about 30
/// to 100: at 4 to 12, which is 8 to 24 renders of each side; four times more or less widens it by about a tenth.
constexpr double effect = 8;

}  // namespace

double anytime_p(double t, double df, double information) {
    if (std::isnan(t)) return t;
    if (!(df > 0) || !(information > 0)) return 1;
    if (std::isinf(t)) return 0;
    const double a = 1 + effect * information, square = t * t / df;
    const double factor = (df + 1) / 2 * (math::log1p(square) - math::log1p(square / a)) - math::log(a) / 2;
    return std::min(1.0, math::exp(-factor));
}

double anytime_quantile(double p, double df, double information) {
    if (!(df > 0) || !(information > 0)) return HUGE_VAL;
    const double a = 1 + effect * information;
    const double c = math::exp(2 / (df + 1) * (math::log(a) / 2 - math::log(p)));
    return c < a ? std::sqrt(df * (c - 1) / (1 - c / a)) : HUGE_VAL;
}

double look_factor(unsigned look_number) {
    const double k = std::numbers::pi * static_cast<double>(std::max(1u, look_number));
    return k * k / 6;
}

}  // namespace crescent
