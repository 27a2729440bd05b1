// Whether a sampler is right: crescent::check_sampler and what its answer says. check/user.h has the signatures that
// a sampler may have; crescent/gtest.h the same as matchers of GoogleTest.
#pragma once

#include "check/report/print.h"
#include "check/user.h"
