// The description of every built-in sampler is complete, and its formulas can be set.
#include "samplers/info.h"

#include <gtest/gtest.h>

#include <set>

#include "output/formula.h"
#include "samplers/all.h"
#include "scene/lobes/lobe.h"

namespace crescent {
namespace info_test {

TEST(ArmInfos, GoByOneNameWhichTheirLabelsHold) {
    std::set<std::string_view> names;
    for (const SamplerInfo& arm : sampler_infos()) {
        EXPECT_TRUE(names.insert(arm.name).second) << arm.name;
        EXPECT_NE(arm.label.find(arm.name), std::string_view::npos) << arm.label;
        EXPECT_EQ(find_arm_info(arm.name), &arm);
    }
    EXPECT_EQ(names.size(), Samplers::count);
    EXPECT_EQ(find_arm_info("no such arm"), nullptr);
}

TEST(ArmInfos, HaveSummariesAndValidFormulas) {
    for (const SamplerInfo& arm : sampler_infos()) {
        EXPECT_FALSE(arm.summary.empty()) << arm.name;
        EXPECT_LE(arm.summary.size(), 100u) << arm.name;
        EXPECT_FALSE(formula::mathml(arm.density).empty()) << arm.name;
        EXPECT_FALSE(formula::pango(arm.formula).empty()) << arm.name;
        EXPECT_FALSE(formula::html(arm.draw).empty()) << arm.name;
        EXPECT_FALSE(formula::html(arm.axis).empty()) << arm.name;
    }
}

TEST(ArmInfos, StateMissedLightAsTheoryExpects) {
    for (const SamplerInfo& arm : sampler_infos()) {
        const bool support = arm.theory && arm.theory({.rho_d = 0.5, .fill = 1}).wrong == "support";
        EXPECT_EQ(!arm.misses.empty(), support) << arm.name;
    }
}

/// Everything a sampler needs, except that its density is a plain number.
template <class F> struct WithoutUnits {
    static constexpr std::string_view name = "without-units";
    static constexpr SamplerDoc manual = {.label = name};
    explicit WithoutUnits(const ShadingPoint<F>&) {}
    Drawn<F> sample(Vec3<F>, Vec2<F>) const { return {}; }
    F pdf(Vec3<F>, Vec3<F>) const { return {}; }
};
/// Two techniques, one of them without a weight.
template <class F> struct WithoutWeight : Cosine<F> {
    static constexpr int techniques = 2;
    using Cosine<F>::Cosine;
    template <int> Drawn<F> sample_technique(Vec3<F> wo, Vec2<F> u) const { return this->sample(wo, u); }
    template <int> PerSr<F> pdf_technique(Vec3<F> wo, Vec3<F> wi) const { return this->pdf(wo, wi); }
};

TEST(Samplers, SatisfyTheConceptInEveryArithmetic) {
    for_each_sampler(Samplers{}, []<template <class> class A>() { static_assert(Sampler<A<double>, double>); });
    static_assert(!Sampler<WithoutUnits<float>, float>);
    static_assert(!Sampler<WithoutWeight<float>, float>);
}

TEST(LobeInfos, NameAnArmThatDrawsFromThemAndAreComplete) {
    for (const LobeInfo& lobe : lobe_infos()) {
        EXPECT_NE(find_arm_info(lobe.own_arm), nullptr) << lobe.name;
        EXPECT_EQ(lobe_named(lobe.name), lobe.kind);
        EXPECT_EQ(lobe_info(lobe.kind).name, lobe.name);
        EXPECT_FALSE(formula::mathml(lobe.formula).empty()) << lobe.name;
        EXPECT_FALSE(lobe.summary.empty() || lobe.label.empty()) << lobe.name;
        const LobeWidth width = lobe.width(32, 0.25);
        EXPECT_GT(width.width, 0) << lobe.name;
        EXPECT_GT(width.reach, width.width) << lobe.name;
        EXPECT_NEAR(lobe.exponent(32, 0.25), 32, 1e-12) << lobe.name;  // alpha = sqrt(2/s)
    }
    EXPECT_EQ(lobe_named(""), LobeKind::none);
}

}  // namespace info_test
}  // namespace crescent
