// A root that is missing in sample, or taken once too often, is named with its number.
#include "check/explain/warps.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/explained.h"

namespace crescent::check {
namespace warps_test {

/// A point of the unit disk lifted to the hemisphere: cos / pi if the radius is sqrt(u).
Vec3d lifted(double r, double u) {
    const math::SinCos phi = math::sincos(two_pi * u);
    return {r * phi.cos, r * phi.sin, std::sqrt(std::max(1 - r * r, 0.0))};
}

TEST(RootsOfNumbers, AMissingOneOfARadiusIsNamed) {
    const Explained r = explained(
        made([](Vec3d, const PrimarySample& u) { return lifted(u[0], u[1]); }, cosine_pdf), {{40, 30}, {70, 0}});
    expect_cause(r, "root");
    EXPECT_NE(r.text().find("sqrt(u1) in place of u1"), std::string::npos) << r.text();
}

TEST(RootsOfNumbers, AMissingOneOfABarycentricIsNamed) {
    const Vec3d a{1, 0.2, 1.2}, b{-0.6, 0.9, 1}, c{-0.3, -0.9, 1.6};
    const Vec3d across = cross(b - a, c - a), n = across * (1 / length(across));
    const auto draw = [=](Vec3d, const PrimarySample& u) {
        const Vec3d x = a * (1 - u[0]) + b * (u[0] * (1 - u[1])) + c * (u[0] * u[1]);
        return x * (1 / length(x));
    };
    const auto density = [=, area = length(across) / 2](Vec3d, Vec3d w) {
        const double cosine = dot(w, n), t = dot(a, n) / (std::fabs(cosine) > 1e-9 ? cosine : 1e-9);
        const Vec3d x = w * t;
        const auto inside = [&](Vec3d p, Vec3d q) { return dot(cross(q - p, x - p), n) >= 0; };
        return t > 0 && inside(a, b) && inside(b, c) && inside(c, a) ? t * t / (area * std::fabs(cosine)) : 0;
    };
    const Explained r = explained(made(draw, density, 2, Traits::WoDomain::none));
    expect_cause(r, "root");
    EXPECT_NE(r.text().find("sqrt(u1)"), std::string::npos) << r.text();
}

TEST(RootsOfNumbers, OneTooManyIsNamed) {
    const auto draw = [](Vec3d, const PrimarySample& u) { return lifted(std::sqrt(std::sqrt(u[0])), u[1]); };
    const Explained r = explained(made(draw, cosine_pdf));
    expect_cause(r, "root");
    EXPECT_NE(r.text().find("u1^2 in place of u1"), std::string::npos) << r.text();
}

}  // namespace warps_test
}  // namespace crescent::check
