// Samplers checked at all their w_o: how cases are grouped, that their results do not depend on each other, and what is
// kept if a sampler fails.
#include "check/decide/check_sampler.h"

#include <gtest/gtest.h>

#include "check/sources/check_case.h"
#include "tests/support/function_sampler.h"

namespace crescent::check {
namespace check_sampler_test {

CheckCase case_of(const std::shared_ptr<const SamplerAdapter>& adapter, double theta) {
    CheckCase t = make_user_case(adapter, theta, 30);
    t.arm = "made";
    return t;
}
std::vector<CheckOutcome> checked(const std::vector<CheckCase>& all, double cases = 1) {
    CheckSettings settings;
    settings.budget = CheckBudget::limited(1e5);
    settings.cases = cases;
    ProgressMonitor monitor;
    return check_samplers(all, settings, monitor);
}

TEST(CheckedSamplers, AreGroupedByNameAndSurface) {
    const auto s = std::make_shared<FunctionSampler>();
    std::vector<CheckCase> all{case_of(s, 10), case_of(s, 40), case_of(s, 60), case_of(s, 70)};
    all[1].brdf = "Lambert";
    all[2].baseline = true;
    const auto found = checked(all);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].check_cases, (std::vector<std::size_t>{0, 3}));
    EXPECT_EQ(found[1].check_cases, std::vector<std::size_t>{1});
    EXPECT_FALSE(found[0].wrong());
    EXPECT_EQ(found[0].checks[1].size(), 1u);  // one technique
}

TEST(CheckedSamplers, HaveTheSameNumbersBesideOthers) {
    const auto s = std::make_shared<FunctionSampler>();
    const auto one = checked({case_of(s, 10)}), two = checked({case_of(s, 10), case_of(s, 70)});
    const Observations &alone = one[0].checks[0][0].observations, &beside = two[0].checks[0][0].observations;
    EXPECT_EQ(alone.sums[slope].sum, beside.sums[slope].sum);
    EXPECT_NE(alone.sums[slope].sum, two[0].checks[1][0].observations.sums[slope].sum);
}

TEST(CheckedSamplers, FreeTheEvidenceOfARightWo) {
    const auto right = std::make_shared<FunctionSampler>(), wrong = std::make_shared<FunctionSampler>();
    wrong->p = [](Vec3d o, Vec3d w) { return 2 * cosine_pdf(o, w); };
    EXPECT_FALSE(checked({case_of(right, 40)})[0].checks[0][0].plan);
    const auto found = checked({case_of(wrong, 40)});
    EXPECT_TRUE(found[0].wrong());
    EXPECT_TRUE(found[0].checks[0][0].plan);
}

TEST(CheckedSamplers, AFaultOfTheWholeSamplerIsOfNoWo) {
    const auto s = std::make_shared<FunctionSampler>();
    s->f_value = [](Vec3d o, Vec3d w) { return w.z > 0 && o.z > 0 ? 0.1 + 0.05 * o.z : 0; };
    const auto found = checked({case_of(s, 20), case_of(s, 60)});
    ASSERT_EQ(found[0].small.size(), 1u);
    EXPECT_EQ(found[0].small[0].family, Family::reciprocity);
    for (const auto& at : found[0].checks) EXPECT_FALSE(at[0].wrong());
}

struct LogMonitor : ProgressMonitor {
    std::vector<std::string> lines;
    void log(std::string_view line) override { lines.emplace_back(line); }
};

TEST(CheckedSamplers, TheFirstWoIsLoggedBeforeTheOthersEnd) {
    struct Serial : FunctionSampler {
        bool serial() const override { return true; }
    };
    const auto right = std::make_shared<Serial>(), wrong = std::make_shared<Serial>();
    wrong->p = [](Vec3d o, Vec3d w) { return 2 * cosine_pdf(o, w); };
    CheckSettings settings;
    settings.budget = CheckBudget::limited(1e5);
    const auto logged = [&](const std::vector<CheckCase>& all) {
        LogMonitor monitor;
        check_samplers(all, settings, monitor);
        return monitor.lines;
    };
    EXPECT_TRUE(logged({case_of(right, 45)}).empty());
    EXPECT_EQ(logged({case_of(right, 10), case_of(right, 45)}),
        std::vector<std::string>{"1 of 2: made, w_o 45 deg az 30: no fault found"});
    EXPECT_EQ(logged({case_of(wrong, 45), case_of(wrong, 60)}),
        std::vector<std::string>{"1 of 2: made, w_o 45 deg az 30: normalised, density wrong"});
}

/// A program that ends at w_o beyond 50 degrees.
struct Ending : FunctionSampler {
    bool serial() const override { return true; }
    void sample(int t, Vec3d wo, std::span<const PrimarySample> u, std::span<Draw> out) const override {
        if (wo.z < 0.64) throw SamplerError("it ended");
        FunctionSampler::sample(t, wo, u, out);
    }
};

TEST(CheckedSamplers, KeepTheResultsBeforeAFailure) {
    const auto s = std::make_shared<Ending>();
    s->of.wo = Traits::WoDomain::upper;
    const auto found = checked({case_of(s, 40), case_of(s, 60)});
    EXPECT_FALSE(found[0].cut[0]);
    EXPECT_EQ(found[0].checks[0].size(), 1u);
    ASSERT_TRUE(found[0].cut[1]);
    EXPECT_EQ(found[0].cut[1]->what, "it ended");
    EXPECT_TRUE(found[0].checks[1].empty());
}

}  // namespace check_sampler_test
}  // namespace crescent::check
