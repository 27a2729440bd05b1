// mean: bridged weights compared with the integral of f cos. support: light where p is 0. physics: the albedo is at
// most 1.
#pragma once

#include <span>

#include "check/verdicts/questions.h"

namespace crescent::check {

/// Calls `visit` for every member of its families.
void test_light(const Evidence& e, const Visit& visit);

/// Whether the weights may have an infinite variance, by their Pareto index and its standard error.
bool tail_may_be_heavy(std::span<const double> weights);
/// Whether their mean can be compared with the integral of f cos.
bool mean_can_be_tested(const Evidence& e);

}  // namespace crescent::check
