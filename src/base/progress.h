// Long work reports its progress and checks whether to continue.
#pragma once

#include <atomic>
#include <chrono>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "base/parallel.h"

namespace crescent {

/// A stop was requested (Ctrl-C, SIGTERM): exit code 130, nothing half-written.
struct Interrupted : std::exception {
    const char* what() const noexcept override { return "interrupted"; }
};

/// The state of the files under the final names of a run's outputs: unchanged; those of either run, complete; the new
/// ones.
enum class Outputs { untouched, moving, complete };

/// The progress of long work, and whether it should continue. Called from many threads at once; every call is cheap.
class ProgressMonitor {
public:
    virtual ~ProgressMonitor() = default;
    /// A new stage of work begins: `total` units, with a name for the user ("seed 3 of 16").
    virtual void begin(std::string_view /*what*/, double /*total*/) {}
    /// `units` more are done.
    virtual void advance(double /*units*/) {}
    /// `units` of the total were done by an earlier run.
    virtual void skip(double /*units*/) {}
    /// A line for the log.
    virtual void log(std::string_view /*line*/) {}
    /// A line that the user needs although the work goes on: what will be wrong, lost or moved aside.
    virtual void warn(std::string_view line) { log("warning: " + std::string(line)); }

    /// Polled by kernels; set from a signal handler.
    std::atomic<bool> stop{false};
    /// The state of the outputs, which the signal handler reports to the user.
    std::atomic<Outputs> outputs{Outputs::untouched};
    void check() const {
        if (stop.load(std::memory_order_relaxed)) throw Interrupted{};
    }
};

// ---- A ProgressMonitor for hosts that poll the progress (a Python thread, a page, a C program); its flag `stop` may
// be set from any thread, and a stop is returned as a value, see run/execute.h.

/// Keeps what the work reports until it is queried. All members may be called from any thread.
class PolledMonitor : public ProgressMonitor {
public:
    /// The current stage ("seed 3 of 16"), and `progress` of `total` units of its own.
    struct State {
        std::string what;
        double progress = 0, total = 0;
    };

    /// Returns the current state; from any thread.
    State state() const {
        const Guard guard(lock_);
        return state_;
    }
    /// Returns the lines logged since the last call; from any thread.
    std::vector<std::string> take_lines() {
        const Guard guard(lock_);
        return std::exchange(lines_, {});
    }

    /// Returns the warnings since the last call, which are among the lines too; from any thread.
    std::vector<std::string> take_warnings() {
        const Guard guard(lock_);
        return std::exchange(warnings_, {});
    }

    void begin(std::string_view what, double total) override {
        const Guard guard(lock_);
        state_ = {std::string(what), 0, total};
    }
    void advance(double units) override {
        const Guard guard(lock_);
        state_.progress += units;
    }
    void skip(double units) override {
        const Guard guard(lock_);
        state_.total -= units;
    }
    void log(std::string_view line) override {
        const Guard guard(lock_);
        lines_.emplace_back(line);
    }
    void warn(std::string_view line) override {
        ProgressMonitor::warn(line);
        const Guard guard(lock_);
        warnings_.emplace_back(line);
    }

private:
    mutable Mutex lock_;
    State state_;
    std::vector<std::string> lines_, warnings_;
};

// ---- Elapsed wall-clock time, in seconds.

/// Starts when it is constructed.
class Stopwatch {
public:
    /// Returns the seconds since its construction.
    double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point start_ = Clock::now();
};

}  // namespace crescent
