// How much is asked of a sampler, and how surely: sample counts, budgets, significance levels.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace crescent::inline trials {

/// Sample counts, quadrature budget and significance levels of the tests.
struct TestSettings {
    bool full = false;
    double alpha = 1e-3;  // family-wise, for everything tested in one call
    std::uint32_t seed = 1;
    std::uint64_t draws = std::uint64_t{1} << 15;  // per trial and technique
    int rings = 20, sectors = 16;
    std::size_t evaluations = 80000;              // of one integral, at most
    bool pictures = false;                        // keep maps and weights for the HTML page
    std::size_t questions = 500000;               // of a limited sampler at one w_o, at most
    std::size_t questions_in_all = 4000000;       // and at the w_o of the grid together
    std::vector<std::pair<double, double>> wo{};  // theta and azimuth in degrees in place of the grid; empty: the grid
    bool accept_few = false;  // a program too slow for every w_o is judged by those that were looked at
    // Two-stage level: a test fails where p < screen on the first seed and p < confirm on a fresh one with more draws.
    double screen = 1e-3, confirm = 1e-4;
    static TestSettings quick() { return {}; }
    static TestSettings thorough();
    /// Levels for `tests` statistical tests: screen * confirm = 1 - (1 - alpha)^(1/tests) (Sidak), confirm = screen
    /// / 10.
    void share(std::uint64_t tests);
};

/// Counted over a whole call, from many threads.
struct TestCounts {
    std::atomic<std::uint64_t> tests{0}, screened{0}, confirmed{0};
};

}  // namespace crescent::inline trials
