// The lines of a file's header, which is text, before its pixels, which are not.
#pragma once

#include <charconv>
#include <string>
#include <string_view>
#include <vector>

#include "compare/open_file.h"

namespace crescent::inline comparing {

class TextHeader {
public:
    explicit TextHeader(const OpenFile& file);

    /// The next line, without its end; throws InputError where none ends within 4096 bytes.
    std::string_view line();
    /// Of the line that line() gave, with its number.
    [[noreturn]] void fail(const std::string& message) const;
    /// The byte after it.
    std::size_t end() const { return at_; }
    /// Throws where these are no sides of an image.
    void check_size(long long width, long long height) const;

private:
    const OpenFile& file_;
    std::string text_;  // as far as a header reaches
    std::size_t at_ = 0;
    unsigned line_ = 0;
};

/// Words between blanks.
std::vector<std::string_view> words_of(std::string_view line);

/// Whether all of the text is one number.
template <class T> bool parse_number(std::string_view text, T& to) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), to);
    return error == std::errc{} && end == text.data() + text.size();
}

}  // namespace crescent::inline comparing
