// Checks a sampler: crescent::check_sampler and its result. check/user.h has the signatures that a sampler may have;
// crescent/gtest.h has GoogleTest matchers.
#pragma once

#if __cplusplus < 202002L
#error "crescent needs C++20: compile with -std=c++20"
#else
#include "check/against.h"
#include "check/report/html.h"
#include "check/report/print.h"
#include "check/report/result_json.h"
#include "check/report/screen.h"
#include "check/report/summary.h"
#include "check/sources/shader.h"
#include "check/user.h"
#include "check/waivers.h"
#endif
