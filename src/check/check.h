// Checks of samplers: the settings, and the checks of a list of cases.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
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
