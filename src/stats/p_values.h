// p-values of statistics that may be infinite, or stand on nothing at all.
#pragma once

#include <cmath>

#include "stats/distributions.h"

namespace crescent::inline stats {

/// Of a chi-square statistic with so many degrees of freedom; 1 of none.
inline double chi_squared_p(double statistic, double degrees) {
    return degrees > 0 ? chi_squared_tail(degrees, statistic) : 1;
}
/// Two-sided, of a normal z; 0 of one that is not finite.
inline double normal_p(double z) { return std::isfinite(z) ? normal_two_sided(z) : 0; }
/// Two-sided, of Student's t with so many degrees of freedom; 0 of one that is not finite.
inline double student_p(double t, double degrees) { return std::isfinite(t) ? student_two_sided(degrees, t) : 0; }

}  // namespace crescent::inline stats
