// How often correct samplers at random parameters are reported as wrong, by family: measured by
// `crescent_calibration false-alarms`.
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
    std::vector<std::string> message;  // of every verdict that is not right, one line each
    double alpha = 0;
    bool full = false;
};

/// Checks correct samplers `first` to `first + count`, one w_o and one call each, on a seed of its own.
FalseAlarmStudy measure_false_alarms(
    std::uint64_t first, std::uint64_t count, const TestSettings& settings, ProgressMonitor& monitor);
/// Returns a table by family, and the messages.
std::string false_alarm_text(const FalseAlarmStudy& study);

}  // namespace crescent
