// GoogleTest matchers: a sampler judged in one line of a user's own suite. gtest_alpha.h shares one alpha over a suite.
//
//   EXPECT_THAT(MySampler{}, crescent::IsARightSampler());        // nothing wrong, nothing left open
//   EXPECT_THAT(MySampler{}, crescent::IsNotAWrongSampler());     // a heavy tail is allowed
//   EXPECT_THAT(bsdf_pointer, crescent::IsARightSampler());       // T*, unique_ptr, shared_ptr
#pragma once

#include <gmock/gmock.h>

#include "verdicts/gtest_alpha.h"
#include "verdicts/user.h"

/// In place of the bytes of a struct that has no operator<<.
template <class S>
    requires(crescent::user::Judgeable<S> && !crescent::user::Pointing<S> &&
        !requires(std::ostream& out, const S s) { out << s; })
class testing::internal::UniversalPrinter<S> {
public:
    static void Print(const S&, std::ostream* out) { *out << "a sampler"; }
};

namespace crescent::inline verdicts {

/// EXPECT_THAT(MySampler{}, crescent::IsARightSampler()): every verdict is right or was skipped.
MATCHER(IsARightSampler, negation ? "is not a right sampler" : "is a right sampler") {
    const Judgement j = judge_sampler("sampler", user::handed(arg), shared_settings());
    if (j.state != State::right) *result_listener << "\n" << what_is_wrong(j);
    return j.state == State::right;
}

/// The same where inconclusive verdicts pass too.
MATCHER(IsNotAWrongSampler, negation ? "is a wrong sampler" : "is not a wrong sampler") {
    const Judgement j = judge_sampler("sampler", user::handed(arg), shared_settings());
    if (j.state == State::wrong) *result_listener << "\n" << what_is_wrong(j);
    return j.state != State::wrong;
}

/// With levels, draws and seed of one's own: EXPECT_THAT(MySampler{},
/// crescent::IsARightSamplerBy(crescent::TestSettings::thorough())).
MATCHER_P(IsARightSamplerBy, settings, negation ? "is not a right sampler" : "is a right sampler") {
    const Judgement j = judge_sampler("sampler", user::handed(arg), shared_settings(settings));
    if (j.state != State::right) *result_listener << "\n" << what_is_wrong(j);
    return j.state == State::right;
}

}  // namespace crescent::inline verdicts
