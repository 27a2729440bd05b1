// A file of a render, open: regular, read by offset, never mapped, so that a file which another program cuts short is
// an error and not a signal. Its state says whether a later reading is of the same bytes.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace crescent::inline comparison {

// ---- Rectangles of pixels as files have them: both ends inside, y from the top down (OpenEXR's windows).

/// More on a side is taken for a damaged header.
inline constexpr std::int64_t most_pixels_a_side = 65536;

struct PixelWindow {
    std::int64_t x0 = 0, y0 = 0, x1 = -1, y1 = -1;
    std::int64_t width() const { return x1 - x0 + 1; }
    std::int64_t height() const { return y1 - y0 + 1; }
    bool empty() const { return width() < 1 || height() < 1; }
    std::size_t pixels() const { return static_cast<std::size_t>(width()) * static_cast<std::size_t>(height()); }
    bool operator==(const PixelWindow&) const = default;
};

inline PixelWindow intersection(const PixelWindow& a, const PixelWindow& b) {
    return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

/// Which file it is and when it was written last.
struct FileState {
    std::uint64_t device = 0, inode = 0, size = 0;
    std::int64_t modified = 0;  // nanoseconds since 1970
    bool operator==(const FileState&) const = default;
};

class OpenFile {
public:
    /// Throws InputError for what is no regular file (a folder, pipe, socket or device), without waiting for it.
    explicit OpenFile(const std::string& path);
    ~OpenFile();
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;

    const std::string& path() const { return path_; }
    const FileState& state() const { return state_; }
    std::uint64_t size() const { return state_.size; }

    /// Fills `to` from the given byte on; throws InputError where the file ends before. Many threads may read at once.
    void read(std::uint64_t from, std::span<char> to) const;
    /// As much of it as there is.
    std::size_t read_some(std::uint64_t from, std::span<char> to) const;
    /// Throws InputError where it has fewer bytes from there on; `of`: "the header promises 4 x 4 pixels".
    void expect_bytes(std::uint64_t from, std::uint64_t bytes, const std::string& of) const;
    /// Throws InputError where it is no longer as it was when it was opened.
    void expect_unchanged() const;

    [[noreturn]] void fail(const std::string& message) const;

private:
    std::string path_;
    FileState state_;
    int file_ = -1;
};

// ---- The lines of a file's header, which is text, before its pixels, which are not.

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

}  // namespace crescent::inline comparison
