// Checks of samplers: the settings, the checks of a list of cases, and the comparison of two samplers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/progress.h"
#include "check/estimate/budget.h"
#include "check/report/print.h"
#include "check/sources/check_case.h"
#include "check/verdict.h"

namespace crescent {

// ---- The settings of a check: error level, budget and w_o.

/// Budgets and the significance level of one call.
struct TestSettings {
    bool full = false;    // more w_o, more draws
    double alpha = 1e-3;  // family-wise, for all tests of one call
    std::uint32_t seed = 1;
    bool pictures = false;                   // store maps and weights, for the page and the JSON
    std::size_t questions = 500000;          // queries to a sampler behind a pipe, plugin or Python at one w_o, at most
    std::size_t questions_in_all = 3600000;  // queries at all w_o of the grid together, at most
    std::size_t further_in_all = 8000000;    // evaluations by which w_o that are not decided go on, in all
    std::vector<std::pair<double, double>> wo{};  // theta and azimuth in degrees; empty: the grid
    bool accept_few = false;  // whether a program too slow for every w_o is checked by those that were examined
    double seconds = 60;      // for one sampler in C++, in all; what is not examined then is inconclusive; 0: no limit
    std::optional<check::CheckBudget> budget{};  // of each w_o; empty: that of the mode, or of the queries

    /// The defaults.
    static TestSettings quick() { return {}; }
    /// More evaluations at each w_o and twice as many w_o: for a cosine lobe, one measurement gave 1.0 s of processor
    /// time for each w_o, where quick takes 0.2 s.
    static TestSettings thorough() {
        TestSettings r;
        r.full = true;
        r.questions = 6000000;
        r.questions_in_all = 72000000;
        r.further_in_all = 0;
        r.seconds = 3600;
        return r;
    }
};

/// Verdicts in the order of the cases and of verdict_names. If a sampler fails to answer at one w_o, the results of its
/// other w_o are kept. Throws Interrupted if the monitor requests a stop.
CheckResult run_checks(std::span<const CheckCase> check_cases, const TestSettings& settings, ProgressMonitor& monitor);

/// The budget of each w_o of a sampler, from the settings and the number of w_o.
check::CheckBudget budget_of(const TestSettings& settings, bool is_limited, std::size_t w_o);

}  // namespace crescent

namespace crescent::check {

// ---- Compares two samplers, A and B, at the same w_o under the same light: whether they draw from one distribution,
// whether they have the same f, and which has the smaller variance. There are three verdicts for each w_o:
//
//   same_distribution  E_A[h] = E_B[h] for the nodes of one tree, mean directions and the share of delta parts, in two
//                      stages
//   same_f             f of both at directions over the whole sphere and at draws of either; q times weight of delta
//                      parts
//   variance           Var X_A / Var X_B with its 95 % interval; "heavy tail" if either sampler has one
//
// Without a pdf(w), X is the weight that the sampler returns with a draw.

/// The cases of A and of B correspond one to one. expect_same: a difference in distribution or f is wrong, not only
/// reported.
CheckResult compare_samplers(std::span<const CheckCase> a, std::span<const CheckCase> b, const TestSettings& settings,
    bool expect_same, ProgressMonitor& monitor);

/// One line for each w_o: both states, the ratio and its interval.
std::string against_text(const CheckResult& result);

}  // namespace crescent::check

namespace crescent {
using check::against_text, check::compare_samplers;
}
