// Handlers are set by sigaction(), limits by setitimer() and SIGALRM. While a run is watched, the process has 0.5 s
// from the first signal to its end, 5 s more if outputs are being moved. The last message follows from the monitor's
// state and is written with write().
#include "signals.h"

#include <atomic>
#include <csignal>
#include <cstring>

#include <sys/time.h>
#include <unistd.h>

#include "commands.h"
#include "crescent/crescent.h"

namespace crescent::cli {

namespace {

std::atomic<ProgressMonitor*> watched_monitor{nullptr};
std::atomic<bool> may_finish{false};
std::atomic<Outputs> last_outputs{Outputs::untouched};  // by work that is no longer watched
constexpr itimerval grace_period{{}, {0, 500'000}};     // a large process needs time to end
constexpr itimerval moving_grace_period{{}, {5, 0}};    // outputs being moved are completed, if the disk is fast enough

/// Returns the state of the outputs when the process ends here.
const char* last_message() {
    const ProgressMonitor* monitor = watched_monitor.load();
    switch (monitor ? monitor->outputs.load() : last_outputs.load()) {
        case Outputs::moving:
            return "crescent: interrupted; the outputs are either all of the earlier run or all of this run\n";
        case Outputs::complete: return "crescent: interrupted; the outputs of this run are complete\n";
        default: return "crescent: interrupted; existing outputs were not changed\n";
    }
}

// All handlers use only async-signal-safe calls (POSIX.1-2017, 2.4.3) and setitimer, which that list lacks and which is
// one system call on Linux, the BSDs and macOS; macOS has no timer_settime.
extern "C" void end_now(int) {
    const char* words = last_message();
    static_cast<void>(!::write(STDERR_FILENO, words, std::strlen(words)));
    Process::kill_all();
    ::_exit(interrupted);
}

extern "C" void time_is_up(int signal) {
    const ProgressMonitor* monitor = watched_monitor.load();
    if (!monitor || monitor->outputs == Outputs::untouched || may_finish.exchange(true)) end_now(signal);
    else ::setitimer(ITIMER_REAL, &moving_grace_period, nullptr);
}

extern "C" void request_stop(int signal) {
    ProgressMonitor* monitor = watched_monitor.load();
    if (!monitor || monitor->stop.exchange(true)) end_now(signal);
    else ::setitimer(ITIMER_REAL, &grace_period, nullptr);
}

void handle(int signal, void (*handler)(int)) {
    struct sigaction action{};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    ::sigaction(signal, &action, nullptr);
}

}  // namespace

void end_on_signals() {
    struct sigaction previous_action{};
    for (const int signal : {SIGINT, SIGTERM}) handle(signal, end_now);
    if (::sigaction(SIGHUP, nullptr, &previous_action) == 0 && previous_action.sa_handler != SIG_IGN)
        handle(SIGHUP, end_now);  // nohup
}

// Installed before the constructors of all libraries run, so that a signal in the first milliseconds also ends with
// 130. The sanitizers start later than this and replace sigaction.
#if defined(__ELF__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#if !defined(__has_feature)
#define __has_feature(x) 0
#endif
#if !__has_feature(address_sanitizer) && !__has_feature(thread_sanitizer) && !__has_feature(memory_sanitizer)
[[gnu::section(".preinit_array"), gnu::used]] void (*preinit_entry)() = end_on_signals;
#endif
#endif

StopOnSignal::StopOnSignal(ProgressMonitor& monitor) {
    watched_monitor = &monitor;
    handle(SIGALRM, time_is_up);
    struct sigaction previous_action{};
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
        if (::sigaction(signal, nullptr, &previous_action) == 0 && previous_action.sa_handler != SIG_IGN)
            handle(signal, request_stop);
}

StopOnSignal::~StopOnSignal() {
    last_outputs = watched_monitor.load()->outputs.load();
    end_on_signals();
    const itimerval never{};
    ::setitimer(ITIMER_REAL, &never, nullptr);
    watched_monitor = nullptr;
}

}  // namespace crescent::cli
