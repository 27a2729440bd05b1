// A user's struct as a sampler, in each form of its parameters and results.
#include "check/sources/user_sampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <stdexcept>
#include <thread>

#include "check/user.h"

namespace crescent {
namespace user_sampler_test {

using Float3 = std::array<float, 3>;

template <class S> Draw drawn(const UserSampler<S>& s, PrimarySample u, Vec3d wo = {0, 0, 1}) {
    Draw out;
    s.sample(0, wo, {&u, 1}, {&out, 1});
    return out;
}
template <class S> std::pair<double, double> pdf_and_f(const UserSampler<S>& s, Pair at) {
    double p = 0, f = 0;
    s.pdf(0, {&at, 1}, {&p, 1});
    s.f({&at, 1}, {&f, 1});
    return {p, f};
}

/// Numbers in two parameters; the first parameter with two of them has the first two.
struct Plain {
    struct Out {
        Float3 wi;
        float pdf, weight;
    };
    Out sample(Float3 wo, float uc, std::array<float, 2> u) const { return {{wo[0], u[0], u[1]}, 0.5f, uc}; }
    float pdf(Float3 wo, Float3 wi) const { return wo[2] + wi[0]; }
    std::array<double, 3> f(const float* wo, std::span<const float> wi) const { return {wo[2], 2, wi[2]}; }
};

TEST(UserSamplers, HaveTheirNumbersInOrder) {
    const UserSampler<Plain> s("plain", {});
    EXPECT_EQ(s.traits().numbers, 3);
    EXPECT_EQ(s.traits().channels, 3);
    EXPECT_FALSE(s.serial());  // its members are const
    PrimarySample u(0.25, 0.5);
    u[2] = 0.75;
    const Draw d = drawn(s, u, {0.125, 0, 1});
    EXPECT_EQ(d.wi.x, 0.125);
    EXPECT_EQ(d.wi.y, 0.25);
    EXPECT_EQ(d.wi.z, 0.5);
    EXPECT_EQ(d.pdf, 0.5);
    EXPECT_EQ(d.weight, 0.75);
    const auto [p, f] = pdf_and_f(s, {{0, 0, 1}, {0.25, 0, 0.5}});
    EXPECT_EQ(p, 1.25);
    EXPECT_NEAR(f, luminance(Vec3d{1, 2, 0.5}), 1e-12);
    EXPECT_EQ(s.spending().answers, 3u);
}

/// Outputs by reference; false: no sample.
struct Written {
    bool sample(const Float3& wo, std::array<double, 2> u, Float3& wi, float* pdf) {
        wi = wo;
        *pdf = 2;
        return u[0] < 0.5;
    }
};

TEST(UserSamplers, MayWriteTheirOutputs) {
    const UserSampler<Written> s("written", {});
    EXPECT_TRUE(s.serial());  // sample is not const
    EXPECT_FALSE(s.traits().has_pdf);
    EXPECT_FALSE(s.has_f());
    EXPECT_EQ(drawn(s, {0.25, 0}).pdf, 1);  // without pdf(w) the density is ignored
    EXPECT_EQ(drawn(s, {0.75, 0}).pdf, 0);
}

/// Without w_o, an optional result, a delta part.
struct Sky {
    struct Out {
        Vec3d wi;
        double pdf;
        bool delta;
        Vec3d weight;
    };
    std::optional<Out> sample(Vec2d u) const {
        if (u.x > 0.9) return {};
        return Out{{0, 0, 1}, 0.25, u.x < 0.5, {1, 2, 3}};
    }
    double pdf(Vec3d) const { return 0.25; }
};

TEST(UserSamplers, MayHaveNoWoAndDeltaParts) {
    const UserSampler<Sky> s("sky", {});
    EXPECT_EQ(s.traits().wo, Traits::WoDomain::none);
    EXPECT_TRUE(s.traits().delta);
    const Draw delta = drawn(s, {0.25, 0}), direction = drawn(s, {0.6, 0});
    EXPECT_EQ(delta.delta, 0.25);
    EXPECT_EQ(delta.pdf, 0);
    EXPECT_EQ(delta.weights.z, 3);
    EXPECT_EQ(direction.delta, 0);
    EXPECT_EQ(direction.pdf, 0.25);
    EXPECT_EQ(drawn(s, {0.95, 0}).pdf, 0);
}

/// f with the draw in place of a weight: f cos / p.
struct WithF {
    struct Out {
        Vec3d wi;
        double pdf, f;
    };
    Out sample(Vec3d, Vec2d) const { return {{0.6, 0, 0.8}, 0.5, 0.25}; }
    double pdf(Vec3d, Vec3d) const { throw std::runtime_error("no luck"); }
};

TEST(UserSamplers, WeightsFollowFromF) {
    const auto pointed = WithF();
    const UserSampler<const WithF*> s("pointed", &pointed);
    EXPECT_NEAR(*drawn(s, {0.5, 0.5}).weight, 0.25 * 0.8 / 0.5, 1e-12);
    EXPECT_TRUE(s.has_drawn_f());
    EXPECT_FALSE(s.has_f());
}

TEST(UserSamplers, ErrorsHaveTheirPlace) {
    const UserSampler<WithF> s("throws", {});
    const Pair at{{0, 0, 1}, {0, 0.6, 0.8}};
    double p = 0;
    try {
        s.pdf(0, {&at, 1}, {&p, 1});
        FAIL();
    } catch (const SamplerError& e) {
        EXPECT_NE(std::string(e.what()).find("no luck"), std::string::npos);
        EXPECT_NE(std::string(e.what()).find("w_i = (0, 0.6, 0.8)"), std::string::npos) << e.what();
    }
}

TEST(UserSamplers, MayBeLambdas) {
    Traits both;
    both.wo = Traits::WoDomain::both;
    auto made = sampler_of([](Vec3d wo, Vec2d) { return WithF::Out{wo, 3, 1}; }, [](Vec3d, Vec3d) { return 3.0; },
        [](Vec3d, Vec3d) { return 1.0; }, both);
    const UserSampler<decltype(made)> s("lambdas", made);
    EXPECT_EQ(s.traits().wo, Traits::WoDomain::both);
    EXPECT_EQ(pdf_and_f(s, {{0, 0, 1}, {0, 0, 1}}), std::pair(3.0, 1.0));
    static_assert(user::Checkable<Plain> && user::Checkable<Sky> && user::Checkable<Written*>);
    struct NoSample {};
    static_assert(!user::Checkable<NoSample>);
}

/// A light that chooses by a number of its own: without w_o.
struct ChosenLight {
    struct Out {
        Vec3d wi;
        double pdf;
    };
    Out sample(float choice, std::array<float, 2> u) const { return {{choice, u[0], u[1]}, 0.5}; }
    double pdf(Vec3d wi) const { return wi.x; }
};

TEST(UserSamplers, MayTakeAChoiceInPlaceOfWo) {
    const UserSampler<ChosenLight> s("light", {});
    EXPECT_EQ(s.traits().numbers, 3);
    EXPECT_EQ(s.traits().wo, Traits::WoDomain::none);
    PrimarySample u(0.25, 0.5);
    u[2] = 0.75;
    const Draw d = drawn(s, u);
    EXPECT_EQ(d.wi.x, 0.75);
    EXPECT_EQ(d.wi.y, 0.25);
    EXPECT_EQ(d.wi.z, 0.5);
    EXPECT_EQ(pdf_and_f(s, {{0, 0, 1}, {0.25, 0, 0.5}}).first, 0.25);
}

/// A class with Mitsuba's names, without and with an f.
struct WithEval : ChosenLight {
    double eval(Vec3d wi) const { return wi.z; }
};
struct WithEvalAndF : WithEval {
    double f(Vec3d wi) const { return wi.z; }
};
static_assert(user::is_checkable<ChosenLight>() && !user::is_checkable<WithEval>());
static_assert(user::is_checkable<WithEvalAndF>());

TEST(UserSamplers, ClosuresThatShareAGeneratorAreCalledByOneThread) {
    int draws = 0;
    const auto counted = [&draws](Vec3d, Vec2d) {
        ++draws;
        return ChosenLight::Out{};
    };
    const auto plain = [](Vec3d, Vec2d) { return ChosenLight::Out{}; };
    const auto pdf = [](Vec3d, Vec3d) { return 0.0; };
    const auto serial = [](auto sampler) { return UserSampler<decltype(sampler)>("closures", sampler).serial(); };
    EXPECT_TRUE(serial(sampler_of(counted, pdf, Traits{.own_random = true})));
    EXPECT_FALSE(serial(sampler_of(counted, pdf)));
    EXPECT_FALSE(serial(sampler_of(plain, pdf, Traits{.own_random = true})));
}

/// A sampler that cannot be copied is checked by a pointer, or moved.
struct Unique : ChosenLight {
    Unique() = default;
    Unique(Unique&&) = default;
};
static_assert(requires(Unique s) { check_sampler("mine", &s); } && requires { check_sampler("mine", Unique{}); });

// ---- A limit of time: what is not examined within it is inconclusive, with the limit; nothing else depends on it.

/// Lambert with its cosine sampler; slow: it sleeps once in so many calls.
struct Lambert {
    int slow = 0;
    struct Out {
        Float3 wi;
        float pdf;
    };
    Out sample(Float3, std::array<float, 2> u) const {
        wait();
        const float r = std::sqrt(u[0]), phi = 2 * std::numbers::pi_v<float> * u[1], z = std::sqrt(1 - u[0]);
        return {{r * std::cos(phi), r * std::sin(phi), z}, z / std::numbers::pi_v<float>};
    }
    float pdf(Float3, Float3 wi) const {
        wait();
        return std::max(wi[2], 0.0f) / std::numbers::pi_v<float>;
    }
    void wait() const {
        if (slow > 0 && ++calls() % slow == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    static std::atomic<int>& calls() {
        static std::atomic<int> count{0};
        return count;
    }
};

TEST(UserSamplers, AreInconclusiveAfterTheLimitOfTime) {
    TestSettings settings;
    EXPECT_EQ(settings.seconds, 60);
    settings.wo = {{0, 0}, {60, 0}};
    settings.seconds = 0.3;
    const auto began = std::chrono::steady_clock::now();
    const CheckResult j = check_sampler("slow", Lambert{50}, settings);
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count(), 20);
    EXPECT_EQ(j.state, State::inconclusive);
    ASSERT_FALSE(j.verdicts.empty());
    EXPECT_EQ(j.verdicts[0].message(),
        "Not examined: 0.3 s (TestSettings::seconds) are not enough for this sampler at every w_o.");
    EXPECT_EQ(j.left_out.size(), 2u);
}

TEST(UserSamplers, HaveTheSameResultWithAndWithoutALimitOfTime) {
    TestSettings limited, unlimited;
    limited.wo = unlimited.wo = {{30, 0}};
    limited.seconds = 3600;
    unlimited.seconds = 0;
    const CheckResult a = check_sampler("fast", Lambert{}, limited), b = check_sampler("fast", Lambert{}, unlimited);
    EXPECT_EQ(a.state, State::right);
    ASSERT_EQ(a.verdicts.size(), b.verdicts.size());
    for (std::size_t k = 0; k < a.verdicts.size(); ++k) {
        if (a.verdicts[k].name == "efficiency") continue;  // it is timed
        EXPECT_EQ(a.verdicts[k].message(), b.verdicts[k].message());
    }
}

}  // namespace user_sampler_test
}  // namespace crescent
