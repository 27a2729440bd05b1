// The file without a name is one of O_TMPFILE, which linkat() gives a name.
#include "base/whole_file.h"

#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <functional>
#include <sys/stat.h>
#include <unistd.h>

#include "base/errors.h"
#include "base/text.h"

namespace crescent {

namespace {

[[noreturn]] void fail(const std::string& path, const std::string& why) {
    throw OutputError("cannot write " + printable(path) + ": " + why);
}

/// Returns whether the path is a stream, such as /dev/stdout, a FIFO or /dev/null. Folders below /dev, such as
/// /dev/shm, have files; /dev/stdout and /dev/fd/1 are streams even if a file is behind them.
bool is_stream(const std::string& path) {
    struct stat s{};
    const bool in_dev = path.starts_with("/dev/") && (path.rfind('/') == 4 || path.starts_with("/dev/fd/"));
    return in_dev || path.starts_with("/proc/") ||
        (stat(path.c_str(), &s) == 0 && !S_ISREG(s.st_mode) && !S_ISDIR(s.st_mode));
}

class UnnamedFile {
public:
    explicit UnnamedFile(const std::string& path) : path_(path) {
        struct stat s{};
        if (stat(path.c_str(), &s) == 0 && S_ISDIR(s.st_mode)) fail(path, "it is a folder");
        const std::size_t slash = path.rfind('/');
        folder_ = slash == std::string::npos ? "./" : path.substr(0, slash + 1);
#ifdef O_TMPFILE
        file_ = access("/proc/self/fd", X_OK) == 0 ? open(folder_.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600) : -1;
#endif
        if (file_ >= 0) return;
        name_ = folder_ + ".crescent-XXXXXX";
        file_ = mkostemp(name_.data(), O_CLOEXEC);
        if (file_ < 0) fail(path, std::strerror(errno));
    }
    ~UnnamedFile() {
        if (file_ >= 0) close(file_);
        if (!name_.empty()) unlink(name_.c_str());
    }
    UnnamedFile(const UnnamedFile&) = delete;
    UnnamedFile& operator=(const UnnamedFile&) = delete;

    int file() const { return file_; }
    void publish() {
        struct stat s{};
        const mode_t mask = umask(0);
        umask(mask);
        const mode_t mode = stat(path_.c_str(), &s) == 0 ? s.st_mode & 07777 : 0666 & ~mask;
        const bool is_complete = fchmod(file_, mode) == 0 && fsync(file_) == 0 &&
            (name_.empty() ? name_and_rename() : rename(name_.c_str(), path_.c_str()) == 0);
        if (!is_complete) fail(path_, std::strerror(errno));
        name_.clear();
    }

private:
    /// Uses the same name for each call with that path, so that the leftover of a killed call is replaced.
    bool name_and_rename() const {
        const std::string descriptor_path = fmt::format("/proc/self/fd/{}", file_);
        const std::string name = fmt::format("{}.crescent-{:016x}", folder_, std::hash<std::string>{}(path_));
        for (int tries = 0; tries < 100; ++tries) {
            if (linkat(AT_FDCWD, descriptor_path.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0) {
                if (rename(name.c_str(), path_.c_str()) == 0) return true;
                if (errno == ENOENT) continue;  // another process writes the same file
                const int why = errno;
                unlink(name.c_str());
                errno = why;
                return false;
            }
            if (errno != EEXIST) return false;
            unlink(name.c_str());
        }
        return false;
    }

    std::string path_, folder_, name_;  // name_: empty for a file without a name
    int file_ = -1;
};

void write_all(int file, const std::string& path, std::string_view text) {
    while (!text.empty()) {
        const ssize_t n = ::write(file, text.data(), text.size());
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) fail(path, std::strerror(errno));
        text.remove_prefix(static_cast<std::size_t>(n));
    }
}

}  // namespace

void can_write(const std::string& path) {
    if (!is_stream(path)) UnnamedFile{path};
}

void claim_outputs(const std::vector<OutputFile>& outputs, const std::vector<std::string>& inputs) {
    std::error_code unknown;
    const auto is_same = [&](const std::string& a, const std::string& b) {
        return std::filesystem::equivalent(a, b, unknown) ||
            std::filesystem::weakly_canonical(a, unknown) == std::filesystem::weakly_canonical(b, unknown);
    };
    for (const OutputFile& output : outputs) {
        if (output.path.empty() || is_stream(output.path)) continue;
        const std::string name = fmt::format("{} {}", output.flag, printable(output.path));
        for (const std::string& input : inputs)
            if (std::filesystem::equivalent(output.path, input, unknown))
                throw InputError({name, 0, 0}, "expected another file than one that is read");
        for (const OutputFile& other : outputs)
            if (&other < &output && !other.path.empty() && is_same(output.path, other.path))
                throw InputError({name, 0, 0}, fmt::format("expected another file than that of {}", other.flag));
        can_write(output.path);
    }
}

void write_whole(const std::string& path, const std::string& text) {
    if (!is_stream(path)) {
        UnnamedFile unnamed(path);
        write_all(unnamed.file(), path, text);
        return unnamed.publish();
    }
    const int file = open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
    if (file < 0) fail(path, std::strerror(errno));
    write_all(file, path, text);
    close(file);
}

}  // namespace crescent
