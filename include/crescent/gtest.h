// EXPECT_THAT(MySampler{}, crescent::IsARightSampler()); needs GoogleTest and GoogleMock.
#pragma once

#include "check/gtest.h"
