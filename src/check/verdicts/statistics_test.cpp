// p-values compared with exact distributions.
#include "check/verdicts/statistics.h"

#include <array>
#include <gtest/gtest.h>

#include "check/verdicts/kinds.h"
#include "tests/support/function_sampler.h"

namespace crescent::check {
namespace statistics_test {

/// P(N >= k) and P(N <= k) of a binomial.
double above(double n, double p, double k) { return k <= 0 ? 1 : beta_i(k, n - k + 1, p, 1 - p); }
double below(double n, double p, double k) { return k >= n ? 1 : 1 - above(n, p, k + 1); }

TEST(CheckStatistics, BennettBoundsTheBinomialTail) {
    for (double n : {100.0, 1e4, 1e6})
        for (double mean : {0.1, 3.0, 20.0, 90.0}) {
            const double p = mean / n;
            for (double by : {1.0, 3.0, 8.0, 20.0, 40.0}) {
                const double k = std::ceil(mean + by);
                if (k > n) continue;
                const double bound = bennett_p(bennett_z2(k - mean, n * p * (1 - p), 1, 1e12));
                EXPECT_GE(bound, above(n, p, k)) << n << " " << mean << " " << k;
                if (mean - by >= 0)
                    EXPECT_GE(bennett_p(bennett_z2(by, n * p * (1 - p), 1, 1e12)), below(n, p, std::floor(mean - by)));
            }
        }
}

TEST(CheckStatistics, BennettApproachesTheNormalDistribution) {
    const double z2 = bennett_z2(5, 1, 1e-6, 1e12);
    EXPECT_NEAR(z2, 25, 0.01);
    EXPECT_GT(bennett_p(z2), normal_two_sided(5));
    EXPECT_LT(bennett_p(z2), 20 * normal_two_sided(5));
}

TEST(CheckStatistics, UncertainVarianceWeakensATest) {
    EXPECT_GT(bennett_p(bennett_z2(6, 1, 1e-3, 2)), 0.01);
    EXPECT_LT(bennett_p(bennett_z2(6, 1, 1e-3, 1e12)), 1e-6);
    EXPECT_EQ(freedom(1, 0), 1e12);
    EXPECT_NEAR(freedom(3, 9), 2, 1e-12);
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(bennett_p(bennett_z2(6, infinity, 1e-3, freedom(infinity, infinity))), 1);
    EXPECT_EQ(student_p_of(6, infinity, freedom(infinity, infinity)), 1);
    EXPECT_LE(freedom(1e200, std::numeric_limits<double>::quiet_NaN()), 1);
}

TEST(CheckStatistics, ReplicatesWithoutSpreadHaveALeastVariance) {
    std::array<double, 32> all;
    all.fill(7.0);
    const ReplicateMean alike(all, 1.0);
    EXPECT_EQ(alike.mean, 7);
    // If one replicate in five has one more draw, none of these 32 shows it with probability 8e-4. The test must pass.
    EXPECT_GT(student_p_of(0.2, alike.variance, 31), alpha2 / 10);
    EXPECT_GT(student_p_of(0.1, alike.variance, 31), 1e-2);
}

// ---- The two stages of a test, and what each verdict needs of a sampler.

struct Given {
    int family = 0, member = 0;
    double difference = 0, p = 1;
};
const Given given[] = {{1, 0, 0.5, 0.2}, {2, 0, 1, 0.3}, {1, 1, -2, 0.01}, {1, 2, 0.1, 0.02}};
const auto visit_given = [](const auto& visit) {
    for (const Given& g : given) visit(g);
};

TEST(TwoStages, TheLeastPIsCorrectedForItsMembers) {
    const auto least = least_by_family<Given>(visit_given);
    ASSERT_EQ(least.size(), 2u);
    EXPECT_EQ(least.at(1).answer.member, 1);
    EXPECT_DOUBLE_EQ(least.at(1).p(), 0.03);
    EXPECT_DOUBLE_EQ(least.at(2).p(), 0.3);
    LeastOf<Given> many{{0, 0, 0, 0.5}, 3};
    EXPECT_EQ(many.p(), 1);
}

TEST(TwoStages, TheSecondTestsTheSameMemberAndSign) {
    EXPECT_EQ(same_member(visit_given, Given{1, 2, 9, 0}).p, 0.02);
    EXPECT_EQ(same_member(visit_given, Given{1, 7, 9, 0}).p, 1);  // it does not exist any more
    EXPECT_EQ(one_sided(Given{1, 0, 2, 0}, Given{1, 0, 1, 0.01}), 0.005);
    EXPECT_EQ(one_sided(Given{1, 0, 2, 0}, Given{1, 0, -1, 0.01}), 1);
}

TEST(VerdictKinds, AreSkippedWithoutWhatTheyNeed) {
    FunctionSampler with_f, without_pdf, with_delta;
    with_f.f_value = lambert(0.5);
    without_pdf.of.has_pdf = false;
    with_delta.of.delta = true;
    const auto applied = [](const SamplerAdapter& s) {
        std::string out;
        for (std::size_t k = 0; k < verdict_names.size(); ++k)
            if (verdict_kinds[k]->applies(s)) out += std::string(verdict_names[k]) + " ";
        return out;
    };
    EXPECT_EQ(applied(FunctionSampler()), "valid normalised density identity ");
    EXPECT_EQ(applied(with_f), "valid support normalised density identity physics tail mean ");
    EXPECT_EQ(applied(without_pdf), "valid density identity ");
    EXPECT_EQ(applied(with_delta), "valid normalised density identity physics ");
}

}  // namespace statistics_test
}  // namespace crescent::check
