// A record is its size, its XXH3-64 seeded with the key's, and its bytes, written together; the first record is the key
// itself. Reading ends at the first incomplete record and truncates the file there. flock() keeps other processes out.
#include "base/journal.h"

#include <utility>

#ifndef CRESCENT_NO_FILESYSTEM
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>

#define XXH_INLINE_ALL
#include <xxhash.h>

#endif

namespace crescent::inline base {

Journal::Journal(std::string path, std::string key, ProgressMonitor& monitor)
    : path_(std::move(path)), key_(std::move(key)), monitor_(monitor) {}

Journal::Journal(Journal&& other) noexcept
    : path_(std::move(other.path_)),
      key_(std::move(other.key_)),
      monitor_(other.monitor_),
      file_(std::exchange(other.file_, -1)),
      disabled_(other.disabled_) {}

#ifndef CRESCENT_NO_FILESYSTEM

namespace {

/// The head of a record. The hash is seeded with the key's, so that a record copied from the journal of other work is
/// rejected.
struct Head {
    std::uint64_t size, hash;
};

bool read_all(int file, void* to, std::size_t size) {
    auto* at = static_cast<char*>(to);
    while (size > 0) {
        const ssize_t n = ::read(file, at, size);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        at += n, size -= static_cast<std::size_t>(n);
    }
    return true;
}

std::uint64_t hash_of(const std::string& key, const std::byte* record, std::size_t size) {
    return XXH3_64bits_withSeed(record, size, XXH3_64bits(key.data(), key.size()));
}

/// Reads the next record, if it is complete.
bool next_record(int file, std::uint64_t left, const std::string& key, std::vector<std::byte>& record) {
    Head head;
    if (left < sizeof head || !read_all(file, &head, sizeof head) || head.size > left - sizeof head) return false;
    record.resize(head.size);
    return read_all(file, record.data(), head.size) && hash_of(key, record.data(), record.size()) == head.hash;
}

Journal::Bytes bytes_of(const std::string& text) { return std::as_bytes(std::span(text)); }

}  // namespace

Journal::~Journal() {
    if (file_ >= 0) close(file_);
}

bool Journal::open(int flags) {
    file_ = ::open(path_.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | flags, 0666);
    if (file_ < 0) return false;
    disabled_ = flock(file_, LOCK_EX | LOCK_NB) != 0;
    return true;
}

void Journal::read(const std::function<void(Bytes)>& take) {
    struct stat about{};
    if (!open(0) || disabled_ || fstat(file_, &about) != 0) return;
    const auto size = static_cast<std::uint64_t>(about.st_size);
    std::uint64_t whole = 0;
    std::vector<std::byte> record;
    while (next_record(file_, size - whole, key_, record)) {
        if (whole > 0) take(record);
        else if (record.size() != key_.size() || std::memcmp(record.data(), key_.data(), key_.size()) != 0) break;
        whole += sizeof(Head) + record.size();
    }
    if (whole == 0 || ftruncate(file_, static_cast<off_t>(whole)) != 0 || lseek(file_, 0, SEEK_END) < 0) remove();
}

void Journal::append(const std::vector<Bytes>& parts) {
    if (disabled_) return;
    bool written = file_ >= 0;
    if (!written) {
        std::error_code ignored;  // open() will report the error
        std::filesystem::create_directories(std::filesystem::path(path_).parent_path(), ignored);
        written = open(O_CREAT);
        if (disabled_) return;
        written = written && ftruncate(file_, 0) == 0 && write({bytes_of(key_)});
    }
    if (written && write(parts)) return;
    monitor_.log(fmt::format("cannot write the checkpoint {}: {}; if this run is stopped, it cannot be resumed", path_,
        std::strerror(errno)));
    remove();
    disabled_ = true;
}

bool Journal::write(const std::vector<Bytes>& parts) {
    std::vector<std::byte> all(sizeof(Head));
    for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
    const Head head = {all.size() - sizeof(Head), hash_of(key_, all.data() + sizeof(Head), all.size() - sizeof(Head))};
    std::memcpy(all.data(), &head, sizeof head);
    for (std::size_t done = 0; done < all.size();) {
        const ssize_t n = ::write(file_, all.data() + done, all.size() - done);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return false;
        done += static_cast<std::size_t>(n);
    }
    return true;
}

void Journal::remove() {
    if (disabled_) return;
    ::unlink(path_.c_str());
    if (file_ >= 0) close(std::exchange(file_, -1));
}

#else  // without files, nothing is kept

Journal::~Journal() = default;
void Journal::read(const std::function<void(Bytes)>&) {}
void Journal::append(const std::vector<Bytes>&) {}
void Journal::remove() {}

#endif

}  // namespace crescent::inline base
