#include "base/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "base/errors.h"

namespace crescent {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view prefix = ".crescent-";

[[noreturn]] void fail(const std::string& what, const std::string& path, const std::string& why) {
    throw OutputError(fmt::format("{} {}: {}", what, path, why));
}

/// Removes stages whose process is gone.
void clear_stale(const std::string& folder) {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
        const std::string name = entry.path().filename();
        if (!name.starts_with(prefix)) continue;
        const long pid = std::strtol(name.c_str() + prefix.size(), nullptr, 10);
        if (pid > 0 && kill(static_cast<pid_t>(pid), 0) != 0 && errno == ESRCH) fs::remove_all(entry.path(), ignored);
    }
}

void write_whole(const std::string& path, const unsigned char* bytes, std::size_t size) {
    const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file < 0) fail("cannot write", path, std::strerror(errno));
    while (size > 0) {
        const ssize_t n = ::write(file, bytes, size);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) {
            const int why = errno;
            close(file);
            fail("cannot write", path, std::strerror(why));
        }
        bytes += n;
        size -= static_cast<std::size_t>(n);
    }
    if (close(file) != 0) fail("cannot write", path, std::strerror(errno));
}

}  // namespace

Staging::Staging(std::string folder) : folder_(std::move(folder)) {
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error || !fs::is_directory(folder_)) fail("cannot make the folder", folder_, error ? error.message() : "something else has that name");
    clear_stale(folder_);
    stage_ = folder_ + "/" + std::string(prefix) + std::to_string(getpid());
    fs::create_directories(stage_, error);
    if (error) fail("cannot write in", folder_, error.message());
}

Staging::~Staging() {
    std::error_code ignored;
    fs::remove_all(stage_, ignored);
}

std::string Staging::path(const std::string& name) {
    const fs::path at = fs::path(stage_) / name;
    std::error_code error;
    fs::create_directories(at.parent_path(), error);
    if (error) fail("cannot make the folder", at.parent_path(), error.message());
    names_.push_back(name);
    return at;
}

void Staging::write(const std::string& name, std::span<const unsigned char> bytes) { write_whole(path(name), bytes.data(), bytes.size()); }

void Staging::write(const std::string& name, const std::string& text) {
    write_whole(path(name), reinterpret_cast<const unsigned char*>(text.data()), text.size());
}

void Staging::commit() {
    std::error_code error;
    for (const std::string& name : names_) {  // all of what can be known beforehand, before the first one moves
        const fs::path to = fs::path(folder_) / name;
        fs::create_directories(to.parent_path(), error);
        if (!error && fs::is_directory(to)) error = std::make_error_code(std::errc::is_a_directory);
        if (!error && !fs::exists(fs::path(stage_) / name)) error = std::make_error_code(std::errc::no_such_file_or_directory);
        if (error) fail("cannot write", to, error.message());
    }
    for (const std::string& name : names_) {
        const fs::path to = fs::path(folder_) / name;
        fs::rename(fs::path(stage_) / name, to, error);
        if (error) fail("cannot write", to, error.message());
    }
    names_.clear();
}

}  // namespace crescent
