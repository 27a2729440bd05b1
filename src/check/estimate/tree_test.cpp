// The tree of a power of the cosine: a partition of the sphere whose leaves have the mass of p.
#include "check/estimate/tree.h"

#include <gtest/gtest.h>

#include "check/estimate/plan.h"
#include "tests/support/function_sampler.h"

namespace crescent::check {
namespace {

class CheckTree : public testing::Test {
protected:
    FunctionSampler sampler = power_sampler(40);
    CaseLighting light;
    Source source{sampler, 0, {0, 0, 1}, light};
    CheckBudget budget = CheckBudget::limited();
    Plan plan = make_plan(source, budget, {});
};

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
        EXPECT_EQ(leaf.met, r.t0 < 0.25) << r.t0;
        if (r.t1 <= 0.25) EXPECT_NEAR(leaf.q, 1 / (0.25 * two_pi), 1e-9);
    }
    EXPECT_GT(edges, 8);
}

}  // namespace
}  // namespace crescent::check
