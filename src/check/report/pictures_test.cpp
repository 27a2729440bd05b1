// Maps sum to the draws, follow the lobe, and show differences.
#include "check/report/pictures.h"

#include <gtest/gtest.h>
#include <numeric>

#include "check/decide/tail.h"
#include "check/sources/cases.h"

namespace crescent::check {
namespace pictures_test {

struct MappedCase {
    CheckCase check_case;
    CheckAt at;
};
MappedCase mapped(const char* arm, double theta) {
    MappedCase out{make_case_on(case_setup(lobe_named("ggx"), false, "fill", 0.1), theta, 120, arm, nullptr), {}};
    out.check_case.adapter = sampler_on(arm, out.check_case);
    out.at = check_sampler_at(
        *out.check_case.adapter, 0, out.check_case.wo, {out.check_case.light}, CheckBudget::limited(), 1);
    return out;
}
double sum_of(const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0); }

TEST(PicturesOfACheck, MapObservedAndExpectedDraws) {
    for (double theta : {0.0, 60.0}) {
        const MappedCase m = mapped("ggx-vndf", theta);
        const std::optional<BinHistogram> map = bin_map(m.check_case, m.at);
        ASSERT_TRUE(map);
        const auto bins = static_cast<std::size_t>(map->rings * map->sectors);
        ASSERT_EQ(map->observed.size(), bins);
        ASSERT_EQ(map->edges.size(), static_cast<std::size_t>(map->rings) + 1);
        ASSERT_EQ(map->sector_edges.size(), static_cast<std::size_t>(map->sectors) + 1);
        EXPECT_TRUE(std::ranges::is_sorted(map->edges));
        const double drawn = static_cast<double>(m.at.observations.checks.directions);
        EXPECT_NEAR(sum_of(map->observed) / drawn, 1, 0.02);
        EXPECT_NEAR(sum_of(map->expected) / sum_of(map->observed), 1, 0.01);
        double furthest = 0;
        for (std::size_t i = 0; i < bins; ++i)
            furthest = std::max(furthest, std::fabs(map->observed[i] - map->expected[i]) / std::max(map->sd[i], 1.0));
        EXPECT_LT(furthest, 5);
        // The lobe fills the map: no bin contains a tenth of the draws.
        EXPECT_LT(*std::ranges::max_element(map->observed), drawn / 10);
    }
}

TEST(PicturesOfACheck, ShowTheWeightsAndTheTail) {
    const MappedCase m = mapped("uniform", 30);
    const std::vector<double> x = weights_of({&m.at, 1});
    WeightHistogram w = weight_picture(m.check_case, x, tail_of({&m.at, 1}));
    EXPECT_EQ(sum_of(w.counts) + w.zeros, static_cast<double>(x.size()));
    EXPECT_EQ(w.log10_edges.size(), w.counts.size() + 1);
    add_rose(m.check_case, w);
    ASSERT_EQ(w.rose_p.size(), 179u);
    ASSERT_EQ(w.rose_f.size(), 179u);
    // In the plane of incidence the lobe is opposite to w_o.
    const auto top = std::ranges::max_element(w.rose_f) - w.rose_f.begin() - 89;
    EXPECT_NEAR(static_cast<double>(top), -30, 3);
}

}  // namespace pictures_test
}  // namespace crescent::check
