// Calls to a sampler at one w_o: their count, unusable answers, and the rows of a file for each stream.
#include "check/estimate/source.h"

#include <gtest/gtest.h>
#include <limits>
#include <set>

#include "tests/support/function_sampler.h"

namespace crescent::check {
namespace source_test {

const CaseLighting uniform_light;

TEST(CheckSource, UnusableAnswersAreZeroAndCounted) {
    FunctionSampler s;
    s.p = [](Vec3d, Vec3d w) { return w.x > 0.5 ? -1.0 : w.y > 0.5 ? std::numeric_limits<double>::infinity() : 0.25; };
    Source source(s, 0, {0, 0, 1}, uniform_light);
    const Vec3d wi[] = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
    double p[3];
    source.density(wi, p);
    EXPECT_EQ(p[0], 0.25);
    EXPECT_EQ(p[1], 0);
    EXPECT_EQ(p[2], 0);
    EXPECT_EQ(source.invalid().count(), 2u);
    EXPECT_EQ(source.evaluations(), 3u);
    double stated[3];
    source.stated_pdf(wi, stated);
    EXPECT_EQ(stated[1], -1);
    EXPECT_EQ(source.invalid().count(), 2u);  // numbers are returned unchanged here
}

TEST(CheckSource, WithoutADensityItIsOne) {
    FunctionSampler s;
    Source source(s, 0, {0, 0, 1}, uniform_light);
    source.by_draws = true;
    EXPECT_EQ(source.density({0, 0, 1}), 1);
    EXPECT_EQ(source.evaluations(), 0u);
}

TEST(CheckSource, FHasTheCosineOfEitherSide) {
    FunctionSampler s;
    s.f_value = [](Vec3d, Vec3d) { return 2.0; };
    Source source(s, 0, {0, 0, 1}, uniform_light);
    const Vec3d wi[] = {tilt(60), tilt(120)};
    Vec3d f[2];
    source.f_cos(wi, f);
    EXPECT_NEAR(f[0].x, 1, 1e-12);
    EXPECT_NEAR(f[1].z, 1, 1e-12);
}

TEST(CheckSource, LightBelowTheSurfaceIsItsUniformPart) {
    FunctionSampler s;
    CaseLighting light;
    light.fill = 0.5;
    light.disks.push_back({20, {0, 0, 2}, {0, 0, -1}, 1});
    const Source source(s, 0, {0, 0, 1}, light);
    EXPECT_EQ(source.radiance({0, 0, 1}), 20);
    EXPECT_EQ(source.radiance({0, 0, -1}), 0.5);
    EXPECT_EQ(source.radiance(tilt(80)), 0.5);
}

struct File : RecordedSampler {
    explicit File(int rows) {
        for (int i = 0; i < rows; ++i) {
            u_.emplace_back(i, 0);
            draws_.push_back({{0, 0, 1}, 1});
        }
    }
    std::string name() const override { return "file"; }
    void pdf(int, std::span<const Pair>, std::span<double>) const override {}
    std::string place(std::size_t) const override { return ""; }
};

TEST(CheckSource, NoRowOfAFileIsUsedTwice) {
    const File file(83);
    Source source(file, 0, {0, 0, 1}, uniform_light);
    std::multiset<double> used;
    for (const auto& [purpose, stage] : {std::pair{Purpose::pilot, std::uint8_t{1}}, {Purpose::draws, std::uint8_t{1}},
             {Purpose::draws, std::uint8_t{2}}}) {
        const StreamKey key{1, 0, 0, stage, purpose};
        std::vector<PrimarySample> u(source.available(key, 1000));
        std::vector<Draw> draws(u.size());
        source.draw(key, 0, u, draws);
        for (const PrimarySample& row : u) used.insert(row.x);
    }
    EXPECT_EQ(used.size(), 83u);
    EXPECT_EQ(std::set<double>(used.begin(), used.end()).size(), 83u);
    EXPECT_EQ(source.available({1, 0, 0, 1, Purpose::draws}, 10), 10u);
}

TEST(CheckSource, ADrawBelowCountsIfThereIsADensity) {
    const Traits surface;
    EXPECT_TRUE(is_direction(surface, {{0, 0, 1}, 1}, 0));
    EXPECT_FALSE(is_direction(surface, {{0, 0, -1}, 1}, 0));
    EXPECT_TRUE(is_direction(surface, {{0, 0, -1}, 1}, 0.1));
    EXPECT_FALSE(is_direction(surface, {{0, 0, 1}, 0}, 1));
    Traits light;
    light.wo = Traits::WoDomain::none;
    EXPECT_TRUE(is_direction(light, {{0, 0, -1}, 1}, 0));
    Draw delta{{0, 0, 1}, 1};
    delta.delta = 0.5;
    EXPECT_FALSE(is_direction(surface, delta, 1));
}

}  // namespace source_test
}  // namespace crescent::check
