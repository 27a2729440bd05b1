// Checks a sampler: crescent::check_sampler and its result. check/user.h has the signatures that a sampler may have;
// crescent/gtest.h has GoogleTest matchers.
#pragma once

#include "check/report/print.h"
#include "check/user.h"
