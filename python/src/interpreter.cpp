// Two flags in order: `is_ending`, after which no work begins and running work is asked to stop; `is_closed`, after
// which no thread takes the lock. Between them waiting threads get the lock, since this one has released it.
#include "interpreter.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <vector>

namespace crescent::python {

namespace {

/// Never destroyed, because sleeping threads may outlive static objects.
struct Gate {
    std::mutex mutex;
    std::condition_variable changed;
    bool is_ending = false, is_closed = false;
    unsigned waiting = 0;  // threads between the gate and the lock
    unsigned works = 0;
    std::vector<ProgressMonitor*> monitors;
    const pid_t process = getpid();
};

Gate& gate() {
    static Gate& instance = *new Gate;
    return instance;
}

/// take() takes the lock, unless the gate is closed.
template <class Take> void through_the_gate(Take&& take) {
    std::unique_lock lock(gate().mutex);
    const bool is_closed = gate().is_closed;
    if (!is_closed) ++gate().waiting;
    lock.unlock();
    if (is_closed) sleep_until_exit();
    take();
    lock.lock();
    --gate().waiting;
    gate().changed.notify_all();
}

/// With the lock held: counts the beginning of work.
ProgressMonitor* registered(ProgressMonitor* monitor) {
    const std::lock_guard guard(gate().mutex);
    if (gate().is_ending) {
        PyErr_SetString(PyExc_RuntimeError, "crescent cannot begin work while the interpreter is ending");
        throw nb::python_error();
    }
    ++gate().works;
    if (monitor) gate().monitors.push_back(monitor);
    return monitor;
}

/// Waits until all work has ended, at most 5 s: work polls its monitor several times a second. Work inside callables
/// that enter and leave none for 0.2 s is not waited for, because a callable cannot be stopped.
void wait_for_work(std::unique_lock<std::mutex>& lock) {
    constexpr std::chrono::milliseconds step{20};
    constexpr int longest = 250, longest_in_callables = 10;
    unsigned call_count = 0;
    int still_count = 0;
    for (int i = 0; i < longest && gate().works > 0 && still_count < longest_in_callables; ++i) {
        gate().changed.wait_for(lock, step);
        const bool is_same = callbacks().call_count == std::exchange(call_count, callbacks().call_count);
        still_count = is_same && callbacks().thread_count >= gate().works ? still_count + 1 : 0;
    }
}

/// Work that could not be stopped still runs when exit() destroys the static objects that it uses. This function is
/// registered last, so it runs first and skips the others; Python has flushed its files by then.
void leave_beside_work() {
#ifdef __GLIBC__
    const auto leave = [](int status, void*) {
        std::fflush(nullptr);
        _exit(status);
    };
    on_exit(leave, nullptr);
#endif
}

void before_exit() {
    std::unique_lock lock(gate().mutex);
    gate().is_ending = true;
    for (ProgressMonitor* monitor : gate().monitors) monitor->stop = true;
    if (getpid() == gate().process) {  // a child of fork() has none of the counted threads
        PyThreadState* const state = PyEval_SaveThread();
        wait_for_work(lock);
        if (gate().works > 0) leave_beside_work();
        gate().is_closed = true;
        gate().changed.wait(lock, [] { return gate().waiting == 0; });
        lock.unlock();
        PyEval_RestoreThread(state);
        return;
    }
    gate().is_closed = true;
}

}  // namespace

void sleep_until_exit() {
    for (;;) pause();
}

Callbacks& callbacks() {
    static Callbacks& instance = *new Callbacks;
    return instance;
}

Locked::Locked() : state_{} {
    through_the_gate([&] { state_ = PyGILState_Ensure(); });
}

Locked::~Locked() { PyGILState_Release(state_); }

Unlocked::Unlocked() : state_(PyEval_SaveThread()) {}

Unlocked::~Unlocked() {
    through_the_gate([&] { PyEval_RestoreThread(state_); });
}

Work::Work(ProgressMonitor* monitor) : monitor_(registered(monitor)) {}

Work::~Work() {
    Gate& g = gate();
    {
        const std::lock_guard guard(g.mutex);
        --g.works;
        if (monitor_) std::erase(g.monitors, monitor_);
        g.changed.notify_all();
        if (!g.is_ending) return;
    }
    sleep_until_exit();
}

void prepare_exit(nb::module_& m) {
    gate();
    callbacks();
    m.def("_before_exit", &before_exit, "Ends what runs, before the interpreter finalizes.");
    nb::module_::import_("atexit").attr("register")(m.attr("_before_exit"));
}

}  // namespace crescent::python
