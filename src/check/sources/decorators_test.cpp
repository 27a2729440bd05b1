// A limit of queries, a cache of answers, one program for several cases of a w_o, and errors that name their side.
#include "check/sources/decorators.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/function_sampler.h"

namespace crescent {
namespace decorators_test {

/// Counts its answers.
struct Counting : InProcessAdapter {
    std::string name() const override { return "counting"; }
    void sample(int, Vec3d, std::span<const PrimarySample> u, std::span<Draw>) const override { count(u.size()); }
    void pdf(int, std::span<const Pair> at, std::span<double>) const override { count(at.size()); }
};

TEST(LimitedSamplers, RefuseTheQueryAboveTheirLimit) {
    const auto inner = std::make_shared<Counting>();
    const auto limited = limited_in_number(inner, 10);
    std::vector<PrimarySample> u(6);
    std::vector<Draw> draws(6);
    std::vector<Pair> at(4);
    std::vector<double> p(4);
    limited->sample(0, {}, u, draws);
    limited->pdf(0, at, p);
    EXPECT_EQ(limited->spending().answers, 10u);
    EXPECT_THROW(limited->exact_pdf(0, std::span(at).first(1), std::span(p).first(1)), SamplerTimeout);
    EXPECT_EQ(inner->spending().answers, 10u);  // it was not called
}

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

}  // namespace decorators_test
}  // namespace crescent
