// Factors of a density, the numbers with a name, and ratios that have a simple cause.
#include "check/explain/factors.h"

#include <gtest/gtest.h>

#include <map>

#include "check/estimate/stream.h"
#include "check/explain/regression.h"
#include "tests/support/explained.h"

namespace crescent::check {
namespace factors_test {

double value_of(const std::vector<Factor>& all, std::string_view name, Vec3d wo, Vec3d wi) {
    return std::ranges::find(all, name, &Factor::name)->value(wo, wi);
}

TEST(HalfVectors, AreThoseOfReflectionAndRefraction) {
    const Vec3d n = tilt(20, 50), wo = tilt(35, 10);
    const Vec3d reflected = n * (2 * dot(wo, n)) - wo;
    EXPECT_NEAR(dot(half_vector_of(wo, reflected, 1.5), n), 1, 1e-12);
    const double c = dot(wo, n), eta = 1.5;  // Snell about n
    const Vec3d refracted = (n * c - wo) * (1 / eta) - n * std::sqrt(1 - (1 - c * c) / (eta * eta));
    EXPECT_NEAR(std::fabs(dot(half_vector_of(wo, refracted, eta), n)), 1, 1e-12);
    EXPECT_EQ(half_vector_of(wo, -wo, 1).z, 1);  // opposite directions
}

TEST(FactorsOfASampler, DependOnItsTraitsAndLight) {
    Traits none, both;
    none.wo = Traits::WoDomain::none;
    both.wo = Traits::WoDomain::both;
    both.eta = Index(1.5);
    EXPECT_EQ(factors_for(none, {}).size(), 2u);  // of theta_i alone
    const std::vector<Factor> of_boundary = factors_for(both, {});
    const Vec3d wo = tilt(40), down = tilt(180 - 25.4, 180), up = mirror(wo);
    EXPECT_NEAR(value_of(of_boundary, "cos theta_i", wo, up), std::cos(40 * pi / 180), 1e-12);
    EXPECT_NEAR(value_of(of_boundary, "w_i.R", wo, up), 1, 1e-12);
    EXPECT_NEAR(value_of(of_boundary, "w_o.m", wo, up), wo.z, 1e-12);
    EXPECT_DOUBLE_EQ(value_of(of_boundary, "eta^2 across the surface", wo, down), 2.25);
    EXPECT_DOUBLE_EQ(value_of(of_boundary, "eta^2 across the surface", -wo, -down), 1 / 2.25);
    EXPECT_EQ(value_of(of_boundary, "eta^2 across the surface", wo, up), 1);
    const double f = value_of(of_boundary, "Fresnel of what is reflected", {0, 0, 1}, {0, 0, 1});
    EXPECT_NEAR(f, 0.04, 1e-12);  // ((1.5 - 1) / (1.5 + 1))^2
    const Vec3d n{0, 0, 1};
    EXPECT_NEAR(value_of(of_boundary, "the Jacobian of refraction", n, -n), 9, 1e-9);  // (1.5 / (1.5 - 1))^2
    EXPECT_NEAR(value_of(of_boundary, "1 - Fresnel of what is refracted", n, -n), 0.96, 1e-12);
    CaseLighting light;
    light.disks.push_back({1, {0, 0, 2}, {0, 0, -1}, 1});
    EXPECT_NEAR(value_of(factors_for(none, light), "distance^2 / cosine at the light", wo, {0, 0, 1}), 4, 1e-12);
}

TEST(NumberNames, AreTheUsualConstants) {
    Traits traits;
    traits.eta = Index(1.5);
    const std::map<double, std::string> known{{2, "2"}, {0.25, "1/4"}, {pi, "pi"}, {1 / pi, "1/pi"}, {2 / pi, "2/pi"},
        {4 * pi, "4 pi"}, {1 / (2 * pi), "1/(2 pi)"}, {2.25, "eta^2"}, {1 / 2.25, "1/eta^2"}, {1.9, ""}, {1, ""}};
    for (const auto& [value, name] : known) EXPECT_EQ(number_name(value * (1 + 5e-4), 1e-3, traits), name) << value;
    EXPECT_EQ(number_name(2.02, 1e-3, traits), "");
}

/// Ratios constant cos^b theta_i at 200 pairs, of which every `but`th is another number.
std::vector<KnownRatio> ratios(double constant, double b, int but = 0) {
    std::vector<KnownRatio> out;
    Stream stream({1});
    for (int i = 0; i < 200; ++i) {
        const Vec3d wo = random_direction(stream, false, 0.05), wi = random_direction(stream, false, 0.05);
        const double other = 3 + stream.number();
        out.push_back({wo, wi, but && i % but == 0 ? other : constant * std::pow(wi.z, b)});
    }
    return out;
}

TEST(KnownRatios, HaveAConstantOrOneFactor) {
    const std::vector<Factor> factors = factors_for({}, {});
    const auto constant = explain_ratios(ratios(0.5, 0), factors);
    ASSERT_TRUE(constant);
    EXPECT_EQ(constant->name, "constant");
    EXPECT_NEAR(constant->constant, 0.5, 1e-9);
    const auto cosine = explain_ratios(ratios(2, -1), factors);
    ASSERT_TRUE(cosine);
    EXPECT_EQ(cosine->name, "cos theta_i");
    EXPECT_EQ(cosine->exponent, -1);
    EXPECT_NEAR(cosine->constant, 2, 1e-6);
    EXPECT_TRUE(explain_ratios(ratios(2, -1, 20), factors));  // but for one in twenty
    EXPECT_FALSE(explain_ratios(ratios(2, -1, 4), factors));
    EXPECT_FALSE(explain_ratios(ratios(1, 0), factors));     // all are right
    EXPECT_FALSE(explain_ratios(ratios(2, -0.8), factors));  // no simple power
}

// The counts of the leaves: draws follow a cosine, p is uniform.
TEST(FactorsOfLeaves, HaveTheExponentOfTheDraws) {
    const Explained r = checked(made(cosine_draw, [](Vec3d, Vec3d w) { return w.z > 0 ? 1 / two_pi : 0; }), {{40, 30}});
    const std::vector<Place> places = r.places(1024);
    ASSERT_EQ(places.size(), 1u);
    const std::vector<FactorHypothesis> found = factor_hypotheses(places);
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found[0].name, "cos theta_i");
    EXPECT_EQ(found[0].exponent, 1);
    EXPECT_NEAR(found[0].fitted_exponent, 1, 5 * found[0].error);
    EXPECT_NEAR(found[0].hypothesis.constant(0), 2, 0.05);
    const Explained power = checked(made([](Vec3d, const PrimarySample& u) { return power_draw({0, 0, 1}, 24, u); },
        [](Vec3d, Vec3d w) { return power_pdf({0, 0, 1}, 20, w); }));
    const auto by_power = power_hypothesis(power.places(1024));
    ASSERT_TRUE(by_power);
    EXPECT_NEAR(by_power->exponent, 0.2, 5 * by_power->error);
    EXPECT_LT(by_power->error, 0.01);  // cos^24 = (cos^20)^1.2
}

}  // namespace factors_test
}  // namespace crescent::check
