// The two stages of a test, and what each verdict needs of a sampler.
#include "check/verdicts/two_stages.h"

#include <gtest/gtest.h>

#include "check/verdicts/kinds.h"
#include "tests/support/function_sampler.h"

namespace crescent::check {
namespace {

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
    without_pdf.of.has_pdf = false, with_delta.of.delta = true;
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

}  // namespace
}  // namespace crescent::check
