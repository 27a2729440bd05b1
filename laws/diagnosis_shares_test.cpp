// What a diagnosis says of parts of a sampler: sides of a surface, lobes, verdicts of the same arm.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <gtest/gtest.h>

#include "judgements/summary.h"
#include "laws/judged.h"
#include "laws/right/renderers.h"
#include "math/functions.h"
#include "math/spherical.h"

namespace crescent {
namespace {

Judgement judged(const Recipe& recipe, double theta = 0) {
    return judged_at(subject_of(recipe), theta, TestSettings::quick(), 0);
}

struct Said {
    State state;
    std::string diagnosis, say;
};
/// The first verdict that is wrong and has a diagnosis.
Said first_said(const Judgement& j) {
    for (const Verdict& v : j.verdicts)
        if (v.state == State::wrong && v.evidence.contains("diagnosis"))
            return {j.state, v.evidence["diagnosis"].get<std::string>(), v.say};
    return {j.state, "", ""};
}

/// Lambert on both sides, the side chosen by the third number: half of the draws go through, pdf has 0.48 there.
TEST(Diagnosis, NamesTheShareOfEachSideOfTheSurface) {
    Recipe r{"leaf", "", {}, {}, {}};
    r.traits.numbers = 3;
    r.traits.wo = Traits::Asked::both;
    r.pdf = [](Vec3d o, Vec3d i) { return (o.z * i.z > 0 ? 0.52 : 0.48) * std::fabs(i.z) / pi; };
    r.f = [](Vec3d o, Vec3d i) { return (o.z * i.z > 0 ? 0.52 : 0.48) * 0.9 / pi; };
    r.sample = [pdf = r.pdf](Vec3d o, const Numbers& u) {
        Vec3d i = math::spherical(std::sqrt(1 - u[0]), 2 * pi * u[1]);
        i.z = std::copysign(i.z, u[2] < 0.5 ? o.z : -o.z);
        return Draw{i, pdf(o, i)};
    };
    const Said said = first_said(judged(r, 60));
    EXPECT_EQ(said.diagnosis, "a constant on either side") << said.say;
    EXPECT_NE(said.say.find("0.96154 above the surface and 1.0417 below it"), std::string::npos) << said.say;
}

/// D for D n.m: m across the surface is by the index, told or of the common ones.
Recipe glass_without_n_m(double eta, bool told, bool both_sides = true) {
    const RoughGlass glass{0.25, eta};
    Recipe r = recipe_of(glass);
    if (!told) r.traits.eta = {};
    r.pdf = [=](Vec3d o, Vec3d i) {
        const double p = glass.pdf(o, i);
        return p > 0 && (both_sides || glass.across(o, i)) ? p / glass.half(o, i).z : p;
    };
    r.sample = [glass, p = r.pdf](Vec3d o, const Numbers& u) {
        Draw d = glass.sample(o, u);
        if (d.pdf > 0) d.pdf = p(o, d.wi);
        return d;
    };
    return r;
}

TEST(Diagnosis, NamesTheCosineOfTheHalfVectorOnBothSidesOfGlass) {
    for (const auto& [theta, told] : {std::pair(45.0, false), {120.0, true}}) {
        const Said said = first_said(judged(glass_without_n_m(1.4, told), theta));
        EXPECT_EQ(said.diagnosis, "n.m") << theta << told << ": " << said.say;
    }
    const Said across = first_said(judged(glass_without_n_m(1.4, true, false), 45));
    EXPECT_EQ(across.diagnosis, "n.m across the surface") << across.say;
}

/// 2.1 is none of the indices that are tried.
TEST(Diagnosis, NamesNoCosineOfAHalfVectorThatItDoesNotKnow) {
    const Said said = first_said(judged(glass_without_n_m(2.1, false), 45));
    EXPECT_EQ(said.state, State::wrong);
    EXPECT_EQ(said.diagnosis, "none") << said.say;
}

/// What another call answers is no factor of p.
TEST(Diagnosis, LooksForNoFactorOfAState) {
    Recipe r{"cosine", "", {}, {}, {}};
    r.pdf = [](Vec3d, Vec3d i) { return std::max(i.z, 0.0) / pi; };
    r.sample = [p = r.pdf, calls = std::make_shared<std::atomic<unsigned>>(0)](Vec3d o, const Numbers& u) {
        const double turn = (u[1] + 0.61803398875 * (*calls)++);
        const Vec3d i = math::spherical(std::sqrt(1 - u[0]), 2 * pi * (turn - std::floor(turn)));
        return Draw{i, p(o, i)};
    };
    const Judgement j = judged(r, 45);
    const Verdict& v = named(j, "identity");
    EXPECT_EQ(v.state, State::wrong);
    EXPECT_EQ(v.say.find("usual factors"), std::string::npos) << v.say;
    EXPECT_FALSE(v.evidence.contains("diagnosis")) << v.say;
}

/// A part that p says is next to never drawn: of 1e169 times as often no digit tells anything.
TEST(Diagnosis, TellsNoRatioBeyondAMillion) {
    Recipe r{"cosine", "", {}, {}, {}};
    r.pdf = [](Vec3d, Vec3d i) { return i.z > 0 ? i.z / pi * (i.y < -0.77 ? 1e-100 : 1.1 + 0.2 * i.x) : 0; };
    r.sample = [p = r.pdf](Vec3d o, const Numbers& u) {
        const Vec3d i = math::spherical(std::sqrt(1 - u[0]), 2 * pi * u[1]);
        return Draw{i, p(o, i)};
    };
    const Said said = first_said(judged(r, 45));
    EXPECT_EQ(said.state, State::wrong);
    EXPECT_NE(said.say.find("more than a million times at some directions"), std::string::npos) << said.say;
    EXPECT_EQ(said.say.find("e+"), std::string::npos) << said.say;
}

/// Two phase functions, the second drawn with a number that is not stretched again: its first part is never drawn, and
/// that is no share.
TEST(Diagnosis, OfANumberThatIsUsedAgainNamesThatAndNoShare) {
    Recipe r{"two phase functions", "", {}, {}, {}};
    r.traits.wo = Traits::Asked::none;
    const auto density = [](double g, double c) {
        return (1 - g * g) / (4 * pi * math::pow(1 + g * g - 2 * g * c, 1.5));
    };
    r.pdf = [density](Vec3d, Vec3d i) { return 0.7 * density(0.6, i.z) + 0.3 * density(-0.3, i.z); };
    r.sample = [pdf = r.pdf](Vec3d o, const Numbers& u) {
        const double g = u[0] < 0.7 ? 0.6 : -0.3, v = u[0] < 0.7 ? u[0] / 0.7 : u[0];
        const double s = (1 - g * g) / (1 - g + 2 * g * v), c = (1 + g * g - s * s) / (2 * g);
        const Vec3d i = math::spherical(std::clamp(c, -1.0, 1.0), 2 * pi * u[1]);
        return Draw{i, pdf(o, i)};
    };
    const Judgement j = judged(r);
    EXPECT_EQ(j.state, State::wrong);
    EXPECT_EQ(first_said(j).diagnosis, "the number that chooses, used again without stretching") << first_said(j).say;
    EXPECT_NE(first_said(j).say.find("(from 0.7 to 1)"), std::string::npos) << first_said(j).say;
}

/// The first finding says what explains it, where only another of its verdicts knows.
TEST(Diagnosis, OfAnotherVerdictIsToldWhereTheWorstHasNone) {
    Judgement j;
    const auto add = [&](const char* name, const char* trial, double chi2, const char* diagnosis) {
        Verdict v;
        v.arm = "mine", v.trial = trial, v.name = name, v.state = State::wrong, v.say = "Off.";
        v.evidence = {{"chi2", chi2}, {"degrees", 10}, {"diagnosis", diagnosis}};
        if (std::string_view(diagnosis) != "none") v.evidence["diagnosis_says"] = "pdf(w) times 2";
        j.verdicts.push_back(v);
    };
    add("density", "w_o 0 deg", 900, "none");
    add("density", "w_o 60 deg", 100, "a constant");
    EXPECT_NE(what_is_wrong(j).find("worst at w_o 0 deg. Off. What explains it at w_o 60 deg: pdf(w) times 2."),
        std::string::npos)
        << what_is_wrong(j);
}

}  // namespace
}  // namespace crescent
