// The GoogleTest matchers: one check for each, on success and on failure, and one alpha over a suite.
#include "check/gtest.h"

#include <gtest/gtest-spi.h>

#include <atomic>
#include <cmath>
#include <sstream>

namespace crescent {
namespace gtest_test {

std::atomic<int> calls = 0;

struct Counted {
    struct Drawn {
        Vec3d wi;
        double pdf;
    };
    double factor = 1;
    Drawn sample(Vec3d wo, Vec2d u) const {
        ++calls;
        const double r = std::sqrt(u.x), phi = 2 * pi * u.y, z = std::sqrt(1 - u.x);
        const Vec3d wi{r * std::cos(phi), r * std::sin(phi), z};
        return {wi, pdf(wo, wi)};
    }
    double pdf(Vec3d, Vec3d wi) const { return wi.z > 0 ? factor * wi.z / pi : 0; }
};

template <class Run> int calls_of(Run&& run) {
    calls = 0;
    run();
    return calls;
}

TestSettings one_wo() {
    TestSettings settings;
    settings.wo = {{45, 130}};
    return settings;
}

TEST(Matchers, CheckOnceAlsoOnFailure) {
    const int once = calls_of([] { check_sampler("sampler", Counted{1.1}, one_wo()); });
    ASSERT_GT(once, 0);
    EXPECT_EQ(calls_of([] { EXPECT_THAT(Counted{}, IsARightSamplerBy(one_wo())); }),
        calls_of([] { check_sampler("sampler", Counted{}, one_wo()); }));
    EXPECT_EQ(calls_of([] {
        EXPECT_NONFATAL_FAILURE(EXPECT_THAT(Counted{1.1}, IsARightSamplerBy(one_wo())), "normalised is wrong");
    }),
        once);
}

TEST(Matchers, RecordWhatWasTested) {
    EXPECT_THAT(Counted{}, IsARightSamplerBy(one_wo()));
    const testing::TestResult& result = *testing::UnitTest::GetInstance()->current_test_info()->result();
    ASSERT_EQ(result.test_property_count(), 1);
    const std::string text = result.GetTestProperty(0).value();
    EXPECT_NE(text.find("Skipped: "), std::string::npos) << text;
    EXPECT_NE(text.find("physics"), std::string::npos) << text;
    EXPECT_NE(text.find("a constant factor of"), std::string::npos) << text;
}

/// The second element has the address of the first: the result of one element must not be used for another.
TEST(Matchers, CheckEachElementSeparately) {
    const auto made = [](double factor) { return Counted{factor}; };
    const auto matcher = testing::Each(testing::ResultOf(made, IsARightSamplerBy(one_wo())));
    EXPECT_TRUE(testing::Value(std::vector<double>{1.0, 1.0}, matcher));
    EXPECT_FALSE(testing::Value(std::vector<double>{1.0, 1.1}, matcher));
    testing::StringMatchResultListener message;
    EXPECT_FALSE(testing::ExplainMatchResult(matcher, std::vector<double>{1.0, 1.1}, &message));
    EXPECT_NE(message.str().find("element #1"), std::string::npos) << message.str();
    const testing::Matcher<const Counted&> kept = IsARightSamplerBy(one_wo());
    Counted sampler;
    EXPECT_TRUE(kept.Matches(sampler));
    sampler.factor = 1.1;
    EXPECT_FALSE(kept.Matches(sampler));
    sampler.factor = 1;
    EXPECT_TRUE(kept.Matches(sampler));
}

TEST(Matchers, AreDescribedAndNegated) {
    const testing::Matcher<Counted> right = IsARightSamplerBy(one_wo()), open = IsNotAWrongSampler();
    std::ostringstream message;
    right.DescribeTo(&message);
    message << "; ";
    right.DescribeNegationTo(&message);
    message << "; ";
    open.DescribeTo(&message);
    EXPECT_EQ(message.str(), "is a right sampler; is not a right sampler; is not a wrong sampler");
    EXPECT_THAT(Counted{1.1}, testing::Not(IsARightSamplerBy(one_wo())));
    EXPECT_EQ(testing::PrintToString(Counted{}), "a sampler");
}

TEST(SharedAlpha, SharesOfAllTestsSumToAlphaAtMost) {
    SharedAlpha shared(0.01);
    double sum = 0;
    for (int test = 0; test < 40; ++test)
        for (int call = 0; call < 25; ++call) sum += shared.next(std::to_string(test), 40);
    EXPECT_LE(sum, 0.01);
    EXPECT_GT(sum, 0.009);
    EXPECT_DOUBLE_EQ(sum, shared.spent());
}

/// Forty processes of one test each use the same shares as one process of forty tests.
TEST(SharedAlpha, SharesDoNotDependOnTheNumberOfProcesses) {
    double sum = 0;
    SharedAlpha one_process(0.01);
    for (int test = 0; test < 40; ++test) {
        SharedAlpha own_process(0.01);
        sum += own_process.next("test", 40);
        one_process.next(std::to_string(test), 40);
    }
    EXPECT_DOUBLE_EQ(sum, one_process.spent());
}

TEST(SharedAlpha, DefaultsToTheAlphaOfTheSettings) {
    EXPECT_EQ(shared_alpha(), nullptr);
    EXPECT_EQ(shared_settings().alpha, TestSettings::quick().alpha);
}

}  // namespace gtest_test
}  // namespace crescent
