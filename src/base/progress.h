// Long work tells how far it is and asks whether to go on.
#pragma once

#include <atomic>
#include <chrono>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "base/parallel.h"

namespace crescent::inline base {

/// The work was asked to stop (Ctrl-C, SIGTERM): exit code 130, nothing half-written.
struct Interrupted : std::exception {
    const char* what() const noexcept override { return "interrupted"; }
};

/// What stands under the final names of a run's outputs: what was there before; one or the other, all of one run; its
/// own.
enum class Outputs { untouched, moving, stand };

/// How far long work is, and whether it is to go on. Called from many threads at once; every call is cheap.
class ProgressMonitor {
public:
    virtual ~ProgressMonitor() = default;
    /// A new stretch of work begins: `total` units, named for the reader ("seed 3 of 16").
    virtual void begin(std::string_view /*what*/, double /*total*/) {}
    /// `units` more are done.
    virtual void advance(double /*units*/) {}
    /// `units` of the total were done by an earlier run.
    virtual void skip(double /*units*/) {}
    /// A line worth keeping in a log.
    virtual void log(std::string_view /*line*/) {}

    /// The flag kernels poll; set from a signal handler.
    std::atomic<bool> stop{false};
    /// Which outputs stand at the moment: what the signal handler tells the user.
    std::atomic<Outputs> outputs{Outputs::untouched};
    void check() const {
        if (stop.load(std::memory_order_relaxed)) throw Interrupted{};
    }
};

// ---- A ProgressMonitor for hosts that poll how far the work is: a Python thread, a page, a C program. Its flag `stop`
// may be set from any thread; a stop is returned as a value, not thrown, see run/execute.h.

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

// ---- How long something took, in wall-clock seconds.

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
