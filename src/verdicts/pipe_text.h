// The words of the pipe protocol: floats in and out, and what came, made fit to be shown.
#pragma once

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <string>
#include <string_view>

namespace crescent {

/// What came, for a message: cut short, with what does not print shown as \xNN.
inline std::string shown(std::string_view s) {
    std::string out = "'";
    for (char c : s.substr(0, 80)) {
        if (c >= ' ' && c < 127) out += c;
        else out += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    }
    return out + (s.size() > 80 ? "...'" : "'");
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
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), out, hex ? std::chars_format::hex : std::chars_format::general);
    if (error == std::errc::result_out_of_range) out = 0;  // an underflow reads as 0; an overflow is not a number this bench can use
    else if (error != std::errc{}) return false;
    if (stop != word.data() + word.size() || word.empty() || word.front() == '-' || word.front() == '+') return false;
    if (negative) out = -out;
    return true;
}

inline bool blank(std::string_view s) { return s.find_first_not_of(" \t") == std::string_view::npos; }

/// Shortest text that reads back as the same double.
inline void append(std::string& to, double v) {
    char buffer[32];
    buffer[0] = ' ';
    const auto end = std::to_chars(buffer + 1, buffer + sizeof buffer, v).ptr;
    to.append(buffer, end);
}

/// A program's name for itself: at most 60 bytes, nothing that moves a terminal's cursor.
inline std::string plain_name(std::string_view s) {
    std::string out(s.substr(0, 60));
    for (char& c : out)
        if (static_cast<unsigned char>(c) < ' ' || c == 127) c = '?';
    return out;
}

}  // namespace crescent
