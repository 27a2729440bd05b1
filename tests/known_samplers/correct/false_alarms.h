// How often right samplers at random parameters are accused, by family: the law that `crescent check --right N`
// measures.
#pragma once

#include "check/check.h"
#include "tests/known_samplers/correct/right.h"

namespace crescent {

struct RightFamily {
    std::string name;
    std::uint64_t checked = 0, false_alarms = 0, undecided = 0;
};

struct FalseAlarmStudy {
    std::vector<RightFamily> families;
    std::uint64_t checked = 0, false_alarms = 0, undecided = 0;
    std::vector<std::string> message;  // of every verdict that is not right, a line each
    double alpha = 0;
    bool full = false;
};

/// Judges right samplers `first` to `first + count`, one w_o and one call each, on a seed of its own.
FalseAlarmStudy measure_false_alarms(
    std::uint64_t first, std::uint64_t count, const TestSettings& settings, ProgressMonitor& monitor);
/// A table by family, and what was said.
std::string false_alarm_text(const FalseAlarmStudy& study);

}  // namespace crescent
