// Delta parts go where a smooth boundary or a thin wall lets them, and what goes straight on is no more than arrives.
// A phase function, told as f |cos|, is reciprocal by itself and held to no index.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "judgements/summary.h"
#include "laws/judged.h"
#include "laws/right/renderers.h"
#include "math/functions.h"
#include "math/spherical.h"
#include "simd/frame.h"
#include "subjects/list.h"
#include "verdicts/judge.h"

namespace crescent {
namespace {

Judgement judged(const Recipe& recipe, double theta) { return judged_at(subject_of(recipe), theta, of_draws(16384)); }

/// Smooth glass of 1.5 whose refracted direction is `bent`.
Recipe glass_towards(std::function<Vec3d(Vec3d wo, Vec3d wi)> bent, double weight_through = 0) {
    Recipe r = smooth_glass(1.5);
    r.sample = [sample = r.sample, bent, weight_through](Vec3d o, const Numbers& u) {
        Draw d = sample(o, u);
        if (d.wi.z * o.z > 0) return d;
        d.wi = bent(o, d.wi);
        if (weight_through > 0) d.weight = weight_through;
        return d;
    };
    return r;
}

Vec3d inverted(Vec3d o, Vec3d) {
    const double e = o.z > 0 ? 1 / 1.5 : 1.5, x = -o.x / e, y = -o.y / e;
    return {x, y, -std::copysign(std::sqrt(std::max(1 - x * x - y * y, 0.0)), o.z)};
}

TEST(SmoothParts, AreRefractedByTheIndexThatIsTold) {
    for (double theta : {0.0, 30.0, 60.0, 150.0, 175.0})
        EXPECT_EQ(judged(smooth_glass(1.5), theta).state, State::right) << theta;
    const Judgement wrong = judged(glass_towards(inverted), 30);
    const Verdict& v = named(wrong, "physics");
    EXPECT_EQ(v.state, State::wrong) << v.say;
    EXPECT_NE(v.say.find("refracts to"), std::string::npos) << v.say;
    EXPECT_EQ(v.evidence.value("diagnosis", ""), "1 / eta");
}

/// Each way leads back, and no energy is made: the boundary that refracts tells where it mirrors to. Not so where all
/// of the light is mirrored.
TEST(SmoothParts, AreMirroredByTheBoundaryThatRefracts) {
    for (double theta : {10.0, 30.0, 85.0, 150.0, 175.0}) {
        Recipe r = smooth_glass(1.5);
        r.sample = [sample = r.sample](Vec3d o, const Numbers& u) {
            Draw d = sample(o, u);
            if (d.wi.z * o.z > 0) d.wi = {o.x, -o.y, o.z};
            return d;
        };
        const Judgement turned = judged(r, theta);
        const Verdict& v = named(turned, "physics");
        EXPECT_EQ(v.state, State::wrong) << theta << v.say;
        EXPECT_NE(v.say.find("mirrors w_o to"), std::string::npos) << theta << v.say;
    }
}

/// Smooth glass of three indices, one for a channel: a third of what is not reflected is of each, and weighs in its
/// channel alone, by `scale`. Along the normal the three go one way.
Recipe dispersive_glass(double scale) {
    constexpr double eta[] = {1.45, 1.5, 1.6}, reflected = 0.1;
    Recipe r{"dispersive glass", "", {}, {}, {}};
    r.traits.numbers = 4;
    r.traits.channels = 3;
    r.traits.wo = Traits::Asked::both;
    r.traits.delta = true;
    r.traits.eta = Vec3d{eta[0], eta[1], eta[2]};
    r.pdf = [](Vec3d, Vec3d) { return 0.0; };
    r.f_channels = [](Vec3d, Vec3d) { return Vec3d{}; };
    r.sample = [=](Vec3d o, const Numbers& u) {
        const int channel = std::min(static_cast<int>(3 * u[2]), 2);
        const double e = o.z > 0 ? eta[channel] : 1 / eta[channel], rest = 1 - (1 - o.z * o.z) / (e * e);
        Draw d{{-o.x, -o.y, o.z}, 0};
        d.delta = reflected;
        d.weights = {1, 1, 1};
        if (u[3] >= reflected) {
            if (rest < 0) return Draw{{0, 0, 1}, 0, {}, {}};
            const double w = 3 * scale / (e * e);
            d.wi = {-o.x / e, -o.y / e, -std::copysign(std::sqrt(rest), o.z)};
            d.delta = (1 - reflected) / 3;
            d.weights = {channel == 0 ? w : 0, channel == 1 ? w : 0, channel == 2 ? w : 0};
        }
        d.weight = luminance(d.weights);
        return d;
    };
    return r;
}

TEST(SmoothParts, OfThreeIndicesAreThreeAlongTheNormalToo) {
    for (double theta : {0.0, 40.0, 160.0, 180.0}) {
        const Judgement j = judged(dispersive_glass(1), theta);
        EXPECT_EQ(j.state, State::right) << theta << what_is_wrong(j);
    }
    EXPECT_EQ(named(judged(dispersive_glass(1.02), 0), "physics").state, State::wrong);
}

TEST(SmoothParts, OfAThinWallGoStraightOnWhateverIndexIsTold) {
    const auto straight = [](Vec3d o, Vec3d) { return -o; };
    for (double theta : {0.0, 30.0, 60.0, 150.0, 180.0}) {
        const Judgement j = judged(glass_towards(straight, 1), theta);
        EXPECT_NE(j.state, State::wrong) << theta << what_is_wrong(j);
    }
}

TEST(SmoothParts, GoAnywhereWhereNoIndexIsTold) {
    Recipe r = glass_towards(inverted);
    r.traits.eta = {};
    EXPECT_NE(judged(r, 30).state, State::wrong);
}

/// Smooth glass that reflects nothing, the normal of its boundary `m`, bent by the index `drawn`, 1.5 being told.
Recipe passed_on(double drawn, Vec3d m) {
    Recipe r = smooth_glass(1.5);
    r.sample = [=](Vec3d o, const Numbers&) {
        const double e = dot(o, m) > 0 ? drawn : 1 / drawn, c = dot(o, m), rest = 1 - (1 - c * c) / (e * e);
        if (rest < 0) return Draw{{0, 0, 1}, 0, {}, {}};
        Draw d{m * (c / e - std::copysign(std::sqrt(rest), c)) - o * (1 / e), 0, {}, {}};
        d.delta = 1;
        d.weight = o.z > 0 ? 1 / (1.5 * 1.5) : 1.5 * 1.5;
        return d;
    };
    return r;
}

TEST(SmoothParts, AreRefractedByTheIndexThatIsToldWhereNothingIsMirrored) {
    for (double theta : {0.0, 30.0, 85.0, 150.0}) {
        EXPECT_EQ(judged(passed_on(1.5, {0, 0, 1}), theta).state, State::right) << theta;
        const Judgement askew = judged(passed_on(1.5, tilt(4, 130)), theta);
        EXPECT_NE(named(askew, "physics").state, State::wrong) << theta << what_is_wrong(askew);
    }
    const Judgement other = judged(passed_on(1.4, {0, 0, 1}), 30), turned = judged(passed_on(1 / 1.5, {0, 0, 1}), 30);
    EXPECT_EQ(named(other, "physics").state, State::wrong) << named(other, "physics").say;
    EXPECT_EQ(other.verdicts[5].evidence.value("diagnosis", "none"), "none");
    EXPECT_EQ(named(turned, "physics").evidence.value("diagnosis", ""), "1 / eta");
}

/// Half goes straight through with `open` of its light, half is reflected by Lambert of 0.5.
Recipe mask(double open) {
    Recipe r{"mask", "", {}, {}, {}};
    r.traits.numbers = 3;
    r.traits.wo = Traits::Asked::both;
    r.traits.delta = true;
    r.pdf = [](Vec3d o, Vec3d i) { return o.z * i.z > 0 ? 0.5 * std::fabs(i.z) / pi : 0; };
    r.f = [](Vec3d o, Vec3d i) { return o.z * i.z > 0 ? 0.5 / pi : 0; };
    r.sample = [open](Vec3d o, const Numbers& u) {
        const double z = std::sqrt(1 - u[0]);
        Draw d{math::spherical(std::sqrt(u[0]), std::copysign(z, o.z), 2 * pi * u[1]), 0.5 * z / pi};
        d.weight = 1;
        if (u[2] >= 0.5) return d;
        d = {-o, 0};
        d.delta = 0.5;
        d.weight = open / 0.5;
        return d;
    };
    return r;
}

TEST(SmoothParts, ThatGoStraightOnCarryNoMoreThanArrives) {
    for (double theta : {30.0, 150.0}) {
        EXPECT_EQ(judged(mask(0.5), theta).state, State::right) << what_is_wrong(judged(mask(0.5), theta));
        const Judgement bright = judged(mask(0.733), theta);
        EXPECT_EQ(named(bright, "physics").state, State::wrong) << named(bright, "physics").say;
        EXPECT_NE(named(bright, "physics").say.find("straight through"), std::string::npos);
    }
}

/// A mirror that turns y round for half of all w_o alone: no index is told, and f has nothing to say of it.
TEST(SmoothParts, SendLightBackTheWayItCame) {
    Recipe r{"mirror", "", {}, {}, {}};
    r.traits.delta = true;
    r.pdf = [](Vec3d, Vec3d) { return 0; };
    for (const bool whole : {true, false}) {
        r.sample = [whole](Vec3d o, const Numbers&) {
            Draw d{{-o.x, whole || o.x > 0 ? -o.y : o.y, o.z}, 0};
            d.delta = 1, d.weight = 0.9;
            return d;
        };
        const Judgement j = judged(r, 60);
        const Verdict& v = named(j, "physics");
        EXPECT_EQ(v.state, whole ? State::skipped : State::wrong) << v.say;
        EXPECT_EQ(v.say.find("never back") != std::string::npos, !whole) << v.say;
    }
}

/// Smooth glass that tints red from above and blue from below, and one that tints alike.
TEST(SmoothParts, CarryAsMuchLightEitherWay) {
    for (const bool alike : {true, false}) {
        Recipe r = smooth_glass(1.5);
        r.traits.channels = 3;
        r.f_channels = [](Vec3d, Vec3d) { return Vec3d{}; };
        r.sample = [alike, sample = r.sample](Vec3d o, const Numbers& u) {
            Draw d = sample(o, u);
            const double w = *d.weight;
            const Vec3d tint = alike || o.z > 0 ? Vec3d{0.9, 0.8, 0.6} : Vec3d{0.6, 0.8, 0.9};
            d.weights = d.wi.z * o.z > 0 ? Vec3d{w, w, w} : w * tint;
            d.weight = luminance(d.weights);
            return d;
        };
        for (double theta : {30.0, 150.0}) {
            const Judgement j = judged(r, theta);
            const Verdict& v = named(j, "physics");
            EXPECT_EQ(v.state == State::wrong, !alike) << v.say;
            EXPECT_EQ(v.say.find("the way back carries") != std::string::npos, !alike) << v.say;
        }
    }
}

/// A tenth of glass of 1.5 is holes. Along the normal glass refracts to where they let through.
TEST(SmoothParts, MayBeHolesInWhatRefracts) {
    Recipe r = smooth_glass(1.5);
    const int chooser = r.traits.numbers++;
    for (const double through : {1.0, 1.9}) {
        Recipe holes = r;
        holes.sample = [=, sample = r.sample](Vec3d o, const Numbers& u) {
            Draw d = sample(o, u);
            d.delta *= 0.9;
            if (u[chooser] >= 0.1) return d;
            d = {-o, 0};
            d.delta = 0.1;
            d.weight = through;
            return d;
        };
        for (const double theta : {0.0, 30.0, 150.0, 180.0})
            EXPECT_EQ(judged(holes, theta).state, through > 1 ? State::wrong : State::right)
                << theta << what_is_wrong(judged(holes, theta));
    }
}

/// Henyey & Greenstein 1941; drawn with g, p and f with their own.
Recipe phase(double drawn, double claimed, double scale, Traits::Asked wo = Traits::Asked::both) {
    Recipe r{"phase", "", {}, {}, {}};
    r.traits.wo = wo;
    const auto p = [](double g, Vec3d o, Vec3d i) {
        return (1 - g * g) / (4 * pi * math::pow(1 + g * g + 2 * g * dot(o, i), 1.5));
    };
    r.pdf = [=](Vec3d o, Vec3d i) { return p(claimed, o, i); };
    r.f = [=](Vec3d o, Vec3d i) { return i.z == 0 ? 0 : scale * p(claimed, o, i) / std::fabs(i.z); };
    r.sample = [=](Vec3d o, const Numbers& u) {
        const double s = (1 - drawn * drawn) / (1 - drawn + 2 * drawn * u[0]);
        const double c = std::clamp((1 + drawn * drawn - s * s) / (2 * drawn), -1.0, 1.0);
        Draw d{frame_about(-o).to_world(math::spherical(c, 2 * pi * u[1])), 0};
        d.pdf = p(claimed, o, d.wi);
        d.weight = scale;
        return d;
    };
    return r;
}

TEST(PhaseFunctions, AreReciprocalAsFTimesTheCosine) {
    for (double theta : {0.0, 60.0, 150.0})
        for (double g : {0.3, 0.75, -0.5}) {
            const Judgement j = judged(phase(g, g, 1), theta);
            EXPECT_EQ(j.state, State::right) << theta << " " << g << what_is_wrong(j);
            EXPECT_NE(named(j, "physics").say.find("as a phase function does"), std::string::npos);
        }
}

/// A renderer's adaptor may answer for w_o above the surface alone, of which a phase function has none.
TEST(PhaseFunctions, AreReciprocalWhereOnlyWoAboveIsAnsweredFor) {
    for (double theta : {0.0, 60.0, 85.0}) {
        const Judgement j = judged(phase(0.75, 0.75, 1, Traits::Asked::upper), theta);
        EXPECT_EQ(j.state, State::right) << theta << what_is_wrong(j);
        EXPECT_NE(named(j, "physics").say.find("as a phase function does"), std::string::npos);
    }
    const Judgement bright = judged(phase(0.6, 0.6, 1.05, Traits::Asked::upper), 60);
    EXPECT_EQ(named(bright, "physics").state, State::wrong) << named(bright, "physics").say;
}

TEST(PhaseFunctions, OfTheOtherSignOrThatIntegrateToMoreAreWrong) {
    EXPECT_EQ(named(judged(phase(0.6, -0.6, 1), 60), "density").state, State::wrong);
    const Judgement bright = judged(phase(0.6, 0.6, 1.05), 60);
    EXPECT_EQ(named(bright, "physics").state, State::wrong) << named(bright, "physics").say;
}

}  // namespace
}  // namespace crescent
