// EXPECT_THAT(MySampler{}, crescent::IsARightSampler()); needs GoogleTest and GoogleMock.
#pragma once

#if __cplusplus < 202002L
#error "crescent needs C++20: compile with -std=c++20"
#else
#include "check/gtest.h"
#include "check/sources/shader.h"
#endif
