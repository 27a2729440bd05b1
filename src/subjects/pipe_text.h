// The words of the pipe protocol: floats in and out, and what came, made fit to be shown.
#pragma once

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <limits>
#include <string>
#include <string_view>

namespace crescent::inline subjects {

/// What came, for a message: cut short, with what does not print shown as \xNN.
inline std::string shown(std::string_view s) {
    std::string out = "'";
    for (char c : s.substr(0, 80)) {
        if (c >= ' ' && c < 127) out += c;
        else out += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    }
    return out + (s.size() > 80 ? "...'" : "'");
}

/// Behind what came in place of an answer: programs greet their users, warn and tell of progress.
inline constexpr const char* only_answers = "; stdout is for answers alone, what else is said belongs on stderr";

/// What a double makes of a number that it cannot hold: infinite where it is too large, 0 where it is too small.
/// Decided by the place of its first digit, in powers of ten (of two for hexadecimal digits).
inline double out_of_range(std::string_view word, bool hex) {
    const std::size_t mark = std::min(word.find_first_of(hex ? "pP" : "eE"), word.size());
    const std::string_view digits = word.substr(0, mark);
    const std::size_t point = std::min(digits.find('.'), digits.size()), first = digits.find_first_not_of("0.");
    if (first == std::string_view::npos) return 0;
    double power = first < point ? static_cast<double>(point - first) : -static_cast<double>(first - point - 1);
    if (hex) power *= 4;
    std::string_view after = word.substr(std::min(mark + 1, word.size()));
    const bool negative = after.starts_with('-');
    if (negative || after.starts_with('+')) after.remove_prefix(1);
    double exponent = 0;
    for (char c : after) exponent = std::min(10 * exponent + (c - '0'), 1e18);
    return power + (negative ? -exponent : exponent) > 0 ? std::numeric_limits<double>::infinity() : 0;
}

/// A float at the front of `s`, decimal or hexadecimal, NaN and infinities included; what is left stays in `s`.
inline bool take_float(std::string_view& s, double& out) {
    while (!s.empty() && (s.front() == ' ' || s.front() == '\t')) s.remove_prefix(1);
    const std::size_t end = std::min(s.find_first_of(" \t"), s.size());
    std::string_view word = s.substr(0, end);
    s.remove_prefix(end);
    const bool negative = !word.empty() && word.front() == '-';
    if (negative || (!word.empty() && word.front() == '+')) word.remove_prefix(1);
    const bool hex = word.size() > 2 && word[0] == '0' && (word[1] == 'x' || word[1] == 'X');
    if (hex) word.remove_prefix(2);
    const auto [stop, error] = std::from_chars(
        word.data(), word.data() + word.size(), out, hex ? std::chars_format::hex : std::chars_format::general);
    if (error == std::errc::result_out_of_range) out = out_of_range(word, hex);
    else if (error != std::errc{}) return false;
    if (stop != word.data() + word.size() || word.empty() || word.front() == '-' || word.front() == '+') return false;
    if (negative) out = -out;
    return true;
}

/// Nothing but spaces.
inline bool blank(std::string_view s) { return s.find_first_not_of(" \t") == std::string_view::npos; }

/// Shortest text that reads back as the same double.
inline void append(std::string& to, double v) {
    char buffer[32];
    buffer[0] = ' ';
    const auto end = std::to_chars(buffer + 1, buffer + sizeof buffer, v).ptr;
    to.append(buffer, end);
}

}  // namespace crescent::inline subjects
