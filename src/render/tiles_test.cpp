// Shading points shared by samplers, seeds and exponents equal those that each of them would create.
#include <gtest/gtest.h>

#include "render/estimator.h"
#include "render/tiles.h"
#include "tests/support/test_scene.h"

namespace crescent {
namespace tiles_test {

/// Returns a scene with a recessed panel, whose sides have no lobe and whose back follows the exponent of the scene.
Scene scene_of_three_surfaces() {
    Experiment e = test::small_scene();
    Shape panel = e.shapes.at(e.surface_of_s().value());
    panel.form = shapes::Panel{{-1.5, 0.8, -1}, {3, 0, 0}, {0, 1.2, 0}, 0.3, {}};
    panel.material.inherits_s = true;
    e.shapes.push_back(panel);
    return Scene(e);
}

void expect_same(const TiledScene::Points& a, const TiledScene::Points& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t g = 0; g < a.size(); ++g) {
        EXPECT_EQ(a[g].lobe, b[g].lobe);
        EXPECT_EQ(a[g].count, b[g].count);
        EXPECT_EQ(a[g].pixel, b[g].pixel);
        EXPECT_EQ(a[g].wox, b[g].wox);
        EXPECT_EQ(a[g].s, b[g].s);
        EXPECT_EQ(a[g].alpha, b[g].alpha);
        EXPECT_EQ(a[g].rho_s, b[g].rho_s);
        EXPECT_EQ(a[g].fill_s, b[g].fill_s);
        EXPECT_EQ(a[g].occluders.size(), b[g].occluders.size());
    }
}

TEST(TiledScene, SharesThePointsThatEachJobWouldMake) {
    const Scene scene = scene_of_three_surfaces();
    TiledScene kept = scene;
    kept.keep_points();
    for (const double s : {scene.s(), 3.0, 700.0}) {
        const TiledScene at_s = views_at(kept, {s}).front();
        for (std::size_t k = 0; k < kept.tiles().size(); ++k) {
            expect_same(*at_s.points(k), shading_points_of(scene.with_s(s), kept.tiles()[k], nullptr));
        }
    }
    EXPECT_EQ(kept.points(0), kept.points(0)) << "made once";
    EXPECT_EQ(kept.points(0), TiledScene(kept).points(0)) << "copies share them";
}

TEST(TiledScene, ThatIsNotToldToKeepsNoPoints) {
    const TiledScene view = scene_of_three_surfaces();
    EXPECT_NE(view.points(0), view.points(0));
    EXPECT_NE(view.with_s(5).points(0), view.with_s(5).points(0));
}

TEST(TiledScene, GivesFilmsTheBitsThatTheyHaveWithoutIt) {
    Scene scene = scene_of_three_surfaces();
    ProgressMonitor monitor;
    scene.remember_primaries();
    TiledScene kept = scene;
    kept.keep_points();
    kept.forget_hits();
    for (const double s : {scene.s(), 90.0})
        for (const char* arm : {"cosine", "phong"})
            EXPECT_EQ(hash(estimate_films(views_at(kept, {s}).front(), arm, {16}, 3, "", monitor)[0]),
                hash(estimate_films(scene.with_s(s), arm, {16}, 3, "", monitor)[0]));
}

}  // namespace tiles_test
}  // namespace crescent
