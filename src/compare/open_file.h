// A file of a render, open: regular, read by offset, never mapped, so that a file which another program cuts short is
// an error and not a signal. Its state says whether a later reading is of the same bytes.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace crescent::inline comparing {

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

}  // namespace crescent::inline comparing
