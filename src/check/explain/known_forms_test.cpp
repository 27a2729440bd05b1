// Distance and cosine at a light in a plane, and the shadowing of the other direction.
#include "check/explain/known_forms.h"

#include <gtest/gtest.h>

#include <cmath>

#include "math/simd/frame.h"
#include "tests/support/explained.h"

namespace crescent::check {
namespace known_forms_test {

/// A disk light, sampled by area; p lacks r^2 or is multiplied by a power of the cosine.
Explained disk_light(int power_of_distance, int power_of_cosine) {
    const Vec3d center{0.3, 0.2, 1.5}, n = Vec3d{-0.3, -0.2, 1} * (1 / std::sqrt(1.13));
    constexpr double radius = 0.8;
    const auto draw = [=](Vec3d, const PrimarySample& u) {
        const Frame<double> frame = frame_about(n);
        const math::SinCos phi = math::sincos(two_pi * u[1]);
        const double r = radius * std::sqrt(u[0]);
        const Vec3d x = center + frame.t * (r * phi.cos) + frame.b * (r * phi.sin);
        return x * (1 / length(x));
    };
    const auto density = [=](Vec3d, Vec3d w) {
        const double c = dot(w, n), t = c > 0 ? dot(center, n) / c : 0;
        const Vec3d from = w * t - center;
        if (!(t > 0) || dot(from, from) > radius * radius) return 0.0;
        return std::pow(t, power_of_distance) * std::pow(c, power_of_cosine) / (pi * radius * radius);
    };
    return explained(made(draw, density, 2, Traits::WoDomain::none));
}

TEST(LightsInAPlane, MissingFactorsAreNamed) {
    EXPECT_FALSE(disk_light(2, -1).wrong());
    const Explained cosine = disk_light(2, 0), distance = disk_light(0, -1), area = disk_light(0, 0);
    for (const Explained* r : {&cosine, &distance, &area}) expect_cause(*r, "light in a plane");
    EXPECT_NE(cosine.text().find("the cosine at the light is missing"), std::string::npos) << cosine.text();
    EXPECT_NE(distance.text().find("the squared distance to the light, r^2, is missing"), std::string::npos);
    EXPECT_NE(area.text().find("a density per area"), std::string::npos);
}

TEST(LightsInAPlane, APowerOfTheCosineIsSaidAsAFactor) {
    EXPECT_NE(plane_words(3).find("a density per area"), std::string::npos);
    EXPECT_NE(plane_words(-1).find("once too often"), std::string::npos);
    EXPECT_EQ(plane_words(0.5), "");
}

/// Smith's G1 of GGX for one roughness.
double shadowing(Vec3d w, double alpha) {
    return 2 / (1 + std::sqrt(1 + alpha * alpha * (w.x * w.x + w.y * w.y) / (w.z * w.z)));
}

/// Visible normals of GGX: Heitz 2018.
Vec3d visible_normal_draw(Vec3d o, double alpha, const PrimarySample& u) {
    const Vec3d stretched{alpha * o.x, alpha * o.y, o.z}, v = stretched * (1 / length(stretched));
    const double across = std::sqrt(v.x * v.x + v.y * v.y);
    const Vec3d t = across > 0 ? Vec3d{-v.y / across, v.x / across, 0} : Vec3d{1, 0, 0}, b = cross(v, t);
    const math::SinCos phi = math::sincos(two_pi * u[1]);
    const double r = std::sqrt(u[0]), x = r * phi.cos, s = (1 + v.z) / 2;
    const double y = (1 - s) * std::sqrt(1 - x * x) + s * r * phi.sin;
    const Vec3d n = t * x + b * y + v * std::sqrt(std::max(0.0, 1 - x * x - y * y));
    const Vec3d back{alpha * n.x, alpha * n.y, n.z}, m = back * (1 / length(back));
    return m * (2 * dot(o, m)) - o;
}

TEST(Shadowing, OfTheOtherDirectionIsNamedWithItsRoughness) {
    constexpr double alpha = 0.4;
    for (const bool other : {false, true}) {
        const auto density = [other](Vec3d o, Vec3d w) {
            if (!(w.z > 0)) return 0.0;
            const Vec3d sum = o + w, m = sum * (1 / length(sum));
            const double d = sqr(alpha) / (pi * sqr(1 + (sqr(alpha) - 1) * sqr(m.z)));
            return shadowing(other ? w : o, alpha) * d / (4 * o.z);
        };
        const Explained r =
            explained(made([](Vec3d o, const PrimarySample& u) { return visible_normal_draw(o, alpha, u); }, density),
                {{30, 20}, {60, 200}});
        EXPECT_EQ(r.wrong(), other);
        if (!other) continue;
        expect_cause(r, "G1");
        EXPECT_NEAR(r.cause ? r.cause->exponent : 0, alpha, 0.01) << r.text();
    }
}

}  // namespace known_forms_test
}  // namespace crescent::check
