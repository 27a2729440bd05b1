// Memory that a program shares which is started with it (ProcessPlan::shared).
#pragma once

#include <cstddef>

namespace crescent {

/// Of a fixed size, zero at first, which takes room where it is used. Closed and unmapped at its end.
class SharedMemory {
public:
    /// Throws OutputError if there is none.
    explicit SharedMemory(std::size_t bytes);
    ~SharedMemory();
    SharedMemory(const SharedMemory&) = delete;
    SharedMemory& operator=(const SharedMemory&) = delete;
    int file() const { return file_; }
    std::byte* at() const { return address_; }

private:
    std::size_t bytes_;
    int file_ = -1;
    std::byte* address_ = nullptr;
};

}  // namespace crescent
