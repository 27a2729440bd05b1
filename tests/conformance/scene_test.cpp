// The camera and the surfaces of a scene.
#include "scene/scene.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/scene_text.h"
#include "tests/support/test_scene.h"

namespace crescent {
namespace scene_test {

/// A camera before a wall at z = 0, looking along -z from 4 m.
Experiment wall(const std::vector<std::string>& overrides = {}) {
    std::vector<std::string> all{"image.width=80", "image.height=40", "camera.eye=[0,0,4]", "camera.target=[0,0,0]",
        "camera.vfov_deg=90", "shapes.floor.normal=[0,0,1]"};
    all.insert(all.end(), overrides.begin(), overrides.end());
    return parse(test::view_text + test::floor_text + test::fill_text + "[arms.cosine]\nn = 4\n", "wall.toml", all);
}

TEST(Camera, PixelsCountFromTheBottomLeftAndAreSquare) {
    const Scene scene(wall());
    const double pixel = 2 * 4 * std::tan(pi / 4) / 40;  // on the wall
    for (const int j : {0, 7, 39})
        for (const int i : {0, 11, 79}) {
            const Vec3d x = scene.primary(i, j)->x;
            EXPECT_NEAR(x.x, (i + 0.5 - 40) * pixel, 1e-12);
            EXPECT_NEAR(x.y, (j + 0.5 - 20) * pixel, 1e-12);
            EXPECT_NEAR(x.z, 0, 1e-12);
        }
}

TEST(Camera, UpIsUpHoweverItIsTilted) {
    for (const char* up : {"[1, 0, 0]", "[0.6, 0.8, 0]", "[0, 0.8, 0.6]"}) {
        const Experiment e = wall({std::string("camera.up=") + up});
        const Scene scene(e);
        const Vec3d rise = scene.primary(40, 39)->x - scene.primary(40, 0)->x,
                    right = scene.primary(79, 20)->x - scene.primary(0, 20)->x;
        EXPECT_GT(dot(rise, e.camera.up), 0) << up;
        EXPECT_NEAR(dot(right, e.camera.up), 0, 1e-9) << up;
        EXPECT_GT(dot(cross(right, rise), Vec3d{0, 0, 1}), 0) << up;  // towards the eye: right-handed
    }
}

TEST(Camera, AHitFacesTheEyeAndKnowsTheWayBack) {
    const Experiment e = test::small_scene();
    const Scene scene(e);
    int hits = 0;
    for (int j = 0; j < e.image.height; ++j)
        for (int i = 0; i < e.image.width; ++i) {
            const auto hit = scene.primary(i, j);
            if (!hit) continue;
            ++hits;
            EXPECT_GT(dot(hit->n, hit->wo), 0);
            const Vec3d back = normalize(e.camera.eye - hit->x);
            EXPECT_NEAR(dot(back, hit->wo), 1, 1e-12);
        }
    EXPECT_GT(hits, 1000);
}

TEST(Primaries, AreTheSameWhereTheyAreRemembered) {
    Scene plain(test::small_scene()), kept(test::small_scene());
    kept.remember_primaries();
    const Scene other = kept.with_s(8);
    Scene shapes_alone = kept;
    shapes_alone.forget_hits();
    for (int j = 0; j < 45; ++j)
        for (int i = 0; i < 67; ++i) {
            const auto a = plain.primary(i, j), b = kept.primary(i, j), c = other.primary(i, j);
            ASSERT_EQ(a.has_value(), b.has_value());
            const auto d = shapes_alone.primary(i, j);
            ASSERT_EQ(a.has_value(), c.has_value());
            ASSERT_EQ(a.has_value(), d.has_value());
            if (!a) continue;
            EXPECT_EQ(a->shape, d->shape);
            EXPECT_EQ(a->x.x, d->x.x);
            EXPECT_EQ(a->n.y, d->n.y);
            EXPECT_EQ(a->shape, b->shape);
            EXPECT_EQ(a->x.x, b->x.x);
            EXPECT_EQ(a->n.y, c->n.y);
            EXPECT_EQ(a->wo.z, c->wo.z);
        }
}

TEST(Primaries, OfALargeImageAreRememberedToTheLastBit) {
    Experiment e = test::small_scene();
    e.image.width = 1340;
    e.image.height = 900;
    const Scene plain(e);
    Scene kept = plain;
    kept.remember_primaries();
    for (int j = 0; j < 900; j += 7)
        for (int i = 0; i < 1340; i += 3) {
            const auto a = plain.primary(i, j), b = kept.primary(i, j);
            ASSERT_EQ(a.has_value(), b.has_value()) << i << ", " << j;
            if (!a) continue;
            const auto all = [](const Hit& h) {
                return std::tuple(h.shape, h.reveal, h.x.x, h.x.y, h.x.z, h.n.x, h.n.y, h.n.z, h.wo.x, h.wo.y, h.wo.z);
            };
            EXPECT_EQ(all(*a), all(*b)) << i << ", " << j;
        }
}

TEST(Surfaces, DefaultToCommonExponentAndEqualWidth) {
    Material m;
    m.rho_d = {0.1, 0.2, 0.3};
    m.rho_s = 0.4;
    m.brdf = lobe_named("blinn-phong");
    const Surface bare = surface_of(m, 48);
    EXPECT_EQ(bare.s, 48);
    EXPECT_DOUBLE_EQ(bare.alpha, 0.2);
    EXPECT_EQ(bare.rho_s, 0.4);
    EXPECT_EQ(bare.brdf, lobe_named("blinn-phong"));
    m.s = 6;
    m.alpha = 0.7;
    EXPECT_EQ(surface_of(m, 48).s, 6);
    EXPECT_EQ(surface_of(m, 48).alpha, 0.7);
    m.alpha.reset();
    EXPECT_DOUBLE_EQ(surface_of(m, 48).alpha, 0.5);  // of its own s
}

TEST(Surfaces, RecessSidesHaveTheirAlbedoAndNoLobe) {
    Experiment e = wall();
    Shape panel;
    panel.form = shapes::Panel{};
    panel.material.rho_d = {0.3, 0.3, 0.3};
    panel.material.rho_s = 0.2;
    panel.material.s = 9;
    e.shapes.push_back(panel);
    const Scene scene(e);
    Hit hit;
    hit.shape = 1;
    EXPECT_EQ(scene.surface(hit).rho_s, 0.2);
    hit.reveal = true;
    EXPECT_EQ(scene.surface(hit).rho_s, 0);
    EXPECT_EQ(scene.surface(hit).rho_d, (Rgb{0.3, 0.3, 0.3}));
    std::get<shapes::Panel>(e.shapes[1].form).reveal_rho_d = Rgb{0.1, 0, 0};
    EXPECT_EQ(Scene(e).surface(hit).rho_d, (Rgb{0.1, 0, 0}));
}

TEST(Origin, LiesWhereTheCameraSees) {
    const Vec3d origin = Scene(wall()).origin();
    EXPECT_NEAR(origin.z, 0, 1e-12);
    EXPECT_LT(length(origin), 4);
    const Scene empty(wall({"camera.target=[0, 0, 8]"}));
    EXPECT_EQ(empty.origin().z, 4);  // nothing is visible: the eye
}

}  // namespace scene_test
}  // namespace crescent
