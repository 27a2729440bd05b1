// An open file of a render: a regular file, read by offset and not mapped, so that a file which another program
// truncates is an error, not a signal. Its state shows whether the file changed between two readings.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace crescent {

// ---- Rectangles of pixels as in files: both ends inclusive, y from the top down (OpenEXR's windows).

/// A header with more pixels per side is considered damaged.
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

/// Identifies the file and its last modification.
struct FileState {
    std::uint64_t device = 0, inode = 0, size = 0;
    std::int64_t modified = 0;  // nanoseconds since 1970
    bool operator==(const FileState&) const = default;
};

/// What a file begins with that Git LFS has not pulled.
inline constexpr std::string_view lfs_pointer = "version https://git-lfs";

class OpenFile {
public:
    /// Throws InputError if it is not a regular file (a folder, pipe, socket or device), without waiting for it.
    explicit OpenFile(const std::string& path);
    ~OpenFile();
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;

    const std::string& path() const { return path_; }
    const FileState& state() const { return state_; }
    std::uint64_t size() const { return state_.size; }
    /// For a child process that reads it.
    int descriptor() const { return file_; }

    /// Fills `to` from byte `from` on; throws InputError if the file ends before. May be called from many threads at
    /// once.
    void read(std::uint64_t from, std::span<char> to) const;
    /// Reads as many of these bytes as the file has.
    std::size_t read_some(std::uint64_t from, std::span<char> to) const;
    /// Throws InputError if it has fewer bytes from there on; `what`: "the header promises 4 x 4 pixels".
    void expect_bytes(std::uint64_t from, std::uint64_t bytes, const std::string& what) const;
    /// Throws InputError if it changed since it was opened.
    void expect_unchanged() const;

    [[noreturn]] void fail(const std::string& message) const;

private:
    std::string path_;
    FileState state_;
    int file_ = -1;
};

// ---- The text header of a file, line by line, before its binary pixels.

class TextHeader {
public:
    explicit TextHeader(const OpenFile& file);

    /// Returns the next line, without its end; throws InputError if no line ends within 4096 bytes.
    std::string_view line();
    /// Throws InputError with the number of the line that line() returned last.
    [[noreturn]] void fail(const std::string& message) const;
    /// Returns the first byte after that line.
    std::size_t end() const { return position_; }
    /// Throws InputError if these are not valid sides of an image.
    void check_size(long long width, long long height) const;

private:
    const OpenFile& file_;
    std::string text_;  // the longest possible header
    std::size_t position_ = 0;
    unsigned line_ = 0;
};

/// Splits at blanks.
std::vector<std::string_view> split_words(std::string_view line);

/// Parses a number; returns whether all of the text is one.
template <class T> bool parse_number(std::string_view text, T& to) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), to);
    return error == std::errc{} && end == text.data() + text.size();
}

}  // namespace crescent
