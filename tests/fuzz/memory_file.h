// Bytes as a file that is opened by its path.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <string>
#include <string_view>

#include "base/errors.h"

namespace crescent {

/// A file in memory.
class MemoryFile {
public:
    explicit MemoryFile(std::string_view bytes) : file_(::memfd_create("fuzz", 0)) {
        ensure(file_ >= 0, "a file in memory is made");
        while (!bytes.empty()) {
            const ssize_t n = ::write(file_, bytes.data(), bytes.size());
            ensure(n > 0, "a file in memory is written");
            bytes.remove_prefix(static_cast<std::size_t>(n));
        }
    }
    ~MemoryFile() { ::close(file_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }

private:
    int file_;
};

/// Calls read(), which may refuse its input with a message.
template <class Read> void read_or_refuse(Read&& read) {
    try {
        read();
    } catch (const InputError& error) {
        ensure(!error.diagnostics().empty() && !error.diagnostics().front().message.empty(), "a refusal says why");
    }
}

}  // namespace crescent
