// The time limits of a sampler in another process: a program behind a pipe (pipe.h) or a plugin (plugin.h).
#pragma once

#include <atomic>
#include <cstddef>

namespace crescent {

/// Time limits of a program behind a pipe or of a plugin.
struct PipeLimits {
    double hello_seconds = 60;   // until the first answer: a sky of millions of texels is read first
    double quiet_seconds = 10;   // without a byte while an answer is pending
    double call_seconds = 60;    // for one call of a function of a plugin
    double total_seconds = 120;  // in total; a slower program cannot be checked
    std::size_t longest_line = 4096;
    const std::atomic<bool>* stop = nullptr;  // if set, the program is ended and Interrupted is thrown
    /// Sets the same limit for each answer of either kind; 0: no change.
    void limit_answers(double seconds) {
        if (seconds > 0) hello_seconds = quiet_seconds = call_seconds = seconds;
    }
};

}  // namespace crescent
