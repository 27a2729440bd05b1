// Long work under Python: the interpreter's lock is released, Ctrl-C ends the work, and the caller receives the
// progress.
#pragma once

#include <exception>
#include <functional>
#include <mutex>

#include "interpreter.h"

namespace crescent::python {

/// An exception raised by a Python callable that C++ called: the first one counts, and requests a stop.
class Raised {
public:
    explicit Raised(ProgressMonitor& monitor) : monitor_(monitor) {}
    /// Must be called inside a catch block.
    void keep() {
        const std::lock_guard guard(lock_);
        if (!first_) first_ = std::current_exception();
        monitor_.stop = true;
    }
    void throw_again() const {
        if (first_) std::rethrow_exception(first_);
    }
    void check() const { monitor_.check(); }

private:
    ProgressMonitor& monitor_;
    std::mutex lock_;
    std::exception_ptr first_;
};

/// Calls `work` without the interpreter's lock. on_this_thread: for callables that require the caller's thread; else in
/// a thread of its own, while this one checks for Ctrl-C and calls progress(what, done, total) several times a second.
/// Warnings of the work become warnings of Python.
void watched(PolledMonitor& monitor, Raised& raised, const nb::object& progress, bool on_this_thread,
    const std::function<void()>& work);

}  // namespace crescent::python
