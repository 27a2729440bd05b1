// Requests to a program and its answers, text lines or blocks of doubles. Requests run far ahead of the answers, both
// ways without blocking, so that neither side waits for the other.
#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "base/process.h"
#include "subjects/pipe.h"

namespace crescent::inline subjects {

class Talk {
public:
    /// Starts `command` by the shell.
    Talk(const std::string& command, const PipeLimits& limits)
        : limits_(limits), program_({.argv = {"/bin/sh", "-c", command}, .label = command}) {}
    Talk(const Talk&) = delete;
    Talk& operator=(const Talk&) = delete;

    using Write = std::function<void(std::size_t, std::string&)>;
    using Read = std::function<bool(std::size_t, std::string_view)>;
    /// One line each way `count` times; `read` says whether an answer was as expected.
    void lines(std::size_t count, std::string_view expected, const Write& write, const Read& read);
    /// Rows of doubles each way; `told` shows a request in a message.
    struct Rows {
        const char* operation;  // four letters
        std::size_t count, given, got;
        std::span<const double> in;
        std::span<double> out;
        std::function<std::string(std::size_t)> told;
    };
    void blocks(const Rows& rows);

    /// Says what is wrong with the answer to request i of those under way.
    [[noreturn]] void fault(
        const std::string& request, std::size_t i, const std::string& what, std::string_view expected);
    void greeted() { greeted_ = true; }
    const std::string& broken() const { return broken_; }
    Spending spending() const { return {requests_, seconds_since(began_), limits_.total_seconds}; }
    /// What it had time to say is read no more; half a second to end by itself, unless it was given up.
    void stop() { program_.end(broken_.empty() ? 500 : 0); }

private:
    using Clock = std::chrono::steady_clock;
    /// Requests under way: how many answers are due, how many requests are written, how many answers came.
    struct Exchange {
        std::size_t count;
        std::string_view expected;
        std::function<std::string(std::size_t)> told;  // request i, for a message
        std::function<void()> produce, take;           // more requests into `outgoing`; answers out of what came
        std::size_t written = 0, answered = 0, sent = 0;
        std::string outgoing{};
    };
    PipeLimits limits_;
    mutable Process program_;  // asked how it ended where a message says so
    std::string incoming_;
    std::size_t read_from_ = 0;
    std::uint64_t requests_ = 0;
    std::string broken_;  // what went wrong; nothing is asked from then on
    bool greeted_ = false, slow_ = false;
    Clock::time_point began_ = Clock::now();

    static double seconds_since(Clock::time_point then) {
        return std::chrono::duration<double>(Clock::now() - then).count();
    }
    void run(Exchange& x);
    void send(Exchange& x, bool answers_wait);
    void mind_the_time(Exchange& x, Clock::time_point last);
    void take_lines(Exchange& x, const Read& read);
    void take_blocks(Exchange& x, const Rows& rows, std::deque<std::size_t>& due);
    [[noreturn]] void fault(Exchange& x, std::size_t i, const std::string& what) {
        fault(x.told(i), i, what, x.expected);
    }
    bool fill();
    std::string_view pending() const { return std::string_view(incoming_).substr(read_from_); }
    std::string how_it_ended(int milliseconds) const;
    std::string why_closed() const;
    std::string why_silent() const;
    std::string end_of_output() const;
};

}  // namespace crescent::inline subjects
