// openat() and its kin from the descriptor, O_NOFOLLOW at every step below it. New files are made with O_EXCL and
// synced; errno outlives the closing of what a failed call had open.
#include "base/folder.h"

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "base/errors.h"

namespace crescent::inline base {

void (*before_change)() = nullptr;

namespace {

void about_to_change() {
    if (before_change) before_change();
}

/// Some file systems cannot sync a folder and say EINVAL; there is nothing more to be done there.
bool synced(int file) { return fsync(file) == 0 || errno == EINVAL || errno == ENOTSUP; }

bool write_all(int file, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t n = ::write(file, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return false;
        bytes.remove_prefix(static_cast<std::size_t>(n));
    }
    return true;
}

/// Closes without losing the errno that is to be reported.
void close_quietly(int file) {
    const int why = errno;
    close(file);
    errno = why;
}

}  // namespace

Folder::Folder(const std::string& path) : file_(open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (file_ < 0) throw OutputError(fmt::format("cannot open the folder {}: {}", path, std::strerror(errno)));
}
Folder::~Folder() {
    if (file_ >= 0) close_quietly(file_);
}
Folder::Folder(Folder&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
Folder& Folder::operator=(Folder&& other) noexcept {
    std::swap(file_, other.file_);
    return *this;
}

Folder Folder::sub(const std::string& name, bool make) const {
    int at = fcntl(file_, F_DUPFD_CLOEXEC, 0);
    for (std::size_t begin = 0; begin < name.size() && at >= 0;) {
        const std::size_t end = std::min(name.find('/', begin), name.size());
        const std::string leaf = name.substr(begin, end - begin);
        begin = end + 1;
        if (leaf.empty()) continue;
        int next = openat(at, leaf.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
        if (next < 0 && errno == ENOENT && make) {
            about_to_change();
            if (mkdirat(at, leaf.c_str(), 0777) == 0 || errno == EEXIST)
                next = openat(at, leaf.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
        }
        close_quietly(at);
        at = next;
    }
    return Folder(at);
}

Folder Folder::parent_of(const std::string& name, bool make) const {
    const std::size_t slash = name.rfind('/');
    return sub(slash == std::string::npos ? "" : name.substr(0, slash), make);
}

Folder::Kind Folder::kind(const std::string& leaf) const {
    struct stat about{};
    if (fstatat(file_, leaf.c_str(), &about, AT_SYMLINK_NOFOLLOW) != 0) return Kind::none;
    if (S_ISREG(about.st_mode)) return Kind::file;
    if (S_ISLNK(about.st_mode)) return Kind::link;
    return S_ISDIR(about.st_mode) ? Kind::folder : Kind::other;
}

std::string Folder::link_text(const std::string& leaf) const {
    char text[4096];
    const ssize_t n = readlinkat(file_, leaf.c_str(), text, sizeof text);
    return n < 0 ? "" : std::string(text, static_cast<std::size_t>(n));
}

std::vector<std::string> Folder::leaves() const {
    std::vector<std::string> out;
    const int again = openat(file_, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);  // a position of its own
    DIR* list = again < 0 ? nullptr : fdopendir(again);
    if (!list && again >= 0) close(again);
    while (const dirent* entry = list ? readdir(list) : nullptr)
        if (const std::string_view name = entry->d_name; name != "." && name != "..") out.emplace_back(name);
    if (list) closedir(list);
    std::sort(out.begin(), out.end());
    return out;
}

std::string Folder::read(const std::string& leaf) const {
    std::string text;
    const int file = openat(file_, leaf.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (file < 0 || kind(leaf) != Kind::file) {
        if (file >= 0) close(file);
        return text;
    }
    char bytes[65536];
    for (ssize_t n; (n = ::read(file, bytes, sizeof bytes)) > 0;) text.append(bytes, static_cast<std::size_t>(n));
    close(file);
    return text;
}

bool Folder::make_folder(const std::string& leaf) const {
    about_to_change();
    return mkdirat(file_, leaf.c_str(), 0777) == 0;
}
bool Folder::make_link(const std::string& text, const std::string& leaf) const {
    about_to_change();
    return symlinkat(text.c_str(), file_, leaf.c_str()) == 0;
}
bool Folder::write(const std::string& leaf, std::string_view bytes) const {
    about_to_change();
    const int file = openat(file_, leaf.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file < 0) return false;
    const bool good = write_all(file, bytes) && synced(file);
    if (!good) return close_quietly(file), false;
    return close(file) == 0;
}
bool Folder::share(const std::string& leaf, const Folder& to, const std::string& as) const {
    about_to_change();
    return linkat(file_, leaf.c_str(), to.file_, as.c_str(), 0) == 0;
}
bool Folder::move(const std::string& leaf, const Folder& to, const std::string& as) const {
    about_to_change();
    return renameat(file_, leaf.c_str(), to.file_, as.c_str()) == 0;
}
bool Folder::remove(const std::string& leaf) const {
    about_to_change();
    return unlinkat(file_, leaf.c_str(), 0) == 0;
}
bool Folder::remove_folder(const std::string& leaf) const {
    about_to_change();
    return unlinkat(file_, leaf.c_str(), AT_REMOVEDIR) == 0;
}
bool Folder::sync() const { return synced(file_); }
bool Folder::sync(const std::string& leaf) const {
    const int file = openat(file_, leaf.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
    if (file < 0) return false;
    const bool good = synced(file);
    close_quietly(file);
    return good;
}

std::string leaf_of(const std::string& name) { return name.substr(name.rfind('/') + 1); }

}  // namespace crescent::inline base
