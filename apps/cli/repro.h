// `crescent check --repro FILE`: a short Python script that shows a fault of a user's sampler without crescent.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "commands.h"
#include "crescent/crescent.h"

namespace crescent::cli {

/// The script for the first wrong verdict that some ten thousand evaluations show, at a w_o and u of round numbers;
/// nothing if none is. For a program or a sampler in a Python file.
std::optional<std::string> repro_script(
    const CheckFlags& flags, std::span<const CheckCase> check_cases, const CheckResult& result);

/// Why there is no script for a result that is wrong: for each wrong verdict, what a script cannot do, or that the
/// fault does not show in so few evaluations.
std::string why_no_repro(const CheckFlags& flags, std::span<const CheckCase> check_cases, const CheckResult& result);

}  // namespace crescent::cli
