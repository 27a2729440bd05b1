// A file named by the XXH3-64 of the run's key: version, commit, the files of program and library, the experiment's
// hash, the back end and the seeds. Each write appends whole items (run/checkpoint_items.h); what a kill cut off, or
// what changed since, is removed before more are appended.
#include "run/checkpoint.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/machine.h"
#include "experiment/identity.h"
#include "run/checkpoint_items.h"
#include "run/version.h"

namespace crescent {

namespace {

namespace fs = std::filesystem;

std::string mark_of(const std::string& path) {
    struct stat status{};
    if (stat(path.c_str(), &status) != 0) return "";
#ifdef __APPLE__
    const timespec& write_time = status.st_mtimespec;
#else
    const timespec& write_time = status.st_mtim;
#endif
    return fmt::format("{:x}-{:x}-{:x}-{:x}-{:x}", status.st_dev, status.st_ino, status.st_size, write_time.tv_sec,
        write_time.tv_nsec);
}

/// Identifies the files of the program and of the library with this code, with their times: what another build kept is
/// not used.
std::string build_mark() {
    Dl_info library{};
    const bool is_found = dladdr(reinterpret_cast<const void*>(&mark_of), &library) != 0;
    return mark_of(program_file()) + " " + mark_of(is_found ? library.dli_fname : "");
}

std::string key_of(const Experiment& experiment, const std::string& work) {
    return fmt::format("{} {} {} {:016x} {}", version(), commit(), build_mark(), hash(experiment), work);
}

constexpr std::uintmax_t most_bytes = std::uintmax_t{1} << 30;  // 4,096 seeds of a hundred passes fit

/// Appends with one call, so that items of two processes do not mix.
bool append(const std::string& path, const std::string& items) {
    // A pipe in its place, which no one reads, does not stop the run.
    constexpr int flags = O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;
    const int file = ::open(path.c_str(), flags, 0666);
    if (file < 0) return false;
    struct stat status{};
    const bool is_regular = ::fstat(file, &status) == 0 && S_ISREG(status.st_mode);
    const ssize_t n = is_regular ? ::write(file, items.data(), items.size()) : 0;
    const int error = !is_regular ? EINVAL : n < 0 ? errno : n == static_cast<ssize_t>(items.size()) ? 0 : ENOSPC;
    ::close(file);
    errno = error;
    return error == 0;
}

/// Returns the bytes of a regular file; empty if there is none, or if it is larger than a checkpoint.
std::optional<std::string> bytes_of(const std::string& path) {
    std::error_code error;
    if (!fs::is_regular_file(fs::symlink_status(path, error))) return {};
    const std::uintmax_t size = fs::file_size(path, error);
    if (error || size > most_bytes) return {};
    std::string bytes(size, '\0');
    std::ifstream in(path, std::ios::binary);
    in.read(bytes.data(), static_cast<std::streamsize>(size));
    bytes.resize(static_cast<std::size_t>(in.gcount()));
    return bytes;
}

}  // namespace

Checkpoint::Checkpoint(const Experiment& experiment, const std::string& work, const std::string& out,
    double checkpoint_after_s, ProgressMonitor& monitor)
    : folder_(out + "/.crescent-kept"),
      key_(key_of(experiment, work)),
      file_(fmt::format("{}/{:016x}", folder_, XXH3_64bits(key_.data(), key_.size()))),
      checkpoint_after_s_(checkpoint_after_s),
      monitor_(monitor) {
    std::error_code ignored;
    if (fs::is_symlink(fs::symlink_status(folder_, ignored)))
        throw OutputError(
            fmt::format("cannot keep anything in {}: it is a link; expected a folder of crescent's own", folder_));
    read(experiment);
    stored_count_ = metrics_.size();
    if (stored_count_ > 0) monitor_.log("resuming from the checkpoint " + file_);
}

void Checkpoint::read(const Experiment& experiment) {
    std::error_code ignored;
    const std::optional<std::string> bytes = bytes_of(file_);
    if (!bytes) return;
    CheckpointContent content = read_items(*bytes, key_, experiment);
    if (content.bytes < bytes->size())
        monitor_.warn(fmt::format(
            "the checkpoint {} is incomplete or damaged from byte {} on: what it held there is computed again", file_,
            content.bytes));
    if (!content.has_key) {
        fs::remove(file_, ignored);
        return;
    }
    has_key_ = true;
    metrics_ = std::move(content.metrics);
    fs::resize_file(file_, content.bytes, ignored);
    if (ignored) is_disabled_ = true;
}

Checkpoint::~Checkpoint() {
    std::error_code ignored;
    if (fs::exists(file_, ignored))
        monitor_.log("finished passes saved in " + file_ + ": the same command resumes from them");
}

std::vector<RunMetrics> Checkpoint::metrics(const Job& job) const {
    std::vector<RunMetrics> out;
    for (const std::uint64_t n : job.n) {
        const auto metric = std::ranges::find(metrics_, RunKey{job.arm, n, job.s, job.seed}, &RunMetrics::key);
        if (metric == metrics_.end()) return {};
        out.push_back(*metric);
    }
    return out;
}

void Checkpoint::add(const std::vector<RunMetrics>& metrics) {
    metrics_.insert(metrics_.end(), metrics.begin(), metrics.end());
    if (is_disabled_ || start_.seconds() < checkpoint_after_s_) return;
    const std::vector<RunMetrics> fresh(metrics_.begin() + static_cast<std::ptrdiff_t>(stored_count_), metrics_.end());
    const std::string items = (has_key_ ? "" : key_item(key_)) + metrics_item(fresh);
    std::error_code ignored;  // append() reports the error
    fs::create_directories(folder_, ignored);
    if (append(file_, items)) {
        has_key_ = true;
        stored_count_ = metrics_.size();
        return;
    }
    monitor_.warn(fmt::format("cannot write the checkpoint {}: {}; if this run is stopped, it cannot be resumed", file_,
        std::strerror(errno)));
    fs::remove(file_, ignored);
    is_disabled_ = true;
}

void Checkpoint::discard() {
    std::error_code ignored;
    fs::remove(file_, ignored);
    if (fs::remove(folder_, ignored) || !fs::exists(folder_, ignored)) return;
    monitor_.log(folder_ + " still holds the checkpoint of another, unfinished run");
}

}  // namespace crescent
