// Samplers that reach under the surface: right glass is left alone whatever its index and whichever way f scales by
// eta^2, glass that creates energy is wrong, and a half that is not judged is said not to be.
#include <cmath>
#include <gtest/gtest.h>

#include "judgements/told_last.h"
#include "check/print.h"
#include "check/user.h"

namespace crescent {
namespace {

struct Drawn {
    Vec3d wi;
    double pdf;
};

/// Rough dielectric, GGX with visible normals (Walter et al. 2007, equations 20, 21 and 17; Heitz 2018). Half of the
/// draws reflect.
struct Glass {
    double alpha = 0.3, eta = 1.5;  // index below over above
    bool radiance = true;           // f divided by eta^2 across the surface
    double lift = 1;                // of what is transmitted
    static double fresnel(double c, double eta) {
        const double t2 = 1 - (1 - c * c) / (eta * eta);
        if (t2 <= 0) return 1;
        const double t = std::sqrt(t2), s = (c - eta * t) / (c + eta * t), p = (eta * c - t) / (eta * c + t);
        return 0.5 * (s * s + p * p);
    }
    double D(Vec3d m) const {
        const double t = 1 + (alpha * alpha - 1) * m.z * m.z;
        return m.z > 0 ? alpha * alpha / (pi * t * t) : 0;
    }
    double G1(Vec3d w) const { return 2 / (1 + std::sqrt(1 + alpha * alpha * (1 - w.z * w.z) / (w.z * w.z))); }
    double visible(Vec3d wo, Vec3d m) const { return G1(wo) * D(m) * std::max(dot(wo, m), 0.0) / wo.z; }
    Vec3d half(Vec3d wo, Vec3d wi) const {
        const Vec3d m = normalize(wi.z > 0 ? wo + wi : wo + eta * wi);
        return m.z < 0 ? -1.0 * m : m;
    }
    /// |dm / dwi|; 0 where m does not lead from wo to wi.
    double jacobian(Vec3d wo, Vec3d wi, Vec3d m) const {
        const double o = dot(wo, m), i = dot(wi, m);
        if (wi.z > 0) return o > 0 ? 1 / (4 * o) : 0;
        return o > 0 && i < 0 ? eta * eta * -i / ((o + eta * i) * (o + eta * i)) : 0;
    }
    double pdf(Vec3d wo, Vec3d wi) const {
        if (wi.z == 0 || wo.z <= 0) return 0;
        const Vec3d m = half(wo, wi);
        const double p = 0.5 * visible(wo, m) * jacobian(wo, wi, m);
        return std::isfinite(p) ? p : 0;
    }
    double f(Vec3d wo, Vec3d wi) const {
        if (wi.z == 0 || wo.z <= 0) return 0;
        const Vec3d m = half(wo, wi);
        const double o = dot(wo, m), F = fresnel(o, eta),
                     common = D(m) * G1(wo) * G1(wi) * std::fabs(o) / (wo.z * std::fabs(wi.z)) * jacobian(wo, wi, m);
        const double value = wi.z > 0 ? F * common : lift * (1 - F) * common / (radiance ? eta * eta : 1);
        return std::isfinite(value) ? value : 0;
    }
    Drawn sample(Vec3d wo, Vec2d u) const {
        const bool reflects = u.x < 0.5;
        const double x = reflects ? 2 * u.x : 2 * u.x - 1;
        const Vec3d v = normalize(Vec3d{alpha * wo.x, alpha * wo.y, wo.z});
        const double across = v.x * v.x + v.y * v.y;
        const Vec3d t = across > 0 ? Vec3d{-v.y, v.x, 0} * (1 / std::sqrt(across)) : Vec3d{1, 0, 0};
        const Vec3d b{v.y * t.z - v.z * t.y, v.z * t.x - v.x * t.z, v.x * t.y - v.y * t.x};
        const double r = std::sqrt(x), phi = 2 * pi * u.y, p = r * std::cos(phi), s = 0.5 * (1 + v.z);
        const double q = (1 - s) * std::sqrt(1 - p * p) + s * r * std::sin(phi);
        const Vec3d h = t * p + b * q + v * std::sqrt(std::max(1 - p * p - q * q, 0.0));
        const Vec3d m = normalize(Vec3d{alpha * h.x, alpha * h.y, std::max(h.z, 1e-12)});
        const double c = dot(wo, m), k = 1 - (1 - c * c) / (eta * eta);
        if (!reflects && k <= 0) return {{0, 0, 1}, 0};
        const Vec3d wi = normalize(reflects ? m * (2 * c) - wo : m * (c / eta - std::sqrt(k)) - wo * (1 / eta));
        return {wi, (wi.z > 0) == reflects ? pdf(wo, wi) : 0};
    }
};

/// Lambert above and below the surface, each half drawn half the time.
struct Paper {
    double above = 0.4, below = 0.4;
    bool draws_below = true;
    double pdf(Vec3d, Vec3d wi) const { return draws_below ? 0.5 * std::fabs(wi.z) / pi : wi.z > 0 ? wi.z / pi : 0; }
    double f(Vec3d, Vec3d wi) const { return (wi.z > 0 ? above : below) / pi; }
    Drawn sample(Vec3d wo, Vec2d u) const {
        const bool under = draws_below && u.x >= 0.5;
        const double x = !draws_below ? u.x
            : under                   ? 2 * u.x - 1
                                      : 2 * u.x,
                     z = std::sqrt(1 - x), r = std::sqrt(x), phi = 2 * pi * u.y;
        const Vec3d wi{r * std::cos(phi), r * std::sin(phi), under ? -z : z};
        return {wi, pdf(wo, wi)};
    }
};

std::size_t count(const Judgement& j, std::string_view name, State state) {
    std::size_t n = 0;
    for (const Verdict& v : j.verdicts) n += v.name == name && v.state == state;
    return n;
}

TEST(Glass, RightGlassIsLeftAloneWhateverItsIndexAndScale) {
    for (const double eta : {1.5, 1 / 1.5})
        for (const bool radiance : {true, false}) {
            const Judgement j = judge_sampler("glass", Glass{0.3, eta, radiance, 1});
            EXPECT_NE(j.state, State::wrong) << eta << radiance << what_is_wrong(j);
            EXPECT_EQ(count(j, "support", State::right), 8u) << what_is_wrong(j);
            EXPECT_EQ(count(j, "physics", State::right), 8u) << what_is_wrong(j);
        }
}

TEST(Glass, EnergyFromNowhereUnderTheSurfaceIsWrong) {
    EXPECT_GT(count(judge_sampler("glass", Glass{0.3, 1.5, true, 5}), "physics", State::wrong), 0u);
    EXPECT_EQ(count(judge_sampler("paper", Paper{0.1, 5}), "physics", State::wrong), 8u);
    EXPECT_EQ(judge_sampler("paper", Paper{}).state, State::right) << what_is_wrong(judge_sampler("paper", Paper{}));
}

TEST(Glass, AHalfThatIsNotJudgedIsSaidNotToBe) {
    const Judgement j = judge_sampler("paper", Paper{0.4, 0.4, false});
    EXPECT_EQ(j.state, State::inconclusive);
    for (const char* name : {"support", "physics", "mean"}) EXPECT_EQ(count(j, name, State::inconclusive), 8u) << name;
    EXPECT_NE(what_is_wrong(j).find("of the upper half only"), std::string::npos);
}

/// The index is not told: right, and said to be half looked at. Told, the other side has to be answered for.
TEST(Glass, WhatWasNotLookedAtIsSaid) {
    TestSettings settings;
    settings.draws = 4096;
    settings.wo = {{45, 0}};
    const Judgement j = judge_sampler("glass", Glass{}, settings);
    EXPECT_NE(verdict_table(j).find("Not looked at: reciprocity across the surface"), std::string::npos)
        << verdict_table(j);
    EXPECT_NE(not_looked_at_told(j).find("eta="), std::string::npos) << not_looked_at_told(j);
    EXPECT_NE(verdict_html(j).find("Not looked at: reciprocity across the surface"), std::string::npos);
    struct Told : Glass {
        Traits traits() const {
            Traits t;
            t.eta = Vec3d{1.5, 1.5, 1.5};
            return t;
        }
    };
    EXPECT_NE(not_looked_at_told(judge_sampler("told", Told{}, settings)).find("wo=both"), std::string::npos);
    EXPECT_EQ(not_looked_at_told(judge_sampler("paper", Paper{0.4, 0, false}, settings)), "");
}

/// A weight that forgets what the lower half does is met there too.
TEST(Glass, APdfOfTheLowerHalfThatIsTwiceWhatIsDrawnIsWrong) {
    struct Doubled : Glass {
        double pdf(Vec3d wo, Vec3d wi) const { return (wi.z < 0 ? 2 : 1) * Glass::pdf(wo, wi); }
    };
    const Judgement j = judge_sampler("doubled", Doubled{});
    EXPECT_EQ(count(j, "identity", State::wrong), 8u) << verdict_table(j);
}

}  // namespace
}  // namespace crescent
