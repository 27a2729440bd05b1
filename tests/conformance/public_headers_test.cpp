// Structs of users: their accepted forms, the messages for those that cannot be checked, and their exceptions.
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>

#include "check/gtest.h"
#include "check/report/summary.h"
#include "check/verdict.h"

namespace crescent {
namespace public_headers_test {

struct V2 {
    float x, y;
};
struct V3 {
    float x, y, z;
};
struct Drawn {
    V3 wi;
    float pdf;
};

Drawn cosine(V2 u) {
    const float r = std::sqrt(u.x), phi = 6.2831853f * u.y, z = std::sqrt(1 - u.x);
    return {{r * std::cos(phi), r * std::sin(phi), z}, z / 3.14159265f};
}

struct Own {
    Drawn sample(V3, V2 u) const { return cosine(u); }
    float pdf(V3, V3 wi) const { return wi.z > 0 ? wi.z / 3.14159265f : 0; }
};
struct Maybe : Own {
    std::optional<Drawn> sample(V3, V2 u) const { return u.x < 1 ? std::optional(cosine(u)) : std::nullopt; }
};
struct Three : Own {
    Drawn sample(V3, V3 u) const { return cosine({u.x, u.y}); }
};
struct NotConst : Own {
    Drawn sample(V3, V2 u) { return cosine(u); }
};
struct Throws : Own {
    Drawn sample(V3 wo, V2 u) const { return wo.z < 0.1f ? throw std::runtime_error("no grazing light") : cosine(u); }
};

struct ChooserFirst : Own {
    Drawn sample(const V3&, float, const V2& u) const { return cosine(u); }
};
struct Written : Own {
    bool sample(V3, const std::array<double, 4>& u, V3& wi, float& pdf) {
        const Drawn d = cosine({static_cast<float>(u[0]), static_cast<float>(u[1])});
        wi = d.wi;
        pdf = d.pdf;
        return true;
    }
};
struct Sky {
    Drawn sample(std::span<const float, 2> u) const {
        const float z = 1 - 2 * u[0], r = std::sqrt(std::max(1 - z * z, 0.0f)), phi = 6.2831853f * u[1];
        return {{r * std::cos(phi), r * std::sin(phi), z}, 0.079577472f};
    }
    float pdf(const V3&) const { return 0.079577472f; }
};
/// Padded to four members, with a delta part and three channels, as pbrt's BSDFSample has them.
struct Coat {
    struct V4 {
        float x, y, z, w;
    };
    struct Rgb {
        float r, g, b;
    };
    struct Sample {
        Rgb f;
        V4 wi;
        float pdf;
        bool specular;
        bool IsSpecular() const { return specular; }
    };
    std::optional<Sample> sample(V4 wo, float uc, V2 u) const {
        if (uc < 0.25f) return Sample{{0.25f / wo.z, 0.25f / wo.z, 0.25f / wo.z}, {-wo.x, -wo.y, wo.z, 0}, 0.25f, true};
        const Drawn d = cosine(u);
        const V4 wi{d.wi.x, d.wi.y, d.wi.z, 0};
        return Sample{f(wo, wi), wi, pdf(wo, wi), false};
    }
    float pdf(V4, V4 wi) const { return wi.z > 0 ? 0.75f * wi.z / 3.14159265f : 0; }
    Rgb f(V4, V4 wi) const { return wi.z > 0 ? Rgb{0.1f, 0.2f, 0.05f} : Rgb{0, 0, 0}; }
};
struct NoPdf {
    Drawn sample(V3, V2 u) const { return cosine(u); }
};

/// In the forms of renderers' classes: behind a base class, with functions as members, or with overloads that a wrapper
/// has to select from.
struct Base {
    virtual ~Base() = default;
    virtual Drawn sample(const V3& wo, const V2& u) const = 0;
    virtual float pdf(const V3& wo, const V3& wi) const = 0;
};
struct Derived final : Base {
    Drawn sample(const V3&, const V2& u) const override { return cosine(u); }
    float pdf(const V3&, const V3& wi) const override { return Own{}.pdf({}, wi); }
};
struct OfFunctions {
    std::function<Drawn(V3, V2)> sample = [](V3, V2 u) { return cosine(u); };
    float (*pdf)(V3, V3) = [](V3, V3 wi) { return Own{}.pdf({}, wi); };
};
struct Overloaded : Own {
    using Own::pdf;
    float pdf(V3 wi) const { return Own::pdf({}, wi); }
};
struct Hidden : Own {
private:
    float f(V3, V3) const { return 1; }
};

static_assert(user::Checkable<std::unique_ptr<Base>> && user::Checkable<const Derived*> && user::all_const<Base>());
static_assert(user::Checkable<OfFunctions> && !user::all_const<OfFunctions>(), "a std::function may hold what changes");
static_assert(
    !user::Checkable<Overloaded> && !user::Checkable<Hidden>, "a pdf or f that cannot be called is not left out");
static_assert(user::Checkable<Own> && user::numbers<Own>() == 2);
static_assert(user::Checkable<Three> && user::numbers<Three>() == 3);
static_assert(user::numbers<ChooserFirst>() == 3 && user::shares<ChooserFirst>()[1].first == 2);
static_assert(user::numbers<Written>() == 4 && !user::all_const<Written>() && user::all_const<Own>());
static_assert(user::without_wo<Sky>() && !user::without_wo<Own>());
static_assert(user::channels<Coat>() == 3 && user::numbers<Coat>() == 3);
static_assert(!user::Checkable<V3>);

TestSettings few() {
    TestSettings r;
    r.budget = check::CheckBudget::limited();
    return r;
}

TEST(Doors, StructsOfOnesOwnAndOptionalDrawsAreTaken) {
    EXPECT_EQ(check_sampler("own", Own{}, few()).state, State::right);
    EXPECT_THAT(Maybe{}, IsARightSamplerBy(few()));
    EXPECT_EQ(testing::PrintToString(Own{}), "a sampler");
    EXPECT_THAT(Three{}, IsARightSamplerBy(few()));
    EXPECT_THAT(NotConst{}, IsARightSamplerBy(few()));
    EXPECT_THAT(ChooserFirst{}, IsARightSamplerBy(few()));
    EXPECT_THAT(Written{}, IsARightSamplerBy(few()));
    EXPECT_THAT(Sky{}, IsARightSamplerBy(few()));
    EXPECT_THAT(Coat{}, IsARightSamplerBy(few()));
    EXPECT_EQ(check_sampler("no pdf", NoPdf{}, few()).state, State::inconclusive) << "nothing holds its draws";
}

TEST(Doors, PointersFunctionsAndLambdasAreTaken) {
    const std::unique_ptr<Base> held = std::make_unique<Derived>();
    EXPECT_THAT(held, IsARightSamplerBy(few()));
    EXPECT_THAT(held.get(), IsARightSamplerBy(few()));
    EXPECT_EQ(check_sampler("shared", std::make_shared<Own>(), few()).state, State::right);
    EXPECT_THAT(OfFunctions{}, IsARightSamplerBy(few()));
    int draws = 0;
    const Overloaded own;
    const auto sample = [&](V3 wo, V2 u) mutable { return ++draws, own.sample(wo, u); };
    EXPECT_THAT(sampler_of(sample, [&](V3 wo, V3 wi) { return own.pdf(wo, wi); }), IsARightSamplerBy(few()));
    EXPECT_GT(draws, 0);
    const auto doubled = [&](V3 wo, V3 wi) { return 2 * own.pdf(wo, wi); };
    const auto f = [](V3, V3 wi) { return wi.z > 0 ? 0.3f : 0.0f; };
    EXPECT_EQ(check_sampler("doubled", sampler_of(sample, doubled, f), few()).state, State::wrong);
    EXPECT_FALSE(UserSampler("told", sampler_of(sample, doubled, f, {.reciprocal = false})).traits().reciprocal);
}

TEST(Doors, ThrowIsAnErrorAtItsPlaceOnly) {
    const CheckResult j = check_sampler("throws", Throws{}, few());
    EXPECT_EQ(j.state, State::error);
    std::size_t errors = 0;
    for (const Verdict& v : j.verdicts) errors += v.state == State::error;
    EXPECT_EQ(errors, 2 * verdict_names.size() + 1) << what_is_wrong(j);  // w_o at 85 and 89 deg; special w_o
    for (const Verdict& v : j.verdicts) EXPECT_TRUE(v.evidence.is_object()) << v.name;
    EXPECT_EQ(unseen_text(j), "") << "what is right is not the whole";
    EXPECT_NE(what_is_wrong(j).find("sample(wo, u) threw 'no grazing light' at w_o = ("), std::string::npos)
        << what_is_wrong(j);
}

TEST(Doors, JudgingStopsWhenItsMonitorSaysSo) {
    ProgressMonitor monitor;
    monitor.stop = true;
    EXPECT_THROW(check_sampler("own", Own{}, few(), &monitor), Interrupted);
}

}  // namespace public_headers_test
}  // namespace crescent
