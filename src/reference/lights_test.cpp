// The kinds of light that are no disks: their sampling by itself, and films under them against the quadrature.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "estimator/estimator.h"
#include "reference/reference.h"
#include "estimator/test_scene.h"
#include "simd/frame.h"

namespace crescent::inline reference {
namespace {

/// A light as the point x sees it, n = +z.
template <class Kind> LocalLight<double> local(const Kind& kind, Vec3d x) {
    const LightNumbers n = kind.numbers(x, frame_about(Vec3d{0, 0, 1}));
    return {0, 1, n.a, n.b, n.c, n.number};
}

struct Techniques {
    double share = 0, share_error = 0;  // mean density by solid angle over that by area, of points by area: 1
    double worst_pdf = 0;               // what sample and pdf say of the same direction, relative
    int missed = 0;                     // directions that do not meet the light
};

template <class Kind> Techniques try_out(const Kind& kind, Vec3d x) {
    const LocalLight<double> light = local(kind, x);
    std::mt19937 next(7);
    std::uniform_real_distribution<double> u(0, 1);
    Techniques out;
    constexpr int n = 20'000;
    double t;
    for (int k = 0; k < n; ++k) {
        const Aimed<double> area = Kind::by_area(light, Vec2<double>{u(next), u(next)});
        const Aimed<double> angle = Kind::by_angle(light, Vec2<double>{u(next), u(next)});
        if (!Kind::meets(light, area.wi, t) || !Kind::meets(light, angle.wi, t)) {
            ++out.missed;
            continue;
        }
        const double share = Kind::angle_pdf(light, area.wi) / area.pdf;
        out.share += share / n, out.share_error += share * share / n;
        const double a = std::fabs(Kind::area_pdf(light, area.wi) / area.pdf - 1),
                     b = std::fabs(Kind::angle_pdf(light, angle.wi) / angle.pdf - 1);
        out.worst_pdf = std::max({out.worst_pdf, b, area.pdf < 1e6 ? a : 0.0});
    }
    out.share_error = std::sqrt((out.share_error - sqr(out.share)) / n);
    return out;
}

template <class Kind> void expect_sound(const Kind& kind, Vec3d x) {
    const Techniques t = try_out(kind, x);
    EXPECT_LT(t.missed, 20) << Kind::name;  // at the very edge
    EXPECT_LT(t.worst_pdf, 1e-5) << Kind::name;
    EXPECT_NEAR(t.share, 1, 4 * t.share_error + 1e-3) << Kind::name;
}

TEST(LightKinds, AreAimedAtWithTheDensityTheyState) {
    for_each_lamp([]<class Kind>() {
        for (const Vec3d x : {Vec3d{0, 0, 0}, {0.5, -0.3, 0.1}, {-2, -1, 0}}) expect_sound(Kind::example(), x);
    });
    for (const double radius : {1e-3, 0.1, 0.9}) expect_sound(lights::Sphere{{0.2, -0.3, 1.2}, radius}, {0, 0, 0});
    for (const double size : {0.02, 0.3, 2.0, 30.0})
        for (const Vec3d off : {Vec3d{0, 0, 1}, {3, 0.4, 0.5}, {-0.2, 0.1, -0.6}})
            expect_sound(
                lights::Rectangle{off - Vec3d{size / 2, size / 4, 0}, {size, 0, 0}, {0, size / 2, 0}, true}, {0, 0, 0});
}

/// Urena, Fajardo & King 2013: equal parts of u1 are equal solid angles, whichever part of the rectangle they cover.
TEST(LightKinds, ARectangleIsDrawnEvenlyBySolidAngle) {
    const lights::Rectangle wide = {{-1, -0.5, 0.4}, {3, 0, 0}, {0, 1.5, 0}, true};
    const LocalLight<double> whole = local(wide, {0, 0, 0});
    for (const double u : {0.1, 0.35, 0.5, 0.8}) {
        const Aimed<double> at = lights::Rectangle::by_angle(whole, Vec2<double>{u, 0.5});
        lights::Rectangle part = wide;
        part.edge_u.x = at.wi.x / at.wi.z * 0.4 + 1;
        EXPECT_NEAR(local(part, {0, 0, 0}).number[2] / whole.number[2], u, 1e-6) << u;
    }
    // The solid angle itself: a square seen from the centre of the cube on it is a sixth of all.
    const lights::Rectangle side = {{-1, -1, 1}, {2, 0, 0}, {0, 2, 0}, true};
    EXPECT_NEAR(local(side, {0, 0, 0}).number[2], 4 * pi / 6, 1e-12);
}

/// The test scene under a ball and a rectangle besides a disk.
Experiment lit_by_all_kinds(const Rgb& fill) {
    Experiment e = test::small_scene();
    e.image = {48, 32}, e.fill = fill;
    e.disks.resize(1);
    e.lights.push_back({"bulb", lights::Sphere{{1.4, 1.6, 1.2}, 0.25}, {12, 10, 8}, {}});
    e.lights.push_back(
        {"window", lights::Rectangle{{-0.6, 2.6, -0.4}, {1.2, 0, 0}, {0, 0, 0.8}, false}, {6, 7, 9}, {}});
    return e;
}

void expect_the_reference(const Experiment& e, const std::vector<const char*>& arms, std::uint64_t n) {
    const Scene scene(e);
    ProgressMonitor monitor;
    const ReferenceFilm reference = quadrature_reference(scene, {e.s()}, monitor)[0];
    for (const char* arm : arms) {
        const Film film = estimate_films(scene, arm, {n}, 17, "", monitor)[0];
        EXPECT_EQ(film.invalid, 0u) << arm;
        double difference = 0, variance = 0, all = 0, stated = 0;
        for (std::size_t at = 0; at < film.size(); ++at) {
            difference += static_cast<double>(film.y[at]) - static_cast<double>(reference.y[at]);
            variance += static_cast<double>(film.var[at]);
            all += static_cast<double>(reference.y[at]), stated += static_cast<double>(reference.error[at]);
        }
        EXPECT_LT(std::fabs(difference), 4 * std::sqrt(variance) + stated + 1e-5 * all) << arm << " of " << all;
    }
}

TEST(LightKinds, EveryArmMeetsTheQuadratureUnderAllOfThem) {
    expect_the_reference(
        lit_by_all_kinds({0.5, 0.6, 0.7}), {"uniform", "cosine", "mixture", "mis-balance", "mis-power"}, 256);
    expect_the_reference(lit_by_all_kinds({0, 0, 0}), {"light-area", "light-solid-angle", "mis-balance"}, 256);
}

TEST(LightKinds, GiveTheSameFilmsOnEveryInstructionSet) {
    const Scene scene(lit_by_all_kinds({0.1, 0.2, 0.3}));
    ProgressMonitor monitor;
    for (const char* arm : {"cosine", "light-area", "light-solid-angle", "mis-power"}) {
        const std::string scalar = hash(estimate_films(scene, arm, {16}, 5, "scalar", monitor)[0]);
        for (const std::string& isa : isas())
            EXPECT_EQ(hash(estimate_films(scene, arm, {16}, 5, isa, monitor)[0]), scalar) << arm << " " << isa;
    }
}

TEST(LightKinds, StandBeforeOneAnother) {
    Experiment e = lit_by_all_kinds({0, 0, 0});
    e.disks[0].center = {0, 3.5, 0}, e.disks[0].normal = {0, -1, 0}, e.disks[0].radius = 0.5;  // over the window
    expect_the_reference(e, {"light-area", "light-solid-angle"}, 256);
}

}  // namespace
}  // namespace crescent::inline reference
