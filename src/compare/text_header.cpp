// Lines out of the first 64 KiB of a file.
#include "compare/text_header.h"

#include <fmt/format.h>

#include "base/errors.h"
#include "compare/pixel_window.h"

namespace crescent::inline comparing {

namespace {

constexpr std::size_t longest_header = 1u << 16, longest_line = 4096;

}  // namespace

TextHeader::TextHeader(const OpenFile& file) : file_(file), text_(longest_header, '\0') {
    text_.resize(file.read_some(0, text_));
}

std::string_view TextHeader::line() {
    ++line_;
    const std::size_t end = text_.find('\n', at_);
    if (end == std::string::npos || end - at_ > longest_line) fail("expected a line of the header, found none");
    const std::string_view out = std::string_view(text_).substr(at_, end - at_);
    at_ = end + 1;
    return out;
}

void TextHeader::fail(const std::string& message) const { throw InputError({file_.path(), line_, 1}, message); }

void TextHeader::check_size(long long width, long long height) const {
    if (width < 1 || height < 1 || width > most_pixels_a_side || height > most_pixels_a_side)
        fail(fmt::format("expected 1 to {} pixels a side, found {} x {}", most_pixels_a_side, width, height));
}

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    for (std::size_t at = 0; at < line.size();) {
        const std::size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
        if (end > at) words.push_back(line.substr(at, end - at));
        at = end + 1;
    }
    return words;
}

}  // namespace crescent::inline comparing
