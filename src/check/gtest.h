// GoogleTest matchers that check a sampler in one line of a test suite, and one alpha over a suite.
//
//   EXPECT_THAT(MySampler{}, crescent::IsARightSampler());        // nothing wrong, nothing inconclusive
//   EXPECT_THAT(MySampler{}, crescent::IsNotAWrongSampler());     // a heavy tail is allowed
//   EXPECT_THAT(bsdf_pointer, crescent::IsARightSampler());       // T*, unique_ptr, shared_ptr
//   EXPECT_THAT(MySampler{}, crescent::IsARightSamplerBy(crescent::TestSettings::thorough()));
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <utility>

#include "check/check.h"
#include "check/report/summary.h"
#include "check/user.h"

namespace crescent {

// ---- One alpha over all tests of a GoogleTest suite, independent of how many samplers they check.
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

/// Hands out the shares of alpha.
class SharedAlpha : public testing::Environment {
public:
    /// alpha: of the whole suite.
    explicit SharedAlpha(double alpha) : alpha_(alpha) {}

    /// The alpha of the next sampler in the test with that name; tests: number of tests in the suite.
    double next(const std::string& test, int tests) {
        const double pi2 = 9.869604401089358, k = ++calls_[test];
        const double share = -std::expm1(std::log1p(-alpha_) / std::max(tests, 1)) * 6 / (pi2 * k * k);
        share_sum_ += share;
        ++check_count_;
        return share;
    }
    /// The sum of the shares that this process used.
    double spent() const { return share_sum_; }
    /// Prints the number of checked samplers and the probability of a false failure.
    void TearDown() override {
        if (check_count_ > 0)
            std::printf(
                "crescent: %d samplers checked in this process; right ones fail by chance with probability at "
                "most %.4g of the suite's %g\n",
                check_count_, share_sum_, alpha_);
    }

private:
    double alpha_, share_sum_ = 0;
    int check_count_ = 0;
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

/// Replaces the bytes that GoogleTest prints for a struct without operator<<.
template <class S>
    requires(crescent::user::Checkable<S> && !crescent::user::Pointing<S> &&
        !requires(std::ostream& out, const S s) { out << s; })
class testing::internal::UniversalPrinter<S> {
public:
    /// Prints a fixed text.
    static void Print(const S&, std::ostream* out) { *out << "a sampler"; }
};

namespace crescent {

/// Prints the name of a sampler of another process in messages of GoogleTest.
template <std::derived_from<SamplerAdapter> Adapter>
void PrintTo(const std::shared_ptr<Adapter>& sampler, std::ostream* out) {
    *out << (sampler ? sampler->name() : "no sampler");
}

/// Checks a sampler. EXPECT_THAT matches first and, on failure, matches again for an explanation: the second match of
/// the same argument reuses the result of the first. A stored result is never used for another match.
template <class Argument> class SamplerMatcher : public testing::MatcherInterface<Argument> {
public:
    /// settings: of each check; is_open: whether inconclusive verdicts match.
    SamplerMatcher(TestSettings settings, bool is_open) : settings_(std::move(settings)), is_open_(is_open) {}

    /// Whether the sampler is right. If it is not, explains why in at most 8 lines.
    bool MatchAndExplain(Argument arg, testing::MatchResultListener* listener) const override {
        const CheckResult j = result_of(arg, listener->IsInterested());
        const bool matches = j.state == State::right || (is_open_ && j.state == State::inconclusive);
        if (!matches && listener->IsInterested()) *listener << "\n" << what_is_wrong(j);
        if (matches && !listener->IsInterested()) record(j);
        return matches;
    }
    /// "is a right sampler"
    void DescribeTo(std::ostream* out) const override {
        *out << (is_open_ ? "is not a wrong sampler" : "is a right sampler");
    }
    /// "is not a right sampler"
    void DescribeNegationTo(std::ostream* out) const override {
        *out << (is_open_ ? "is a wrong sampler" : "is not a right sampler");
    }

private:
    /// What was tested is a property of the running test in GoogleTest's XML and JSON: crescent_1, crescent_2 ... It is
    /// also printed if the environment variable CRESCENT_PRINT is set.
    static void record(const CheckResult& result) {
        static int count = 0;
        const std::string text = what_was_tested(result);
        if (testing::UnitTest::GetInstance()->current_test_info())
            testing::Test::RecordProperty("crescent_" + std::to_string(++count), text);
        if (std::getenv("CRESCENT_PRINT")) std::printf("%s", text.c_str());
    }
    /// Matchers of several elements (Each, ElementsAre) match some before they explain the first: only an explanation
    /// directly after a single match reuses its result.
    CheckResult result_of(const std::remove_cvref_t<Argument>& arg, bool explains) const {
        if (explains && since_explained_ == 1 && argument_ == &arg && result_) {
            since_explained_ = 0;
            return *std::exchange(result_, std::nullopt);
        }
        CheckResult j = check_sampler("sampler", user::copy_for_check(arg), shared_settings(settings_));
        result_.reset();
        since_explained_ = explains ? 0 : since_explained_ + 1;
        if (!explains) {
            result_ = j;
            argument_ = &arg;
        }
        return j;
    }

    TestSettings settings_;
    bool is_open_;
    mutable std::optional<CheckResult> result_;
    mutable const void* argument_ = nullptr;
    mutable int since_explained_ = 0;
};

/// A matcher for any sampler that check_sampler accepts.
class AnySamplerMatcher {
public:
    /// As SamplerMatcher.
    AnySamplerMatcher(TestSettings settings, bool is_open) : settings_(std::move(settings)), is_open_(is_open) {}
    /// The matcher for one type.
    template <class Argument> operator testing::Matcher<Argument>() const {
        return testing::Matcher<Argument>(new SamplerMatcher<Argument>(settings_, is_open_));
    }

private:
    TestSettings settings_;
    bool is_open_;
};

/// EXPECT_THAT(MySampler{}, crescent::IsARightSampler()): every verdict is right or skipped.
inline AnySamplerMatcher IsARightSampler() { return {TestSettings::quick(), false}; }

/// The same, but inconclusive verdicts pass too.
inline AnySamplerMatcher IsNotAWrongSampler() { return {TestSettings::quick(), true}; }

/// The same with other settings: EXPECT_THAT(MySampler{},
/// crescent::IsARightSamplerBy(crescent::TestSettings::thorough())).
inline AnySamplerMatcher IsARightSamplerBy(const TestSettings& settings) { return {settings, false}; }

}  // namespace crescent
