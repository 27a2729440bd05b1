// Reads files that a user names: at most a stated number of bytes, and never from a named pipe, whose writer may not
// exist. A pipe that a shell opened (/dev/stdin, /dev/fd/63) is read.
#pragma once

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <string>
#include <string_view>

#include "base/errors.h"

namespace crescent::inline base {

inline bool is_named_pipe(const std::string& path) {
    std::error_code ignored;
    return std::filesystem::is_fifo(path, ignored) && !path.starts_with("/dev/") && !path.starts_with("/proc/");
}

/// Opens a file for reading. Throws InputError: "expected {what} that can be read: ...".
inline std::ifstream open_input(const std::string& path, std::string_view what) {
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

/// Returns the content of a file. Throws InputError if it has more than `most` bytes, or, if it is no regular file and
/// may be endless, more than 64 MiB.
inline std::string read_input(const std::string& path, std::size_t most, std::string_view what) {
    std::ifstream file = open_input(path, what);
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) most = std::min(most, std::size_t{64} << 20);
    std::string text;
    while (file && text.size() <= most) {
        const std::size_t before = text.size();
        text.resize(std::min(most + 1, before + (std::size_t{1} << 20)));
        errno = 0;
        file.read(text.data() + before, static_cast<std::streamsize>(text.size() - before));
        text.resize(before + static_cast<std::size_t>(file.gcount()));
    }
    if (file.bad())
        throw InputError({path, 0, 0}, fmt::format("expected {} that can be read: {}", what, std::strerror(errno)));
    if (text.size() > most)
        throw InputError({path, 0, 0}, fmt::format("expected {} of at most {} MiB, found more", what, most >> 20));
    return text;
}

/// Reads a line without its end. Returns false at the end of the file, or, with `text` longer than `most`, at a line
/// that is longer.
inline bool read_line(std::istream& file, std::string& text, std::size_t most) {
    text.clear();
    int c = file.get();
    if (c == std::istream::traits_type::eof()) return false;
    for (; c != '\n' && c != std::istream::traits_type::eof(); c = file.get()) {
        if (text.size() > most) return false;
        text += static_cast<char>(c);
    }
    return true;
}

}  // namespace crescent::inline base
