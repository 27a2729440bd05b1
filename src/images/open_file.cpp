// POSIX files: stat() before open(), then pread().
#include "images/open_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/errors.h"

namespace crescent {

// ---- Lines of the first 64 KiB of a file.

namespace {

constexpr std::size_t longest_header = 1u << 16, longest_line = 4096;

}  // namespace

TextHeader::TextHeader(const OpenFile& file) : file_(file), text_(longest_header, '\0') {
    text_.resize(file.read_some(0, text_));
}

std::string_view TextHeader::line() {
    ++line_;
    const std::size_t end = text_.find('\n', position_);
    if (end == std::string::npos || end - position_ > longest_line) fail("expected a line of the header, found none");
    const std::string_view out = std::string_view(text_).substr(position_, end - position_);
    position_ = end + 1;
    return out;
}

void TextHeader::fail(const std::string& message) const { throw InputError({file_.path(), line_, 1}, message); }

void TextHeader::check_size(long long width, long long height) const {
    if (width < 1 || height < 1 || width > most_pixels_a_side || height > most_pixels_a_side)
        fail(fmt::format("expected 1 to {} pixels a side, found {} x {}", most_pixels_a_side, width, height));
}

std::vector<std::string_view> split_words(std::string_view line) {
    std::vector<std::string_view> words;
    for (std::size_t start = 0; start < line.size();) {
        const std::size_t end = std::min(line.find_first_of(" \t\r", start), line.size());
        if (end > start) words.push_back(line.substr(start, end - start));
        start = end + 1;
    }
    return words;
}

namespace {

const char* kind_of(mode_t mode) {
    return S_ISDIR(mode) ? "a folder"
        : S_ISFIFO(mode) ? "a pipe, and renders are read twice: write it to a file"
        : S_ISSOCK(mode) ? "a socket"
                         : "a device";
}

FileState state_of(const struct stat& s) {
    FileState out;
    out.device = static_cast<std::uint64_t>(s.st_dev);
    out.inode = static_cast<std::uint64_t>(s.st_ino);
    out.size = static_cast<std::uint64_t>(std::max<off_t>(0, s.st_size));
#ifdef __APPLE__
    const timespec& t = s.st_mtimespec;
#else
    const timespec& t = s.st_mtim;
#endif
    out.modified = static_cast<std::int64_t>(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
    return out;
}

}  // namespace

OpenFile::OpenFile(const std::string& path) : path_(path) {
    struct stat s{};
    const auto check = [&](int result) {
        if (result) fail(std::string("expected a render that can be read: ") + std::strerror(errno));
        if (!S_ISREG(s.st_mode)) fail(std::string("expected a render, found ") + kind_of(s.st_mode));
    };
    check(::stat(path.c_str(), &s));  // before open(), which would wait for a pipe and may start a device
    file_ = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
    if (file_ < 0) check(-1);
    try {
        check(::fstat(file_, &s));
    } catch (...) {
        ::close(file_);
        throw;
    }
    state_ = state_of(s);
}

OpenFile::~OpenFile() { ::close(file_); }

void OpenFile::fail(const std::string& message) const { throw InputError({path_, 0, 0}, message); }

std::size_t OpenFile::read_some(std::uint64_t from, std::span<char> to) const {
    std::size_t count = 0;
    while (count < to.size()) {
        const ssize_t n = ::pread(file_, to.data() + count, to.size() - count, static_cast<off_t>(from + count));
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) fail(std::string("expected a render that can be read: ") + std::strerror(errno));
        if (n == 0) break;
        count += static_cast<std::size_t>(n);
    }
    return count;
}

void OpenFile::read(std::uint64_t from, std::span<char> to) const {
    if (const std::size_t n = read_some(from, to); n < to.size())
        fail(fmt::format("expected {} bytes from byte {} on, found {}: the file is cut off", to.size(), from, n));
}

void OpenFile::expect_bytes(std::uint64_t from, std::uint64_t bytes, const std::string& what) const {
    const std::uint64_t available = from < size() ? size() - from : 0;
    if (available < bytes)
        fail(fmt::format(
            "the file is cut off: {}, expected {} bytes from byte {} on, found {}", what, bytes, from, available));
}

void OpenFile::expect_unchanged() const {
    struct stat s{};
    if (::fstat(file_, &s) || state_of(s) != state_) fail("the file was changed while it was read");
}

}  // namespace crescent
