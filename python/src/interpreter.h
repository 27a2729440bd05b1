// The interpreter's lock, for threads that may outlive the interpreter: a daemon thread in one of our calls, and the
// worker threads of such a call.
//
// After finalization, Python ends a thread that takes its lock by pthread_exit (3.11 to 3.13), which must not unwind
// C++ frames, or lets it sleep (3.14). Here no thread reaches that state: a function registered with atexit, which runs
// before Python finalizes, asks all work to stop, waits for it and closes a gate before the lock. A thread stopped by
// the gate sleeps until the process ends, as a daemon thread of Python does.
#pragma once

#include <nanobind/nanobind.h>

#include <cxxabi.h>

#include <atomic>
#include <utility>

#include "crescent/crescent.h"

namespace crescent::python {

namespace nb = nanobind;

/// Holds the lock; on a thread that may have no Python state.
class Locked {
public:
    Locked();
    ~Locked();
    Locked(const Locked&) = delete;
    Locked& operator=(const Locked&) = delete;

private:
    PyGILState_STATE state_;
};

/// Releases the lock that this thread holds, and takes it again.
class Unlocked {
public:
    Unlocked();
    ~Unlocked();
    Unlocked(const Unlocked&) = delete;
    Unlocked& operator=(const Unlocked&) = delete;

private:
    PyThreadState* state_;
};

/// A call from Python that works without the lock. At exit it is asked to stop, if it has a monitor, and waited for;
/// then it does not return. Throws nb::python_error (RuntimeError) if the interpreter is already ending.
class Work {
public:
    explicit Work(ProgressMonitor* monitor = nullptr);
    ~Work();
    Work(const Work&) = delete;
    Work& operator=(const Work&) = delete;

private:
    ProgressMonitor* monitor_;
    Unlocked free_;
};

/// The number of threads inside a Python callable, and the number of calls.
struct Callbacks {
    std::atomic<unsigned> thread_count{0}, call_count{0};
};
Callbacks& callbacks();

/// Sleeps until the process ends.
[[noreturn]] void sleep_until_exit();

/// Calls callable(arguments...) with the lock held. If Python ends this thread inside the callable, the thread sleeps
/// instead.
template <class... Arguments> nb::object call_python(const nb::object& callable, Arguments&&... arguments) {
    ++callbacks().thread_count;
    ++callbacks().call_count;
    try {
        nb::object out = callable(std::forward<Arguments>(arguments)...);
        --callbacks().thread_count;
        return out;
    } catch (abi::__forced_unwind&) { sleep_until_exit(); } catch (...) {
        --callbacks().thread_count;
        throw;
    }
}

/// Registers the actions required before Python finalizes.
void prepare_exit(nb::module_& m);

}  // namespace crescent::python
