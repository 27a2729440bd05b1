// A cause that is not there is not named: faults whose ratio of what is drawn to pdf(w) varies little, or over few
// faces, are no constant.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "laws/judged.h"
#include "laws/planted/planted.h"
#include "laws/right/renderers.h"
#include "math/functions.h"
#include "math/spherical.h"
#include "simd/frame.h"
#include "subjects/list.h"
#include "verdicts/judge.h"

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

/// A rectangle drawn by area, with the cosine at the surface in place of the cosine at the light: it spreads by 6 %.
Recipe rectangle_with_the_wrong_cosine() {
    Recipe r{"rectangle", "", {}, {}, {}};
    const Frame<double> frame = frame_about(normalize(Vec3d{-0.3, 0.1, -1}));
    const Vec3d n = normalize(Vec3d{-0.3, 0.1, -1}), centre{0.8, -0.3, 2};
    constexpr double w = 1.2, h = 0.7;
    r.pdf = [=](Vec3d, Vec3d i) {
        const double across = dot(i, n), d = across < 0 ? dot(centre, n) / across : 0;
        const Vec3d q = i * d - centre;
        if (!(d > 0) || std::fabs(dot(q, frame.t)) > w / 2 || std::fabs(dot(q, frame.b)) > h / 2) return 0.0;
        return d * d / (w * h * std::fabs(i.z));
    };
    r.sample = [=, p = r.pdf](Vec3d o, const Numbers& u) {
        const Vec3d i = normalize(centre + frame.t * ((u[0] - 0.5) * w) + frame.b * ((u[1] - 0.5) * h));
        return Draw{i, p(o, i), {}, {}};
    };
    return r;
}

/// Henyey & Greenstein 1941, its pdf tilted by 1 % from one pole to the other.
Recipe tilted_phase() {
    Recipe r{"phase", "", {}, {}, {}};
    constexpr double g = 0.6;
    r.pdf = [](Vec3d o, Vec3d i) {
        const double c = -dot(o, i);
        return (1 + 0.01 * c) * (1 - g * g) / (4 * pi * math::pow(1 + g * g - 2 * g * c, 1.5));
    };
    r.sample = [p = r.pdf](Vec3d o, const Numbers& u) {
        const double s = (1 - g * g) / (1 - g + 2 * g * u[0]), c = (1 + g * g - s * s) / (2 * g);
        const Vec3d i = frame_about(-o).to_world(math::spherical(std::clamp(c, -1.0, 1.0), 2 * pi * u[1]));
        return Draw{i, p(o, i), {}, {}};
    };
    return r;
}

/// Sheen half vectors (Estevez & Kulla 2017) whose pdf has 1 + 0.02 n.m too much: near w_o = n that is all but
/// constant.
Recipe sheen_off_by_a_cosine() {
    Recipe r{"sheen", "", {}, {}, {}};
    constexpr double a = 0.3;
    r.pdf = [](Vec3d o, Vec3d i) {
        if (i.z <= 0) return 0.0;
        const Vec3d h = normalize(o + i);
        const double sin = std::sqrt(std::max(1 - h.z * h.z, 0.0));
        return (2 + 1 / a) * math::pow(sin, 1 / a) / (2 * pi) * h.z / (4 * dot(o, h)) * (1 + 0.02 * h.z);
    };
    r.sample = [p = r.pdf](Vec3d o, const Numbers& u) {
        const double sin = math::pow(u[0], a / (2 * a + 1));
        const Vec3d h = math::spherical(std::sqrt(std::max(1 - sin * sin, 0.0)), 2 * pi * u[1]);
        const Vec3d i = h * (2 * dot(o, h)) - o;
        if (dot(o, h) <= 0 || i.z <= 0) return Draw{{0, 0, 1}, 0, {}, {}};
        return Draw{i, p(o, i), {}, {}};
    };
    return r;
}

/// A cube drawn by area over its six faces, each direction reached by two of them; the pdf of one face is 2 % too high.
Recipe cube_with_one_face_off() {
    Recipe r{"cube", "", {}, {}, {}};
    r.traits.numbers = 3;
    const Vec3d centre{0.6, 0.4, 1.8};
    constexpr double h = 0.35;
    r.pdf = [=](Vec3d, Vec3d i) {
        const double at[3] = {centre.x, centre.y, centre.z}, along[3] = {i.x, i.y, i.z};
        double near = -1e9, far = 1e9;
        int entered = 0, left = 0;
        for (int k = 0; k < 3; ++k) {
            const auto [first, second] = std::minmax({(at[k] - h) / along[k], (at[k] + h) / along[k]});
            if (first > near) near = first, entered = k;
            if (second < far) far = second, left = k;
        }
        if (near >= far || far <= 0) return 0.0;
        constexpr double area = 24 * h * h;
        return (near * near / std::fabs(along[entered]) + far * far / std::fabs(along[left])) / area *
            (entered == 2 ? 1.02 : 1);
    };
    r.sample = [=, p = r.pdf](Vec3d o, const Numbers& u) {
        const int face = std::min(5, static_cast<int>(u[2] * 6)), k = face / 2;
        double q[3];
        q[k] = face & 1 ? h : -h;
        q[(k + 1) % 3] = (2 * u[0] - 1) * h;
        q[(k + 2) % 3] = (2 * u[1] - 1) * h;
        const Vec3d i = normalize(centre + Vec3d{q[0], q[1], q[2]});
        return Draw{i, p(o, i), {}, {}};
    };
    return r;
}

TEST(Diagnosis, NamesNoConstantWhereTheRatiosSpread) {
    const Said rectangle = first_said(judged(rectangle_with_the_wrong_cosine()));
    EXPECT_EQ(rectangle.diagnosis, "none") << rectangle.say;
    EXPECT_NE(rectangle.say.find("nine of ten directions"), std::string::npos) << rectangle.say;
    for (const auto& [recipe, theta] :
        {std::pair(tilted_phase(), 45.0), {sheen_off_by_a_cosine(), 1.0}, {cube_with_one_face_off(), 30.0}}) {
        const Said said = first_said(judged(recipe, theta));
        EXPECT_EQ(said.state, State::wrong) << recipe.family;
        EXPECT_EQ(said.diagnosis, "none") << recipe.family << ": " << said.say;
        EXPECT_NE(said.say.find("on average"), std::string::npos) << recipe.family << ": " << said.say;
    }
}

/// The cosine, of which one draw in ten is NaN and whose pdf is 1 % too low: below is nothing to be exchanged for.
TEST(Diagnosis, NamesNoSideThatIsNotThere) {
    Recipe r{"cosine", "", {}, {}, {}};
    r.pdf = [](Vec3d, Vec3d i) { return 0.99 * std::fabs(i.z) / pi * (i.z > 0); };
    r.sample = [p = r.pdf](Vec3d o, const Numbers& u) {
        const Vec3d i = math::spherical(std::sqrt(1 - u[0]), 2 * pi * u[1]);
        return Draw{u[1] < 0.1 ? Vec3d{std::nan(""), i.y, i.z} : i, p(o, i), {}, {}};
    };
    const Judgement j = judged(r, 45);
    ASSERT_EQ(j.verdicts[0].name, "valid");
    EXPECT_EQ(j.verdicts[0].state, State::wrong);
    EXPECT_NE(j.verdicts[0].say.find("%, cannot be used: they are NaN"), std::string::npos) << j.verdicts[0].say;
    for (const Verdict& v : j.verdicts) EXPECT_EQ(v.say.find("exchanged"), std::string::npos) << v.say;
}

TEST(Diagnosis, NamesTheChannelWhoseWeightIsOff) {
    Recipe r{"cosine in colour", "", {}, {}, {}};
    r.traits.channels = 3;
    r.pdf = [](Vec3d, Vec3d i) { return std::max(i.z, 0.0) / pi; };
    r.f_channels = [](Vec3d, Vec3d i) { return i.z > 0 ? Vec3d{0.8 / pi, 0.5 / pi, 0.1 / pi} : Vec3d{}; };
    r.sample = [](Vec3d, const Numbers& u) {
        const Vec3d i = math::spherical(std::sqrt(1 - u[0]), 2 * pi * u[1]);
        Draw d{i, i.z / pi, {}, {}};
        d.weights = {0.8, 0.5, 0.2};
        d.weight = luminance(d.weights);
        return d;
    };
    const Said said = first_said(judged(r, 45));
    EXPECT_EQ(said.diagnosis, "channel 3") << said.say;
    EXPECT_NE(said.say.find("the weight of channel 3 is f cos / p times a constant 2"), std::string::npos) << said.say;
}

/// Factors by name, and constants by theirs, of one cause each.
TEST(Diagnosis, NamesCausesInWordsThatReadOneWay) {
    for (const bool over : {false, true}) {
        Recipe r{"cosine", "", {}, {}, {}};
        r.pdf = [over](Vec3d o, Vec3d i) { return i.z > 0 ? i.z / pi * (over ? 1 / o.z : o.z) : 0; };
        r.sample = [p = r.pdf](Vec3d o, const Numbers& u) {
            const Vec3d i = math::spherical(std::sqrt(1 - u[0]), 2 * pi * u[1]);
            return Draw{i, p(o, i), {}, {}};
        };
        const Said said = first_said(judged(r, 40));
        EXPECT_NE(said.say.find(over ? " = cos theta_o." : " = 1/(cos theta_o)."), std::string::npos) << said.say;
    }
    RoughGlass glass{0.2, 1.5};
    Recipe r = recipe_of(glass);
    r.pdf = [glass](Vec3d o, Vec3d i) {
        const Vec3d m = glass.half(o, i);
        return glass.pdf(o, i) * (glass.across(o, i) ? std::fabs(dot(o, m) / dot(i, m)) : 1);
    };
    r.sample = [glass, p = r.pdf](Vec3d o, const Numbers& u) {
        Draw d = glass.sample(o, u);
        if (d.pdf > 0) d.pdf = p(o, d.wi);
        return d;
    };
    EXPECT_EQ(first_said(judged(r, 60)).diagnosis, "(w_i.m) / (w_o.m) across the surface");
}

/// At the normal next to nothing is reflected, and what is refracted is off by eta^2 all the same.
TEST(Diagnosis, NamesWhatIsOffAcrossTheSurfaceWhereHardlyADrawIsReflected) {
    RoughGlass glass{0.2, 1.33};
    Recipe r = recipe_of(glass);
    const auto eta2 = [](Vec3d o) { return o.z > 0 ? 1.33 * 1.33 : 1 / (1.33 * 1.33); };
    r.pdf = [=](Vec3d o, Vec3d i) { return glass.pdf(o, i) / (glass.across(o, i) ? eta2(o) : 1); };
    r.sample = [glass, p = r.pdf](Vec3d o, const Numbers& u) {
        Draw d = glass.sample(o, u);
        if (d.pdf > 0) d.pdf = p(o, d.wi);
        return d;
    };
    for (double theta : {0.0, 60.0, 180.0}) {
        const Said said = first_said(judged(r, theta));
        EXPECT_EQ(said.diagnosis, "eta^2 across the surface") << theta << ": " << said.say;
    }
}

/// An alias table sends several u to one direction, so that bins alone tell; of a sky they name the sine by its
/// constant.
TEST(Diagnosis, NamesTheSineThatAnAliasTableLeavesOut) {
    Dice dice(5);
    const std::shared_ptr<const Sky> sky = sky_with_sun(dice, 64, 128, 0.3, true);
    for (const double constant : {1.0, pi / 2}) {
        Recipe r = recipe_of(sky);
        r.pdf = [=](Vec3d, Vec3d i) { return constant * sky->pdf(i) * std::sqrt(std::max(1 - i.z * i.z, 0.0)); };
        r.sample = [sky, p = r.pdf](Vec3d o, const Numbers& u) {
            Draw d = sky->sample(u);
            d.pdf = p(o, d.wi);
            return d;
        };
        const Said said = first_said(judged(r));
        EXPECT_EQ(said.diagnosis, "1 / (sin theta_i)") << said.say;
        EXPECT_EQ(said.say.find("= 2/pi") == std::string::npos, constant == 1) << said.say;
    }
}

/// A fibre along x, its lobe exponential in x and logistic about it, whose pdf has the cosine about its own axis too
/// much: that is nearly 1 / cos theta_i with a constant, which is not the cause.
TEST(Diagnosis, NamesNoFactorByBinsWhoseConstantNobodyKnows) {
    Recipe r{"fibre", "", {}, {}, {}};
    r.traits.numbers = 3;
    r.traits.wo = Traits::Asked::both;
    constexpr double v = 0.01, width = 0.15;
    const double trim = std::tanh(pi / (2 * width));
    const auto angle_of = [](Vec3d w) { return math::atan2(w.z, w.y); };
    r.pdf = [=](Vec3d o, Vec3d i) {
        const double along = std::copysign(i.x, -o.x * i.x), phi = angle_of(i) - angle_of(o) - pi;
        const double e = math::exp(-std::fabs(phi - 2 * pi * std::round(phi / (2 * pi))) / width);
        return math::exp((along - 1) / v) / (v * -math::expm1(-2 / v)) * e / (width * sqr(1 + e)) / trim *
            std::sqrt(std::max(1 - i.x * i.x, 0.0));
    };
    r.sample = [=, p = r.pdf](Vec3d o, const Numbers& u) {
        const double x = 1 + v * math::log(u[0] + (1 - u[0]) * math::exp(-2 / v)), y = 0.5 * (1 - trim) + u[1] * trim;
        const double phi = angle_of(o) + pi + width * math::log(y / (1 - y)), c = std::sqrt(std::max(1 - x * x, 0.0));
        const Vec3d i{std::copysign(x, -o.x), c * math::cos(phi), c * math::sin(phi)};
        return Draw{i, p(o, i), {}, {}};
    };
    const Said said = first_said(judged(r, 89));
    EXPECT_EQ(said.state, State::wrong) << said.say;
    EXPECT_EQ(said.diagnosis, "none") << said.say;
}

/// Two u reach each direction, so that no point of the warp speaks; along sectors the ratio goes up and down by a
/// tenth, which is lost among all bins.
TEST(Diagnosis, NamesNoConstantWhereSectorsDiffer) {
    for (const double uneven : {0.0, 0.1}) {
        Recipe r{"cosine", "", {}, {}, {}};
        r.traits.numbers = 3;
        r.pdf = [=](Vec3d, Vec3d i) {
            const double sin = std::max(math::hypot(i.x, i.y), 1e-9);
            return i.z > 0 ? 2 * i.z / pi * (1 + uneven * i.x / sin) : 0;
        };
        r.sample = [p = r.pdf](Vec3d o, const Numbers& u) {
            const double turn = u[2] < 0.5 ? 0 : pi;
            const Vec3d i = math::spherical(std::sqrt(1 - u[0]), 2 * pi * u[1] + turn);
            return Draw{i, p(o, i), {}, {}};
        };
        const Said said = first_said(judged(r, 45));
        EXPECT_EQ(said.diagnosis, uneven > 0 ? "none" : "a constant") << said.say;
    }
}

/// A pdf with a bump of 3 % about one direction, which the rest makes up for by one per mille: no turn of w_o, on which
/// it does not depend, explains it.
TEST(Diagnosis, NamesNoTurnThatLeavesThePdfAsItIs) {
    Recipe r{"cosine", "", {}, {}, {}};
    r.pdf = [](Vec3d, Vec3d i) {
        const double c = dot(i, tilt(40, 20)), near = std::clamp((c - std::cos(0.3)) / (1 - std::cos(0.3)), 0.0, 1.0);
        return std::max(i.z, 0.0) / pi * (1 + 0.03 * sqr(near) * (3 - 2 * near)) * 0.9988;
    };
    r.sample = [p = r.pdf](Vec3d o, const Numbers& u) {
        const Vec3d i = math::spherical(std::sqrt(1 - u[0]), 2 * pi * u[1]);
        return Draw{i, p(o, i), {}, {}};
    };
    const Said said = first_said(judged(r, 45));
    EXPECT_EQ(said.state, State::wrong) << said.say;
    EXPECT_EQ(said.diagnosis, "none") << said.say;
}

}  // namespace
}  // namespace crescent
