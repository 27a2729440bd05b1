// How often compare errs, on renders whose truth is known: false alarms, power, and how often its intervals hold the
// truth; a section of docs/error-rates.md.
#pragma once

#include <string>

#include "base/progress_monitor.h"

namespace crescent::inline comparing {

/// Markdown. `repeats` calls of each kind of noise; equal arguments give equal text but for the date in the caller's.
std::string compare_error_rates(std::uint32_t repeats, std::uint32_t seed, ProgressMonitor& monitor);

}  // namespace crescent::inline comparing
