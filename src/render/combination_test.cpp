// Combinations in the kernels have the bits of the general path, which draws and weighs one direction at a time, on
// every instruction set.
#include "render/combination.h"

#include <gtest/gtest.h>

#include <string>

#include "math/simd/random.h"
#include "render/estimator.h"
#include "scene/mesh/mesh.h"
#include "tests/support/skies.h"
#include "tests/support/test_scene.h"

namespace crescent {
namespace combination_test {

/// A square that emits above the ball, and one below it that reflects alone.
void add_meshes(Experiment& e) {
    const auto add = [&](const char* name, float y, float reach, const Rgb& emission) {
        Mesh mesh;
        mesh.positions = {{-reach, y, -reach}, {reach, y, -reach}, {reach, y, reach}, {-reach, y, reach}};
        mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
        MeshObject& object = e.meshes.emplace_back();
        object.name = name;
        object.pack = make_pack(std::move(mesh));
        object.emission = emission;
        object.material.rho_d = {0.3, 0.2, 0.4};
        object.material.s = 1;
    };
    add("panel", 2.2f, 0.5f, {7, 6, 5});
    add("plate", 0.35f, 0.9f, {});
}

struct Around {
    const char* name;
    bool fill, disks, sky, meshes;
};
constexpr Around scenes[] = {{"fill and disks", true, true, false, false}, {"sky and disks", false, true, true, false},
    {"fill and emitting triangles", true, false, false, true}, {"emitting triangles", false, false, false, true},
    {"all but the fill", false, true, true, true}};

Scene scene_of(const Around& around) {
    Experiment e = test::small_scene();
    if (!around.fill) e.fill = {};
    if (!around.disks) {
        e.disks.clear();
        e.lights.clear();
    }
    if (around.sky) e.sky = test::noisy_sky(16, 4);
    if (around.meshes) add_meshes(e);
    return Scene(std::move(e));
}

std::vector<CombinationPlan> plans() {
    std::vector<CombinationPlan> out(6);
    for (CombinationPlan& plan : out) {
        plan.kind = CombinationKind::mis;
        plan.of = {"cosine", "phong", "light-area", "sky", "light-triangle"};
    }
    out[1].heuristic = MisHeuristic::power;
    out[1].samples = {1, 2, 1, 3, 1};
    out[2].weights = {"p1^2 / (p1^2 + p2^2 + p3^2 + p4^2 + p5^2)", "p2^2 / (p1^2 + p2^2 + p3^2 + p4^2 + p5^2)",
        "p3^2 / (p1^2 + p2^2 + p3^2 + p4^2 + p5^2)", "p4^2 / (p1^2 + p2^2 + p3^2 + p4^2 + p5^2)", "rest"};
    out[3].draw = MisDraw::one;
    out[3].heuristic = MisHeuristic::power;
    out[4].draw = MisDraw::one;
    out[4].probabilities = {"0.25", "rho_s / 2", "0.125", "0", "rest"};
    out[5].kind = CombinationKind::mixture;
    out[5].weights = {"0.5", "min(rho_s, 0.25)", "0.125", "0.0625", "rest"};
    return out;
}

Combination combination_of(const CombinationPlan& plan) {
    Techniques of;
    for (const std::string& name : plan.of) of.push_back(built_in_technique(name));
    return {"tested", plan, std::move(of), nullptr, {}, {}};
}

struct Estimate {
    std::vector<float> x;
    Moments moments;
};
Estimate estimate(const Combination& combination, const ShadingPoints& points, const std::string& isa, bool in_kernels,
    const PixelNumbers* numbers) {
    constexpr std::uint64_t n = 18;  // more than a block
    Estimate out;
    out.x.resize(points.count * n);
    out.moments.resize(points);
    std::vector<std::byte> memory(points.kernel_memory());
    const std::array<std::uint64_t, 1> counts = {n};
    estimate_combination(combination,
        {&points, counts, 5, std::span(&out.moments, 1), nullptr, out.x.data(), memory.data()}, isa, numbers,
        in_kernels);
    return out;
}

template <class T> std::size_t differences(const std::vector<T>& a, const std::vector<T>& b, std::size_t count) {
    std::size_t out = 0;
    for (std::size_t i = 0; i < count; ++i) out += a[i] != b[i];
    return out;
}

void compare(const Estimate& a, const Estimate& b, std::size_t points) {
    EXPECT_EQ(differences(a.x, b.x, a.x.size()), 0u);
    EXPECT_EQ(differences(a.moments.spread, b.moments.spread, points), 0u);
    EXPECT_EQ(differences(a.moments.horizon, b.moments.horizon, points), 0u);
    EXPECT_EQ(differences(a.moments.hits, b.moments.hits, points), 0u);
    EXPECT_EQ(differences(a.moments.bad, b.moments.bad, points), 0u);
    for (std::size_t k = 0; k < a.moments.light_g.size(); ++k)
        EXPECT_EQ(differences(a.moments.light_g_lobe[k], b.moments.light_g_lobe[k], points), 0u);
    for (std::size_t c = 0; !a.moments.around_g.empty() && c < 3; ++c) {
        EXPECT_EQ(differences(a.moments.around_rgb[c], b.moments.around_rgb[c], points), 0u);
        EXPECT_EQ(differences(a.moments.around_rgb_lobe[c], b.moments.around_rgb_lobe[c], points), 0u);
    }
}

TEST(CombinationsInKernels, HaveTheBitsOfTheGeneralPath) {
    for (const Around& around : scenes) {
        const Scene scene = scene_of(around);
        int number = 0;
        for (const CombinationPlan& plan : plans()) {
            const Combination combination = combination_of(plan);
            ASSERT_TRUE(combination.runs_in_kernels());
            SCOPED_TRACE(std::string(around.name) + ", plan " + std::to_string(number++));
            for (const ShadingPoints& points : shading_points_of(scene, {10, 10, 50, 34}, nullptr)) {
                const Estimate general = estimate(combination, points, "", false, nullptr);
                double sum = 0;
                for (const float x : general.x) sum += double(x);
                EXPECT_GT(sum, 0);
                for (const std::string& isa : isas()) {
                    SCOPED_TRACE(isa);
                    compare(estimate(combination, points, isa, true, nullptr), general, points.count);
                }
            }
        }
    }
}

TEST(CombinationsInKernels, TakeOtherNumbers) {
    const Scene scene = scene_of(scenes[4]);
    const PixelNumbers numbers = [](std::uint32_t pixel, std::uint64_t sample, std::uint32_t block) {
        return crescent::draw(77, pixel, sample + 1000, block);
    };
    for (const CombinationPlan& plan : plans()) {
        const Combination combination = combination_of(plan);
        for (const ShadingPoints& points : shading_points_of(scene, {10, 10, 30, 24}, nullptr))
            compare(estimate(combination, points, "", true, &numbers),
                estimate(combination, points, "", false, &numbers), points.count);
    }
}

TEST(CombinationsInKernels, AreThoseOfBuiltInSamplers) {
    CombinationPlan plan = plans()[0];
    plan.kind = CombinationKind::ris;
    plan.candidates = 4;
    EXPECT_FALSE(combination_of(plan).runs_in_kernels());
    plan = plans()[5];
    plan.kind = CombinationKind::mis;
    plan.weights.clear();
    plan.of = {"cosine"};
    Techniques of = {built_in_technique("cosine"), combination_of(plans()[5]).technique()};
    EXPECT_FALSE(Combination("tested", plan, std::move(of), nullptr, {}, {}).runs_in_kernels());
}

/// Counts how often its density is evaluated.
class Counted : public Technique {
public:
    int numbers() const override { return 2; }
    void draw(const PointRows& /*at*/, std::span<const double> /*u*/, std::span<PointDraw> /*out*/) const override {}
    void density(const PointRows& /*at*/, std::span<const Vec3<float>> /*wi*/, std::span<double> out) const override {
        ++calls;
        std::ranges::fill(out, 0.25);
    }
    mutable int calls = 0;
};

TEST(Mixtures, EvaluateAPartThatOccursSeveralTimesOnce) {
    const std::vector<ShadingPoints> groups = shading_points_of(scene_of(scenes[0]), {20, 20, 24, 24}, nullptr);
    const PointRun run{0, {0, 0, 1}, 3};
    const std::vector<Vec3<float>> wi(3, {0, 0, 1});
    std::vector<double> p(3);
    const auto counted = std::make_shared<Counted>();
    std::shared_ptr<const Technique> chain = counted;
    for (int level = 0; level < 30; ++level) chain = mixture_technique({chain, chain}, WeightList({}, 2, false, {}));
    chain->density({groups[0], {&run, 1}}, wi, p);
    EXPECT_EQ(counted->calls, 1);
    EXPECT_EQ(p, std::vector<double>(3, 0.25));
}

}  // namespace combination_test
}  // namespace crescent
