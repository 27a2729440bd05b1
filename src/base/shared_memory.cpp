// Sealed against becoming smaller, so that no access to it can fail because of the other program.
#include "base/shared_memory.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/errors.h"

namespace crescent {

SharedMemory::SharedMemory(std::size_t bytes) : bytes_(bytes) {
#ifdef __linux__
    file_ = ::memfd_create("crescent", MFD_CLOEXEC | MFD_ALLOW_SEALING);
#else
    const std::string name = fmt::format("/crescent-{}-{}", ::getpid(), static_cast<const void*>(this));
    file_ = ::shm_open(name.c_str(), O_RDWR | O_CREAT | O_EXCL, 0600);
    ::shm_unlink(name.c_str());
#endif
    void* address = MAP_FAILED;
    if (file_ >= 0 && ::ftruncate(file_, static_cast<off_t>(bytes)) == 0)
        address = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file_, 0);
    if (address == MAP_FAILED) {
        const int why = errno;
        if (file_ >= 0) ::close(file_);
        throw OutputError(fmt::format("no shared memory: {}", std::strerror(why)));
    }
    address_ = static_cast<std::byte*>(address);
#ifdef __linux__
    ::fcntl(file_, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_SEAL);
#endif
}

SharedMemory::~SharedMemory() {
    ::munmap(address_, bytes_);
    ::close(file_);
}

}  // namespace crescent
