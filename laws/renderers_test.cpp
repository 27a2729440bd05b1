// Samplers as renderers have them: several random numbers, both sides, delta parts, colour, no w_o, no pdf, a state;
// and what programs say of themselves.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "laws/judged.h"
#include "laws/right/renderers.h"
#include "subjects/list.h"
#include "subjects/pipe.h"
#include "subjects/pipe_greeting.h"

namespace crescent {
namespace {

Judgement judged(const Recipe& recipe, double theta = 45) {
    return judged_at(subject_of(recipe), theta, of_draws(8192));
}

TEST(Renderers, GlassIsJudgedFromBothSides) {
    for (double theta : {45.0, 135.0}) {
        const Judgement j = judged(recipe_of(RoughGlass{}), theta);
        EXPECT_EQ(j.state, State::right) << what_is_wrong(j);
        EXPECT_NE(named(j, "identity").say.find("on every branch"), std::string::npos) << named(j, "identity").say;
        EXPECT_NE(named(j, "physics").say.find("pairs across the surface"), std::string::npos);
    }
}

TEST(Renderers, DeltaPartsAreToldWithTheirShareAndWeight) {
    const Judgement j = judged(recipe_of(SmoothCoat{}));
    EXPECT_EQ(j.state, State::right) << what_is_wrong(j);
    const auto& parts = named(j, "density").evidence["delta_parts"];
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_DOUBLE_EQ(parts[0]["q"].get<double>(), 0.3);
    EXPECT_NEAR(named(j, "normalised").evidence["drawn_delta"].get<double>(), 0.3, 1e-3);
    EXPECT_EQ(judged(smooth_glass(1.5)).state, State::right) << what_is_wrong(judged(smooth_glass(1.5)));
}

TEST(Renderers, EveryChannelCountsForEnergy) {
    const Judgement j = judged(recipe_of(SmoothCoat{0.2, 0.3, {0.5, 0.5, 1.01}}));
    EXPECT_EQ(named(j, "physics").state, State::wrong);
    EXPECT_NE(named(j, "physics").say.find("in the third channel"), std::string::npos) << named(j, "physics").say;
}

TEST(Renderers, ASkyHasNoViewAndIsJudgedOnce) {
    Dice dice(3);
    const auto sky = subject_of(recipe_of(sky_with_sun(dice, 32, 64, 0.5, true)));
    const std::vector<Trial> trials = trials_of_subject(sky, false);
    ASSERT_EQ(trials.size(), 1u);
    EXPECT_EQ(trials[0].text(), "no w_o");
    ProgressMonitor monitor;
    const Judgement j = judge(trials, TestSettings::quick(), monitor);
    EXPECT_EQ(j.state, State::right) << what_is_wrong(j);
    EXPECT_EQ(named(j, "normalised").evidence["quadrature_error"].get<double>(), 0) << "its texels are summed";
}

/// 512 x 256 texels, of which bins hold hundreds: where one stands for its neighbour no bin is off.
TEST(Renderers, AnAliasTableThatIsOffByOneIsFoundFromTexelToTexel) {
    Dice dice(3);
    Sky sky = *sky_with_sun(dice, 256, 512, 0.02, true);
    const Judgement right = judged(recipe_of(std::make_shared<const Sky>(sky)), 0);
    EXPECT_EQ(right.state, State::right) << what_is_wrong(right);
    EXPECT_GT(named(right, "density").evidence.value("p_heights", -1.0), 1e-3);
    for (int& other : sky.other) other = (other + 1) % (256 * 512);
    const Judgement wrong = judged(recipe_of(std::make_shared<const Sky>(sky)), 0);
    EXPECT_EQ(named(wrong, "density").state, State::wrong);
    EXPECT_NE(
        what_is_wrong(wrong).find("density: wrong. The draws do not follow p from texel to texel"), std::string::npos)
        << what_is_wrong(wrong);
}

/// Lambert about a normal that is tilted by 25 deg towards x, black where w_o lies behind it.
Recipe tilted_lambert(bool draws) {
    const Vec3d n = tilt(25, 0);
    Recipe r{"tilted", "", {}, {}, {}};
    r.traits.reciprocal = false;
    r.pdf = [n](Vec3d o, Vec3d i) { return dot(o, n) > 0 && i.z > 0 ? std::max(dot(i, n), 0.0) / pi : 0; };
    r.f = [n](Vec3d o, Vec3d i) { return dot(o, n) > 0 && i.z > 0 ? 0.5 / pi * std::max(dot(i, n), 0.0) / i.z : 0; };
    r.sample = [n, draws, pdf = r.pdf](Vec3d o, const Numbers& u) {
        const Vec3d wi = about(n, std::sqrt(1 - u[0]), u[1]);
        return Draw{wi, draws ? pdf(o, wi) : 0};
    };
    return r;
}

TEST(Renderers, ThatDrawNothingAreRightWhereFIsZeroAndNowhereElse) {
    const auto at = [](const Recipe& r, double phi) { return judged_at(subject_of(r), 89, of_draws(8192), phi); };
    const Judgement behind = at(tilted_lambert(true), 180);
    EXPECT_EQ(behind.state, State::right) << what_is_wrong(behind);
    EXPECT_NE(named(behind, "valid").say.find("nothing to draw"), std::string::npos) << named(behind, "valid").say;
    EXPECT_EQ(named(at(tilted_lambert(false), 0), "normalised").state, State::wrong) << "p is not 0";
}

/// cos / pi over the upper half, asked of no pdf.
TEST(Renderers, WithoutAPdfTheDensityThatDrawsImplyIsTold) {
    Recipe r{"cosine", "", {}, {}, {}};
    r.traits.has_pdf = false;
    r.sample = [](Vec3d, const Numbers& u) {
        const double s = std::sqrt(u[0]), phi = 2 * pi * u[1];
        return Draw{{s * std::cos(phi), s * std::sin(phi), std::sqrt(1 - u[0])}, 1};
    };
    r.pdf = [](Vec3d, Vec3d) { return 1.0; };
    const Judgement j = judged(r);
    EXPECT_EQ(j.state, State::inconclusive) << what_is_wrong(j);
    const Verdict& v = named(j, "density");
    ASSERT_EQ(v.evidence["implied_by"], "jacobian") << v.say;
    for (const auto& row : v.evidence["implied_density"]["rows"])
        EXPECT_NEAR(row[3].get<double>() * pi / row[2].get<double>(), 1, 0.02);
}

TEST(Renderers, ThatDrawTheirOwnNumbersAreJudgedWithoutWhatNeedsThem) {
    for (bool says : {false, true}) {
        Recipe r = recipe_of(SmoothCoat{});
        r.traits.own_random = says;
        const auto dice = std::make_shared<Dice>(5);
        r.sample = [coat = SmoothCoat{}, dice](Vec3d wo, const Numbers&) {
            Numbers u;
            for (int k = 0; k < 3; ++k) u[k] = dice->uniform(0, 1);
            return coat.sample(wo, u);
        };
        const Judgement j = judged(r);
        EXPECT_EQ(named(j, "identity").state, says ? State::right : State::wrong) << named(j, "identity").say;
        EXPECT_EQ(named(j, "density").state, State::right) << named(j, "density").say;
    }
}

TEST(Greetings, SayWhatAProgramIs) {
    Greeting g;
    EXPECT_EQ(
        read_greeting("hello 2 my glass u=3 domain=sphere wo=both channels=3 weight=yes delta=yes eta=1.5,1.51,1.52 "
                      "transport=importance f=cos reciprocal=no random=own real=f32 block=f64",
            g)
            .got,
        "");
    EXPECT_EQ(g.name, "my glass");
    EXPECT_EQ(g.traits.numbers, 3);
    EXPECT_EQ(g.traits.channels, 3);
    EXPECT_TRUE(g.traits.delta && g.weight && g.f_cos && g.blocks && g.traits.importance && g.traits.own_random);
    EXPECT_FALSE(g.traits.reciprocal || g.hemisphere);
    EXPECT_EQ(g.traits.wo, Traits::Asked::both);
    EXPECT_DOUBLE_EQ(g.traits.eta->z, 1.52);
    EXPECT_EQ(g.traits.bits, 24);
}

TEST(Greetings, SayWhatIsKnownWhereAKeyIsNot) {
    const auto fault = [](const char* answer) {
        Greeting g;
        const GreetingFault fault = read_greeting(answer, g);
        return fault ? "expected " + fault.expected + ", " + fault.got : "";
    };
    EXPECT_NE(fault("hello 2 x colour=3").find("expected one of u, domain, wo, channels"), std::string::npos);
    EXPECT_NE(fault("hello 2 x colour=3").find("got the unknown key 'colour'"), std::string::npos);
    EXPECT_NE(fault("hello 2 x weights=yes").find("did you mean 'weight'?"), std::string::npos);
    EXPECT_NE(fault("hello 2 x u=9").find("expected a whole number from 1 to 8 for u, got '9'"), std::string::npos);
    EXPECT_NE(fault("hello 2 x delta=yes").find("weight=yes"), std::string::npos);
    EXPECT_NE(fault("hello 2 x u=3 wo=both u=2").find("got the key 'u' twice"), std::string::npos);
    EXPECT_NE(fault("hello 2 u=3").find("no name"), std::string::npos);
    EXPECT_NE(fault("hello 3 x").find("got 'hello 3 x'"), std::string::npos);
    EXPECT_EQ(fault("hello 1 x y=z"), "") << "protocol 1 has no keys: that is its name";
}

std::string fault_of(const std::string& program) {
    PipeLimits limits;
    limits.hello_seconds = limits.quiet_seconds = 2;
    try {
        const auto pipe = start_pipe(program, limits);
        std::vector<Numbers> u(10, {0.5, 0.5});
        std::vector<Draw> out(10);
        pipe->sample(0, {0, 0, 1}, u, out);
    } catch (const SubjectFault& fault) { return fault.what(); }
    return "";
}

/// The answer to f is a block of one NaN; then come an error, and a block of another size.
TEST(Greetings, BlocksThatSayAnErrorAreTold) {
    const std::string start =
        "read hello; echo hello 2 x block=f64; head -c 56 >/dev/null; printf "
        "'\\001\\000\\000\\000\\000\\000\\000\\000\\000\\000\\370\\177'; ";
    EXPECT_NE(
        fault_of(start + "head -c 408 >/dev/null; printf '\\000\\000\\000\\000\\007\\000\\000\\000no luck'; sleep 3")
            .find("got an error: 'no luck'"),
        std::string::npos);
    EXPECT_NE(fault_of(start + "head -c 408 >/dev/null; printf '\\003\\000\\000\\000'; sleep 3")
                  .find("got a block of 3 rows for one of 10"),
        std::string::npos);
}

}  // namespace
}  // namespace crescent
