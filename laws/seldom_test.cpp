// Samplers that seldom draw anything, or nothing at all, are right where p says so; one direction that is drawn again
// and again has no density.
#include <cmath>
#include <gtest/gtest.h>

#include "judgements/summary.h"
#include "laws/judged.h"
#include "laws/right/renderers.h"
#include "math/spherical.h"
#include "subjects/list.h"
#include "verdicts/judge.h"

namespace crescent {
namespace {

Vec3d about_normal(const Numbers& u) { return math::spherical(std::sqrt(u[0]), std::sqrt(1 - u[0]), 2 * pi * u[1]); }

/// A share of cosine, drawn as seldom; f of albedo 0.5.
Recipe seldom(double share) {
    Recipe r{"seldom", "", {}, {}, {}};
    r.traits.numbers = 3;
    r.pdf = [share](Vec3d, Vec3d i) { return share * std::max(i.z, 0.0) / pi; };
    r.f = [](Vec3d, Vec3d i) { return i.z > 0 ? 0.5 / pi : 0; };
    r.sample = [share](Vec3d, const Numbers& u) {
        const Vec3d wi = about_normal(u);
        return Draw{wi, u[2] < share ? share * wi.z / pi : 0};
    };
    return r;
}

/// A hundred draws of 32,768, of which a test that takes their number for granted makes too much.
TEST(Seldom, DrawnIsNotWrong) {
    for (const double share : {0.01, 0.003, 0.0001})
        for (const std::uint32_t seed : {1u, 2u, 3u, 58u}) {
            TestSettings settings = TestSettings::quick();
            settings.seed = seed;
            ProgressMonitor monitor;
            const Judgement j = judge(trials_of_subject(subject_of(seldom(share)), false), settings, monitor);
            EXPECT_NE(j.state, State::wrong) << share << " " << seed << what_is_wrong(j);
        }
}

TEST(Seldom, WhatIsNeverDrawnThoughPSaysSoIsWrong) {
    Recipe never = seldom(0.003);
    never.sample = [](Vec3d, const Numbers& u) { return Draw{about_normal(u), 0}; };
    EXPECT_EQ(named(judged_at(subject_of(never), 30, TestSettings::quick()), "normalised").state, State::wrong);
    Recipe black = never;
    black.pdf = [](Vec3d, Vec3d) { return 0; };
    EXPECT_EQ(named(judged_at(subject_of(black), 30, TestSettings::quick()), "valid").state, State::wrong);
}

/// Nothing is known of its f; under the surface there is nothing to draw.
TEST(Seldom, ASurfaceOfOneSideIsRightOnBoth) {
    Recipe r{"one side", "", {}, {}, {}};
    r.traits.wo = Traits::Asked::both;
    r.pdf = [](Vec3d o, Vec3d i) { return o.z > 0 ? std::max(i.z, 0.0) / pi : 0; };
    r.sample = [](Vec3d o, const Numbers& u) {
        const Vec3d wi = about_normal(u);
        return Draw{wi, o.z > 0 ? wi.z / pi : 0};
    };
    for (const double theta : {30.0, 150.0, 180.0}) {
        const Judgement j = judged_at(subject_of(r), theta, of_draws(8192));
        EXPECT_EQ(j.state, State::right) << theta << what_is_wrong(j);
    }
}

/// One draw in 1500 goes where a clamp sends it.
TEST(Seldom, OneDirectionDrawnAgainAndAgainIsFound) {
    Recipe r = seldom(1);
    r.sample = [](Vec3d, const Numbers& u) {
        const Vec3d wi = u[2] < 1 / 1500.0 ? tilt(40, 20) : about_normal(u);
        return Draw{wi, wi.z / pi};
    };
    const Judgement j = judged_at(subject_of(r), 30, TestSettings::quick());
    EXPECT_EQ(named(j, "identity").state, State::wrong) << what_is_wrong(j);
    EXPECT_NE(named(j, "identity").say.find("the very direction (0.6"), std::string::npos) << named(j, "identity").say;
}

}  // namespace
}  // namespace crescent
