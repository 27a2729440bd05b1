// identity and valid, from counts of single draws: values, pointwise, zero, weight, and repeated directions; and the
// counts of delta parts.
#pragma once

#include "check/verdicts/questions.h"

namespace crescent::check {

// Each calls `visit` for every member of its families.
void test_counts(const Evidence& e, const Visit& visit);
void test_deltas(const Evidence& e, const Visit& visit);

}  // namespace crescent::check
