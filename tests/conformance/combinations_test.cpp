// Declared combinations of samplers: they have the films of the built-in combinations, agree with the reference, keep
// their bits on any number of threads, and pass the check.
#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "check/check.h"
#include "metrics/furnace.h"
#include "render/combination.h"
#include "render/estimator.h"
#include "render/reference/reference.h"
#include "run/arm_cases.h"
#include "run/execute.h"
#include "run/external_samplers.h"
#include "tests/support/scene_text.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/test_scene.h"

namespace crescent {
namespace combinations_test {

/// A glossy ball over a floor under two lights, with these arms.
Experiment with(const std::string& arms) {
    static const std::string lights = R"toml(
[disks.key]
center = [1.2, 2.9, 1.3]
normal = [-0.48, -0.81, -0.3369]
radius = 0.3
radiance = [90, 80, 70]
[lights.bulb]
kind = "sphere"
center = [-1.5, 2, 1]
radius = 0.3
radiance = [20, 30, 40]
[furnaces.white]
arm = "tested"
shape = "ball"
n = 4096
)toml";
    return parse(test::view_text + test::ball_text + test::floor_text + test::fill_text + lights + arms, "room.toml",
        {"seed=3", "n=64", "image.width=40", "image.height=24", "camera.eye=[0,0.8,3.2]", "camera.target=[0,0.5,0]",
            "camera.vfov_deg=42", "shapes.ball.center=[0,0.65,0]", "shapes.ball.radius=0.65",
            "shapes.ball.rho_d=[0.155,0.175,0.188]", "shapes.ball.rho_s=0.3", "shapes.ball.s=32",
            "shapes.ball.occludes=true", "shapes.floor.rho_d=[0.4,0.3,0.2]", "fill.radiance=[1.2,1.38,1.62]"});
}

/// The film of an arm at 64 samples per pixel.
Film film_of(const Experiment& e, const std::string& arm, std::uint64_t n = 64) {
    const ExternalSamplers outside = open_external(e);
    ProgressMonitor monitor;
    return estimate_films(
        Scene(e), SamplerRef(e.find_arm(arm)->sampler, external_of(outside, arm)), {n}, e.seed, "", monitor)[0];
}

/// The difference of the sums of two films, in the standard errors of `a`.
double errors_between(const Film& a, std::span<const float> reference) {
    double difference = 0, variance = 0;
    for (std::size_t i = 0; i < a.y.size(); ++i) {
        difference += double(a.y[i]) - double(reference[i]);
        variance += double(a.var[i]);
    }
    return difference / std::sqrt(variance);
}

ReferenceFilm reference_of(const Experiment& e) {
    ProgressMonitor monitor;
    return quadrature_reference(Scene(e), {e.s()}, monitor).front();
}

struct BuiltInPair {
    const char *built_in, *declared;
};

TEST(Combinations, HaveTheFilmsOfTheBuiltInOnes) {
    for (const auto& [built_in, declared] : {BuiltInPair{"mixture",
                                                 R"toml(kind = "mixture"
of = ["phong", "cosine"]
weights = ["min(rho_s / (rho_s + rho_d), 0.9)", "rest"])toml"},
             BuiltInPair{"mis-balance", "kind = \"mis\"\nof = [\"mixture\", \"light-area\"]"},
             BuiltInPair{"mis-power", "kind = \"mis\"\nof = [\"mixture\", \"light-area\"]\nheuristic = \"power\""},
             BuiltInPair{"mis-power",
                 "kind = \"mis\"\nof = [\"mixture\", \"light-area\"]\n"
                 "weights = [\"p1^2 / (p1^2 + p2^2)\", \"p2^2 / (p1^2 + p2^2)\"]"}}) {
        SCOPED_TRACE(declared);
        const Experiment e = with(std::string("[arms.") + built_in + "]\n[arms.tested]\n" + declared + "\n");
        const Film a = film_of(e, built_in), b = film_of(e, "tested");
        EXPECT_EQ(a.directions, b.directions);
        std::size_t unequal = 0, seen = 0;
        for (std::size_t i = 0; i < a.y.size(); ++i) {
            seen += a.y[i] > 0;
            unequal += std::fabs(a.y[i] - b.y[i]) > 1e-4f * a.y[i];
        }
        EXPECT_GT(seen, a.y.size() / 2);
        EXPECT_LE(unequal, seen / 200);  // a direction at the edge of a light or of a choice may be rounded across it
    }
}

TEST(Combinations, AgreeWithTheReference) {
    for (const std::string declared : {"kind = \"mis\"\nof = [\"cosine\", \"phong\", \"light-area\"]",
             "kind = \"mis\"\nof = [\"cosine\", \"phong\", \"light-solid-angle\"]\nsamples = [1, 2, 3]",
             "kind = \"mis\"\nof = [\"cosine\", \"uniform\"]\nweights = [0.25, 0.75]",
             "kind = \"mis\"\nof = [\"cosine\", \"phong\", \"light-area\"]\ndraw = \"one\"\nheuristic = \"power\"\n"
             "probabilities = [0.5, \"rho_s\", \"rest\"]",
             "kind = \"mis\"\nof = [\"cosine\", \"light-area\"]\ndraw = \"one\"",
             "kind = \"mixture\"\nof = [\"cosine\", \"light-area\", \"phong\"]\nweights = [0.5, 0.25, 0.25]",
             "kind = \"ris\"\nof = [\"cosine\", \"light-area\"]\ncandidates = 8",
             "kind = \"ris\"\nof = [\"cosine\"]\ncandidates = 5\ntarget = \"brdf\"",
             "kind = \"ris\"\nof = [\"cosine\", \"phong\"]\ncandidates = 3\ntarget = \"mixture\""}) {
        SCOPED_TRACE(declared);
        const Experiment e = with("[arms.tested]\n" + declared + "\n");
        const Film film = film_of(e, "tested", 256);
        EXPECT_EQ(film.invalid, 0u);
        EXPECT_LT(std::fabs(errors_between(film, reference_of(e).y)), 4);
    }
}

TEST(Combinations, ABiasedOneIsNoticed) {
    // No other sampler reaches the fill, and half of each direction is dropped.
    const Experiment e =
        with("[arms.tested]\nkind = \"mis\"\nof = [\"cosine\", \"light-area\"]\nweights = [0.5, 0.5]\n");
    EXPECT_GT(std::fabs(errors_between(film_of(e, "tested", 256), reference_of(e).y)), 10);
}

TEST(Combinations, MayCombineCombinations) {
    const Experiment e = with(
        "[arms.lobes]\nkind = \"mixture\"\nof = [\"cosine\", \"phong\"]\n"
        "[arms.tested]\nkind = \"mis\"\nof = [\"lobes\", \"light-area\"]\n");
    EXPECT_LT(std::fabs(errors_between(film_of(e, "tested", 256), reference_of(e).y)), 4);
}

TEST(Combinations, HaveTheBitsOfAnyNumberOfThreadsAndOfAPrefix) {
    for (const std::string declared : {"kind = \"mis\"\nof = [\"cosine\", \"light-area\"]",
             "kind = \"ris\"\nof = [\"cosine\", \"light-area\"]\ncandidates = 4"}) {
        const Experiment e = with("[arms.tested]\n" + declared + "\n");
        const ExternalSamplers outside = open_external(e);
        const SamplerRef arm("", external_of(outside, "tested"));
        ProgressMonitor monitor;
        const std::vector<Film> many = estimate_films(Scene(e), arm, {5, 64}, e.seed, "", monitor);
        on_threads(1, [&] {
            EXPECT_EQ(hash(estimate_films(Scene(e), arm, {5}, e.seed, "scalar", monitor)[0]), hash(many[0]));
            EXPECT_EQ(hash(estimate_films(Scene(e), arm, {64}, e.seed, "scalar", monitor)[0]), hash(many[1]));
        });
    }
}

TEST(Combinations, StateTheirCost) {
    const auto cost = [](const std::string& declared) {
        const Experiment e = with("[arms.tested]\n" + declared + "\n");
        return combination_of(open_external(e).at("tested").get())->cost();
    };
    const SampleCost every = cost("kind = \"mis\"\nof = [\"cosine\", \"light-area\"]\nsamples = [1, 3]");
    EXPECT_EQ(every.directions, 4u);
    EXPECT_EQ(every.f, 4u);
    EXPECT_EQ(every.densities, 4u);
    const SampleCost resampled = cost("kind = \"ris\"\nof = [\"cosine\", \"light-area\"]\ncandidates = 8");
    EXPECT_EQ(resampled.directions, 1u);
    EXPECT_EQ(resampled.f, 8u);
    EXPECT_EQ(resampled.densities, 8u);
    EXPECT_EQ(cost("kind = \"mixture\"\nof = [\"cosine\", \"phong\"]").directions, 1u);
}

TEST(Combinations, KeepTheWhiteFurnace) {
    for (const std::string declared : {"kind = \"mixture\"\nof = [\"cosine\", \"phong\"]",
             "kind = \"mis\"\nof = [\"cosine\", \"phong\", \"light-area\"]",
             "kind = \"ris\"\nof = [\"cosine\"]\ncandidates = 4"}) {
        SCOPED_TRACE(declared);
        const Experiment e = with("[arms.tested]\n" + declared + "\n");
        ProgressMonitor monitor;
        for (const FurnaceResult& f : furnaces(e, nullptr, "", monitor, open_external(e)))
            EXPECT_LT(std::fabs(f.measured - f.expected), 4 * f.se + 1e-6) << f.measured << " " << f.expected;
    }
}

CheckResult checked(const Experiment& e, int pixels) {
    ProgressMonitor monitor;
    TestSettings settings = TestSettings::quick();
    return run_checks(arm_cases(e, "tested", open_external(e), {.pixels = pixels}), settings, monitor);
}

TEST(ArmCases, PassACorrectCombinationAtPixelsOfItsScene) {
    for (const std::string declared : {"kind = \"mixture\"\nof = [\"cosine\", \"phong\"]",
             "kind = \"mis\"\nof = [\"cosine\", \"phong\", \"light-area\"]\nheuristic = \"power\"",
             "kind = \"ris\"\nof = [\"cosine\", \"light-area\"]\ncandidates = 4"}) {
        SCOPED_TRACE(declared);
        const CheckResult result = checked(with("[arms.tested]\n" + declared + "\n"), 2);
        for (const Verdict& v : result.verdicts) EXPECT_NE(v.state, State::wrong) << v.name << ": " << v.message();
    }
}

TEST(ArmCases, FailABiasedCombination) {
    const CheckResult result =
        checked(with("[arms.tested]\nkind = \"mis\"\nof = [\"cosine\", \"light-area\"]\nweights = [0.5, 0.5]\n"), 1);
    EXPECT_EQ(result.state, State::wrong);
}

}  // namespace combinations_test
}  // namespace crescent
