// The settings of a check: error level, budget and w_o.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "check/estimate/budget.h"

namespace crescent {

/// Budgets and the significance level of one call.
struct TestSettings {
    bool full = false;    // more w_o, more draws
    double alpha = 1e-3;  // family-wise, for all tests of one call
    std::uint32_t seed = 1;
    bool pictures = false;                   // store maps and weights for the HTML page
    std::size_t questions = 500000;          // queries to a sampler behind a pipe, plugin or Python at one w_o, at most
    std::size_t questions_in_all = 3600000;  // queries at all w_o of the grid together, at most
    std::vector<std::pair<double, double>> wo{};  // theta and azimuth in degrees; empty: the grid
    bool accept_few = false;  // whether a program too slow for every w_o is checked by those that were examined
    std::optional<check::CheckBudget> budget{};  // of each w_o; empty: that of the mode, or of the queries

    static TestSettings quick() { return {}; }
    /// More evaluations at each w_o and twice as many w_o: for a cosine lobe, one measurement gave 1.0 s of processor
    /// time for each w_o, where quick takes 0.2 s.
    static TestSettings thorough() {
        TestSettings r;
        r.full = true;
        r.questions = 6000000;
        r.questions_in_all = 72000000;
        return r;
    }
};

}  // namespace crescent
