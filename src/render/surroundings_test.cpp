// Kernels under skies and emitting triangles: against a plain loop in double precision, on every instruction set, and
// where the answer is known.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <variant>

#include "math/simd/random.h"
#include "render/estimator.h"
#include "render/reference/paired.h"
#include "render/reference/reference.h"
#include "samplers/all.h"
#include "scene/lobes/all.h"
#include "scene/mesh/mesh.h"
#include "tests/support/oracle.h"
#include "tests/support/scene_text.h"
#include "tests/support/skies.h"
#include "tests/support/test_scene.h"

namespace crescent {
namespace surroundings_test {

Experiment under_sky(int height = 16) {
    Experiment e = test::small_scene();
    e.fill = {};
    e.sky = test::noisy_sky(height, 4);
    e.sky->rotation = 50;
    return e;
}

/// A mesh of two triangles, the parallelogram of a light in the form of a rectangle.
MeshObject two_triangles(const lights::Rectangle& r, const Rgb& radiance) {
    Mesh mesh;
    for (const Vec3d& p : {r.corner, r.corner + r.edge_u, r.corner + r.edge_u + r.edge_v, r.corner + r.edge_v})
        mesh.positions.push_back(as<float>(p));
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    MeshObject out;
    out.name = "panel";
    out.pack = make_pack(std::move(mesh));
    out.emission = radiance;
    out.material.rho_d = {0.2, 0.2, 0.2};
    out.material.s = 1;
    return out;
}

constexpr lights::Rectangle panel{
    {-0.9, 2.4, 0.6}, {0, 0, -1.2}, {1.8, 0, 0}};  // shines downwards, above what the camera sees

std::vector<Film> films(const Scene& scene, const char* sampler, std::uint64_t n, const std::string& isa = "") {
    ProgressMonitor monitor;
    return estimate_films(scene, {sampler}, {n}, 11, isa, monitor);
}

ReferenceFilm paired(const Scene& scene, std::uint64_t n, std::uint32_t seed = 1) {
    ProgressMonitor monitor;
    return paired_reference({TiledScene(scene)}, {n, {2 * seed, 2 * seed + 1}}, monitor).front();
}

double mean_y(const std::vector<float>& y) {
    double sum = 0;
    for (const float v : y) sum += double(v);
    return sum / double(y.size());
}

/// X of one direction of the world, in double, by the bodies of the oracle.
double worth(const Scene& scene, const Hit& hit, const Surface& on, Vec3d wi) {
    if (!(wi.z > 0)) return 0;
    const Frame<double> frame = frame_about(hit.n);
    const Vec3d d = frame.to_world(wi), wo = frame.to_local(hit.wo);
    double nearest = 1e300;
    Rgb radiance{};
    for (const Light& light : scene.lights()) {
        const auto& disk = std::get<lights::Disk>(light.form);
        const Vec3d c = disk.center - hit.x;
        const double along = dot(c, disk.normal), v = dot(d, disk.normal), t = along / v;
        const Vec3d off = t * d - c;
        if (!(t > 0) || (along > 0 && !disk.two_sided) || dot(off, off) > sqr(disk.radius) || t >= nearest) continue;
        nearest = t;
        radiance = light.radiance;
    }
    const SkyTable& sky = *scene.surroundings()->sky;
    if (nearest == 1e300) radiance = sky.radiance(sky.texel_at(d));
    const double eye = std::sqrt(dot(hit.x - scene.camera().eye, hit.x - scene.camera().eye));
    const double lo = 1e-5 * (nearest < 1e300 ? nearest : eye);
    for (const Occluder& o : scene.occluders())
        if (o.shape != hit.shape && std::visit(test::Crosses{hit.x, d, lo, (1 - 1e-5) * nearest}, o.body))
            radiance = {};
    const double lobe = on.rho_s > 0 ? lobe_value(on.brdf, on.s, on.alpha, wo, wi) : 0;
    double x = 0;
    for (std::size_t c = 0; c < 3; ++c)
        x += luminance_weights[c] * radiance[c] * (on.rho_d[c] / pi + on.rho_s * on.tint[c] * lobe);
    return x * wi.z;
}

TEST(Surroundings, AreSampledAsByAPlainLoop) {
    const Scene scene(under_sky());
    constexpr std::uint64_t n = 512;
    int points = 0;
    for (int j = 3; j < 45; j += 8)
        for (int i = 2; i < 67; i += 9) {
            const auto hit = scene.primary(i, j);
            if (!hit) continue;
            const ShadingPoints group = shading_points_of(scene, {i, j, i + 1, j + 1}, nullptr)[0];
            std::vector<float> x(n);
            estimate_points(group, {"cosine"}, n, 5, "", nullptr, x.data());
            const Surface on = scene.surface(*hit);
            int off = 0;
            double plain = 0;
            for (std::uint64_t k = 0; k < n; ++k) {
                const Vec2<float> u = draw(5, group.pixel[0], k);
                const double r = std::sqrt(1 - double(u.x)), phi = 2 * pi * double(u.y), z = std::sqrt(double(u.x));
                const double value = worth(scene, *hit, on, {r * std::cos(phi), r * std::sin(phi), z}) / (z / pi);
                off += std::fabs(value - double(x[k])) > 1e-4 * value + 1e-7;
                plain += value;
            }
            EXPECT_LE(off, 2) << i << ", " << j;  // within rounding of an edge
            EXPECT_GT(plain, 0);
            ++points;
        }
    EXPECT_GT(points, 20);
}

TEST(Surroundings, HaveTheSameBitsOnEveryInstructionSet) {
    Experiment e = under_sky();
    e.meshes.push_back(two_triangles(panel, {4, 5, 6}));
    const Scene scene(std::move(e));
    for (const char* sampler : {"cosine", "sky", "light-triangle", "mis-balance"}) {
        const std::string scalar = hash(films(scene, sampler, 8, "scalar")[0]);
        for (const std::string& isa : isas()) EXPECT_EQ(hash(films(scene, sampler, 8, isa)[0]), scalar) << isa;
    }
}

TEST(Surroundings, OfOneRadianceAreAFill) {
    Experiment e = test::small_scene();
    for (Shape& shape : e.shapes) shape.occludes = false;
    e.disks.clear();
    e.fill = {0.5, 0.6, 0.7};
    const Film fill = films(Scene(e), "phong", 64)[0];
    e.fill = {};
    e.sky = test::constant_sky(0.25f, 0.3f, 0.35f);
    e.sky->scale = 2;
    e.sky->visible = false;  // like the fill
    const Film sky = films(Scene(e), "phong", 64)[0];
    for (std::size_t k = 0; k < fill.size(); ++k) {
        EXPECT_NEAR(double(sky.r[k]), double(fill.r[k]), 1e-6 * double(fill.r[k]));
        EXPECT_NEAR(double(sky.b[k]), double(fill.b[k]), 1e-6 * double(fill.b[k]));
        EXPECT_NEAR(double(sky.var[k]), double(fill.var[k]), 1e-4 * double(fill.var[k]) + 1e-12);
    }
}

/// Where no surface is, the camera sees the texel behind the pixel's centre, in films and in the reference.
TEST(Surroundings, AreSeenByTheCamera) {
    Experiment e = under_sky();
    e.sky->visible = true;
    const Scene scene(e);
    const Film film = films(scene, "cosine", 8)[0];
    const ReferenceFilm reference = paired(scene, 16);
    e.sky->visible = false;
    const Film hidden = films(Scene(e), "cosine", 8)[0];
    const Image& image = scene.image();
    const SkyTable sky(*e.sky);
    const Vec3d forward = normalize(e.camera.target - e.camera.eye), right = normalize(cross(forward, e.camera.up));
    const double size = 2 * std::tan(e.camera.vfov_deg * pi / 360) / image.height;
    std::size_t seen = 0;
    for (int j = 0; j < image.height; ++j)
        for (int i = 0; i < image.width; ++i) {
            const auto k = static_cast<std::size_t>(j * image.width + i);
            if (scene.primary(i, j)) {
                EXPECT_EQ(film.y[k], hidden.y[k]);
                continue;
            }
            ++seen;
            const Vec3d d = forward +
                size * ((i + 0.5 - 0.5 * image.width) * right + (j + 0.5 - 0.5 * image.height) * cross(right, forward));
            const Rgb expected = sky.radiance(sky.texel_at(d));
            EXPECT_EQ(film.r[k], static_cast<float>(expected[0]));
            EXPECT_EQ(film.b[k], static_cast<float>(expected[2]));
            EXPECT_EQ(film.var[k], 0);
            EXPECT_EQ(film.largest[k], 0);
            EXPECT_EQ(reference.y[k], film.y[k]);
            EXPECT_EQ(reference.error[k], 0);
            EXPECT_EQ(hidden.y[k], 0);
        }
    EXPECT_GT(seen, 10u);
    EXPECT_LT(seen, film.size());
}

/// A plane below a ball, under an even sky: the ball covers (r/d)^2 cos of the projected hemisphere.
TEST(Surroundings, AreHiddenByABall) {
    const Experiment e = parse(
        test::view_text + test::fill_text + test::floor_text + test::ball_text + "[arms.cosine]\nn = 4\n", "ball.toml",
        {"image.width=9", "image.height=1", "camera.eye=[0,1,4]", "camera.target=[0,0,0]", "camera.vfov_deg=2",
            "shapes.floor.rho_d=[0.6,0.6,0.6]", "shapes.ball.center=[0.3,1.5,0.2]", "shapes.ball.radius=0.6",
            "shapes.ball.occludes=true"});
    SceneData data = e;
    data.fill = {};
    data.sky = test::constant_sky(1, 1, 1);
    const Scene scene(data);
    const ReferenceFilm film = paired(scene, 16384);
    for (int i = 0; i < 9; ++i) {
        const auto hit = scene.primary(i, 0);
        ASSERT_TRUE(hit && hit->shape == 0);
        const Vec3d c = Vec3d{0.3, 1.5, 0.2} - hit->x;
        const double d2 = dot(c, c), covered = 0.36 / d2 * c.y / std::sqrt(d2);
        EXPECT_NEAR(double(film.y[std::size_t(i)]), 0.6 * (1 - covered), 3e-4) << i;
    }
}

TEST(LightTriangles, ShineLikeARectangle) {
    Experiment e = test::small_scene();
    e.disks.clear();
    e.fill = {};
    Experiment with_rectangle = e;
    with_rectangle.lights.push_back({"panel", panel, {7, 8, 9}, {}});
    e.meshes.push_back(two_triangles(panel, {7, 8, 9}));
    ProgressMonitor monitor;
    const ReferenceFilm exact = quadrature_reference(Scene(with_rectangle), {24}, monitor)[0];
    const ReferenceFilm film = paired(Scene(e), 1024);
    double squares = 0, stated = 0, y = 0;
    for (std::size_t k = 0; k < film.size(); ++k) {
        squares += sqr(double(film.y[k]) - double(exact.y[k]));
        stated += sqr(double(film.error[k]));
        y += sqr(double(exact.y[k]));
    }
    EXPECT_GT(y / double(film.size()), 0.01);
    EXPECT_LT(squares, 2 * stated + 1e-9 * y);
    EXPECT_LT(stated, 1e-4 * y);
    for (const char* sampler : {"light-triangle", "cosine"}) {
        const Film sampled = films(Scene(e), sampler, 4096)[0];
        EXPECT_NEAR(mean_y(sampled.y) / mean_y(exact.y), 1, 4e-3) << sampler;
        EXPECT_EQ(sampled.invalid, 0u);
    }
}

/// The sampler of the sky alone, and the cosine, have the mean of the reference.
TEST(Surroundings, HaveOneMeanForEverySampler) {
    const Scene scene([] {
        Experiment e = under_sky();
        e.disks.clear();
        return e;
    }());
    const double mean = mean_y(paired(scene, 512).y);
    for (const char* sampler : {"sky", "cosine", "uniform", "mixture"})
        EXPECT_NEAR(mean_y(films(scene, sampler, 2048)[0].y) / mean, 1, 5e-3) << sampler;
}

// ---- The paired reference of scenes that the quadrature reaches.

struct Agreement {
    double squares = 0, stated = 0;
};
Agreement against_quadrature(const Scene& scene, std::uint64_t n) {
    ProgressMonitor monitor;
    const ReferenceFilm exact = quadrature_reference(scene, {scene.s()}, monitor)[0], film = paired(scene, n, 3);
    Agreement out;
    for (std::size_t k = 0; k < film.size(); ++k) {
        out.squares += sqr(double(film.y[k]) - double(exact.y[k]));
        out.stated += sqr(double(film.error[k]));
    }
    return out;
}

TEST(PairedReference, AgreesWithTheQuadratureWithinItsStatedError) {
    const Scene scene(test::small_scene());
    const Agreement few = against_quadrature(scene, 64), many = against_quadrature(scene, 640);
    // Both estimate the variance of the mean of R1 and R2, over 3,000 pixels of very different variances.
    for (const Agreement& of : {few, many}) {
        EXPECT_LT(of.squares, 1.5 * of.stated);
        EXPECT_GT(of.squares, of.stated / 1.5);
    }
    EXPECT_LT(many.squares, few.squares / 10);  // at least as fast as independent samples
}

/// The squared error of a film by pairs of estimates is that by the quadrature, for any number of samples of theirs.
TEST(PairedReference, EstimatesSquaredErrorsWithoutBias) {
    const Scene scene(test::small_scene());
    ProgressMonitor monitor;
    const ReferenceFilm exact = quadrature_reference(scene, {scene.s()}, monitor)[0];
    const Film film = films(scene, "mis-balance", 64)[0];
    const auto mse = [&](const ReferenceFilm& reference, bool pair) {
        double sum = 0;
        for (std::size_t k = 0; k < film.size(); ++k)
            sum += sqr(double(film.y[k]) - double(reference.y[k])) - (pair ? sqr(double(reference.error[k])) : 0);
        return sum / double(film.size());
    };
    const double truth = mse(exact, false);
    double sum = 0, square = 0, with_bias = 0;
    constexpr int repeats = 12;
    for (std::uint32_t k = 0; k < repeats; ++k) {
        const ReferenceFilm reference = paired(scene, 16, 10 + k);
        const double estimate = mse(reference, true);
        sum += estimate;
        square += estimate * estimate;
        with_bias += mse(reference, false) / repeats;
    }
    const double mean = sum / repeats, error = std::sqrt((square / repeats - mean * mean) / (repeats - 1));
    EXPECT_NEAR(mean, truth, 5 * error);
    EXPECT_GT(with_bias, truth + 10 * error);  // what the pair removes is far larger
}

}  // namespace surroundings_test
}  // namespace crescent
