// Light in directions that no draw met, where its weight would be larger than any that was drawn.
#pragma once

#include <span>

#include "judgements/verdict.h"
#include "trials/integrals.h"

namespace crescent::inline trials {

/// The mean is short, and a tail that no draw met explains it: such a mean is not accused (unmet.cpp).
bool has_unmet_tail(const Integrals& work, bool even);
Unmet look_for_unmet(const Integrals& work, std::span<const double> x, bool even);
/// "heavy tail that no draw met", with its mass and how many draws would meet it; sets `settle` too.
void tell_unmet(Verdict& v, const Unmet& unmet, const Integral& expected, std::size_t draws);

}  // namespace crescent::inline trials
