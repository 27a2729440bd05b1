// Steps of arithmetic and the constants of the test functions.
#include "check/estimate/plan.h"

#include <gtest/gtest.h>

#include "check/constants.h"
#include "tests/support/power_plan.h"

namespace crescent::check {

// ---- The tree of a power of the cosine: a partition of the sphere whose leaves have the mass of p.
namespace plan_test {

class CheckTree : public PowerPlan {};

TEST_F(CheckTree, LeavesPartitionTheSphere) {
    double area = 0;
    for (const Leaf& leaf : plan.tree.leaves()) area += plan.tree.rect(leaf).area();
    EXPECT_NEAR(area, 4 * pi, 1e-11);
    EXPECT_GE(plan.tree.leaves().size(), static_cast<std::size_t>(budget.leaves()));
    EXPECT_LE(plan.tree.leaves().size(), static_cast<std::size_t>(budget.most_leaves()));
    Stream stream({1, 0, 0, 1, Purpose::pairs});
    for (int i = 0; i < 10000; ++i) {
        const ChartPoint at{2 * stream.number(), two_pi * stream.number()};
        const ChartRect& r = plan.tree.rect(plan.tree.leaves()[plan.tree.find(at)]);
        EXPECT_TRUE(r.t0 <= at.t && at.t <= r.t1 && r.phi0 <= at.phi && at.phi <= r.phi1);
    }
}

// A narrow lobe off the pole has most of its leaves in one cell of the grid at which a search starts.
TEST(CheckTreeSearch, EndsInTheLeafThatContainsThePoint) {
    const Vec3d axis = normalize(Vec3d{0.3, -0.5, 0.7});
    FunctionSampler lobe;
    lobe.draw = [&](Vec3d, const PrimarySample& u) {
        const Vec3d w = from_chart({2e-6 * -std::log1p(-u[0]), two_pi * u[1]});
        return frame_about(axis).to_world(w);
    };
    lobe.p = [&](Vec3d, Vec3d w) {
        const Vec3d off = w - axis;
        return std::exp(-dot(off, off) / 2 / 2e-6) / (two_pi * 2e-6);
    };
    const CaseLighting light;
    Source source(lobe, 0, {0, 0, 1}, light);
    const Plan plan = make_plan(source, CheckBudget::limited(1e5), {});
    Stream stream({1, 0, 0, 1, Purpose::pairs});
    std::vector<ChartPoint> places;
    for (const Leaf& leaf : plan.tree.leaves()) {
        const ChartRect& r = plan.tree.rect(leaf);
        for (double x : {0.0, 0.5, stream.number(), 1 - 1e-9}) places.push_back(r.at(x, stream.number()));
    }
    std::vector<std::uint32_t> found(places.size());
    plan.tree.find(places, found);
    for (std::size_t i = 0; i < places.size(); ++i) {
        EXPECT_EQ(found[i], i / 4);
        EXPECT_EQ(plan.tree.find(places[i]), i / 4);
    }
}

TEST_F(CheckTree, LeafDensitiesAreCloseToPWhereItsMassIs) {
    double off = 0;
    for (const Leaf& leaf : plan.tree.leaves()) {
        const ChartRect& r = plan.tree.rect(leaf);
        const auto below = [&](double t) { return t < 1 ? std::pow(1 - t, 41.0) : 0; };
        const double mass_here = (below(r.t0) - below(r.t1)) * (r.phi1 - r.phi0) / two_pi;
        if (leaf.has_mass) off += std::fabs(leaf.q * r.area() - mass_here);
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

// A sampler whose draws are all in a cone has no density elsewhere, and its leaves at the rim are edges.
TEST(CheckTreeEdges, AreLeavesBesideAnEmptyOne) {
    FunctionSampler cone;
    cone.draw = [](Vec3d, const PrimarySample& u) { return from_chart({0.25 * u[0], two_pi * u[1]}); };
    cone.p = [](Vec3d, Vec3d w) { return w.z > 0.75 ? 1 / (0.25 * two_pi) : 0; };
    const CaseLighting light;
    Source source(cone, 0, {0, 0, 1}, light);
    const Plan plan = make_plan(source, CheckBudget::limited(1e5), {});
    int edges = 0;
    for (const Leaf& leaf : plan.tree.leaves()) {
        const ChartRect& r = plan.tree.rect(leaf);
        edges += leaf.edge;
        if (leaf.edge) EXPECT_NEAR(r.t1, 0.25, 0.05);
        EXPECT_EQ(leaf.has_mass, r.t0 < 0.25) << r.t0;
        if (r.t1 <= 0.25) EXPECT_NEAR(leaf.q, 1 / (0.25 * two_pi), 1e-9);
    }
    EXPECT_GT(edges, 8);
}

}  // namespace plan_test
namespace plan_test {

TEST(CheckPlan, FindsTheStepOfALattice) {
    Stream stream({1, 0, 0, 1, Purpose::pairs});
    std::vector<double> exact, few, many;
    for (int i = 0; i < 1 << 14; ++i) {
        const double x = stream.number();
        exact.push_back(x);
        few.push_back(std::floor(x * 0x1p24) * 0x1p-24);
        many.push_back(std::floor(x * 256) / 256);
    }
    EXPECT_EQ(step_of(exact), 0);
    EXPECT_NEAR(step_of(few) * 0x1p24, 1, 0.5);
    EXPECT_NEAR(step_of(many) * 256, 1, 1e-9);
}

TEST(CheckPlan, StepOfDirectionsIsAnAngle) {
    std::vector<Vec3d> single, exact;
    for (std::uint32_t i = 0; i < 1u << 14; ++i) {
        const Vec3d w = cosine_draw({}, numbers_at({1}, i, 2, Resolution::standard));
        const auto rounded = [](double v) { return static_cast<double>(static_cast<float>(v)); };
        exact.push_back(w);
        single.push_back({rounded(w.x), rounded(w.y), rounded(w.z)});
    }
    EXPECT_EQ(step_of_directions(exact), 0);
    EXPECT_GT(step_of_directions(single), angle_per_step * ulp / 4);
    EXPECT_LT(step_of_directions(single), angle_per_step * ulp * 4);
}

TEST(CheckPlan, DescribesThePilotDraws) {
    FunctionSampler s;
    s.draw = [](Vec3d o, const PrimarySample& u) { return u.y < 0.5 ? Vec3d{} : cosine_draw(o, u); };
    s.weights = [](Vec3d, Vec3d) { return Vec3d{0.8, 0, 0}; };
    const CaseLighting light;
    Source source(s, 0, {0, 0, 1}, light);
    const CheckBudget budget = CheckBudget::limited(2e5);
    const Plan plan = make_plan(source, budget, {});
    EXPECT_EQ(plan.draw_count, budget.pilot());
    EXPECT_NEAR(plan.direction_count, plan.draw_count / 2.0, 4 * std::sqrt(plan.draw_count / 4.0));
    EXPECT_NEAR(plan.mean_weight[0], 0.4, 0.05);
    EXPECT_NEAR(plan.middle.z, 2.0 / 3, 0.03);        // E[cos theta]
    EXPECT_NEAR(plan.middle.y, -4.0 / 3 / pi, 0.03);  // azimuths from pi to 2 pi: -(2 / pi) E[sin theta]
    EXPECT_NEAR(plan.median_log_p, std::log(std::sqrt(0.5) / pi), 0.05);
}

TEST(CheckPlan, LogarithmOfADensityIsThatOfTheLibrary) {
    for (double p = 1e-300; p < 1e300; p *= 1.37) EXPECT_NEAR(Plan::log_of(p), std::log(p), 1e-9) << p;
    EXPECT_NEAR(Plan::log_of(1), 0, 1e-15);
}

TEST(CheckPlan, TestFunctionsAreBridgedWithTheLeaf) {
    const FunctionSampler cosine;
    const CaseLighting light;
    Source source(cosine, 0, {0, 0, 1}, light);
    Plan plan = make_plan(source, CheckBudget::limited(1e4), {});
    plan.median_log_p = -1;
    plan.middle = {0.1, 0.2, 0.3};
    Leaf leaf;
    leaf.q = 0.3;
    const Values at = plan.values(leaf, {0.5, 0.5, 0.7}, 0.1);
    EXPECT_DOUBLE_EQ(at[bridge], 0.75);
    EXPECT_NEAR(at[slope], 0.75 * (Plan::log_of(0.1) + 1), 1e-12);
    EXPECT_NEAR(at[centre_x], 0.75 * 0.4, 1e-12);
    EXPECT_NEAR(at[centre_z], 0.75 * 0.4, 1e-12);
    EXPECT_EQ(plan.values(leaf, {0, 0, 1}, 0)[slope], 0);
    leaf.resolvable_p = 0.5;
    EXPECT_TRUE(plan.resolves(leaf, 0.5));
    EXPECT_FALSE(plan.resolves(leaf, 0.6));
    EXPECT_DOUBLE_EQ(plan.values(leaf, {0, 0, 1}, 0.6)[bridge], 1.0 / 3);
    plan.estimates = true;  // h does not depend on a random p
    EXPECT_DOUBLE_EQ(plan.values(leaf, {0, 0, 1}, 0.9)[bridge], 0.5);
}

}  // namespace plan_test
}  // namespace crescent::check
