#include "signals.h"

#include <atomic>
#include <csignal>
#include <ctime>

#include <unistd.h>

#include "commands.h"
#include "crescent.h"

namespace crescent::cli {

namespace {

std::atomic<Watch*> watched{nullptr};
timer_t deadline;
constexpr long patience_ns = 800'000'000;

// Both handlers use async-signal-safe calls only (POSIX.1-2017, 2.4.3).
extern "C" void end_now(int) { ::_exit(interrupted); }

extern "C" void ask_to_stop(int) {
    Watch* watch = watched.load();
    if (!watch || watch->stop.exchange(true)) ::_exit(interrupted);
    itimerspec once{};
    once.it_value.tv_nsec = patience_ns;
    ::timer_settime(deadline, 0, &once, nullptr);
}

void handle(int signal, void (*handler)(int)) {
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    ::sigaction(signal, &action, nullptr);
}

}  // namespace

StopOnSignal::StopOnSignal(Watch& watch) {
    watched = &watch;
    sigevent event{};
    event.sigev_notify = SIGEV_SIGNAL;
    event.sigev_signo = SIGALRM;
    ::timer_create(CLOCK_MONOTONIC, &event, &deadline);
    handle(SIGALRM, end_now);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) handle(signal, ask_to_stop);
}

StopOnSignal::~StopOnSignal() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) handle(signal, SIG_DFL);
    ::timer_delete(deadline);
    watched = nullptr;
}

}  // namespace crescent::cli
