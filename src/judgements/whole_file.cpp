// One file that is seen whole or not at all. It is written under a name of its own beside the place (mkstemp: nothing
// of anybody else's is opened, followed or removed), brought to the disk and renamed. Pipes and devices are written to
// as they are.
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/errors.h"
#include "base/text.h"
#include "judgements/print.h"

namespace crescent::inline judgements {

namespace {

[[noreturn]] void fail(const std::string& path, const std::string& why) {
    throw OutputError("cannot write " + printable(path) + ": " + why);
}

/// /dev/stdout, a FIFO, /dev/null.
bool takes_a_stream(const std::string& path) {
    struct stat s{};
    return path.starts_with("/dev/") || path.starts_with("/proc/") ||
        (stat(path.c_str(), &s) == 0 && !S_ISREG(s.st_mode) && !S_ISDIR(s.st_mode));
}

class Beside {
public:
    explicit Beside(const std::string& path) : path_(path) {
        struct stat s{};
        if (stat(path.c_str(), &s) == 0 && S_ISDIR(s.st_mode)) fail(path, "it is a folder");
        const std::size_t slash = path.rfind('/');
        name_ = (slash == std::string::npos ? "" : path.substr(0, slash + 1)) + ".crescent-XXXXXX";
        file_ = mkostemp(name_.data(), O_CLOEXEC);
        if (file_ < 0) fail(path, std::strerror(errno));
    }
    ~Beside() {
        if (file_ >= 0) close(file_);
        if (!name_.empty()) unlink(name_.c_str());
    }
    Beside(const Beside&) = delete;
    Beside& operator=(const Beside&) = delete;

    int file() const { return file_; }
    void bring() {
        struct stat s{};
        const mode_t mask = umask(0);
        umask(mask);
        const mode_t mode = stat(path_.c_str(), &s) == 0 ? s.st_mode & 07777 : 0666 & ~mask;
        const bool done = fchmod(file_, mode) == 0 && fsync(file_) == 0 && rename(name_.c_str(), path_.c_str()) == 0;
        if (!done) fail(path_, std::strerror(errno));
        name_.clear();
    }

private:
    std::string path_, name_;
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
    if (!takes_a_stream(path)) Beside{path};
}

void write_whole(const std::string& path, const std::string& text) {
    if (!takes_a_stream(path)) {
        Beside beside(path);
        write_all(beside.file(), path, text);
        return beside.bring();
    }
    const int file = open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
    if (file < 0) fail(path, std::strerror(errno));
    write_all(file, path, text);
    close(file);
}

}  // namespace crescent::inline judgements
