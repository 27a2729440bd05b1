// One alpha over all tests of a GoogleTest program, however many samplers they judge.
//
//   int main(int argc, char** argv) {
//       testing::InitGoogleTest(&argc, argv);
//       crescent::share_alpha(1e-3);  // a program of right samplers fails by chance once in 1000 runs at most
//       return RUN_ALL_TESTS();
//   }
//
// Tests that run have equal shares (Sidak), and the k-th matcher within a test 6 / (pi k)^2 of its test's. At the end
// the program says what was spent.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>

#include "trials/settings.h"

namespace crescent::inline verdicts {

class SharedAlpha : public testing::Environment {
public:
    explicit SharedAlpha(double alpha) : alpha_(alpha) {}

    /// The alpha of the next sampler in the test named so.
    double next(const std::string& test, int tests) {
        const double pi2 = 9.869604401089358, k = ++calls_[test];
        const double share = -std::expm1(std::log1p(-alpha_) / std::max(tests, 1)) * 6 / (pi2 * k * k);
        spent_ += share;
        ++judged_;
        return share;
    }
    double spent() const { return spent_; }
    void TearDown() override {
        if (judged_ > 0)
            std::printf(
                "crescent: %d samplers judged, which share alpha = %g: right ones fail by chance at most once in "
                "%.0f runs\n",
                judged_, alpha_, 1 / spent_);
    }

private:
    double alpha_, spent_ = 0;
    int judged_ = 0;
    std::map<std::string, int> calls_;
};

/// Where the sharing stands; null: each matcher has alpha for itself.
inline SharedAlpha*& shared_alpha() {
    static SharedAlpha* shared = nullptr;
    return shared;
}
/// From here on the matchers of this program share alpha. GoogleTest owns what is returned.
inline SharedAlpha& share_alpha(double alpha = 1e-3) {
    auto* shared = new SharedAlpha(alpha);
    testing::AddGlobalTestEnvironment(shared);
    return *(shared_alpha() = shared);
}
/// `settings` with the share of alpha that the running test's next sampler has.
inline TestSettings shared_settings(TestSettings settings = TestSettings::quick()) {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    if (shared_alpha() && test)
        settings.alpha = shared_alpha()->next(std::string(test->test_suite_name()) + "." + test->name(),
            testing::UnitTest::GetInstance()->test_to_run_count());
    return settings;
}

}  // namespace crescent::inline verdicts
