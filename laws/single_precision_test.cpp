// Right samplers that compute in single precision, where that shows: half vectors by their cosine, which rounds to 1
// over the middle of a sharp lobe and moves in steps around it; values of f that have few digits left. A fault is found
// in them all the same.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "laws/judged.h"
#include "laws/right/law.h"
#include "math/spherical.h"
#include "verdicts/summary.h"

namespace crescent {
namespace {

struct V {
    float x, y, z;
};
V narrow(Vec3d v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }
float inner(V a, V b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// GGX by D cos, all in float: the half vector by its cosine, its sine by sqrt(1 - cos^2).
struct FloatGgx {
    float alpha;
    float drawn_alpha;   // right where it is alpha
    float mirrored = 0;  // a share of the draws that goes to the mirror direction; right where it is 0

    Draw sample(Vec3d wo, const Numbers& u) const {
        const V o = narrow(wo);
        const float v = static_cast<float>(u[0]), phi = 6.2831853f * static_cast<float>(u[1]);
        float c = 1 / std::sqrt(1 + drawn_alpha * drawn_alpha * v / (1 - v));
        if (static_cast<float>(u[1]) < mirrored) c = 1;
        const float s = std::sqrt(std::max(0.0f, 1 - c * c));
        const V m = {s * std::cos(phi), s * std::sin(phi), c};
        const float d = 2 * inner(o, m);
        const V i = {d * m.x - o.x, d * m.y - o.y, d * m.z - o.z};
        if (!(d > 0) || !(i.z > 0)) return {{0, 0, 1}, 0};
        const Vec3d wi = {i.x, i.y, i.z};
        return {wi, pdf(wo, wi)};
    }
    double pdf(Vec3d wo, Vec3d wi) const {
        const V o = narrow(wo), i = narrow(wi);
        V m = {o.x + i.x, o.y + i.y, o.z + i.z};
        const float size = std::sqrt(inner(m, m));
        m = {m.x / size, m.y / size, m.z / size};
        if (!(o.z > 0) || !(i.z > 0) || !(inner(o, m) > 0)) return 0;
        const float sin2 = m.x * m.x + m.y * m.y, k = m.z * m.z * alpha * alpha + sin2;
        return static_cast<double>(alpha * alpha * m.z / (3.14159265f * k * k) / (4 * inner(o, m)));
    }
};

Recipe recipe_of(const FloatGgx& ggx) {
    Recipe r{"GGX in float", "", {}, {}, {}};
    r.sample = [ggx](Vec3d wo, const Numbers& u) { return ggx.sample(wo, u); };
    r.pdf = [ggx](Vec3d wo, Vec3d wi) { return ggx.pdf(wo, wi); };
    return r;
}

Judgement judged(const Recipe& r, double theta) { return judged_at(subject_of(r), theta, of_draws(32768)); }

TEST(SinglePrecision, OfASharpLobeIsNotAccused) {
    for (const float alpha : {0.005f, 0.01f, 0.03f})
        for (double theta : {0.0, 30.0, 60.0}) {
            const Judgement j = judged(recipe_of({alpha, alpha}), theta);
            EXPECT_NE(j.state, State::wrong) << alpha << " " << theta << "\n" << what_is_wrong(j);
            EXPECT_EQ(named(j, "density").state, State::right) << alpha << " " << theta << "\n" << what_is_wrong(j);
        }
}

TEST(SinglePrecision, OfASharpLobeHidesNoFault) {
    for (double theta : {0.0, 60.0}) {
        const Judgement wide = judged(recipe_of({0.01f, 0.011f}), theta);
        EXPECT_EQ(named(wide, "density").state, State::wrong) << theta << "\n" << what_is_wrong(wide);
        const Judgement atom = judged(recipe_of({0.01f, 0.01f, 0.05f}), theta);
        EXPECT_EQ(named(atom, "identity").state, State::wrong) << theta << "\n" << what_is_wrong(atom);
    }
}

/// f falls to 1e-43 and further, weights with it: one in float, the other not.
TEST(SinglePrecision, OfNumbersBelowItsRangeIsNoDifference) {
    Recipe r{"a velvet", "", {}, {}, {}};
    const auto f = [](Vec3d, Vec3d wi) {
        return static_cast<double>(static_cast<float>(0.1 * std::exp(-100 * (1 - wi.z))));
    };
    r.sample = [f](Vec3d wo, const Numbers& u) {
        Draw d{math::spherical(std::sqrt(1 - u[0] * u[0]), u[0], 2 * pi * u[1]), 1 / (2 * pi)};
        d.weight = static_cast<double>(static_cast<float>(f(wo, d.wi)) * static_cast<float>(d.wi.z / d.pdf));
        return d;
    };
    r.pdf = [](Vec3d, Vec3d wi) { return wi.z > 0 ? 1 / (2 * pi) : 0; };
    r.f = [f](Vec3d wo, Vec3d wi) { return wi.z > 0 ? f(wo, wi) : 0; };
    r.traits.reciprocal = false;
    const Judgement j = judged(r, 45);
    EXPECT_EQ(named(j, "identity").state, State::right) << what_is_wrong(j);
}

}  // namespace
}  // namespace crescent
