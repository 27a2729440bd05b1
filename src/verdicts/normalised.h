// What p may differ from one by.
#pragma once

namespace crescent::inline verdicts {

/// What the sum of p over the sphere may differ from one by.
inline constexpr double granted_mass = 1e-4;

}  // namespace crescent::inline verdicts
