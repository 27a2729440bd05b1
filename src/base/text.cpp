// UTF-8 as in RFC 3629, section 4: no overlong forms, no surrogates; U+FFFE and U+FFFF also count as invalid. Each
// character is passed on, replaced or shown by its number. Shell words are in single quotes.
#include "base/text.h"

#include <algorithm>
#include <fmt/format.h>

#include "base/errors.h"

namespace crescent {
namespace {

constexpr std::string_view replacement = "\xEF\xBF\xBD";  // U+FFFD

/// Returns the bytes of the UTF-8 sequence that begins at `start`, 0 if it is invalid (RFC 3629, section 4).
std::size_t sequence_length(std::string_view text, std::size_t start) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned first = byte(start);
    const std::size_t length = first < 0x80 ? 1
        : first >= 0xC2 && first < 0xE0     ? 2
        : first >= 0xE0 && first < 0xF0     ? 3
        : first >= 0xF0 && first < 0xF5     ? 4
                                            : 0;
    if (length == 0 || start + length > text.size()) return 0;
    for (std::size_t i = 1; i < length; ++i)
        if ((byte(start + i) & 0xC0) != 0x80) return 0;
    if (length < 3) return length;
    const unsigned second = byte(start + 1);
    const bool overlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
    const bool is_outside = (first == 0xED && second > 0x9F) || (first == 0xF4 && second > 0x8F);
    const bool noncharacter = first == 0xEF && second == 0xBF && byte(start + 2) >= 0xBE;  // U+FFFE, U+FFFF
    return overlong || is_outside || noncharacter ? 0 : length;
}

bool forbidden(char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x20 && c != '\t' && c != '\n' && c != '\r';
}

std::string_view reference(char c) {
    switch (c) {
        case '&': return "&amp;";
        case '<': return "&lt;";
        case '>': return "&gt;";
        case '"': return "&quot;";
        case '\'': return "&#39;";
        default: return {};
    }
}

}  // namespace

std::string escape(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t length = sequence_length(text, i);
        if (length == 0 || forbidden(text[i])) {
            out += replacement;
            ++i;
            continue;
        }
        const std::string_view name = reference(text[i]);
        out += name.empty() ? text.substr(i, length) : name;
        i += length;
    }
    return out;
}

std::string printable(std::string_view text, std::size_t longest) {
    std::string out;
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t length = sequence_length(text, i);
        if (i + std::max<std::size_t>(length, 1) > longest) return out + "...";
        const auto byte = [&](std::size_t k) { return static_cast<unsigned>(static_cast<unsigned char>(text[i + k])); };
        unsigned c = byte(0);
        if (length == 2) c = (c & 0x1F) << 6 | (byte(1) & 0x3F);
        if (length == 3) c = (c & 0x0F) << 12 | (byte(1) & 0x3F) << 6 | (byte(2) & 0x3F);
        const bool turns = length == 3 && ((c >= 0x2028 && c <= 0x202E) || (c >= 0x2066 && c <= 0x2069));
        if (length == 0 || (length == 1 && (c < 0x20 || c == 0x7F))) out += fmt::format("\\x{:02x}", c);
        else if (turns || (length == 2 && c < 0xA0)) out += fmt::format("\\u{{{:x}}}", c);
        else out += text.substr(i, length);
        i += std::max<std::size_t>(length, 1);
    }
    return out;
}

std::string printable_lines(std::string_view text) {
    std::string out;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find_first_of("\t\n"), text.size());
        out += printable(text.substr(0, end));
        if (end < text.size()) out += text[end];
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return out;
}

std::string shell_word(std::string_view word) {
    constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
    if (!word.empty() && word.find_first_not_of(plain) == std::string_view::npos) return std::string(word);
    std::string out = "'";
    for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

// ---- Formats the suggestion of nearest(); words of more than 64 characters get none.

std::string did_you_mean(std::string_view word, const std::vector<std::string>& valid) {
    const std::string suggestion = word.size() > 64 ? "" : nearest(word, valid);
    return suggestion.empty() || suggestion == word ? "" : "; did you mean '" + suggestion + "'?";
}

std::string expected_one_of(const std::vector<std::string>& valid, std::string_view word) {
    std::string words;
    for (const std::string& name : valid) words += (words.empty() ? "" : ", ") + name;
    return "expected one of " + words + ", not '" + printable(std::string(word)) + "'" + did_you_mean(word, valid);
}

}  // namespace crescent
