// The work runs in a std::thread, while every 50 ms this thread takes the interpreter's lock and checks for signals; or
// on this thread, with the lock released, which checks once at the end. The first exception of either is thrown again.
#include "watched.h"

#include <nanobind/stl/string.h>

#include <chrono>
#include <condition_variable>
#include <thread>

namespace crescent::python {

namespace {

/// With the lock held: Ctrl-C, or an exception of the progress callable, requests a stop.
void look_around(PolledMonitor& monitor, Raised& raised, const nb::object& progress) {
    try {
        if (PyErr_CheckSignals() != 0) throw nb::python_error();
        if (progress.is_none() || monitor.stop) return;
        const PolledMonitor::State state = monitor.state();
        call_python(progress, state.what, state.progress, state.total);
    } catch (...) { raised.keep(); }
}

/// Warnings become those of Python, which may raise them.
void show_warnings(PolledMonitor& monitor, Raised& raised) {
    try {
        for (const std::string& line : monitor.take_warnings())
            if (PyErr_WarnEx(PyExc_UserWarning, line.c_str(), 2) != 0) throw nb::python_error();
    } catch (...) { raised.keep(); }
}

}  // namespace

void watched(PolledMonitor& monitor, Raised& raised, const nb::object& progress, bool on_this_thread,
    const std::function<void()>& work) {
    const auto guarded = [&] {
        try {
            work();
        } catch (...) { raised.keep(); }
    };
    if (on_this_thread) {
        {
            const Work work_scope(&monitor);
            guarded();
        }
        look_around(monitor, raised, progress);
        show_warnings(monitor, raised);
        return raised.throw_again();
    }
    std::mutex lock;
    std::condition_variable end_signal;
    bool is_done = false;
    {
        const Work work_scope(&monitor);
        std::thread worker([&] {
            guarded();
            const std::lock_guard guard(lock);
            is_done = true;
            end_signal.notify_one();
        });
        std::unique_lock guard(lock);
        while (!end_signal.wait_for(guard, std::chrono::milliseconds(50), [&] { return is_done; })) {
            guard.unlock();
            {
                const Locked python_lock;
                look_around(monitor, raised, progress);
            }
            guard.lock();
        }
        guard.unlock();
        worker.join();
    }
    look_around(monitor, raised, progress);
    show_warnings(monitor, raised);
    raised.throw_again();
}

}  // namespace crescent::python
