// Lights of a case, its text, and adapters that limit the number of queries.
#include "check/sources/sampler_adapter.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "math/simd/random.h"
#include "tests/support/function_sampler.h"

namespace crescent {
namespace sampler_adapter_test {

constexpr CaseDiskLight overhead{20, {0, 0, 2}, {0, 0, -1}, 1};

TEST(CaseLights, AreMetAtTheirDistance) {
    EXPECT_DOUBLE_EQ(*overhead.distance({0, 0, 1}), 2);
    const double rim = std::atan(0.5) * 180 / pi;
    EXPECT_NEAR(*overhead.distance(tilt(rim - 0.1)), std::sqrt(5), 0.01);
    EXPECT_FALSE(overhead.distance(tilt(rim + 0.1)));
    CaseDiskLight turned = overhead;
    turned.normal = {0, 0, 1};
    EXPECT_FALSE(turned.distance({0, 0, 1}));  // its dark side
}

TEST(CaseLights, TheNearestCounts) {
    CaseLighting light;
    light.fill = 0.5;
    light.disks = {{12, {0, 0, 3}, {0, 0, -1}, 3}, overhead};
    EXPECT_FALSE(light.even());
    EXPECT_EQ(light({0, 0, 1}), 20);
    EXPECT_EQ(light.first_met({0, 0, 1})->distance, 2);
    EXPECT_EQ(light(tilt(40)), 12);
    EXPECT_EQ(light(tilt(80)), 0.5);
    EXPECT_EQ(light(tilt(100)), 0);
    EXPECT_TRUE(CaseLighting().even());
}

TEST(CaseLights, OfOtherKindsHaveTheirPower) {
    CaseAreaLight ball{3, lights::Sphere{{0, 0, 4}, 1}};
    EXPECT_NEAR(*ball.distance({0, 0, 1}), 3, 1e-9);
    EXPECT_FALSE(ball.distance(tilt(30)));
    CaseLighting light;
    light.area_lights = {ball};
    light.disks = {{20, {0, 0, 3.5}, {0, 0, -1}, 5}};  // behind the front of the ball
    EXPECT_EQ(light({0, 0, 1}), 3);
    EXPECT_EQ(light(tilt(45)), 20);
    ball.radiance = 6;
    EXPECT_DOUBLE_EQ(ball.power(), 2 * light.area_lights[0].power());
}

TEST(CheckCases, AreDescribedByTheirDirectionAndParameters) {
    CheckCase t;
    t.theta_deg = 60;
    t.azimuth_deg = 250;
    t.parameters = {{"s", 32}};
    t.brdf = "Lambert";
    t.lighting = "fill";
    EXPECT_EQ(t.text(), "w_o 60 deg az 250, s=32, Lambert, fill");
    auto sky = std::make_shared<check::FunctionSampler>();
    sky->of.wo = Traits::WoDomain::none;
    CheckCase of_sky;
    of_sky.adapter = sky;
    EXPECT_EQ(of_sky.text(), without_wo);
    EXPECT_NEAR(tilt(30, 90).y, 0.5, 1e-12);
    EXPECT_NEAR(tilt(120).z, -0.5, 1e-12);
}

/// Counts its answers.
struct Counting : InProcessAdapter {
    std::string name() const override { return "counting"; }
    void sample(int, Vec3d, std::span<const PrimarySample> u, std::span<Draw>) const override { count(u.size()); }
    void pdf(int, std::span<const Pair> at, std::span<double>) const override { count(at.size()); }
};

TEST(LimitedAdapters, RefuseTheQueryAboveTheirLimit) {
    const auto inner = std::make_shared<Counting>();
    const LimitedAdapter limited(inner, 10);
    std::vector<PrimarySample> u(6);
    std::vector<Draw> draws(6);
    std::vector<Pair> at(4);
    std::vector<double> p(4);
    limited.sample(0, {}, u, draws);
    limited.pdf(0, at, p);
    EXPECT_EQ(limited.spending().answers, 10u);
    EXPECT_THROW(limited.exact_pdf(0, std::span(at).first(1), std::span(p).first(1)), SamplerTimeout);
    EXPECT_EQ(inner->spending().answers, 10u);  // it was not called
}

// ---- Random numbers of samplers under test.

TEST(DrawnNumbers, AreThoseOfTheEstimator) {
    const PrimarySample u = drawn_numbers(7, 3, 11, 0, 2);
    EXPECT_EQ(u.x, static_cast<double>(draw(7, 3, 11).x));
    EXPECT_EQ(u.y, static_cast<double>(draw(7, 3, 11).y));
    const PrimarySample eight = drawn_numbers(7, 3, 11, 0, 8);
    EXPECT_EQ(eight.x, u.x);
    for (int a = 0; a < 8; ++a)
        for (int b = 0; b < a; ++b) EXPECT_NE(eight[a], eight[b]);
    EXPECT_NE(drawn_numbers(7, 3, 11, 1, 2).x, u.x);  // of another technique
    for (int k = 0; k < 8; ++k) EXPECT_EQ(std::fmod(eight[k] * 0x1p24, 1), 0);
}

// ---- A cache of answers, one program for several cases of a w_o, and errors that name their side.

/// A cosine sampler that counts its calls and fails on request.
struct Program : check::FunctionSampler {
    mutable int draws = 0, densities = 0;
    bool fails = false;
    bool serial() const override { return true; }
    void sample(int t, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        draws += static_cast<int>(u.size());
        if (fails) throw SamplerExited("it ended");
        FunctionSampler::sample(t, wo, u, out);
    }
    void pdf(int t, std::span<const Pair> at, std::span<double> out) const override {
        densities += static_cast<int>(at.size());
        if (fails) throw SamplerTimeout("too slow");
        FunctionSampler::pdf(t, at, out);
    }
};
const Pair pairs[] = {{{0, 0, 1}, {0, 0, 1}}, {{0, 0, 1}, tilt(60)}, {{0, 0, 1}, {0, 0, 1}}};

TEST(CachedSamplers, EvaluateEachPairOnce) {
    const auto inner = std::make_shared<Program>();
    const auto cache = cached(inner);
    double p[3];
    cache->exact_pdf(0, pairs, p);
    cache->exact_pdf(0, pairs, p);
    EXPECT_EQ(inner->densities, 2);
    EXPECT_NEAR(p[1], 0.5 / pi, 1e-12);
    EXPECT_EQ(p[0], p[2]);
    EXPECT_EQ(cache->spending().answers, 2u);
    cache->pdf(0, pairs, p);
    cache->pdf(0, pairs, p);  // plain densities are not cached without the draws
    EXPECT_EQ(inner->densities, 2 + 6);
    EXPECT_EQ(&uncached(*inner), inner.get());
    EXPECT_NE(&uncached(*cache), cache.get());
}

TEST(CachedSamplers, KeepDrawsOnRequest) {
    const auto inner = std::make_shared<Program>();
    const auto cache = cached(inner, true);
    std::vector<PrimarySample> u{{0.1, 0.2}, {0.3, 0.4}};
    std::vector<Draw> first(2), second(2);
    cache->sample(0, {0, 0, 1}, u, first);
    cache->sample(0, {0, 0, 1}, u, second);
    EXPECT_EQ(inner->draws, 2);
    EXPECT_EQ(first[1].wi.x, second[1].wi.x);
    u[1].y = 0.5;
    cache->sample(0, {0, 0, 1}, u, second);
    EXPECT_EQ(inner->draws, 4);
}

TEST(CachedSamplers, KeepNothingOfACallThatFails) {
    const auto inner = std::make_shared<Program>();
    const auto cache = cached(inner);
    double p[3];
    inner->fails = true;
    EXPECT_THROW(cache->exact_pdf(0, pairs, p), SamplerTimeout);
    inner->fails = false;
    cache->exact_pdf(0, pairs, p);
    EXPECT_NEAR(p[0], 1 / pi, 1e-12);
}

TEST(SidesOfAComparison, ShareThePrograms) {
    CheckCase a;
    a.adapter = std::make_shared<Program>();
    a.wo = {0, 0, 1};
    CheckCase b = a;
    b.brdf = "another surface";
    PerDirectionCache cache;
    const Side first = cache.of(a, 5), second = cache.of(b, 6);
    EXPECT_EQ(first.check_case.adapter, second.check_case.adapter);
    EXPECT_EQ(second.stream, 5u);
    b.wo = tilt(30);
    EXPECT_NE(cache.of(b, 7).check_case.adapter, first.check_case.adapter);
    CheckCase fast;
    fast.adapter = std::make_shared<check::FunctionSampler>();
    EXPECT_EQ(cache.of(fast, 8).check_case.adapter, fast.adapter);  // in process: nothing to save
}

TEST(SidesOfAComparison, AreNamedInErrors) {
    const auto program = std::make_shared<Program>();
    program->fails = true;
    const auto side = named_side(named_side(program, "A"), "B");
    double p[3];
    try {
        side->pdf(0, pairs, p);
        FAIL();
    } catch (const SamplerTimeout& fault) { EXPECT_STREQ(fault.what(), "sampler A (made): too slow"); }
    std::vector<PrimarySample> u(1);
    std::vector<Draw> draws(1);
    EXPECT_THROW(side->sample(0, {0, 0, 1}, u, draws), SamplerExited);  // the type is kept
    const auto plain = std::make_shared<check::FunctionSampler>();
    EXPECT_EQ(named_side(plain, "A"), plain);
}

}  // namespace sampler_adapter_test
}  // namespace crescent
