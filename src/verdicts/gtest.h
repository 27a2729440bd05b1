// GoogleTest matchers: a sampler judged in one line of somebody else's suite.
//
//   EXPECT_THAT(MySampler{}, crescent::IsARightSampler());        // nothing wrong, nothing left open
//   EXPECT_THAT(MySampler{}, crescent::IsNotAWrongSampler());     // a heavy tail is allowed
#pragma once

#include <gmock/gmock.h>

#include "verdicts/user.h"

namespace crescent {

MATCHER(IsARightSampler, negation ? "is not a right sampler" : "is a right sampler") {
    const Judgement j = judge_sampler("sampler", arg);
    if (j.state != State::right) *result_listener << "\n" << what_is_wrong(j);
    return j.state == State::right;
}

MATCHER(IsNotAWrongSampler, negation ? "is a wrong sampler" : "is not a wrong sampler") {
    const Judgement j = judge_sampler("sampler", arg);
    if (j.state == State::wrong) *result_listener << "\n" << what_is_wrong(j);
    return j.state != State::wrong;
}

}  // namespace crescent
