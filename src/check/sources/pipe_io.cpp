// One loop over poll() writes requests and reads answers, whichever side is ready, so neither side blocks the other.
// The time limits are checked at least every 50 ms. A program that failed once gets no further requests.
#include "check/sources/pipe_io.h"

#include <bit>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>

#include "base/errors.h"
#include "base/progress.h"
#include "check/sources/check_case.h"

namespace crescent {

static_assert(std::endian::native == std::endian::little, "blocks are little-endian, and are copied as they are");

void PipeConnection::fault(
    const std::string& request, std::size_t i, const std::string& what, std::string_view expected) {
    program_.wait_ready(false, false, 0);  // its output precedes the error
    broken_ = fmt::format("request {} ({}): expected {}, {}", requests_ + i + 1, shown(request), expected, what);
    if (const std::optional<ProcessEnd> end = program_.ended(0)) throw ProgramEnded(broken_, *end);
    throw SamplerError(broken_);
}

/// "" while it runs.
std::string PipeConnection::exit_text(int milliseconds) const {
    const std::optional<ProcessEnd> end = program_.ended(milliseconds);
    if (!end) return "";
    if (end->signal != 0) return "the program was killed by " + end->text();
    // The shell reports a signal of the program as 128 + its number.
    const bool by_signal = end->code > 128 && end->code < 160;
    return "the program ended with " + end->text() + (by_signal ? ": " + ProcessEnd{0, end->code - 128}.text() : "");
}

std::string PipeConnection::close_reason() const {
    const std::string how = exit_text(200);
    return how.empty() ? "the program closed its output" : how;
}

/// The reason for a missing answer: a program that continues in the background, or one that does not flush its answers.
std::string PipeConnection::silence_reason() const {
    const std::string how = exit_text(0);
    if (!how.empty()) return ": " + how + ", and what it left running keeps its output open without an answer";
    return pending().empty() ? " (does it flush every answer?)" : "; it sent an incomplete answer: " + shown(pending());
}

std::string PipeConnection::end_of_output() const {
    return fmt::format(
        "but {}{}", close_reason(), pending().empty() ? "" : " in the middle of an answer: " + shown(pending()));
}

/// Returns false at the end of the program's output.
bool PipeConnection::fill() {
    incoming_.erase(0, read_from_);
    read_from_ = 0;
    constexpr std::size_t chunk = 1 << 18;
    const std::size_t before = incoming_.size();
    incoming_.resize(before + chunk);
    const ssize_t n = program_.read(incoming_.data() + before, chunk);
    const int error = errno;
    incoming_.resize(before + static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
    return n > 0 || (n < 0 && (error == EAGAIN || error == EINTR));
}

/// Returns the number of bytes written.
std::size_t PipeConnection::send(Exchange& x, std::string_view bytes, bool answers_wait) {
    const ssize_t n = program_.write(bytes);
    if (n < 0 && errno == EPIPE && !answers_wait) fault(x, x.answered, "but it closed its input: " + close_reason());
    return static_cast<std::size_t>(std::max<ssize_t>(n, 0));
}

void PipeConnection::check_time_limits(Exchange& x, Clock::time_point last) {
    if (limits_.stop && limits_.stop->load()) {
        broken_ = "interrupted";
        throw Interrupted{};
    }
    if (seconds_since(began_) > limits_.total_seconds) {
        broken_ =
            fmt::format("the program is too slow to check: {:g} s are spent and it gives {:.2g} answers per second",
                limits_.total_seconds, static_cast<double>(requests_ + x.answered) / seconds_since(began_));
        slow_ = true;
        throw SamplerTimeout(broken_);
    }
    const double quiet = seconds_since(last);
    if (quiet > (handshake_done_ ? limits_.quiet_seconds : limits_.hello_seconds))
        fault(x, x.answered, fmt::format("got nothing for {:.0f} s{}", quiet, silence_reason()));
}

void PipeConnection::check_open() const {
    if (slow_) throw SamplerTimeout(broken_);
    if (!broken_.empty()) throw SamplerExited("the program was given up: " + broken_);
}

/// Writes all requests and reads all answers, whichever side is ready.
void PipeConnection::run(Exchange& x) {
    check_open();
    Clock::time_point last = Clock::now();
    while (x.answered < x.count) {
        constexpr std::size_t ahead = 1 << 18;  // bytes of requests kept ready
        if (x.outgoing.size() - x.sent < ahead / 2) {
            x.outgoing.erase(0, x.sent);
            x.sent = 0;
            while (x.written < x.count && x.outgoing.size() < ahead) x.produce();
        }
        const bool more = x.sent < x.outgoing.size();
        const Process::Ready ready = program_.wait_ready(more, true, 50);
        if (ready.input) x.sent += send(x, std::string_view(x.outgoing).substr(x.sent), ready.output);
        if (ready.output) {
            if (!fill()) fault(x, x.answered, end_of_output());
            last = Clock::now();
            x.take();
        }
        check_time_limits(x, last);
    }
}

void PipeConnection::lines(std::size_t count, std::string_view expected, const Write& write, const Read& read) {
    std::string line;
    Exchange x{.count = count,
        .expected = expected,
        .describe = [&](std::size_t i) { return write(i, line), line; },
        .produce = {},
        .take = {}};
    x.produce = [&] {
        write(x.written++, line);
        x.outgoing += line;
        x.outgoing += '\n';
    };
    x.take = [&] { take_lines(x, read); };
    run(x);
    if (pending().find('\n') != std::string_view::npos)
        fault(x, count - 1,
            "got more lines than requested: " + shown(pending().substr(0, pending().find('\n'))) + only_answers);
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

namespace {

void write_numbers(std::span<const double> numbers, bool single, std::byte* to) {
    if (single) std::ranges::copy(numbers, reinterpret_cast<float*>(to));
    else std::memcpy(to, numbers.data(), numbers.size_bytes());
}
void read_numbers(const std::byte* from, bool single, std::span<double> numbers) {
    if (single) std::copy_n(reinterpret_cast<const float*>(from), numbers.size(), numbers.begin());
    else std::memcpy(numbers.data(), from, numbers.size_bytes());
}

}  // namespace

/// The bytes of rows of a block for the pipe; those in single precision are overwritten by the next block.
std::string_view PipeConnection::payload_of(const Rows& rows, std::span<const double> in) {
    if (!rows.single) return {reinterpret_cast<const char*>(in.data()), in.size_bytes()};
    floats_sent_.assign(in.begin(), in.end());
    return {reinterpret_cast<const char*>(floats_sent_.data()), in.size() * sizeof(float)};
}

// Doubles are read from and written to the caller's memory without a copy: they are most of the exchanged data.
void PipeConnection::blocks(const Rows& rows) {
    const std::size_t columns = rows.in.size() / rows.count;
    Exchange x{.count = rows.count, .expected = rows.expected, .describe = rows.describe, .produce = {}, .take = {}};
    check_open();
    const std::size_t rows_in_block = most_rows(rows);
    const auto rows_from = [&](std::size_t row) { return std::min(rows.count - row, rows_in_block); };
    const auto head_of = [&](std::size_t row) {
        const auto n = static_cast<std::uint32_t>(rows_from(row));
        std::string head(rows.operation, 4);
        head.append(reinterpret_cast<const char*>(&n), sizeof n);
        return head + rows.header;
    };
    std::string head = head_of(0), answer_head;
    std::string_view payload;  // what is left of it
    std::size_t head_sent = 0, payload_read = 0;
    const Clock::time_point began = Clock::now();
    Clock::time_point last = began;
    while (x.answered < x.count) {
        const bool has_slot = !uses_memory_ || blocks_sent_ < blocks_answered_ + slots;
        const Process::Ready ready = program_.wait_ready(x.written < x.count && has_slot, true, 50);
        if (ready.input) {
            if (head_sent == 0) {
                const auto in = rows.in.subspan(x.written * columns, rows_from(x.written) * columns);
                if (uses_memory_) write_numbers(in, rows.single, slot(blocks_sent_));
                else payload = payload_of(rows, in);
            }
            if (head_sent < head.size()) head_sent += send(x, std::string_view(head).substr(head_sent), ready.output);
            if (head_sent == head.size() && !payload.empty()) payload.remove_prefix(send(x, payload, ready.output));
            if (head_sent == head.size() && payload.empty()) {
                ++blocks_sent_;
                x.written += rows_from(x.written);
                head_sent = 0;
                if (x.written < x.count) head = head_of(x.written);
            }
        }
        if (ready.output) {
            if (!take_block(x, rows, rows_from(x.answered), answer_head, payload_read)) {
                incoming_ = answer_head;
                read_from_ = 0;
                fault(x, x.answered, end_of_output());
            }
            last = Clock::now();
        }
        check_time_limits(x, last);
    }
    if (program_.wait_ready(false, true, 0).output && fill() && !pending().empty())
        fault(
            x, rows.count - 1, fmt::format("got {} bytes more than requested: {}", pending().size(), shown(pending())));
    requests_ += rows.count;
    if (uses_memory_ && rows.count >= fewest_rows)  // the cost of fewer is that of the query
        seconds_a_row_[rows.operation] = seconds_since(began) / static_cast<double>(rows.count);
}

/// Of a block: docs/samplers.md, and in memory what a slot takes, and what a slow shader answers within a second.
std::size_t PipeConnection::most_rows(const Rows& rows) const {
    constexpr std::size_t in_block = 1 << 16;
    if (!uses_memory_) return in_block;
    const std::size_t row = std::max(rows.in.size(), rows.out.size()) / rows.count * bytes_of_number(rows);
    const auto cost = seconds_a_row_.find(rows.operation);
    if (cost == seconds_a_row_.end()) return std::min(first_rows, slot_bytes / 2 / row);
    const double in_a_second = std::min(1 / cost->second, static_cast<double>(in_block));
    return std::min(std::max(fewest_rows, static_cast<std::size_t>(in_a_second)), slot_bytes / 2 / row);
}

/// Where the bytes of an answer arrive.
std::span<std::byte> PipeConnection::arrival_of(const Rows& rows, std::span<double> out) {
    if (uses_memory_) return {slot(blocks_answered_) + slot_bytes / 2, out.size() * bytes_of_number(rows)};
    if (!rows.single) return std::as_writable_bytes(out);
    floats_received_.resize(out.size());
    return std::as_writable_bytes(std::span(floats_received_));
}

/// Reads the available part of the answer to `n` rows; returns false at the end of the program's output.
bool PipeConnection::take_block(
    Exchange& x, const Rows& rows, std::size_t n, std::string& head, std::size_t& payload_read) {
    const auto read = [&](char* to, std::size_t limit, std::size_t& got) {
        const ssize_t count = program_.read(to, limit);
        const bool open = count > 0 || (count < 0 && (errno == EAGAIN || errno == EINTR));
        got = static_cast<std::size_t>(std::max<ssize_t>(count, 0));
        return open;
    };
    const auto read_head = [&](std::size_t size) {
        const std::size_t before = head.size();
        std::size_t got = 0;
        head.resize(size);
        const bool open = read(head.data() + before, size - before, got);
        head.resize(before + got);
        return open;
    };
    const auto number = [&](std::size_t offset) {
        std::uint32_t value = 0;
        std::memcpy(&value, head.data() + offset, sizeof value);
        return value;
    };
    const auto has = [&](std::size_t size, bool& open) {
        open = head.size() >= size || read_head(size);
        return head.size() >= size;
    };
    bool open = true;
    if (!has(4, open)) return open;
    if (number(0) == 0) {  // an error: its length and its text
        if (!has(8, open)) return open;
        const std::size_t length = std::min<std::size_t>(number(4), 4096);
        if (!has(8 + length, open)) return open;
        fault(x, x.answered, "got an error: " + shown(std::string_view(head).substr(8, length)));
    }
    if (number(0) != n) fault(x, x.answered, fmt::format("got a block of {} rows for one of {}", number(0), n));
    const std::size_t columns = rows.out.size() / rows.count;
    const std::span<double> out = rows.out.subspan(x.answered * columns, n * columns);
    const std::span<std::byte> arrival = arrival_of(rows, out);
    if (!uses_memory_) {
        std::size_t got = 0;
        open = read(reinterpret_cast<char*>(arrival.data()) + payload_read, arrival.size() - payload_read, got);
        payload_read += got;
        if (payload_read < arrival.size()) return open;
    }
    if (arrival.data() != std::as_bytes(out).data()) read_numbers(arrival.data(), rows.single, out);
    ++blocks_answered_;
    x.answered += n;
    payload_read = 0;
    head.clear();
    return open;
}

}  // namespace crescent
