// A ProgressMonitor for hosts that poll how far the work is: a Python thread, a page, a C program. Its flag `stop` may
// be set from any thread; a stop is returned as a value, not thrown, see run/execute.h.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/parallel.h"
#include "base/progress_monitor.h"

namespace crescent::inline base {

/// Keeps what the work says until it is asked for. All members may be called from any thread.
class PolledMonitor : public ProgressMonitor {
public:
    /// What is under way ("seed 3 of 16"), and how much of it is done: `done` of `total` units of its own.
    struct State {
        std::string what;
        double done = 0, total = 0;
    };

    /// Of this moment; any thread may ask.
    State state() const {
        const Guard guard(lock_);
        return state_;
    }
    /// The lines that the work said since they were last taken; any thread may ask.
    std::vector<std::string> take_lines() {
        const Guard guard(lock_);
        return std::exchange(lines_, {});
    }

    void begin(std::string_view what, double total) override {
        const Guard guard(lock_);
        state_ = {std::string(what), 0, total};
    }
    void advance(double units) override {
        const Guard guard(lock_);
        state_.done += units;
    }
    void skip(double units) override {
        const Guard guard(lock_);
        state_.total -= units;
    }
    void log(std::string_view line) override {
        const Guard guard(lock_);
        lines_.emplace_back(line);
    }

private:
    mutable Mutex lock_;
    State state_;
    std::vector<std::string> lines_;
};

}  // namespace crescent::inline base
