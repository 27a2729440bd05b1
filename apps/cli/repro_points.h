// The scripts of `crescent check --repro` for samplers of points, and for estimators of a number.
#pragma once

#include <optional>
#include <string>

#include "commands.h"
#include "crescent/crescent.h"

namespace crescent::cli {

/// The script that shows a wrong verdict of a sampler of points; nothing if 65,536 draws and points do not show it.
std::optional<std::string> script_of_points(
    const CheckFlags& flags, const CheckCase& check_case, const Finding& finding);
/// The script that shows the wrong mean of an estimator, or a value that is no number.
std::optional<std::string> script_of_number(
    const CheckFlags& flags, const SamplerAdapter& estimator, const CheckResult& result);

}  // namespace crescent::cli
