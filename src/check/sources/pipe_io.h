// The pipe protocol: floats as text, received text in a printable form, and the connection to a program.
#pragma once

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <fmt/format.h>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/process.h"
#include "base/shared_memory.h"
#include "check/sources/external.h"
#include "samplers/sampler_adapter.h"

namespace crescent {

/// Received text for a message: shortened, with unprintable bytes as \xNN.
inline std::string quote(std::string_view s) {
    std::string out = "'";
    for (char c : s.substr(0, 80)) {
        if (c >= ' ' && c < 127) out += c;
        else out += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    }
    return out + (s.size() > 80 ? "...'" : "'");
}

/// Appended to an unexpected answer: programs print greetings, warnings and progress.
inline constexpr const char* only_answers = "; stdout is for answers alone, other output belongs on stderr";

/// The double for a number out of range: infinite if it is too large, 0 if it is too small. Decided by the position of
/// its first digit, in powers of ten (of two for hexadecimal digits).
inline double out_of_range(std::string_view word, bool is_hex) {
    const std::size_t mark = std::min(word.find_first_of(is_hex ? "pP" : "eE"), word.size());
    const std::string_view digits = word.substr(0, mark);
    const std::size_t point = std::min(digits.find('.'), digits.size()), first = digits.find_first_not_of("0.");
    if (first == std::string_view::npos) return 0;
    double power = first < point ? static_cast<double>(point - first) : -static_cast<double>(first - point - 1);
    if (is_hex) power *= 4;
    std::string_view exponent_text = word.substr(std::min(mark + 1, word.size()));
    const bool is_negative = exponent_text.starts_with('-');
    if (is_negative || exponent_text.starts_with('+')) exponent_text.remove_prefix(1);
    double exponent = 0;
    for (char c : exponent_text) exponent = std::min(10 * exponent + (c - '0'), 1e18);
    return power + (is_negative ? -exponent : exponent) > 0 ? std::numeric_limits<double>::infinity() : 0;
}

/// Reads a float at the front of `s`, decimal or hexadecimal, including NaN and infinities, and removes it from `s`.
inline bool take_float(std::string_view& s, double& out) {
    while (!s.empty() && (s.front() == ' ' || s.front() == '\t')) s.remove_prefix(1);
    const std::size_t end = std::min(s.find_first_of(" \t"), s.size());
    std::string_view word = s.substr(0, end);
    s.remove_prefix(end);
    const bool is_negative = !word.empty() && word.front() == '-';
    if (is_negative || (!word.empty() && word.front() == '+')) word.remove_prefix(1);
    const bool is_hex = word.size() > 2 && word[0] == '0' && (word[1] == 'x' || word[1] == 'X');
    if (is_hex) word.remove_prefix(2);
    const auto [stop, error] = std::from_chars(
        word.data(), word.data() + word.size(), out, is_hex ? std::chars_format::hex : std::chars_format::general);
    if (error == std::errc::result_out_of_range) out = out_of_range(word, is_hex);
    else if (error != std::errc{}) return false;
    if (stop != word.data() + word.size() || word.empty() || word.front() == '-' || word.front() == '+') return false;
    if (is_negative) out = -out;
    return true;
}

/// Whether there are only spaces.
inline bool blank(std::string_view s) { return s.find_first_not_of(" \t") == std::string_view::npos; }

/// Appends the shortest text that reads back as the same double.
inline void append(std::string& to, double v) {
    char buffer[32];
    buffer[0] = ' ';
    const auto end = std::to_chars(buffer + 1, buffer + sizeof buffer, v).ptr;
    to.append(buffer, end);
}

// ---- Requests to a program and its answers, as text lines or blocks of numbers. Requests are sent far ahead of the
// answers, without blocking, so that neither side waits for the other.

/// A program that ended before it answered.
struct ProgramEnded : SamplerError {
    ProgramEnded(const std::string& message, const ProcessEnd& program_end) : SamplerError(message), end(program_end) {}
    ProcessEnd end;
};

class PipeConnection {
public:
    /// Starts `command` with the shell; `label` is the prefix of its stderr output. `offers_memory`: gives it memory
    /// for blocks.
    PipeConnection(
        const std::string& command, const PipeLimits& limits, const std::string& label, bool offers_memory = false)
        : limits_(limits),
          memory_(offers_memory ? std::make_unique<SharedMemory>(slots * slot_bytes) : nullptr),
          program_({.argv = {"/bin/sh", "-c", command}, .label = label, .shared = memory_ ? memory_->file() : -1}) {}
    PipeConnection(const PipeConnection&) = delete;
    PipeConnection& operator=(const PipeConnection&) = delete;

    using Write = std::function<void(std::size_t, std::string&)>;
    using Read = std::function<bool(std::size_t, std::string_view)>;
    /// Sends and receives one line `count` times; `read` returns whether an answer is valid.
    void lines(std::size_t count, std::string_view expected, const Write& write, const Read& read);
    /// Rows of equal size in both directions; `describe` formats a request for a message.
    struct Rows {
        const char* operation;  // four letters
        std::size_t count;
        std::span<const double> in;
        std::span<double> out;
        bool is_single = false;  // sent and received as floats
        std::string expected;    // an answer, for a message
        std::function<std::string(std::size_t)> describe;
        std::string header{};  // bytes between the count and the rows
    };
    void blocks(const Rows& rows);
    /// From here on rows and answers of blocks are in the memory, and the pipes have the rest. Returns false if none
    /// was offered.
    bool use_memory() { return uses_memory_ = memory_ != nullptr; }

    /// Throws an error for the answer to request i of the current exchange.
    [[noreturn]] void fault(
        const std::string& request, std::size_t i, const std::string& what, std::string_view expected);
    void finish_handshake() { has_handshake_ = true; }
    const std::string& broken() const { return error_; }
    QueryUsage spending() const { return {requests_, seconds_since(start_), limits_.total_seconds}; }
    /// Ends the program without reading more output; it has half a second to exit by itself, unless it failed.
    void stop() { program_.end(error_.empty() ? 500 : 0); }

private:
    using Clock = std::chrono::steady_clock;
    /// A series of requests: number of answers expected, requests written, answers received.
    struct Exchange {
        std::size_t count;
        std::string_view expected;
        std::function<std::string(std::size_t)> describe;  // request i, for a message
        std::function<void()> produce, take;  // appends requests to `outgoing`; reads answers from the received bytes
        std::size_t request_count = 0, answer_count = 0, sent_bytes = 0;
        std::string outgoing{};
    };
    /// Blocks use the slots in turn; the answers are in the second half of a slot.
    static constexpr std::size_t slots = 2, slot_bytes = 16u << 20;
    /// Of a block in memory at least, and of the first one.
    static constexpr std::size_t fewest_rows = 1024, first_rows = 4096;
    PipeLimits limits_;
    std::unique_ptr<SharedMemory> memory_;
    bool uses_memory_ = false;
    std::size_t blocks_sent_ = 0, blocks_answered_ = 0;
    mutable Process program_;  // mutable, to query the exit status for a message
    std::string incoming_;
    std::size_t read_offset_ = 0;
    std::vector<float> floats_sent_, floats_received_;          // of a block in single precision
    std::map<std::string, double, std::less<>> seconds_a_row_;  // of the last rows in memory, by operation
    std::atomic<std::uint64_t> requests_ = 0;
    std::string error_;  // the error; no requests are sent after it
    bool has_handshake_ = false, is_slow_ = false;
    Clock::time_point start_ = Clock::now();

    static double seconds_since(Clock::time_point start) {
        return std::chrono::duration<double>(Clock::now() - start).count();
    }
    void run(Exchange& x);
    void check_open() const;
    std::size_t send(Exchange& x, std::string_view bytes, bool has_answers);
    void check_time_limits(Exchange& x, Clock::time_point last);
    void take_lines(Exchange& x, const Read& read);
    bool take_block(Exchange& x, const Rows& rows, std::size_t n, std::string& head, std::size_t& payload_read);
    std::byte* slot(std::size_t block) const { return memory_->at() + block % slots * slot_bytes; }
    static std::size_t bytes_of_number(const Rows& rows) { return rows.is_single ? sizeof(float) : sizeof(double); }
    std::size_t most_rows(const Rows& rows) const;
    std::string_view payload_of(const Rows& rows, std::span<const double> in);
    std::span<std::byte> arrival_of(const Rows& rows, std::span<double> out);
    [[noreturn]] void fault(Exchange& x, std::size_t i, const std::string& what) {
        fault(x.describe(i), i, what, x.expected);
    }
    bool fill();
    std::string_view pending() const { return std::string_view(incoming_).substr(read_offset_); }
    std::string exit_text(int milliseconds) const;
    std::string close_reason() const;
    std::string silence_reason() const;
    std::string end_of_output() const;
};

}  // namespace crescent
