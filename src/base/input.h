// Reads files that a user names: at most a stated number of bytes, and never from a named pipe, whose writer may not
// exist. A pipe that a shell opened (/dev/stdin, /dev/fd/63) is read.
#pragma once

#include <cstddef>
#include <fstream>
#include <string>
#include <string_view>

namespace crescent {

/// Whether it is a pipe with a name; false for one that a shell opened.
bool is_named_pipe(const std::string& path);

/// Opens a file for reading. Throws InputError: "expected {what} that can be read: ...".
std::ifstream open_input(const std::string& path, std::string_view what);

/// Returns the content of a file. Throws InputError if it has more than `limit` bytes, or, if it is no regular file and
/// may be endless, more than 64 MiB.
std::string read_input(const std::string& path, std::size_t limit, std::string_view what);

/// Reads a line without its end. Returns false at the end of the file, or, with `text` longer than `limit`, at a line
/// that is longer.
bool read_line(std::istream& file, std::string& text, std::size_t limit);

}  // namespace crescent
