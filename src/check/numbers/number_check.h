// Checks of estimators of a number: each draw is one value, or three by channel, and their mean is the expected value,
// or the mean of another estimator.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "base/progress.h"
#include "check/check.h"
#include "check/sources/check_case.h"

namespace crescent::check {

/// What the mean of an estimator is compared with: one of the two.
struct ExpectedMean {
    std::optional<std::array<double, 3>> value{};       // by channel
    std::shared_ptr<const SamplerAdapter> estimator{};  // another one of the same number
};

/// The verdicts valid, tail, mean and, against another estimator, efficiency; the others are skipped. An estimator is a
/// sampler with Traits::number, whose draws have the weight that is their value. Throws SamplerError, and Interrupted
/// if the monitor requests a stop.
CheckResult check_number(const std::shared_ptr<const SamplerAdapter>& estimator, const ExpectedMean& expected,
    const TestSettings& settings, ProgressMonitor& monitor);

}  // namespace crescent::check
