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
constexpr long patience_ns = 500'000'000;  // a large process takes a while to end

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

void end_on_signals() {
    struct sigaction before {};
    for (const int signal : {SIGINT, SIGTERM}) handle(signal, end_now);
    if (::sigaction(SIGHUP, nullptr, &before) == 0 && before.sa_handler != SIG_IGN) handle(SIGHUP, end_now);  // nohup
}

StopOnSignal::StopOnSignal(Watch& watch) {
    watched = &watch;
    sigevent event{};
    event.sigev_notify = SIGEV_SIGNAL;
    event.sigev_signo = SIGALRM;
    ::timer_create(CLOCK_MONOTONIC, &event, &deadline);
    handle(SIGALRM, end_now);
    struct sigaction before {};
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
        if (::sigaction(signal, nullptr, &before) == 0 && before.sa_handler != SIG_IGN) handle(signal, ask_to_stop);
}

StopOnSignal::~StopOnSignal() {
    end_on_signals();
    ::timer_delete(deadline);
    watched = nullptr;
}

}  // namespace crescent::cli
