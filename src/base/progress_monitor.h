// Long work tells how far it is and asks whether to go on.
#pragma once

#include <atomic>
#include <exception>
#include <string_view>

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

}  // namespace crescent::inline base
