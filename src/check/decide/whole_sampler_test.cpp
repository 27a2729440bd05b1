// Tests of a sampler that belong to no w_o: directions on axes, reciprocity, weights of techniques.
#include "check/decide/whole_sampler.h"

#include <gtest/gtest.h>

#include <limits>

#include "check/constants.h"
#include "tests/support/function_sampler.h"

namespace crescent::check {
namespace whole_sampler_test {

constexpr StreamKey key{3, 0, 0, 1, Purpose::light};
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(SpecialDirections, AreUnitAndBesideTheAxes) {
    const std::vector<Vec3d> all = special_directions();
    int axes = 0, beside = 0, longer = 0, shorter = 0;
    for (const Vec3d w : all) {
        EXPECT_NEAR(dot(w, w), 1, 5 * ulp);
        axes += std::fabs(w.z) == 1;
        beside += w.z > 0 && w.z < 1e-7;
        longer += dot(w, w) > 1 + ulp;
        shorter += dot(w, w) < 1 - ulp;
    }
    EXPECT_EQ(axes, 2);
    EXPECT_EQ(longer, 6);
    EXPECT_EQ(shorter, 6);
    EXPECT_EQ(beside, 8);  // one ulp above the horizon, from the axes and diagonals on it
}

TEST(SpecialPlaces, FindDivisionsByZero) {
    const Vec3d ordinary[] = {tilt(40, 30)};
    FunctionSampler s;
    s.f_value = lambert(0.5);
    EXPECT_FALSE(special_places(s, 0, ordinary));
    s.p = [](Vec3d o, Vec3d w) { return w.x == 0 && w.y == 0 ? nan : cosine_pdf(o, w); };
    const auto of_p = special_places(s, 0, ordinary);
    ASSERT_TRUE(of_p);
    EXPECT_EQ(of_p->first.draw.wi.x, 0);
    s.p = cosine_pdf;
    s.draw = [](Vec3d o, const PrimarySample& u) { return o.x == 0 ? Vec3d{0, 0, 2} : cosine_draw(o, u); };
    const auto of_draws = special_places(s, 0, ordinary);
    ASSERT_TRUE(of_draws);
    EXPECT_EQ(of_draws->wo->x, 0);
    s.of.wo = Traits::WoDomain::none;  // w_o has no meaning
    EXPECT_FALSE(special_places(s, 0, {}));
}

TEST(SpecialPlaces, AreAlsoTheDirectionsOfASmoothBoundary) {
    const Vec3d ordinary[] = {tilt(40, 30), tilt(10), tilt(20), tilt(70, 200)};
    FunctionSampler s;
    s.f_value = [last = ordinary[3]](Vec3d o, Vec3d w) {
        return dot(o, last) > 1 - 1e-12 && dot(w, Vec3d{-o.x, -o.y, o.z}) > 1 - 1e-12 ? nan : 0.1;
    };
    const auto fault = special_places(s, 0, ordinary);  // of the last w_o, at its mirror direction alone
    ASSERT_TRUE(fault);
    EXPECT_NEAR(fault->first.draw.wi.x, -ordinary[3].x, 1e-12);
    FunctionSampler unit;  // fails if rounding makes w_i longer than 1
    unit.f_value = [](Vec3d, Vec3d w) { return std::isnan(std::sqrt(1 - w.z * w.z)) ? nan : 0.1; };
    EXPECT_TRUE(special_places(unit, 0, ordinary));
}

TEST(Reciprocity, IsOfFAndScaledByTheIndex) {
    Traits traits;
    traits.eta = Index(Vec3d{1.5, 2, 3});
    const Pair down{{0, 0, 1}, {0, 0, -1}}, up{{0, 0, -1}, {0, 0, 1}}, above{{0, 0, 1}, {0, 0, 1}};
    EXPECT_DOUBLE_EQ(reciprocal_ratio(traits, down, 0), 2.25);
    EXPECT_DOUBLE_EQ(reciprocal_ratio(traits, down, 2), 9);
    EXPECT_DOUBLE_EQ(reciprocal_ratio(traits, up, 0), 1 / 2.25);
    EXPECT_EQ(reciprocal_ratio(traits, above, 0), 1);
    traits.importance = true;
    EXPECT_DOUBLE_EQ(reciprocal_ratio(traits, down, 0), 1 / 2.25);
    EXPECT_EQ(reciprocal_ratio({}, down, 0), 1);
}

TEST(Reciprocity, IsTestedWithAndWithoutAnIndex) {
    FunctionSampler s;
    s.f_value = [](Vec3d o, Vec3d w) { return 0.1 + 0.1 * o.z * w.z; };
    EXPECT_FALSE(reciprocity(s, key));
    s.f_value = [](Vec3d o, Vec3d) { return 0.1 + 0.1 * o.z; };
    const auto fault = reciprocity(s, key);
    ASSERT_TRUE(fault);
    EXPECT_GT(fault->times, 200);
    s.of.reciprocal = false;
    EXPECT_FALSE(reciprocity(s, key));
    FunctionSampler glass;
    glass.of.wo = Traits::WoDomain::both;
    glass.of.eta = Index(1.5);
    glass.f_value = [](Vec3d o, Vec3d w) { return o.z * w.z < 0 && o.z < 0 ? 0.1 * 2.25 : 0.1; };
    EXPECT_FALSE(reciprocity(glass, key));
    glass.f_value = [](Vec3d, Vec3d) { return 0.1; };
    EXPECT_TRUE(reciprocity(glass, key));
}

/// Two techniques whose weights are `first` and 1 - first, times a factor.
struct Combined : FunctionSampler {
    double factor = 1;
    int techniques() const override { return 2; }
    void mis_weight(int t, std::span<const Pair> at, std::span<double> out) const override {
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = factor * (t == 0 ? at[i].wi.z : 1 - at[i].wi.z);
    }
};

TEST(WeightsOfTechniques, SumToOne) {
    Combined s;
    EXPECT_FALSE(mis_weights(s, {0, 0, 1}, key));
    s.factor = 1.1;
    const auto fault = mis_weights(s, {0, 0, 1}, key);
    ASSERT_TRUE(fault);
    EXPECT_NEAR(fault->size, 0.1, 1e-9);
    EXPECT_EQ(fault->times, fault->trials);
    EXPECT_FALSE(mis_weights(FunctionSampler(), {0, 0, 1}, key));
}

/// The second technique has a density only for x > 0, and half of the weight everywhere.
struct WeightWithoutDensity : FunctionSampler {
    int techniques() const override { return 2; }
    void pdf(int t, std::span<const Pair> at, std::span<double> out) const override {
        FunctionSampler::pdf(0, at, out);
        for (std::size_t i = 0; t == 1 && i < at.size(); ++i) out[i] *= at[i].wi.x > 0 ? 2 : 0;
    }
    void mis_weight(int t, std::span<const Pair> at, std::span<double> out) const override {
        for (std::size_t i = 0; i < at.size(); ++i) out[i] = t == 0 || at[i].wi.x > 0 ? 0.5 : 0;
    }
};

TEST(WeightsOfTechniques, AreZeroWhereADensityIs) {
    const auto fault = mis_weights(WeightWithoutDensity(), {0, 0, 1}, key);
    ASSERT_TRUE(fault);
    EXPECT_NEAR(fault->size, -0.5, 1e-9);
    EXPECT_EQ(fault->first.expected, 2);  // the sampler
    EXPECT_NE(std::string(fault->what).find("where its density is 0"), std::string::npos);
}

}  // namespace whole_sampler_test
}  // namespace crescent::check
