// Streams, Sobol nets, the chart, the tree and the integrals, compared with closed forms.
#include <gtest/gtest.h>
#include <functional>
#include <set>
#include <type_traits>

#include "check/estimate/observations.h"

namespace crescent::check {
namespace {

constexpr double pi_value = 3.14159265358979323846;

/// p = (1 + s) / (2 pi) cos^s about n, drawn exactly.
struct CosinePower : SamplerAdapter {
    double s = 1;
    explicit CosinePower(double exponent) : s(exponent) {}
    std::string name() const override { return "cosine power"; }
    void sample(int, Vec3d, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        for (std::size_t i = 0; i < u.size(); ++i) {
            const double z = std::pow(u[i].x, 1 / (s + 1)), r = std::sqrt(1 - z * z);
            out[i] = {{r * std::cos(two_pi * u[i].y), r * std::sin(two_pi * u[i].y), z}, value(z)};
        }
    }
    void pdf(int, std::span<const Pair> at, std::span<double> out) const override {
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = value(at[i].wi.z);
    }
    double value(double z) const { return z > 0 ? (s + 1) / (2 * pi_value) * std::pow(z, s) : 0; }
};

/// Half vectors by GGX in arithmetic of type F, for one roughness; p = D m.z / (4 w_o.m).
template <class F> struct HalfVector : SamplerAdapter {
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
        return c > 0 && m.z > 0 ? alpha2 * m.z / (F(pi_value) * t * t * 4 * c) : F(0);
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

TEST(CheckStreams, KeysThatDifferInAnyFieldShareNoBlock) {
    const StreamKey base{7, 3, 0, 1, Purpose::draws, 2};
    std::vector<StreamKey> keys(7, base);
    keys[1].seed = 8, keys[2].place = 4, keys[3].technique = 1, keys[4].stage = 2, keys[5].purpose = Purpose::points;
    keys[6].part = 3;
    std::set<std::array<std::uint32_t, 4>> blocks;
    for (const StreamKey& key : keys)
        for (std::uint32_t i = 0; i < 4096; ++i) {
            const auto b = key.block(i);
            blocks.insert({b.x, b.y, b.z, b.w});
        }
    EXPECT_EQ(blocks.size(), keys.size() * 4096);
}

TEST(CheckStreams, NumbersDoNotRoundToOneInFloat) {
    EXPECT_LT(static_cast<float>(unit_number(0xffffffffu)), 1.0f);
    EXPECT_GT(unit_number(0), 0);
    EXPECT_EQ(single_number(unit_number(0)), 0x1p-24);
}

/// Largest number of points in a cell over all elementary intervals of one shape, for a net of 2^m points.
int most_in_a_cell(int d0, int d1, int bits0, int bits1, int m, std::uint32_t seed0, std::uint32_t seed1) {
    std::vector<int> count(std::size_t{1} << (bits0 + bits1));
    int most = 0;
    for (std::uint32_t i = 0; i < 1u << m; ++i) {
        const std::uint32_t x = owen_scrambled(sobol(i, d0), seed0), y = owen_scrambled(sobol(i, d1), seed1);
        const std::size_t cell = (bits0 ? x >> (32 - bits0) : 0u) << bits1 | (bits1 ? y >> (32 - bits1) : 0u);
        most = std::max(most, ++count[cell]);
    }
    return most;
}

TEST(CheckSobol, FirstTwoDimensionsAreANetWithOnePointInEachElementaryInterval) {
    constexpr int m = 10;
    for (int a = 0; a <= m; ++a) {
        EXPECT_EQ(most_in_a_cell(0, 1, a, m - a, m, 0, 0), 1) << a;
        EXPECT_EQ(most_in_a_cell(0, 1, a, m - a, m, 0x12345678u, 0x9abcdef1u), 1) << a;
    }
}

TEST(CheckSobol, EveryDimensionHasOnePointInEachOfItsIntervals) {
    for (int d = 0; d < PrimarySample::most; ++d) EXPECT_EQ(most_in_a_cell(d, 0, 10, 0, 10, 77u, 0), 1) << d;
}

TEST(CheckSobol, PairsOfDimensionsHaveNoMoreThanEightPointsInACell) {  // t <= 3 of Joe and Kuo's first eight
    for (int a = 0; a < PrimarySample::most; ++a)
        for (int b = 0; b < a; ++b) EXPECT_LE(most_in_a_cell(a, b, 5, 5, 10, 1u, 2u), 8) << a << " " << b;
}

TEST(CheckChart, RoundTripIsExactToRounding) {
    for (double t : {1e-18, 1e-9, 0.3, 1.0, 1.7, 2 - 1e-9})
        for (double phi : {0.0, 1e-9, 2.0, 6.28}) {
            const ChartPoint back = to_chart(from_chart({t, phi}));
            EXPECT_NEAR(back.t, t, 4e-16 + 1e-15 * t);
            EXPECT_NEAR(back.phi, phi, 1e-12);
        }
}

TEST(CheckChart, AreaIsSolidAngle) {
    const ChartRect cap{0, 1 - std::cos(0.3), 0, two_pi};
    EXPECT_NEAR(cap.area(), two_pi * (1 - std::cos(0.3)), 1e-15);
    EXPECT_NEAR(cap.theta_width(), 0.3, 1e-14);
}

class CheckTree : public testing::Test {
protected:
    CosinePower sampler{40};
    CaseLighting light;
    Source source{sampler, 0, {0, 0, 1}, light};
    CheckBudget budget = CheckBudget::limited();
    Plan plan = make_plan(source, budget, {});
};

TEST_F(CheckTree, LeavesPartitionTheSphere) {
    double area = 0;
    for (const Leaf& leaf : plan.tree.leaves()) area += plan.tree.rect(leaf).area();
    EXPECT_NEAR(area, 4 * pi_value, 1e-11);
    EXPECT_GE(plan.tree.leaves().size(), static_cast<std::size_t>(budget.leaves()));
    EXPECT_LE(plan.tree.leaves().size(), static_cast<std::size_t>(budget.most_leaves()));
    Stream stream({1, 0, 0, 1, Purpose::pairs});
    for (int i = 0; i < 10000; ++i) {
        const ChartPoint at{2 * stream.number(), two_pi * stream.number()};
        const ChartRect& r = plan.tree.rect(plan.tree.leaves()[plan.tree.find(at)]);
        EXPECT_TRUE(r.t0 <= at.t && at.t <= r.t1 && r.phi0 <= at.phi && at.phi <= r.phi1);
    }
}

TEST_F(CheckTree, LeafDensitiesAreCloseToPWhereItsMassIs) {
    double off = 0;
    for (const Leaf& leaf : plan.tree.leaves()) {
        const ChartRect& r = plan.tree.rect(leaf);
        const auto below = [&](double t) { return t < 1 ? std::pow(1 - t, 41.0) : 0; };
        const double mass_here = (below(r.t0) - below(r.t1)) * (r.phi1 - r.phi0) / two_pi;
        if (leaf.met) off += std::fabs(leaf.q * r.area() - mass_here);
    }
    EXPECT_LT(off, 0.03);
}

TEST_F(CheckTree, NoLeafIsNarrowerThanFourSteps) {
    constexpr double step = 1e-3;
    const Tree coarse(source, {}, 1024, {}, step, budget, {1, 0, 0, 1, Purpose::tree});
    for (const Leaf& leaf : coarse.leaves()) {
        const ChartRect& r = coarse.rect(leaf);
        EXPECT_GT(std::max(r.theta_width(), r.phi_width()), 2 * step);
    }
}

TEST_F(CheckTree, IntegralsAreThoseOfTheClosedForm) {
    Integrals all;
    integrate(source, plan, 1u << 15, false, {1, 0, 0, 1, Purpose::points, 0}, all);
    integrate(source, plan, 1u << 16, false, {1, 0, 0, 1, Purpose::points, 1}, all);
    const Estimate& m = all.sums[mass];
    EXPECT_NEAR(m.value, 1, 5 * std::sqrt(m.variance));
    EXPECT_LT(std::sqrt(m.variance), 2e-4);
    EXPECT_NEAR(all.domain, 2 * pi_value, 0.05);
    double leaves = 0;
    for (const LeafIntegral& leaf : all.leaves) leaves += leaf.bridge.value;
    EXPECT_NEAR(leaves, all.sums[bridge].value, 1e-12);
}

TEST_F(CheckTree, StatedVarianceOfAnIntegralIsItsVariance) {
    double square = 0, stated = 0;
    constexpr int times = 60;
    for (std::uint16_t k = 0; k < times; ++k) {
        Integrals one;
        integrate(source, plan, 1u << 14, false, {1, 0, 0, 1, Purpose::points, k}, one);
        square += sqr(one.sums[mass].value - 1) / times, stated += one.sums[mass].variance / times;
    }
    EXPECT_NEAR(square / stated, 1, 0.6);  // 3 standard errors of 60 squares
}

TEST_F(CheckTree, BothSidesAgreeForEveryTestFunction) {
    Integrals claimed;
    Observations drawn;
    integrate(source, plan, 1u << 15, false, {1, 0, 0, 1, Purpose::points, 0}, claimed);
    observe(source, plan, {1u << 15, 1u << 15, 1u << 15}, 0, {1}, claimed, drawn);
    for (std::size_t q = 0; q < integrands; ++q) {
        const double n = drawn.independent, mean = drawn.sums[q].sum / n;
        const double v = (drawn.sums[q].square / n - mean * mean) / n + claimed.sums[q].variance;
        EXPECT_NEAR(mean, claimed.sums[q].value, 5 * std::sqrt(v) + 1e-12) << q;
    }
    EXPECT_EQ(drawn.checks.directions, 1u << 15);
    EXPECT_EQ(drawn.checks.pointwise.times + drawn.checks.zero.times + drawn.checks.invalid.times, 0u);
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
            ++unknown, mass_there += all.leaves[l].bridge.value;
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

TEST(CheckPlan, FindsTheStepOfALattice) {
    Stream stream({1, 0, 0, 1, Purpose::pairs});
    std::vector<double> exact, few, many;
    for (int i = 0; i < 1 << 14; ++i) {
        const double x = stream.number();
        exact.push_back(x), few.push_back(std::floor(x * 0x1p24) * 0x1p-24), many.push_back(std::floor(x * 256) / 256);
    }
    EXPECT_EQ(step_of(exact), 0);
    EXPECT_NEAR(step_of(few) * 0x1p24, 1, 0.5);
    EXPECT_NEAR(step_of(many) * 256, 1, 1e-9);
}

}  // namespace
}  // namespace crescent::check
