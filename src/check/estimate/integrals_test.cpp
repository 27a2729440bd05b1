// Integrals of densities and of light against their closed forms, with their stated variances.
#include "check/estimate/integrals.h"

#include <gtest/gtest.h>

#include <functional>
#include <type_traits>

#include "tests/support/power_plan.h"

namespace crescent::check {
namespace integrals_test {

/// Half vectors by GGX in arithmetic of type F, for one roughness; p = D m.z / (4 w_o.m).
template <class F> struct HalfVector : SamplerSource {
    static constexpr F alpha2 = F(0.04);
    std::string name() const override { return "GGX"; }
    Traits traits() const override {
        Traits t;
        t.bits = std::is_same_v<F, float> ? 24 : 53;
        return t;
    }
    static F pdf_of(Vec3<F> o, Vec3<F> i) {
        const Vec3<F> m = normalize(o + i);
        const F c = dot(o, m), t = m.z * m.z * (alpha2 - 1) + 1;
        return c > 0 && m.z > 0 ? alpha2 * m.z / (F(pi) * t * t * 4 * c) : F(0);
    }
    void sample(int, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        const Vec3<F> o(F(wo.x), F(wo.y), F(wo.z));
        for (std::size_t k = 0; k < u.size(); ++k) {
            const F x = F(u[k].x), phi = F(two_pi * u[k].y), z = std::sqrt((1 - x) / (1 + (alpha2 - 1) * x));
            const F r = std::sqrt(std::max(1 - z * z, F(0)));
            const Vec3<F> m{r * std::cos(phi), r * std::sin(phi), z}, i = m * (2 * dot(o, m)) - o;
            out[k] = {{i.x, i.y, i.z}, dot(o, m) > 0 ? static_cast<double>(pdf_of(o, i)) : 0};
        }
    }
    void pdf(int, std::span<const Pair> at, std::span<double> out) const override {
        for (std::size_t k = 0; k < at.size(); ++k)
            out[k] =
                pdf_of({F(at[k].wo.x), F(at[k].wo.y), F(at[k].wo.z)}, {F(at[k].wi.x), F(at[k].wi.y), F(at[k].wi.z)});
    }
};

class CheckIntegralsOfPower : public PowerPlan {};

TEST_F(CheckIntegralsOfPower, IntegralsAreThoseOfTheClosedForm) {
    Integrals all;
    integrate(source, plan, 1u << 15, false, {1, 0, 0, 1, Purpose::points, 0}, all);
    integrate(source, plan, 1u << 16, false, {1, 0, 0, 1, Purpose::points, 1}, all);
    const Estimate& m = all.sums[mass];
    EXPECT_NEAR(m.value, 1, 5 * std::sqrt(m.variance));
    EXPECT_LT(std::sqrt(m.variance), 2e-4);
    EXPECT_NEAR(all.domain, 2 * pi, 0.05);
    double leaves = 0;
    for (const LeafIntegral& leaf : all.leaves) leaves += leaf.bridge.value;
    EXPECT_NEAR(leaves, all.sums[bridge].value, 1e-12);
}

TEST_F(CheckIntegralsOfPower, StatedVarianceOfAnIntegralIsItsVariance) {
    double square = 0, stated = 0;
    constexpr int times = 60;
    for (std::uint16_t k = 0; k < times; ++k) {
        Integrals one;
        integrate(source, plan, 1u << 14, false, {1, 0, 0, 1, Purpose::points, k}, one);
        square += sqr(one.sums[mass].value - 1) / times;
        stated += one.sums[mass].variance / times;
    }
    EXPECT_NEAR(square / stated, 1, 0.6);  // 3 standard errors of 60 squares
}

/// The integrals of p for w_o near the horizon, where half vectors at right angles to it are frequent.
template <class F> void with_rounding(const std::function<void(Vec3d wo, const Plan&, const Integrals&)>& look) {
    const HalfVector<F> sampler;
    const CaseLighting light;
    const Vec3d wo{std::sin(1.5), 0, std::cos(1.5)};
    Source source(sampler, 0, wo, light);
    const Plan plan = make_plan(source, CheckBudget::quick(), {});
    Integrals all;
    integrate(source, plan, 1u << 18, false, {1, 0, 0, 1, Purpose::points, 0}, all);
    look(wo, plan, all);
}

TEST(CheckIntegrals, KnowWhereSinglePrecisionDoesNotKnowP) {
    with_rounding<float>([](Vec3d wo, const Plan& plan, const Integrals& all) {
        double mass_there = 0;
        int unknown = 0;
        for (std::size_t l = 0; l < all.leaves.size(); ++l) {
            EXPECT_LE(all.leaves[l].rounding, 1);
            if (all.leaves[l].rounding < 0.1) continue;
            ++unknown;
            mass_there += all.leaves[l].bridge.value;
            const ChartRect& r = plan.tree.rect(plan.tree.leaves()[l]);
            const Vec3d off = from_chart(r.at(0.5, 0.5)) + wo;
            EXPECT_LT(std::sqrt(dot(off, off)), 0.002 + r.theta_width() + r.phi_width()) << "opposite to w_o";
        }
        EXPECT_GT(unknown, 0);
        EXPECT_LT(mass_there, 0.002);
    });
    with_rounding<double>([](Vec3d, const Plan&, const Integrals& all) {
        for (const LeafIntegral& leaf : all.leaves) EXPECT_EQ(leaf.rounding, 0);
    });
}

TEST(CheckEstimates, AddPairsWithTheirVariance) {
    Estimate e;
    e.add_pair(3, 1, 0.5);  // 0.5 (3 + 1), 0.25 (3 - 1)^2
    EXPECT_EQ(e.value, 2);
    EXPECT_EQ(e.variance, 1);
    EXPECT_NEAR(e.doubt, 2.0 / 3, 1e-15);
    e.scale(2);
    EXPECT_EQ(e.value, 4);
    EXPECT_EQ(e.variance, 4);
    EXPECT_NEAR(e.doubt, 16 * 2.0 / 3, 1e-12);
}

/// Integrals of light of a sampler at w_o = n, with a pass of points.
Integrals light_of(const FunctionSampler& s, const CaseLighting& light) {
    Source source(s, 0, {0, 0, 1}, light);
    const Plan plan = make_plan(source, CheckBudget::limited(1e5), {});
    Integrals out;
    integrate(source, plan, 1u << 14, true, {1, 0, 0, 1, Purpose::points, 0}, out);
    return out;
}

TEST(CheckLight, HasTheAlbedoAndTheLightOfAFill) {
    FunctionSampler s;
    s.f_value = lambert(0.6);
    CaseLighting light;
    light.fill = 3;
    const LightIntegrals l = light_of(s, light).light;
    EXPECT_NEAR(l.albedo[0].value, 0.6, 5 * std::sqrt(l.albedo[0].variance) + 1e-6);
    EXPECT_NEAR(l.lit.value, 1.8, 5 * std::sqrt(l.lit.variance) + 1e-6);
    EXPECT_NEAR(l.integral[0].value / l.lit.value, 1.0 / 3, 1e-2);
    EXPECT_EQ(l.lost.value, 0);
    for (const WeightedPoint& point : l.weighted_points) EXPECT_NEAR(point.x, 1.8, 1e-9);  // f L cos / p
}

TEST(CheckLight, IsLostWherePIsZero) {
    FunctionSampler s;
    s.f_value = lambert(1);
    s.p = [](Vec3d o, Vec3d w) { return w.x > 0 && w.y > 0 ? 0 : cosine_pdf(o, w); };
    const LightIntegrals l = light_of(s, {}).light;
    EXPECT_NEAR(l.lost.value, 0.25, 0.01);
    EXPECT_NEAR(l.separate_lost.value, 0.25, 0.02);
}

TEST(CheckLight, IsScaledAcrossTheSurface) {
    FunctionSampler glass;
    glass.of.wo = Traits::WoDomain::both;
    const CaseLighting light;
    const auto factor = [&](Vec3d wo, Vec3d wi) { return flux_factor(Source(glass, 0, wo, light), wi, 0); };
    EXPECT_EQ(factor({0, 0, 1}, {0, 0, 1}), 1);
    EXPECT_EQ(factor({0, 0, 1}, {0, 0, -1}), 0);  // the index is not known
    glass.of.eta = Index(1.5);
    EXPECT_DOUBLE_EQ(factor({0, 0, 1}, {0, 0, -1}), 2.25);
    EXPECT_DOUBLE_EQ(factor({0, 0, -1}, {0, 0, 1}), 1 / 2.25);
    glass.of.importance = true;
    EXPECT_EQ(factor({0, 0, 1}, {0, 0, -1}), 1);
}

TEST(CheckLight, BridgesKeepWeightsBelowTheUsualOne) {
    EXPECT_EQ(mean_bridge(5, 0.1, 2, false), 1);
    EXPECT_EQ(mean_bridge(5, 0, 2, true), 0);
    for (const double f_cos : {0.0, 0.1, 10.0, 1e9}) {
        const double h = mean_bridge(f_cos, 0.1, 2, true);
        EXPECT_LE(h * f_cos / 0.1, 2);
        EXPECT_DOUBLE_EQ(h, 2 * 0.1 / (2 * 0.1 + f_cos));
    }
}

}  // namespace integrals_test
}  // namespace crescent::check
