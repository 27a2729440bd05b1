// Against sums over 160 000 points of a disk or a million directions, and against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "math/simd/random.h"
#include "render/reference/disk_quadrature.h"
#include "render/reference/lobe_albedo.h"
#include "scene/lobes/all.h"
#include "tests/support/sanitized.h"
#include "tests/support/test_scene.h"

namespace crescent {
namespace quadrature_test {

bool blocked(const Scene& scene, const Hit& hit, Vec3d y) {
    const Vec3d d = y - hit.x;
    for (const Occluder& o : scene.occluders()) {
        if (o.shape == hit.shape) continue;
        const auto parts = hidden(o, hit.x, y, y + 1e-9 * frame_about(d).t);
        if (!parts[0].empty() || !parts[1].empty()) return true;
    }
    return false;
}

/// Returns the same integral as a sum over a million points.
DiskIntegral brute_force(const Scene& scene, const lights::Disk& disk, const Hit& hit, const Surface& surface) {
    const Frame<double> light = frame_about(disk.normal), local = frame_about(hit.n);
    constexpr int rings = 400, spokes = 400;
    DiskIntegral sum;
    for (int i = 0; i < rings; ++i) {
        for (int k = 0; k < spokes; ++k) {
            const double r = disk.radius * std::sqrt((i + 0.5) / rings), phi = 2 * pi * (k + 0.5) / spokes;
            const Vec3d y = disk.center + light.t * (r * std::cos(phi)) + light.b * (r * std::sin(phi)), d = y - hit.x;
            const double r2 = dot(d, d);
            const Vec3d w = d * (1 / std::sqrt(r2)), wi = local.to_local(w);
            const double emits = -dot(w, disk.normal);
            if (wi.z <= 0 || (emits <= 0 && !disk.two_sided) || blocked(scene, hit, y)) continue;
            const double g = wi.z * std::fabs(emits) / r2 * pi * sqr(disk.radius) / (rings * spokes);
            sum.diffuse += g / pi;
            if (surface.rho_s > 0) sum.lobe += g * PhongLobe<double>(surface.s, 0)(local.to_local(hit.wo), wi);
        }
    }
    return sum;
}

TEST(DiskQuadrature, MatchesBruteForce) {
    const Scene scene(test::small_scene());
    int lit = 0;
    for (std::size_t k = 0; k < scene.lights().size(); ++k) {
        const DiskQuadrature quadrature(scene, k);
        for (std::uint32_t n = 0; n < 60; n += test::every) {
            const Vec2<float> u = draw(3, n, 0);
            const auto hit = scene.primary(static_cast<int>(u.x * 67), static_cast<int>(u.y * 45));
            if (!hit) continue;
            const Surface surface = scene.surface(*hit);
            const DiskIntegral got = quadrature(*hit, surface),
                               want = brute_force(scene, std::get<lights::Disk>(scene.lights()[k].form), *hit, surface);
            EXPECT_NEAR(got.diffuse, want.diffuse, 2e-3 * want.diffuse + 2e-6);
            EXPECT_NEAR(got.lobe, want.lobe, 3e-3 * want.lobe + 2e-5);
            lit += got.diffuse > 0;
        }
    }
    EXPECT_GT(lit, 20 / static_cast<int>(test::every));
}

TEST(DiskQuadrature, FindsPixelsThatAreHalfInShadow) {
    const Experiment experiment = test::small_scene();
    const Scene scene(experiment);
    Experiment bare = experiment;
    for (Shape& shape : bare.shapes) shape.occludes = false;
    const Scene open(bare);
    const DiskQuadrature shadowed(scene, 0), unshadowed(open, 0);
    int half = 0, dark = 0;
    for (int j = 0; j < 45; ++j)
        for (int i = 0; i < 67; ++i) {
            const auto hit = scene.primary(i, j);
            if (!hit) continue;
            const double all = unshadowed(*hit, scene.surface(*hit)).diffuse,
                         got = shadowed(*hit, scene.surface(*hit)).diffuse;
            EXPECT_LE(got, all * (1 + 1e-6) + 1e-12);
            half += got > 0.2 * all && got < 0.8 * all;
            dark += all > 0 && got == 0;
        }
    EXPECT_GT(half, 5);
    EXPECT_GT(dark, 50);
}

/// Returns an area light of half-angle `half` directly above a point that is seen from above; with `hidden`, a body
/// hides half of it.
Experiment area_light_above(double half, bool hidden) {
    Experiment e = test::small_scene();
    e.shapes.resize(2);
    e.shapes[0].form = shapes::Plane{{0, 0, 0}, {0, 1, 0}};
    e.shapes[1].form = shapes::Quad{{0, 0.5, -9}, {9, 0, 0}, {0, 0, 18}};
    e.shapes[1].occludes = hidden;
    e.disks.resize(1);
    e.disks[0].center = {0, 1, 0};
    e.disks[0].normal = {0, -1, 0};
    e.disks[0].radius = std::tan(half);
    return e;
}

TEST(DiskQuadrature, StatedErrorBoundsTheTrueError) {
    const Hit hit = {0, false, {0, 0, 0}, {0, 1, 0}, {0, 1, 0}};
    for (const double half : {1e-6, 1e-3, 0.03, 0.3, 1.0, 1.5})
        for (const double s : {0.01, 1.0, 32.0, 1e3, 1e5, 1e6})
            for (const bool hidden : {false, true}) {
                const Scene scene(area_light_above(half, hidden));
                Surface surface;
                surface.rho_d = {0.3, 0.3, 0.3};
                surface.rho_s = 0.5;
                surface.s = s;
                const DiskIntegral got = DiskQuadrature(scene, 0)(hit, surface);
                const double share = hidden ? 0.5 : 1;  // lobe: (s+2) integral cos^(s+1) sin
                const double diffuse = share * sqr(std::sin(half)),
                             lobe = -share * std::expm1(0.5 * (s + 2) * std::log1p(-sqr(std::sin(half))));
                EXPECT_LE(std::fabs(got.diffuse - diffuse), got.diffuse_error + 1e-8 * diffuse)
                    << half << " " << s << " " << hidden;
                EXPECT_LE(std::fabs(got.lobe - lobe), got.lobe_error + 1e-8 * lobe)
                    << half << " " << s << " " << hidden;
                EXPECT_LE(got.diffuse_error + got.lobe_error, 1e-3 * (diffuse + lobe))
                    << half << " " << s << " " << hidden;
            }
}

TEST(LobeAlbedo, PhongFromAboveIsOne) {
    for (double s : {1.0, 8.0, 32.0, 128.0, 5000.0})
        EXPECT_NEAR(lobe_albedo(lobe_named("phong"), s, 0, 1.0), 1, 1e-8) << s;
    const LobeAlbedo table(lobe_named("phong"), 32, 0);
    for (double c = 0.01; c < 1; c += 0.0173) {
        EXPECT_LT(table.error(c), 2.01e-7) << c;
        EXPECT_NEAR(table(c), lobe_albedo(lobe_named("phong"), 32, 0, c), table.error(c)) << c;
    }
}

TEST(LobeAlbedo, HalfVectorLobesMatchAMillionDirections) {
    const auto brute_force = [](const auto& lobe, double cos_o) {
        constexpr int n = 1000;
        const Vec3<double> wo = {std::sqrt(1 - cos_o * cos_o), 0, cos_o};
        double sum = 0;
        for (int i = 0; i < n; ++i) {
            const double z = (i + 0.5) / n, r = std::sqrt(1 - z * z);
            for (int k = 0; k < n; ++k) {
                const double phi = pi * (k + 0.5) / n;
                sum += lobe(wo, Vec3<double>{r * std::cos(phi), r * std::sin(phi), z}) * z;
            }
        }
        return sum * 2 * pi / n / n;
    };
    for (double cos_o : {0.05, 0.5, 0.9}) {
        for (double alpha : {0.3, 0.5, 0.9})
            EXPECT_NEAR(
                lobe_albedo(lobe_named("ggx"), 0, alpha, cos_o), brute_force(GgxLobe<double>(0, alpha), cos_o), 2e-6)
                << alpha;
        for (double alpha : {0.3, 0.5, 0.9})
            EXPECT_NEAR(lobe_albedo(lobe_named("beckmann"), 0, alpha, cos_o),
                brute_force(BeckmannLobe<double>(0, alpha), cos_o), 2e-6)
                << alpha;
        for (double s : {3.0, 40.0})
            EXPECT_NEAR(lobe_albedo(lobe_named("blinn-phong"), s, 0, cos_o),
                brute_force(BlinnPhongLobe<double>(s, 0), cos_o), 2e-6)
                << s;
    }
    EXPECT_LT(LobeAlbedo(lobe_named("ggx"), 0, 0.5).error(0.5), 3e-6);
}

TEST(LobeAlbedo, NeverReflectsMoreThanArrives) {
    for (double c = 0.05; c <= 1; c += 0.19) {
        EXPECT_LE(lobe_albedo(lobe_named("phong"), 32, 0, c), 1 + 1e-8);
        for (const LobeInfo& lobe : lobe_infos()) EXPECT_LE(lobe_albedo(lobe.kind, 32, 0.3, c), 1 + 1e-6) << lobe.name;
    }
}

}  // namespace quadrature_test
}  // namespace crescent
