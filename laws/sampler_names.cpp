// The words an experiment may use for samplers are the arms of the list, in its order.
#include <gtest/gtest.h>

#include "arms/all.h"
#include "experiment/names.h"

namespace crescent {
namespace {

TEST(SamplerNames, AreTheArmsOfTheList) {
    std::vector<std::string> names;
    for_each_arm(Arms{}, [&]<template <class> class A>() { names.emplace_back(A<float>::name); });
    EXPECT_EQ(names, sampler_names());
}

}  // namespace
}  // namespace crescent
