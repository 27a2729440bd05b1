// One alpha over all tests of a GoogleTest suite, independent of how many samplers they check.
//
//   int main(int argc, char** argv) {
//       testing::InitGoogleTest(&argc, argv);
//       crescent::share_alpha(1e-3);  // a suite of right samplers fails by chance once in 1000 runs at most
//       return RUN_ALL_TESTS();
//   }
//
// Every test of the program has an equal share (Sidak), whether it runs or not, and the k-th matcher of a test has 6 /
// (pi k)^2 of the share of that test. The shares are therefore the same if all tests run in one process or, with
// gtest_discover_tests, each in its own process.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>

#include "check/settings.h"

namespace crescent {

class SharedAlpha : public testing::Environment {
public:
    explicit SharedAlpha(double alpha) : alpha_(alpha) {}

    /// The alpha of the next sampler in the test with that name; tests: number of tests in the suite.
    double next(const std::string& test, int tests) {
        const double pi2 = 9.869604401089358, k = ++calls_[test];
        const double share = -std::expm1(std::log1p(-alpha_) / std::max(tests, 1)) * 6 / (pi2 * k * k);
        spent_ += share;
        ++checked_;
        return share;
    }
    /// The sum of the shares that this process used.
    double spent() const { return spent_; }
    /// Prints the number of checked samplers and the probability of a false failure.
    void TearDown() override {
        if (checked_ > 0)
            std::printf(
                "crescent: %d samplers checked in this process; right ones fail by chance with probability at "
                "most %.4g of the suite's %g\n",
                checked_, spent_, alpha_);
    }

private:
    double alpha_, spent_ = 0;
    int checked_ = 0;
    std::map<std::string, int> calls_;
};

/// The shared alpha; null: each matcher has its own alpha.
inline SharedAlpha*& shared_alpha() {
    static SharedAlpha* shared = nullptr;
    return shared;
}
/// Makes the matchers of this program share alpha. GoogleTest owns the returned object.
inline SharedAlpha& share_alpha(double alpha = 1e-3) {
    auto* shared = new SharedAlpha(alpha);
    testing::AddGlobalTestEnvironment(shared);
    return *(shared_alpha() = shared);
}
/// `settings` with the share of alpha of the next sampler in the running test.
inline TestSettings shared_settings(TestSettings settings = TestSettings::quick()) {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    if (shared_alpha() && test)
        settings.alpha = shared_alpha()->next(std::string(test->test_suite_name()) + "." + test->name(),
            testing::UnitTest::GetInstance()->total_test_count());
    return settings;
}

}  // namespace crescent
