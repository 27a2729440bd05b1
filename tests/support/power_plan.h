// The plan of a check of cos^40 about n, for tests of what is measured with it.
#pragma once

#include <gtest/gtest.h>

#include "check/estimate/plan.h"
#include "tests/support/function_sampler.h"

namespace crescent::check {

class PowerPlan : public testing::Test {
protected:
    FunctionSampler sampler = power_sampler(40);
    CaseLighting light;
    Source source{sampler, 0, {0, 0, 1}, light};
    CheckBudget budget = CheckBudget::limited();
    Plan plan = make_plan(source, budget, {});
};

}  // namespace crescent::check
