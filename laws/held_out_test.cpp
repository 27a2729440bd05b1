// Faults whose causes were written down before a diagnosis was asked for them: four of five are named, and nothing is
// said of those that have no such cause.
#include <gtest/gtest.h>

#include "base/sanitized_test.h"
#include "laws/planted/planted.h"

namespace crescent {
namespace {

void expect_four_of_five_named(const std::vector<PlantedFault>& faults) {
    ProgressMonitor monitor;
    std::size_t with = 0, named = 0;
    std::string told;
    EXPECT_GE(faults.size(), 20u);
    for (std::size_t k = 0; k < faults.size(); k += test::every) {
        const PlantedFault& fault = faults[k];
        TestSettings settings;
        settings.draws = 16384;
        const Judgement j =
            judge(std::span(fault.trials).subspan(1, 1), settings, monitor);  // one w_o shows each of them
        EXPECT_EQ(j.state, State::wrong) << fault.name;
        const Explained e = explained(fault, j);
        with += !e.cause.empty();
        named += e.right;
        told += e.fault + ": " + e.cause + " -> " + e.said + "\n";
        if (e.cause.empty()) EXPECT_EQ(e.said, "none") << e.fault;
    }
    EXPECT_GE(10 * named, 8 * with) << told;
}

TEST(HeldOutFaults, AreCaughtAndFourOfFiveCausesAreNamed) { expect_four_of_five_named(held_out_faults()); }

TEST(HeldOutFaults, OfSeveralLobesAndOfLightsAreCaughtAndFourOfFiveCausesAreNamed) {
    expect_four_of_five_named(held_out_lobe_faults());
}

}  // namespace
}  // namespace crescent
