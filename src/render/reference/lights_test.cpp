// Lights other than disks: their sampling alone, and films under them against the quadrature.
#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "math/simd/frame.h"
#include "render/estimator.h"
#include "render/reference/reference.h"
#include "tests/support/oracle.h"
#include "tests/support/test_scene.h"

namespace crescent {
namespace lights_test {

/// Returns a light as the point x sees it, n = +z.
template <class Kind> LocalLight<double> local(const Kind& kind, Vec3d x) {
    const LightNumbers n = kind.numbers(x, frame_about(Vec3d{0, 0, 1}));
    return {0, 1, n.a, n.b, n.c, n.number};
}

struct Techniques {
    double share = 0, share_error = 0;  // mean over points by area of the density by solid angle over that by area:
                                        // expected 1
    double worst_pdf = 0;               // relative difference between sample and pdf for the same direction
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
        out.share += share / n;
        out.share_error += share * share / n;
        const double a = std::fabs(Kind::area_pdf(light, area.wi) / area.pdf - 1),
                     b = std::fabs(Kind::angle_pdf(light, angle.wi) / angle.pdf - 1);
        out.worst_pdf = std::max({out.worst_pdf, b, area.pdf < 1e6 ? a : 0.0});
    }
    out.share_error = std::sqrt((out.share_error - sqr(out.share)) / n);
    return out;
}

template <class Kind> void expect_sound(const Kind& kind, Vec3d x) {
    const Techniques t = try_out(kind, x);
    EXPECT_LT(t.missed, 20) << Kind::name;  // only at the very edge
    EXPECT_LT(t.worst_pdf, 1e-5) << Kind::name;
    EXPECT_NEAR(t.share, 1, 4 * t.share_error + 1e-3) << Kind::name;
}

TEST(LightKinds, AreAimedAtWithTheDensityTheyState) {
    for_each_area_light([]<class Kind>() {
        for (const Vec3d x : {Vec3d{0, 0, 0}, {0.5, -0.3, 0.1}, {-2, -1, 0}}) expect_sound(Kind::example(), x);
    });
    for (const double radius : {1e-3, 0.1, 0.9}) expect_sound(lights::Sphere{{0.2, -0.3, 1.2}, radius}, {0, 0, 0});
    for (const double size : {0.02, 0.3, 2.0, 30.0})
        for (const Vec3d off : {Vec3d{0, 0, 1}, {3, 0.4, 0.5}, {-0.2, 0.1, -0.6}})
            expect_sound(
                lights::Rectangle{off - Vec3d{size / 2, size / 4, 0}, {size, 0, 0}, {0, size / 2, 0}, true}, {0, 0, 0});
}

/// Urena, Fajardo & King 2013: equal parts of u1 are equal solid angles, for any part of the rectangle.
TEST(LightKinds, ARectangleIsDrawnEvenlyBySolidAngle) {
    const lights::Rectangle wide = {{-1, -0.5, 0.4}, {3, 0, 0}, {0, 1.5, 0}, true};
    const LocalLight<double> whole = local(wide, {0, 0, 0});
    for (const double u : {0.1, 0.35, 0.5, 0.8}) {
        const Aimed<double> at = lights::Rectangle::by_angle(whole, Vec2<double>{u, 0.5});
        lights::Rectangle part = wide;
        part.edge_u.x = at.wi.x / at.wi.z * 0.4 + 1;
        EXPECT_NEAR(local(part, {0, 0, 0}).number[2] / whole.number[2], u, 1e-6) << u;
    }
    // The solid angle itself: a face of a cube seen from the cube's centre is a sixth of the sphere.
    const lights::Rectangle side = {{-1, -1, 1}, {2, 0, 0}, {0, 2, 0}, true};
    EXPECT_NEAR(local(side, {0, 0, 0}).number[2], 4 * pi / 6, 1e-12);
}

/// Returns the test scene with a sphere, a rectangle and a disk light.
Experiment lit_by_all_kinds(const Rgb& fill) {
    Experiment e = test::small_scene();
    e.image = {48, 32};
    e.fill = fill;
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
            all += static_cast<double>(reference.y[at]);
            stated += static_cast<double>(reference.error[at]);
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
    e.disks[0].center = {0, 3.5, 0};
    e.disks[0].normal = {0, -1, 0};
    e.disks[0].radius = 0.5;  // over the window
    expect_the_reference(e, {"light-area", "light-solid-angle"}, 256);
}

}  // namespace lights_test

// ---- Lights down to the smallest size, and scenes as far from (0, 0, 0), as the schema permits: the mean of every
// unbiased sampler there agrees with the reference within both uncertainties.

namespace lights_test {

/// Returns the test scene without fill, with area lights of another size, moved by an offset.
Experiment area_lights(double radius, double offset, const std::vector<std::string>& overrides = {}) {
    Experiment e = test::small_scene(overrides);
    e.image = {32, 22};
    e.fill = {};
    for (DiskLight& disk : e.disks) disk.radius = radius;
    e.disks[0].center = {-1.5, 3.5, 1.0};
    e.disks[1].center = {3, 3, 2};  // an area light of 1 m clears ball, block and ground
    test::shift(e, {offset, -0.5 * offset, offset / 3});
    return e;
}

/// Films are in single precision, with sums of 16 samples: 1e-6 of each pixel.
constexpr double film_error = 1e-6;

void expect_mean(const Scene& scene, const ReferenceFilm& reference, const std::string& arm, std::uint64_t n,
    const std::string& what) {
    ProgressMonitor monitor;
    const Film film = estimate_films(scene, arm, {n}, 17, "", monitor)[0];
    double difference = 0, variance = 0, stated = 0;
    for (std::size_t at = 0; at < film.size(); ++at) {
        difference += static_cast<double>(film.y[at]) - static_cast<double>(reference.y[at]);
        variance += static_cast<double>(film.var[at]);
        stated += static_cast<double>(reference.error[at]) + film_error * static_cast<double>(reference.y[at]);
    }
    EXPECT_LE(std::fabs(difference), 5 * std::sqrt(variance) + stated) << arm << ", " << what;
    EXPECT_EQ(film.invalid, 0u) << arm << ", " << what;
}

void expect_means(const Experiment& e, const std::vector<std::string>& arms, std::uint64_t n, const std::string& what) {
    const Scene scene(e);
    ProgressMonitor monitor;
    const ReferenceFilm reference = quadrature_reference(scene, {e.s()}, monitor)[0];
    for (const std::string& arm : arms) expect_mean(scene, reference, arm, n, what);
}

const std::vector<std::string> aiming = {"light-area", "light-solid-angle", "mis-balance", "mis-power"};
const std::vector<std::string> reaching = {"uniform", "cosine", "mixture"};  // these meet a small area light too rarely

class AreaLightAgreement : public testing::TestWithParam<double> {};

TEST_P(AreaLightAgreement, UnbiasedArmsMatchTheReferenceAnywhere) {
    const double radius = GetParam();
    for (const double offset : {0.0, 1e3, 1e5, 1e6}) {
        const std::string what = "radius " + std::to_string(radius) + " m, moved by " + std::to_string(offset) + " m";
        const Experiment e = area_lights(radius, offset);
        expect_means(e, aiming, 256, what);
        if (radius >= 0.1) expect_means(e, reaching, 1024, what);
    }
}

INSTANTIATE_TEST_SUITE_P(Radii, AreaLightAgreement, testing::Values(1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6));

TEST(AreaLights, TheirSizeChangesNoMoreThanTheirLight) {
    const auto irradiance = [](double radius, const std::string& arm) {  // per area of the area light
        const Scene scene(area_lights(radius, 0));
        ProgressMonitor monitor;
        const Film film = estimate_films(scene, arm, {64}, 3, "", monitor)[0];
        double sum = 0;
        for (const float y : film.y) sum += static_cast<double>(y);
        return sum / sqr(radius);
    };
    for (const std::string& arm : aiming) EXPECT_NEAR(irradiance(1e-6, arm) / irradiance(1e-4, arm), 1, 1e-5) << arm;
}

TEST(AreaLights, SixtyFourAreAllCounted) {
    Experiment e = area_lights(0.05, 0);
    e.disks.resize(1);
    e.disks[0].radius = 0.05;
    e.disks[0].normal = {0, -1, 0};
    for (int k = 1; k < 64; ++k) {
        DiskLight disk = e.disks[0];
        disk.name = "lamp" + std::to_string(k);
        disk.center = {0.4 * (k % 8) - 1.4, 3.5, 0.4 * (k / 8) - 1};
        e.disks.push_back(disk);
    }
    ASSERT_EQ(e.disks.size(), most_lights);
    expect_means(e, aiming, 256, "64 lamps");
}

TEST(AreaLights, ShadowsDoNotDependOnThePlace) {
    ProgressMonitor monitor;
    const auto film_at = [&](double offset) {
        return estimate_films(Scene(area_lights(0.2, offset)), "light-area", {16}, 3, "", monitor)[0];
    };
    const Film here = film_at(0), there = film_at(1e6);
    std::size_t other = 0;
    for (std::size_t at = 0; at < here.size(); ++at) other += std::fabs(here.y[at] - there.y[at]) > 1e-3f * here.y[at];
    EXPECT_LE(other, here.size() / 50);
}

}  // namespace lights_test

// ---- Spherical lights that bodies and other lights reach into: the reference finds what is hidden and does not merely
// widen its error; and spheres of up to 1e6 m, whose nearest point is 1 m away, in single precision.

namespace lights_test {

/// Returns a floor under a spherical light of radius 0.5 m, 1 m above it.
Experiment under_a_ball() {
    Experiment e = test::small_scene();
    e.image = {3, 2};
    e.fill = {};
    e.shapes.resize(1);
    e.shapes[0].form = shapes::Plane{{0, 0, 0}, {0, 1, 0}};
    e.camera.eye = {0.3, 2, 3};
    e.camera.target = {0, 0, 0};
    e.camera.vfov_deg = 10;
    e.disks.clear();
    e.lights.push_back({"ball", lights::Sphere{{0, 1.5, 0}, 0.5}, {10, 10, 10}, {}});
    return e;
}

/// Compares sums over the pixels: the reference agrees with the brute-force value, and states an error of at most
/// `doubt`, relative.
void expect_known(const Experiment& e, double doubt, const std::string& what) {
    const Scene scene(e);
    ProgressMonitor monitor;
    const ReferenceFilm film = quadrature_reference(scene, {scene.s()}, monitor)[0];
    double y = 0, stated = 0, truth = 0, variance = 0;
    for (int j = 0; j < film.height; ++j)
        for (int i = 0; i < film.width; ++i) {
            const auto hit = scene.primary(i, j);
            ASSERT_TRUE(hit);
            const auto at = static_cast<std::size_t>(j * film.width + i);
            const test::Opinion opinion = test::Oracle(scene, *hit, static_cast<std::uint32_t>(at))(20'000);
            y += static_cast<double>(film.y[at]);
            stated += static_cast<double>(film.error[at]);
            truth += opinion.y;
            variance += opinion.variance;
        }
    EXPECT_NEAR(y, truth, stated + 5 * std::sqrt(variance)) << what;
    EXPECT_LE(stated, doubt * truth) << what;
}

Shape body(const shapes::Quad& quad) {
    Shape s;
    s.name = "shelf";
    s.form = quad;
    s.occludes = true;
    s.material.rho_d = {0.3, 0.3, 0.3};
    s.material.s = 10;
    return s;
}

TEST(BallLights, ThatAShelfCutsAreKnown) {
    for (const double height : {1.05, 1.2, 1.3, 1.4}) {
        Experiment e = under_a_ball();
        e.shapes.push_back(body({{-2, height, -2}, {0, 0, 4}, {4, 0, 0}}));
        expect_known(e, 0.15, "a shelf at " + std::to_string(height));
        e.shapes.back().form = shapes::Quad{{-2, height, 0.1}, {0, 0, 4}, {4, 0, 0.3}};
        expect_known(e, 0.1, "half a shelf at " + std::to_string(height));
    }
}

TEST(BallLights, ThatOtherLightsCutAreKnown) {
    Experiment e = under_a_ball();
    e.lights.push_back({"sheet", lights::Rectangle{{-1, 1.2, -1}, {2, 0, 0}, {0, 0, 2}, true}, {1, 1, 1}, {}});
    expect_known(e, 0.1, "a bright ball in a sheet of light");
    e.lights[0].radiance = {1, 1, 1};
    e.lights[1].radiance = {10, 10, 10};
    expect_known(e, 0.1, "a dim ball in a sheet of light");
    e.lights[1].form = lights::Sphere{{0.4, 1.4, 0.2}, 0.45};
    expect_known(e, 0.1, "two balls in one another");
}

TEST(BallLights, OfAnySizeShineAlikeOnEveryArm) {
    for (const double radius : {0.1, 10.0, 1e3, 1e6}) {
        Experiment e = under_a_ball();
        e.lights[0].form = lights::Sphere{{0, radius + 1, 0}, radius};
        const Scene scene(e);
        ProgressMonitor monitor;
        const ReferenceFilm reference = quadrature_reference(scene, {scene.s()}, monitor)[0];
        for (const char* arm : {"light-area", "light-solid-angle", "cosine", "mis-balance"}) {
            const Film film = estimate_films(scene, arm, {16384}, 3, "", monitor)[0];
            double y = 0, truth = 0, doubt = 0, variance = 0;
            for (std::size_t at = 0; at < film.y.size(); ++at) {
                y += static_cast<double>(film.y[at]);
                variance += static_cast<double>(film.var[at]);
                truth += static_cast<double>(reference.y[at]);
                doubt += static_cast<double>(reference.error[at]);
            }
            EXPECT_NEAR(y, truth, doubt + 5 * std::sqrt(variance) + 1e-5 * truth) << arm << ", " << radius << " m";
        }
    }
}

}  // namespace lights_test
}  // namespace crescent
