// Cases of built-in samplers and of a user's: their w_o, parameters, surfaces and baselines.
#include "check/sources/cases.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.h"
#include "tests/support/function_sampler.h"

namespace crescent {
namespace cases_test {

using check::FunctionSampler;

double pdf_of(const SamplerAdapter& s, Vec3d wo, Vec3d wi) {
    const Pair at{wo, wi};
    double out = 0;
    s.pdf(0, {&at, 1}, {&out, 1});
    return out;
}

TEST(CasesOfSamplers, CoverTheGridOnEachSurface) {
    EXPECT_EQ(wo_grid(false).size(), 8u);
    EXPECT_EQ(wo_grid(true).size(), 16u);
    for (const CheckCase& t : make_cases("cosine", {}, false)) {
        EXPECT_EQ(t.arm, "cosine");
        EXPECT_NEAR(std::acos(t.wo.z) * 180 / pi, t.theta_deg, 1e-6);
        EXPECT_NEAR(pdf_of(*t.adapter, t.wo, tilt(60)), 0.5 / pi, 1e-6);
    }
    EXPECT_EQ(make_cases("cosine", {}, true).size(), 2 * make_cases("cosine", {}, false).size());
    EXPECT_EQ(make_cases("cosine", {}, false, {{10, 20}}).size(), make_cases("cosine", {}, false).size() / 8);
    EXPECT_THROW((void)make_cases("cosin", {}, false), InputError);
}

TEST(CasesOfSamplers, HaveTheGivenParameters) {
    int with_s = 0;
    for (const CheckCase& t : make_cases("phong", {{"s", 7}}, false, {{30, 0}}))
        for (const auto& [name, value] : t.parameters)
            if (name == "s") {
                ++with_s;
                EXPECT_EQ(value, 7);
            }
    EXPECT_GT(with_s, 0);
    EXPECT_THROW((void)make_cases("phong", {{"roughness", 1}}, false), InputError);
    EXPECT_THROW((void)make_cases("phong", {{"rho_s", 0.9}}, false), InputError);  // with rho_d more than arrives
    EXPECT_THROW(
        (void)make_cases("beckmann-d", {{"alpha", 5e-4}}, false), InputError);  // below what Beckmann is checked from
    EXPECT_NO_THROW((void)make_cases("beckmann-d", {{"alpha", 2e-3}}, false));
}

TEST(CasesOfSamplers, LightsAreThoseOfTheirNames) {
    EXPECT_TRUE(case_setup(LobeKind::none, true, "fill", 32).light.even());
    const CaseLighting disk = case_setup(LobeKind::none, true, "disk", 32).light;
    EXPECT_EQ(disk.fill, 0);
    EXPECT_EQ(disk(tilt(35, 20)), 20);
    EXPECT_EQ(disk(tilt(35, 200)), 0);
    const CaseLighting two = case_setup(LobeKind::none, true, "fill + two disks", 32).light;
    EXPECT_EQ(two(tilt(35, 20)), 20);  // the nearer one, although it is second
    EXPECT_EQ(two(tilt(80, 200)), 1);
    EXPECT_EQ(case_setup(LobeKind::none, true, "rectangle", 32).light.area_lights.size(), 1u);
}

TEST(CasesAgainst, HaveTheSurfaceOfTheOther) {
    const CheckCase a = make_case_on(case_setup(lobe_named("phong"), true, "fill", 20), 40, 10, "made", nullptr);
    const auto cosine = sampler_on("cosine", a);
    const Pair at{a.wo, mirror(a.wo)};
    double f = 0;
    cosine->f({&at, 1}, {&f, 1});
    EXPECT_NEAR(f, brdf_value({lobe_named("phong"), 0.5, 0.4, 20, 0}, at.wo, at.wi), 1e-9);
    CaseSetup bright = case_setup(LobeKind::none, true, "fill", 20);
    bright.surface.rho_d = 0.9;
    const CheckCase c = make_case_on(bright, 40, 10, "made", nullptr);
    sampler_on("cosine", c)->f({&at, 1}, {&f, 1});
    EXPECT_NEAR(f, 0.9 / pi, 1e-9);
    FunctionSampler owner;
    owner.f_value = check::lambert(0.25);
    CheckCase user = a;
    user.adapter = std::make_shared<FunctionSampler>(owner);
    const CheckCase b = sampler_named_against("cosine", {&user, 1})[0];
    b.adapter->f({&at, 1}, {&f, 1});
    EXPECT_NEAR(f, 0.25 / pi, 1e-9);  // f is that of A
    EXPECT_EQ(b.arm, "cosine");
    EXPECT_NEAR(pdf_of(*b.adapter, a.wo, tilt(60)), 0.5 / pi, 1e-6);
    EXPECT_EQ(sampler_against(user.adapter, {&a, 1})[0].adapter, user.adapter);
}

TEST(CasesOfUsers, FollowTheDomainOfWo) {
    const auto cases = [](Traits::WoDomain wo, bool with_f, bool full = false) {
        auto s = std::make_shared<FunctionSampler>();
        s->of.wo = wo;
        if (with_f) s->f_value = check::lambert(0.5);
        return make_user_cases(s, full);
    };
    using Domain = Traits::WoDomain;
    EXPECT_EQ(cases(Domain::none, false).size(), 1u);
    EXPECT_EQ(cases(Domain::upper, false).size(), 8u);
    const auto both = cases(Domain::both, false);
    EXPECT_EQ(both.size(), 12u);
    EXPECT_EQ(std::ranges::count_if(both, [](const CheckCase& t) { return t.wo.z < 0; }), 4);
    EXPECT_EQ(cases(Domain::both, false, true).size(), 32u);
    const auto ranked = cases(Domain::upper, true);
    EXPECT_EQ(ranked.size(), 24u);  // with uniform and cosine
    EXPECT_EQ(std::ranges::count_if(ranked, [](const CheckCase& t) { return t.baseline; }), 16);
}

}  // namespace cases_test
}  // namespace crescent
