// How long something took, in wall-clock seconds.
#pragma once

#include <chrono>

namespace crescent::inline base {

/// Runs from when it is made.
class Stopwatch {
public:
    /// Since it was made.
    double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point start_ = Clock::now();
};

}  // namespace crescent::inline base
