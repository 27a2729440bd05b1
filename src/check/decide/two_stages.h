// The two stages of a test: what fails at the first is tested again with fresh draws and fresh points.
#pragma once

#include <functional>
#include <map>
#include <vector>

#include "check/verdicts/questions.h"
#include "check/verdicts/statistics.h"

namespace crescent::check {

/// Calls `visit` for every member of all families that are tested.
using VisitAll = std::function<void(const Visit&)>;
/// The member of a family with the least p.
using Least = LeastOf<Answer>;

/// For each family below the level, the member to test again. Among all members that are below the level by themselves
/// it is the one with the largest ratio of difference to standard error, where the standard error includes that of the
/// draws that cause the difference. The member with the least p may have two draws where none was expected; the next
/// stage has none of these with a probability of 13 %. draws: number of independent draws.
std::vector<Least> suspects_of(
    const VisitAll& visit_all, const std::map<Family, Least>& least_answers, double level, double draws);

/// Tests the same member again, one-sided in the direction of the first result. Unusable numbers are a fault by
/// themselves and need no second test.
Answer retest(const VisitAll& visit_all, const Answer& first);

}  // namespace crescent::check
