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
    error_ = fmt::format("request {} ({}): expected {}, {}", requests_ + i + 1, quote(request), expected, what);
    if (const std::optional<ProcessEnd> end = program_.ended(0)) throw ProgramEnded(error_, *end);
    throw SamplerError(error_);
}

/// "" while it runs.
std::string PipeConnection::exit_text(int milliseconds) const {
    const std::optional<ProcessEnd> end = program_.ended(milliseconds);
    if (!end) return "";
    if (end->signal != 0) return "the program was killed by " + end->text();
    // The shell reports a signal of the program as 128 + its number.
    const bool is_signal = end->code > 128 && end->code < 160;
    return "the program ended with " + end->text() + (is_signal ? ": " + ProcessEnd{0, end->code - 128}.text() : "");
}

std::string PipeConnection::close_reason() const {
    const std::string end_text = exit_text(200);
    return end_text.empty() ? "the program closed its output" : end_text;
}

/// The reason for a missing answer: a program that continues in the background, or one that does not flush its answers.
std::string PipeConnection::silence_reason() const {
    const std::string end_text = exit_text(0);
    if (!end_text.empty())
        return ": " + end_text + ", and what it left running keeps its output open without an answer";
    return pending().empty() ? " (does it flush every answer?)" : "; it sent an incomplete answer: " + quote(pending());
}

std::string PipeConnection::end_of_output() const {
    return fmt::format(
        "but {}{}", close_reason(), pending().empty() ? "" : " in the middle of an answer: " + quote(pending()));
}

/// Returns false at the end of the program's output.
bool PipeConnection::fill() {
    incoming_.erase(0, read_offset_);
    read_offset_ = 0;
    constexpr std::size_t chunk = 1 << 18;
    const std::size_t old_size = incoming_.size();
    incoming_.resize(old_size + chunk);
    const ssize_t n = program_.read(incoming_.data() + old_size, chunk);
    const int error = errno;
    incoming_.resize(old_size + static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
    return n > 0 || (n < 0 && (error == EAGAIN || error == EINTR));
}

/// Returns the number of bytes written.
std::size_t PipeConnection::send(Exchange& x, std::string_view bytes, bool has_answers) {
    const ssize_t n = program_.write(bytes);
    if (n < 0 && errno == EPIPE && !has_answers) fault(x, x.answer_count, "but it closed its input: " + close_reason());
    return static_cast<std::size_t>(std::max<ssize_t>(n, 0));
}

void PipeConnection::check_time_limits(Exchange& x, Clock::time_point last) {
    if (limits_.stop && limits_.stop->load()) {
        error_ = "interrupted";
        throw Interrupted{};
    }
    if (seconds_since(start_) > limits_.total_seconds) {
        error_ =
            fmt::format("the program is too slow to check: {:g} s are spent and it gives {:.2g} answers per second",
                limits_.total_seconds, static_cast<double>(requests_ + x.answer_count) / seconds_since(start_));
        is_slow_ = true;
        throw SamplerTimeout(error_);
    }
    const double quiet_seconds = seconds_since(last);
    if (quiet_seconds > (has_handshake_ ? limits_.quiet_seconds : limits_.hello_seconds))
        fault(x, x.answer_count, fmt::format("got nothing for {:.0f} s{}", quiet_seconds, silence_reason()));
}

void PipeConnection::check_open() const {
    if (is_slow_) throw SamplerTimeout(error_);
    if (!error_.empty()) throw SamplerExited("the program was given up: " + error_);
}

/// Writes all requests and reads all answers, whichever side is ready.
void PipeConnection::run(Exchange& x) {
    check_open();
    Clock::time_point last = Clock::now();
    while (x.answer_count < x.count) {
        constexpr std::size_t ready_bytes = 1 << 18;  // bytes of requests kept ready
        if (x.outgoing.size() - x.sent_bytes < ready_bytes / 2) {
            x.outgoing.erase(0, x.sent_bytes);
            x.sent_bytes = 0;
            while (x.request_count < x.count && x.outgoing.size() < ready_bytes) x.produce();
        }
        const bool has_more = x.sent_bytes < x.outgoing.size();
        const Process::Ready ready = program_.wait_ready(has_more, true, 50);
        if (ready.input) x.sent_bytes += send(x, std::string_view(x.outgoing).substr(x.sent_bytes), ready.output);
        if (ready.output) {
            if (!fill()) fault(x, x.answer_count, end_of_output());
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
        write(x.request_count++, line);
        x.outgoing += line;
        x.outgoing += '\n';
    };
    x.take = [&] { take_lines(x, read); };
    run(x);
    if (pending().find('\n') != std::string_view::npos)
        fault(x, count - 1,
            "got more lines than requested: " + quote(pending().substr(0, pending().find('\n'))) + only_answers);
    requests_ += count;
}

void PipeConnection::take_lines(Exchange& x, const Read& read) {
    for (;;) {
        const std::size_t end = incoming_.find('\n', read_offset_);
        if (end == std::string::npos) {
            if (pending().size() > limits_.longest_line)
                fault(x, std::min(x.answer_count, x.count - 1),
                    fmt::format("got a line of more than {} bytes: {}", limits_.longest_line, quote(pending())));
            return;
        }
        std::string_view text(incoming_.data() + read_offset_, end - read_offset_);
        if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
        if (x.answer_count >= x.request_count)
            fault(x, std::min(x.answer_count, x.count - 1), "unexpected extra line: " + quote(text) + only_answers);
        if (x.answer_count >= x.count) return;
        if (!read(x.answer_count, text)) fault(x, x.answer_count, "got " + quote(text) + only_answers);
        ++x.answer_count;
        read_offset_ = end + 1;
    }
}

namespace {

void write_numbers(std::span<const double> numbers, bool is_single, std::byte* to) {
    if (is_single) std::ranges::copy(numbers, reinterpret_cast<float*>(to));
    else std::memcpy(to, numbers.data(), numbers.size_bytes());
}
void read_numbers(const std::byte* from, bool is_single, std::span<double> numbers) {
    if (is_single) std::copy_n(reinterpret_cast<const float*>(from), numbers.size(), numbers.begin());
    else std::memcpy(numbers.data(), from, numbers.size_bytes());
}

}  // namespace

/// The bytes of rows of a block for the pipe; those in single precision are overwritten by the next block.
std::string_view PipeConnection::payload_of(const Rows& rows, std::span<const double> in) {
    if (!rows.is_single) return {reinterpret_cast<const char*>(in.data()), in.size_bytes()};
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
    while (x.answer_count < x.count) {
        const bool has_slot = !uses_memory_ || blocks_sent_ < blocks_answered_ + slots;
        const Process::Ready ready = program_.wait_ready(x.request_count < x.count && has_slot, true, 50);
        if (ready.input) {
            if (head_sent == 0) {
                const auto in = rows.in.subspan(x.request_count * columns, rows_from(x.request_count) * columns);
                if (uses_memory_) write_numbers(in, rows.is_single, slot(blocks_sent_));
                else payload = payload_of(rows, in);
            }
            if (head_sent < head.size()) head_sent += send(x, std::string_view(head).substr(head_sent), ready.output);
            if (head_sent == head.size() && !payload.empty()) payload.remove_prefix(send(x, payload, ready.output));
            if (head_sent == head.size() && payload.empty()) {
                ++blocks_sent_;
                x.request_count += rows_from(x.request_count);
                head_sent = 0;
                if (x.request_count < x.count) head = head_of(x.request_count);
            }
        }
        if (ready.output) {
            if (!take_block(x, rows, rows_from(x.answer_count), answer_head, payload_read)) {
                incoming_ = answer_head;
                read_offset_ = 0;
                fault(x, x.answer_count, end_of_output());
            }
            last = Clock::now();
        }
        check_time_limits(x, last);
    }
    if (program_.wait_ready(false, true, 0).output && fill() && !pending().empty())
        fault(
            x, rows.count - 1, fmt::format("got {} bytes more than requested: {}", pending().size(), quote(pending())));
    requests_ += rows.count;
    if (uses_memory_ && rows.count >= fewest_rows)  // the cost of fewer is that of the query
        seconds_a_row_[rows.operation] = seconds_since(began) / static_cast<double>(rows.count);
}

/// Of a block: docs/samplers.md, and in memory what a slot takes, and what a slow shader answers within a second.
std::size_t PipeConnection::most_rows(const Rows& rows) const {
    constexpr std::size_t block_rows = 1 << 16;
    if (!uses_memory_) return block_rows;
    const std::size_t row_bytes = std::max(rows.in.size(), rows.out.size()) / rows.count * bytes_of_number(rows);
    const auto cost = seconds_a_row_.find(rows.operation);
    if (cost == seconds_a_row_.end()) return std::min(first_rows, slot_bytes / 2 / row_bytes);
    const double rows_per_second = std::min(1 / cost->second, static_cast<double>(block_rows));
    return std::min(std::max(fewest_rows, static_cast<std::size_t>(rows_per_second)), slot_bytes / 2 / row_bytes);
}

/// Where the bytes of an answer arrive.
std::span<std::byte> PipeConnection::arrival_of(const Rows& rows, std::span<double> out) {
    if (uses_memory_) return {slot(blocks_answered_) + slot_bytes / 2, out.size() * bytes_of_number(rows)};
    if (!rows.is_single) return std::as_writable_bytes(out);
    floats_received_.resize(out.size());
    return std::as_writable_bytes(std::span(floats_received_));
}

/// Reads the available part of the answer to `n` rows; returns false at the end of the program's output.
bool PipeConnection::take_block(
    Exchange& x, const Rows& rows, std::size_t n, std::string& head, std::size_t& payload_read) {
    const auto read = [&](char* to, std::size_t limit, std::size_t& read_size) {
        const ssize_t count = program_.read(to, limit);
        const bool is_open = count > 0 || (count < 0 && (errno == EAGAIN || errno == EINTR));
        read_size = static_cast<std::size_t>(std::max<ssize_t>(count, 0));
        return is_open;
    };
    const auto read_head = [&](std::size_t size) {
        const std::size_t old_size = head.size();
        std::size_t read_size = 0;
        head.resize(size);
        const bool is_open = read(head.data() + old_size, size - old_size, read_size);
        head.resize(old_size + read_size);
        return is_open;
    };
    const auto number_at = [&](std::size_t offset) {
        std::uint32_t value = 0;
        std::memcpy(&value, head.data() + offset, sizeof value);
        return value;
    };
    const auto has_bytes = [&](std::size_t size, bool& is_open) {
        is_open = head.size() >= size || read_head(size);
        return head.size() >= size;
    };
    bool is_open = true;
    if (!has_bytes(4, is_open)) return is_open;
    if (number_at(0) == 0) {  // an error: its length and its text
        if (!has_bytes(8, is_open)) return is_open;
        const std::size_t length = std::min<std::size_t>(number_at(4), 4096);
        if (!has_bytes(8 + length, is_open)) return is_open;
        fault(x, x.answer_count, "got an error: " + quote(std::string_view(head).substr(8, length)));
    }
    if (number_at(0) != n)
        fault(x, x.answer_count, fmt::format("got a block of {} rows for one of {}", number_at(0), n));
    const std::size_t columns = rows.out.size() / rows.count;
    const std::span<double> out = rows.out.subspan(x.answer_count * columns, n * columns);
    const std::span<std::byte> arrival = arrival_of(rows, out);
    if (!uses_memory_) {
        std::size_t read_size = 0;
        is_open =
            read(reinterpret_cast<char*>(arrival.data()) + payload_read, arrival.size() - payload_read, read_size);
        payload_read += read_size;
        if (payload_read < arrival.size()) return is_open;
    }
    if (arrival.data() != std::as_bytes(out).data()) read_numbers(arrival.data(), rows.is_single, out);
    ++blocks_answered_;
    x.answer_count += n;
    payload_read = 0;
    head.clear();
    return is_open;
}

}  // namespace crescent
