// One loop over poll() writes requests and reads answers, whichever side is ready: neither can wait for the other for
// ever. Time is looked at every 50 ms at least. A program that broke off once is not asked again.
#include "check/sources/pipe_io.h"

#include <bit>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>

#include "base/errors.h"
#include "base/progress.h"
#include "check/sources/sampler_adapter.h"

namespace crescent::inline sources {

static_assert(std::endian::native == std::endian::little, "blocks are little-endian, and are copied as they are");

void PipeConnection::fault(
    const std::string& request, std::size_t i, const std::string& what, std::string_view expected) {
    program_.wait_ready(false, false, 0);  // what it printed comes before the error
    broken_ = fmt::format("request {} ({}): expected {}, {}", requests_ + i + 1, shown(request), expected, what);
    throw SamplerError(broken_);
}

/// "" while it runs.
std::string PipeConnection::how_it_ended(int milliseconds) const {
    const std::optional<ProcessEnd> end = program_.ended(milliseconds);
    if (!end) return "";
    if (end->signal != 0) return "the program was killed by " + end->text();
    // The shell reports a signal of the program as 128 + its number.
    const bool by_signal = end->code > 128 && end->code < 160;
    return "the program ended with " + end->text() + (by_signal ? ": " + ProcessEnd{0, end->code - 128}.text() : "");
}

std::string PipeConnection::why_closed() const {
    const std::string how = how_it_ended(200);
    return how.empty() ? "the program closed its output" : how;
}

/// Why nothing comes: a program that went on in the background and ended itself, or one that keeps its answers.
std::string PipeConnection::why_silent() const {
    const std::string how = how_it_ended(0);
    if (!how.empty()) return ": " + how + ", and what it left running holds its output open and says nothing";
    return pending().empty() ? " (does it flush every answer?)" : "; half an answer stands there: " + shown(pending());
}

std::string PipeConnection::end_of_output() const {
    return fmt::format(
        "but {}{}", why_closed(), pending().empty() ? "" : " in the middle of an answer: " + shown(pending()));
}

/// False at the end of the program's output.
bool PipeConnection::fill() {
    incoming_.erase(0, read_from_);
    read_from_ = 0;
    char buffer[1 << 16];
    const ssize_t n = program_.read(buffer, sizeof buffer);
    if (n < 0) return errno == EAGAIN || errno == EINTR;
    incoming_.append(buffer, static_cast<std::size_t>(n));
    return n > 0;
}

void PipeConnection::send(Exchange& x, bool answers_wait) {
    const ssize_t n = program_.write(std::string_view(x.outgoing).substr(x.sent));
    if (n > 0) x.sent += static_cast<std::size_t>(n);
    else if (n < 0 && errno == EPIPE && !answers_wait) fault(x, x.answered, "but it closed its input: " + why_closed());
}

void PipeConnection::mind_the_time(Exchange& x, Clock::time_point last) {
    if (limits_.stop && limits_.stop->load()) {
        broken_ = "interrupted";
        throw Interrupted{};
    }
    if (seconds_since(began_) > limits_.total_seconds) {
        broken_ = fmt::format("the program is too slow to judge: {:g} s are spent and it gives {:.2g} answers a second",
            limits_.total_seconds, static_cast<double>(requests_ + x.answered) / seconds_since(began_));
        slow_ = true;
        throw SamplerTimeout(broken_);
    }
    const double quiet = seconds_since(last);
    if (quiet > (greeted_ ? limits_.quiet_seconds : limits_.hello_seconds))
        fault(x, x.answered, fmt::format("got nothing for {:.0f} s{}", quiet, why_silent()));
}

/// Writes all requests and reads all answers, whichever side is ready.
void PipeConnection::run(Exchange& x) {
    if (slow_) throw SamplerTimeout(broken_);
    if (!broken_.empty()) throw SamplerExited("the program was given up: " + broken_);
    Clock::time_point last = Clock::now();
    while (x.answered < x.count) {
        constexpr std::size_t ahead = 1 << 16;  // bytes of requests kept ready
        if (x.outgoing.size() - x.sent < ahead / 2) {
            x.outgoing.erase(0, x.sent);
            x.sent = 0;
            while (x.written < x.count && x.outgoing.size() < ahead) x.produce();
        }
        const bool more = x.sent < x.outgoing.size();
        const Process::Ready ready = program_.wait_ready(more, true, 50);
        if (ready.input) send(x, ready.output);
        if (ready.output) {
            if (!fill()) fault(x, x.answered, end_of_output());
            last = Clock::now();
            x.take();
        }
        mind_the_time(x, last);
    }
}

void PipeConnection::lines(std::size_t count, std::string_view expected, const Write& write, const Read& read) {
    std::string line;
    Exchange x{count, expected, [&](std::size_t i) { return write(i, line), line; }, {}, {}};
    x.produce = [&] {
        write(x.written++, line);
        x.outgoing += line;
        x.outgoing += '\n';
    };
    x.take = [&] { take_lines(x, read); };
    run(x);
    if (pending().find('\n') != std::string_view::npos)
        fault(x, count - 1,
            "got more lines than were asked for: " + shown(pending().substr(0, pending().find('\n'))) + only_answers);
    requests_ += count;
}

void PipeConnection::take_lines(Exchange& x, const Read& read) {
    for (;;) {
        const std::size_t end = incoming_.find('\n', read_from_);
        if (end == std::string::npos) {
            if (pending().size() > limits_.longest_line)
                fault(x, std::min(x.answered, x.count - 1),
                    fmt::format("got a line of more than {} bytes: {}", limits_.longest_line, shown(pending())));
            return;
        }
        std::string_view text(incoming_.data() + read_from_, end - read_from_);
        if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
        if (x.answered >= x.written)
            fault(x, std::min(x.answered, x.count - 1), "unexpected extra line: " + shown(text) + only_answers);
        if (x.answered >= x.count) return;
        if (!read(x.answered, text)) fault(x, x.answered, "got " + shown(text) + only_answers);
        ++x.answered;
        read_from_ = end + 1;
    }
}

void PipeConnection::blocks(const Rows& rows) {
    constexpr std::size_t most_rows = 1 << 15;  // 65536 are allowed; smaller ones let both sides work at once
    std::deque<std::size_t> due;
    const std::string expected = fmt::format("a block of {} doubles a row", rows.got);
    Exchange x{rows.count, expected, rows.describe, {}, {}};
    x.produce = [&] {
        const std::size_t n = std::min(rows.count - x.written, most_rows);
        const auto head = static_cast<std::uint32_t>(n);
        x.outgoing.append(rows.operation, 4);
        x.outgoing.append(reinterpret_cast<const char*>(&head), sizeof head);
        x.outgoing.append(
            reinterpret_cast<const char*>(rows.in.data() + x.written * rows.given), n * rows.given * sizeof(double));
        due.push_back(n);
        x.written += n;
    };
    x.take = [&] { take_blocks(x, rows, due); };
    run(x);
    if (!pending().empty())
        fault(x, rows.count - 1,
            fmt::format("got {} bytes more than were asked for: {}", pending().size(), shown(pending())));
    requests_ += rows.count;
}

void PipeConnection::take_blocks(Exchange& x, const Rows& rows, std::deque<std::size_t>& due) {
    const auto number = [&](std::size_t at) {
        std::uint32_t n = 0;
        std::memcpy(&n, incoming_.data() + read_from_ + at, sizeof n);
        return n;
    };
    while (pending().size() >= sizeof(std::uint32_t)) {
        if (due.empty()) fault(x, std::min(x.answered, x.count - 1), "unexpected extra answer: " + shown(pending()));
        const std::size_t n = number(0);
        if (n == 0) {  // an error: its length and its text
            if (pending().size() < 8 || pending().size() < 8 + std::min<std::size_t>(number(4), 4096)) return;
            fault(x, x.answered, "got an error: " + shown(pending().substr(8, std::min<std::size_t>(number(4), 4096))));
        }
        if (n != due.front()) fault(x, x.answered, fmt::format("got a block of {} rows for one of {}", n, due.front()));
        const std::size_t bytes = n * rows.got * sizeof(double);
        if (pending().size() < sizeof(std::uint32_t) + bytes) return;
        std::memcpy(
            rows.out.data() + x.answered * rows.got, incoming_.data() + read_from_ + sizeof(std::uint32_t), bytes);
        read_from_ += sizeof(std::uint32_t) + bytes;
        x.answered += n;
        due.pop_front();
    }
}

}  // namespace crescent::inline sources
