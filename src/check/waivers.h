// What a caller expects of a result beside "right": "phong support=wrong: it never reaches the horizon". A verdict
// that is as expected does not count; an expectation that nothing meets any more does.
//
//   [ARM ]VERDICT=STATE: REASON      STATE is wrong or inconclusive; without ARM, or with *, of every arm
#pragma once

#include <span>
#include <string>
#include <vector>

#include "check/verdict.h"

namespace crescent::inline results {

/// One expectation, and where it was said.
struct Waiver {
    std::string arm, verdict, reason;  // arm "": any
    State state = State::wrong;
    std::string place;  // "--expect" or "waivers.txt:3"
};

/// Each text is a waiver, or a file of them, one a line, with comments from # on. Throws InputError with the place and
/// the nearest word that is known.
std::vector<Waiver> read_waivers(std::span<const std::string> texts);
/// Throws InputError where a waiver names none of these arms.
void check_waivers(std::span<const Waiver> waivers, std::span<const std::string> arms);
/// Takes what is waived out of the state of the whole, and tells of waivers that nothing needs.
void waive(CheckResult& result, std::span<const Waiver> waivers);

}  // namespace crescent::inline results
