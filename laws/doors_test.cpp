// Structs of somebody's own: what they may look like, what is said where they cannot be judged, and what happens when
// they throw.
#include <cmath>
#include <gtest/gtest.h>
#include <optional>
#include <stdexcept>

#include "verdicts/gtest.h"

namespace crescent {
namespace {

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

static_assert(user::Callable<Own> && !user::TakesThree<Own>);
static_assert(user::TakesThree<Three>);
static_assert(!user::Callable<NotConst> && user::CallableIfNotConst<NotConst>);
static_assert(!user::Callable<V3> && !user::CallableIfNotConst<V3>);

Rigour few() {
    Rigour r;
    r.draws = 4096;
    return r;
}

TEST(Doors, StructsOfOnesOwnAndOptionalDrawsAreTaken) {
    EXPECT_EQ(judge_sampler("own", Own{}, few()).state, State::right);
    EXPECT_THAT(Maybe{}, IsARightSamplerBy(few()));
    EXPECT_EQ(testing::PrintToString(Own{}), "a sampler");
}

TEST(Doors, WhatASamplerThrowsIsAnErrorAtItsPlaceAndTheRestIsJudged) {
    const Judgement j = judge_sampler("throws", Throws{}, few());
    EXPECT_EQ(j.state, State::error);
    std::size_t errors = 0;
    for (const Verdict& v : j.verdicts) errors += v.state == State::error;
    EXPECT_EQ(errors, 2 * verdict_names.size()) << what_is_wrong(j);  // w_o at 85 and 89 deg
    EXPECT_NE(what_is_wrong(j).find("sample(wo, u) threw 'no grazing light' at w_o = ("), std::string::npos)
        << what_is_wrong(j);
}

TEST(Doors, JudgingStopsWhenItsWatchSaysSo) {
    Watch watch;
    watch.stop = true;
    EXPECT_THROW(judge_sampler("own", Own{}, few(), &watch), Interrupted);
}

}  // namespace
}  // namespace crescent
