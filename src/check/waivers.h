// Verdicts other than "right" that a caller expects: "phong support=wrong: it never reaches the horizon". An
// expected verdict does not count; an expectation that no verdict meets any more does.
//
//   [ARM ]VERDICT=STATE: REASON      STATE is wrong or inconclusive; without ARM, or with *, of every arm
//
// Not in crescent::check built alone.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "check/verdict.h"

namespace crescent {

/// One expectation, and its place in the input.
struct Waiver {
    std::string arm, verdict, reason;  // arm "": any
    State state = State::wrong;
    std::string place;  // "--expect" or "waivers.txt:3"
};

/// Each text is a waiver, or a file of waivers, one on each line, with comments from # on. Throws InputError with the
/// place and the nearest known word.
std::vector<Waiver> read_waivers(std::span<const std::string> texts);
/// Throws InputError if a waiver names none of these arms.
void check_waivers(std::span<const Waiver> waivers, std::span<const std::string> arms);
/// Excludes waived verdicts from the state of the result, and lists waivers that no verdict meets.
void waive(CheckResult& result, std::span<const Waiver> waivers);

}  // namespace crescent
