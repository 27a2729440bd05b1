// Tests at one w_o other than the identity: usable draws, corners of u, repeated calls, used bits, and the map of u.
#include "check/decide/small_tests.h"

#include <gtest/gtest.h>

#include <limits>

#include "check/constants.h"
#include "tests/support/function_sampler.h"

namespace crescent::check {
namespace small_tests_test {

const CaseLighting uniform_light;
constexpr StreamKey key{3, 0, 0, 1, Purpose::corners};
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Returns the result of a test of a sampler at w_o = n.
template <class Test> auto tested(const FunctionSampler& s, const Test& test) {
    Source source(s, 0, {0, 0, 1}, uniform_light);
    return test(source);
}
std::optional<SmallFault> corners(Source& s) { return corners_of_u(s); }
std::optional<SmallFault> again(Source& s) { return same_u_again(s, key); }
std::optional<SmallFault> answers(Source& s) { return same_answers_again(s, key); }
std::optional<SmallFault> bits(Source& s) { return few_bits(s, key); }
std::optional<SmallFault> map(Source& s) { return jacobian(s, key); }

TEST(UsableDraws, HaveNumbersThatMeanSomething) {
    const auto is_usable = [](double pdf, Vec3d wi, double delta = 0, std::optional<double> weight = {}) {
        Draw d{wi, pdf};
        d.delta = delta, d.weight = weight;
        return !fault_of(d);
    };
    constexpr Vec3d n{0, 0, 1};
    EXPECT_TRUE(is_usable(1, n));
    EXPECT_TRUE(is_usable(0, {0, 0, 7}));  // no sample
    EXPECT_TRUE(is_usable(0, n, 0.5, 2));
    EXPECT_TRUE(is_usable(1, {0, 0, 1 + 5e-6}));
    EXPECT_TRUE(is_usable(1, n, 0, -1e-7));
    EXPECT_FALSE(is_usable(nan, n));
    EXPECT_FALSE(is_usable(-1, n));
    EXPECT_FALSE(is_usable(std::numeric_limits<double>::infinity(), n));
    EXPECT_FALSE(is_usable(1, {0, nan, 1}));
    EXPECT_FALSE(is_usable(1, {0, 0, 1.001}));
    EXPECT_FALSE(is_usable(0, n, 1.5, 1));
    EXPECT_FALSE(is_usable(0, n, 0.5));  // a delta part without its weight
    EXPECT_FALSE(is_usable(1, n, 0, -1));
    EXPECT_FALSE(is_usable(1, n, 0, nan));
}

TEST(CornersOfU, AreTestedForEveryPairOfNumbers) {
    FunctionSampler s;
    EXPECT_FALSE(tested(s, corners));
    s.of.numbers = 3;
    s.change = [](const PrimarySample& u, Draw& d) {
        if (u[1] == 0 && u[2] == 0) d.wi.x = nan;
    };
    const auto fault = tested(s, corners);
    ASSERT_TRUE(fault);
    EXPECT_EQ(fault->times, 3);  // with the first number elsewhere, at 0 and next to 1
    EXPECT_EQ(fault->of, 3 * 36 + 8);
    EXPECT_EQ(fault->family, Family::corners);
}

/// Exchanges the first and the last answer of a block of seven.
struct MixedRows : FunctionSampler {
    void pdf(int t, std::span<const Pair> at, std::span<double> out) const override {
        FunctionSampler::pdf(t, at, out);
        if (at.size() == 7) std::swap(out.front(), out.back());
    }
};

TEST(RepeatedCalls, GiveTheSameDrawsAndAnswers) {
    FunctionSampler right;
    right.f_value = lambert(0.5);
    EXPECT_FALSE(tested(right, again));
    EXPECT_FALSE(tested(right, answers));
    FunctionSampler state = right;
    int calls = 0;
    state.change = [&calls](const PrimarySample&, Draw& d) {
        if (++calls % 50 == 0) d.wi.x = -d.wi.x;
    };
    const auto fault = tested(state, again);
    ASSERT_TRUE(fault);
    EXPECT_EQ(fault->family, Family::state);
    state.of.own_random = true;
    EXPECT_FALSE(tested(state, again));
    EXPECT_TRUE(tested(MixedRows(), answers));
}

/// Rounds p next to w_i = -w_o by the size of the block, as vector units do that add in another order.
struct RoundedByBlock : FunctionSampler {
    double factor = 1;  // 1: by rounding alone
    void pdf(int, std::span<const Pair> pairs, std::span<double> out) const override {
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const auto rounded = [](double x) { return static_cast<double>(static_cast<float>(x)); };
            const Pair& p = pairs[i];
            const double by = pairs.size() % 2 == 0 ? 0 : 2 * ulp;
            const Vec3d m{rounded(p.wo.x + p.wi.x) + by, rounded(p.wo.y + p.wi.y) - by, rounded(p.wo.z + p.wi.z) + by};
            const double c = m.z * m.z / (dot(m, m) + 1e-30);
            out[i] = (1 + c) / two_pi * (by > 0 ? factor : 1);
        }
    }
};

TEST(RepeatedCalls, MayDifferByRounding) {
    RoundedByBlock s;
    // Draws within 1e-6 of -w_o, where the half vector has few bits.
    s.draw = [](Vec3d, const PrimarySample& u) {
        const Vec3d w{1e-6 * (u.x - 0.5), 1e-6 * (u.y - 0.5), -1};
        return w * (1 / length(w));
    };
    EXPECT_FALSE(tested(s, answers));
    s.factor = 1.01;
    EXPECT_TRUE(tested(s, answers));
}

TEST(RepeatedCalls, OfNumbersThatAreNotFiniteAreEqual) {
    FunctionSampler s;
    s.change = [](const PrimarySample& u, Draw& d) {
        if (u.x < 0.2) d.pdf = std::numeric_limits<double>::infinity();
        if (u.y < 0.2) d.wi.x = std::numeric_limits<double>::infinity();
    };
    EXPECT_FALSE(tested(s, again));  // that they are not finite is another fault
}

TEST(DrawsOnACurve, AreFound) {
    const auto curve = [](const FunctionSampler& s) {
        return tested(s, [](Source& source) { return draws_on_curve(source, key); });
    };
    EXPECT_FALSE(curve(FunctionSampler()));
    EXPECT_FALSE(curve(power_sampler(2000)));
    FunctionSampler twice;
    twice.draw = [](Vec3d o, const PrimarySample& u) { return cosine_draw(o, PrimarySample(u.x, u.x)); };
    const auto fault = curve(twice);
    ASSERT_TRUE(fault);
    EXPECT_EQ(fault->family, Family::repeats);
    FunctionSampler sum;
    sum.draw = [](Vec3d o, const PrimarySample& u) {
        const double x = (u.x + u.y) / 2;
        return cosine_draw(o, PrimarySample(x, x * x));
    };
    EXPECT_TRUE(curve(sum));
    FunctionSampler lobes;  // the third number chooses
    lobes.of.numbers = 3;
    lobes.draw = [](Vec3d o, const PrimarySample& u) { return u[2] < 0.5 ? cosine_draw(o, u) : power_draw(o, 30, u); };
    EXPECT_FALSE(curve(lobes));
    FunctionSampler narrow = power_sampler(5e5);  // in single precision a number moves nothing by a small step
    narrow.change = [](const PrimarySample&, Draw& d) {
        d.wi = {static_cast<double>(static_cast<float>(d.wi.x)), static_cast<double>(static_cast<float>(d.wi.y)),
            static_cast<double>(static_cast<float>(d.wi.z))};
    };
    EXPECT_FALSE(curve(narrow));
    FunctionSampler one;  // one number is cut into two
    one.of.numbers = 2;
    one.draw = [](Vec3d o, const PrimarySample& u) {
        return cosine_draw(o, PrimarySample(u.x, std::fmod(4096 * u.y, 1.0)));
    };
    EXPECT_FALSE(curve(one));
}

TEST(BitsOfNumbers, OfWhichFewAreUsedAreFound) {
    EXPECT_FALSE(tested(FunctionSampler(), bits));
    FunctionSampler coarse;
    coarse.draw = [](Vec3d o, const PrimarySample& u) {
        return cosine_draw(o, PrimarySample(u.x, (std::floor(4096 * u.y) + 0.5) / 4096));
    };
    const auto fault = tested(coarse, bits);
    ASSERT_TRUE(fault);
    EXPECT_EQ(fault->size, 1);  // the second number
}

TEST(NumbersWithoutEffect, AreListed) {
    const auto unused = [](const FunctionSampler& s) {
        return tested(s, [](Source& source) { return numbers_without_effect(source, key); });
    };
    FunctionSampler s;
    EXPECT_TRUE(unused(s).empty());
    s.of.numbers = 3;
    EXPECT_EQ(unused(s), std::vector<int>{2});
    s.draw = [](Vec3d o, const PrimarySample& u) { return cosine_draw(o, PrimarySample(0.5, u[2])); };
    EXPECT_EQ(unused(s), (std::vector<int>{0, 1}));
}

TEST(MapOfU, HasTheDensityOfTheDraws) {
    const auto densities = [](const FunctionSampler& s) {
        return tested(s, [](Source& source) { return map_densities(source, key); });
    };
    for (const FunctionSampler& s : {FunctionSampler(), power_sampler(30)}) {
        EXPECT_GT(densities(s).size(), 20u);
        for (const MapDensity& m : densities(s)) EXPECT_NEAR(m.drawn / m.p, 1, 4 * m.error + 1e-4);
        EXPECT_FALSE(tested(s, map));
    }
    FunctionSampler two;  // the third number chooses between two lobes
    two.of.numbers = 3;
    const Vec3d a = tilt(20), b = tilt(60, 120);
    two.draw = [a, b](Vec3d, const PrimarySample& u) { return power_draw(u[2] < 0.3 ? a : b, 40, u); };
    two.p = [a, b](Vec3d, Vec3d w) { return 0.3 * power_pdf(a, 40, w) + 0.7 * power_pdf(b, 40, w); };
    EXPECT_FALSE(densities(two).empty());
    for (const MapDensity& m : densities(two)) EXPECT_LE(m.drawn, m.p * (1 + 1e-3));
    EXPECT_FALSE(tested(two, map));
}

TEST(MapOfU, ADensityBelowThatOfTheMapIsFound) {
    FunctionSampler low, high;
    low.p = [](Vec3d o, Vec3d w) { return 0.9 * cosine_pdf(o, w); };
    high.p = [](Vec3d o, Vec3d w) { return 1.1 * cosine_pdf(o, w); };
    const auto fault = tested(low, map);
    ASSERT_TRUE(fault);
    EXPECT_NEAR(fault->size, -0.1, 2e-3);
    EXPECT_EQ(fault->times, fault->of);
    EXPECT_FALSE(tested(high, map));  // other u may map to the same direction
}

}  // namespace small_tests_test
}  // namespace crescent::check
