// Tests at one w_o other than the identity: usable draws, corners of u, repeated calls, used bits, and the map of u.
#include "check/decide/small_tests.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "check/constants.h"
#include "check/decide/curve.h"
#include "check/decide/jacobian.h"
#include "check/decide/resolution.h"
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
        d.delta = delta;
        d.weight = weight;
        return !fault_of(d, {});
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
    EXPECT_FALSE(is_usable(0, n, 0, nan));  // no sample, and yet a weight that spoils a mean
    EXPECT_TRUE(is_usable(0, n, 0, 3));
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
    EXPECT_EQ(fault->trials, 3 * 36 + 8);
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
        for (const MapDensity& m : densities(s)) EXPECT_NEAR(m.density / m.p, 1, 4 * m.error + 1e-4);
        EXPECT_FALSE(tested(s, map));
    }
    FunctionSampler two;  // the third number chooses between two lobes
    two.of.numbers = 3;
    const Vec3d a = tilt(20), b = tilt(60, 120);
    two.draw = [a, b](Vec3d, const PrimarySample& u) { return power_draw(u[2] < 0.3 ? a : b, 40, u); };
    two.p = [a, b](Vec3d, Vec3d w) { return 0.3 * power_pdf(a, 40, w) + 0.7 * power_pdf(b, 40, w); };
    EXPECT_FALSE(densities(two).empty());
    for (const MapDensity& m : densities(two)) EXPECT_LE(m.density, m.p * (1 + 1e-3));
    EXPECT_FALSE(tested(two, map));
}

TEST(MapOfU, ADensityBelowThatOfTheMapIsFound) {
    FunctionSampler low, high;
    low.p = [](Vec3d o, Vec3d w) { return 0.9 * cosine_pdf(o, w); };
    high.p = [](Vec3d o, Vec3d w) { return 1.1 * cosine_pdf(o, w); };
    const auto fault = tested(low, map);
    ASSERT_TRUE(fault);
    EXPECT_NEAR(fault->size, -0.1, 2e-3);
    EXPECT_EQ(fault->times, fault->trials);
    EXPECT_FALSE(tested(high, map));  // other u may map to the same direction
}

/// An alias table over lights of these powers, each an equal band of z; the third number chooses an entry and then the
/// entry itself or its alias.
FunctionSampler alias_lights(std::vector<double> powers) {
    const std::size_t n = powers.size();
    double sum = 0;
    for (double v : powers) sum += v;
    std::vector<double> rest, share(n, 1);
    std::vector<std::size_t> alias(n), small, large;
    for (std::size_t i = 0; i < n; ++i) {
        rest.push_back(powers[i] / sum * static_cast<double>(n));
        alias[i] = i;
        (rest[i] < 1 ? small : large).push_back(i);
    }
    while (!small.empty() && !large.empty()) {
        const std::size_t low = small.back(), high = large.back();
        small.pop_back();
        share[low] = rest[low];
        alias[low] = high;
        rest[high] -= 1 - rest[low];
        if (rest[high] < 1) {
            large.pop_back();
            small.push_back(high);
        }
    }
    FunctionSampler s;
    s.of.numbers = 3;
    s.of.wo = Traits::WoDomain::none;
    s.draw = [=](Vec3d, const PrimarySample& u) {
        const double at = u[2] * static_cast<double>(n);
        const auto entry = std::min(static_cast<std::size_t>(at), n - 1);
        const std::size_t lamp = at - static_cast<double>(entry) < share[entry] ? entry : alias[entry];
        return from_chart({2 * (static_cast<double>(lamp) + u[0]) / static_cast<double>(n), two_pi * u[1]});
    };
    s.p = [=](Vec3d, Vec3d w) {
        const double band = (1 - w.z) / 2 * static_cast<double>(n);
        const auto lamp = std::min(static_cast<std::size_t>(std::max(band, 0.0)), n - 1);
        return powers[lamp] / sum * static_cast<double>(n) / (2 * two_pi);
    };
    return s;
}

/// The first number chooses a half of the sphere and is used again, rounded to steps of its own size as in single
/// precision. The map of small steps of u has another slope than p, the same for several of them.
TEST(MapOfU, ANumberThatIsUsedAgainMayBeRounded) {
    for (double share = 0.51; share < 0.99; share += 0.004) {
        FunctionSampler s;
        s.draw = [=](Vec3d, const PrimarySample& u) {
            const bool first = u[0] < share;
            const double again = first ? u[0] / share : (u[0] - share) / (1 - share);
            return from_chart({(first ? 0 : 1) + std::floor(again / ulp) * ulp, two_pi * u[1]});
        };
        s.p = [=](Vec3d, Vec3d w) { return (w.z > 0 ? share : 1 - share) / two_pi; };
        EXPECT_FALSE(tested(s, map)) << share;
    }
}

TEST(MapOfU, ABranchMayBeSeveralIntervalsOfTheChoosingNumber) {
    const FunctionSampler two = alias_lights({3, 1});  // [0, 1/2) and [3/4, 1), and [1/2, 3/4)
    const std::vector<MapDensity> all = tested(two, [](Source& source) { return map_densities(source, key); });
    EXPECT_GT(all.size(), 20u);
    for (const MapDensity& m : all) EXPECT_NEAR(m.density / m.p, 1, 1e-3);
    EXPECT_FALSE(tested(two, map));
    FunctionSampler low = two;  // and a p that is too low is still found
    low.p = [p = two.p](Vec3d o, Vec3d w) { return 0.98 * p(o, w); };
    const auto fault = tested(low, map);
    ASSERT_TRUE(fault);
    EXPECT_NEAR(fault->size, -0.02, 2e-3);
}

TEST(MapOfU, AliasTablesOfAnySizeAreRight) {
    for (std::size_t n = 2; n <= 512; n = n < 8 ? n + 1 : 2 * n) {
        std::vector<double> many, alternating;
        for (std::size_t i = 0; i < n; ++i) {
            many.push_back(0.05 + std::fmod(0.618 * static_cast<double>(i * i + 1), 1.0));
            alternating.push_back(i % 2 == 0 ? 3 : 1);
        }
        EXPECT_FALSE(tested(alias_lights(many), map)) << n;
        EXPECT_FALSE(tested(alias_lights(alternating), map)) << n;
    }
}

/// Two lights that alternate over many intervals, most of which no probe of a branch meets.
TEST(MapOfU, ShortIntervalsOfOtherBranchesAreAllowedFor) {
    FunctionSampler s = alias_lights({1, 1});
    s.draw = [](Vec3d, const PrimarySample& u) {
        const bool below = std::fmod(u[2] * 400, 1.0) < 0.05;
        return from_chart({below ? 1 + u[0] : u[0], two_pi * u[1]});
    };
    s.p = [](Vec3d, Vec3d w) { return (w.z < 0 ? 0.05 : 0.95) / two_pi; };
    EXPECT_FALSE(tested(s, map));
}

TEST(ResolutionOfNumbers, IsTheShareOfTheDrawsOnAStep) {
    FunctionSampler s;
    const auto effect = [](const FunctionSampler& sampler) {
        Source source(sampler, 0, {0, 0, 1}, uniform_light);
        const Plan plan = make_plan(source, CheckBudget::limited(1e5), {});
        return resolution_effect(source, plan, key);
    };
    EXPECT_EQ(effect(s).share, 0);
    s.draw = [](Vec3d o, const PrimarySample& u) {  // 2^16 pieces of the first number, in another order
        const double at = u.x * 65536, piece = std::floor(at);
        return cosine_draw(o, PrimarySample((std::fmod(piece * 40503, 65536) + at - piece) / 65536, u.y));
    };
    EXPECT_NEAR(effect(s).share, 1 / 256.0, 4 / std::sqrt(4096 * 256.0));
    EXPECT_GT(effect(s).sums[bridge], 0);
    s.of.u_bits = 53;
    EXPECT_EQ(effect(s).share, 0);
}

}  // namespace small_tests_test
}  // namespace crescent::check
