#include "scene/material.h"

#include <cmath>

namespace crescent {

Surface surface_of(const Material& m, double common_s) {
    const double s = m.s.value_or(common_s);
    return {m.rho_d, m.rho_s, m.brdf, s, m.alpha.value_or(std::sqrt(2 / (s + 2)))};
}

}  // namespace crescent
