// Files are read in pieces of a MiB, so that an endless one ends at its limit.
#include "base/input.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>

#include "base/errors.h"

namespace crescent {

bool is_named_pipe(const std::string& path) {
    std::error_code ignored;
    return std::filesystem::is_fifo(path, ignored) && !path.starts_with("/dev/") && !path.starts_with("/proc/");
}

std::ifstream open_input(const std::string& path, std::string_view what) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored))
        throw InputError({path, 0, 0}, fmt::format("expected {}, found a folder", what));
    if (is_named_pipe(path))
        throw InputError({path, 0, 0}, fmt::format("expected {} in a regular file, found a named pipe", what));
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    if (!file)
        throw InputError(
            {path, 0, 0}, fmt::format("expected {} that can be read: {}", what, std::strerror(errno ? errno : ENOENT)));
    return file;
}

std::string read_input(const std::string& path, std::size_t limit, std::string_view what) {
    std::ifstream file = open_input(path, what);
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) limit = std::min(limit, std::size_t{64} << 20);
    std::string text;
    while (file && text.size() <= limit) {
        const std::size_t offset = text.size();
        text.resize(std::min(limit + 1, offset + (std::size_t{1} << 20)));
        errno = 0;
        file.read(text.data() + offset, static_cast<std::streamsize>(text.size() - offset));
        text.resize(offset + static_cast<std::size_t>(file.gcount()));
    }
    if (file.bad())
        throw InputError({path, 0, 0}, fmt::format("expected {} that can be read: {}", what, std::strerror(errno)));
    if (text.size() > limit)
        throw InputError({path, 0, 0}, fmt::format("expected {} of at most {} MiB, found more", what, limit >> 20));
    return text;
}

bool read_line(std::istream& file, std::string& text, std::size_t limit) {
    text.clear();
    int c = file.get();
    if (c == std::istream::traits_type::eof()) return false;
    for (; c != '\n' && c != std::istream::traits_type::eof(); c = file.get()) {
        if (text.size() > limit) return false;
        text += static_cast<char>(c);
    }
    return true;
}

}  // namespace crescent
