// A file named by the XXH3-64 of the run's key (version, commit, the files of program and library, the experiment's
// hash, the back end and the seeds) with a sequence of CBOR items (RFC 8742): the key, then the metrics of finished
// passes. CBOR keeps every double exactly, including NaN and infinities. Each write appends whole items; an item that a
// kill cut off is removed before more are appended.
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
#include <nlohmann/json.hpp>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/machine.h"
#include "run/version.h"

namespace crescent::inline runs {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RunKey, arm, n, s, seed)
#define CRESCENT_FIELD(name, Type) , name
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(
    RegionMetrics, region, pixels, flip, mse, mse_error, reference_error CRESCENT_REGION_METRICS(CRESCENT_FIELD))
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RunMetrics, key, regions CRESCENT_FRAME_METRICS(CRESCENT_FIELD))
#undef CRESCENT_FIELD

namespace {

namespace fs = std::filesystem;

std::string mark_of(const std::string& path) {
    struct stat about{};
    std::error_code unknown;
    const auto written = fs::last_write_time(path, unknown);
    if (unknown || stat(path.c_str(), &about) != 0) return "";
    return fmt::format("{:x}-{:x}-{:x}-{:x}", about.st_dev, about.st_ino, about.st_size,
        static_cast<std::int64_t>(written.time_since_epoch().count()));
}

/// Identifies the files of the program and of the library with this code, with their times: what another build kept is
/// not used.
std::string build_mark() {
    Dl_info about{};
    const bool known = dladdr(reinterpret_cast<const void*>(&mark_of), &about) != 0;
    return mark_of(program_file()) + " " + mark_of(known ? about.dli_fname : "");
}

bool are_of(const Experiment& experiment, const std::vector<RegionMetrics>& metrics) {
    return std::equal(metrics.begin(), metrics.end(), experiment.regions.begin(), experiment.regions.end(),
        [](const RegionMetrics& m, const Region& region) { return m.region == region.name; });
}

std::string key_of(const Experiment& experiment, const std::string& work) {
    return fmt::format("{} {} {} {:016x} {}", version(), commit(), build_mark(), hash(experiment), work);
}

using Item = std::vector<std::uint8_t>;

/// Appends with one call, so that items of two processes do not mix.
bool append(const std::string& path, const Item& items) {
    const int file = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (file < 0) return false;
    const ssize_t n = ::write(file, items.data(), items.size());
    const int error = n < 0 ? errno : n == static_cast<ssize_t>(items.size()) ? 0 : ENOSPC;
    ::close(file);
    errno = error;
    return error == 0;
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
    written_ = metrics_.size();
    if (written_ > 0) monitor_.log("resuming from the checkpoint " + file_);
}

void Checkpoint::read(const Experiment& experiment) {
    std::error_code ignored;
    if (!fs::is_regular_file(fs::symlink_status(file_, ignored))) return;
    std::ifstream in(file_, std::ios::binary);
    const auto next = [&] { return nlohmann::json::from_cbor(in, false, false); };  // discarded at an incomplete item
    if (!(next() == key_)) {  // != is false for an incomplete item
        fs::remove(file_, ignored);
        return;
    }
    begun_ = true;
    std::streamoff whole = in.tellg();
    try {
        for (nlohmann::json item = next(); !item.is_discarded(); item = next()) {
            for (RunMetrics& metric : item.get<std::vector<RunMetrics>>())
                if (are_of(experiment, metric.regions)) metrics_.push_back(std::move(metric));
            whole = in.tellg();
        }
    } catch (const nlohmann::json::exception&) {}  // not metrics: what follows is not used
    fs::resize_file(file_, static_cast<std::uintmax_t>(whole), ignored);
    if (ignored) disabled_ = true;
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
    if (disabled_ || start_.seconds() < checkpoint_after_s_) return;
    const std::vector<RunMetrics> fresh(metrics_.begin() + static_cast<std::ptrdiff_t>(written_), metrics_.end());
    Item items;
    if (!begun_) nlohmann::json::to_cbor(key_, items);
    nlohmann::json::to_cbor(fresh, items);
    std::error_code ignored;  // append() reports the error
    fs::create_directories(folder_, ignored);
    if (append(file_, items)) {
        begun_ = true, written_ = metrics_.size();
        return;
    }
    monitor_.log(fmt::format("cannot write the checkpoint {}: {}; if this run is stopped, it cannot be resumed", file_,
        std::strerror(errno)));
    fs::remove(file_, ignored);
    disabled_ = true;
}

void Checkpoint::discard() {
    std::error_code ignored;
    fs::remove(file_, ignored);
    if (fs::remove(folder_, ignored) || !fs::exists(folder_, ignored)) return;
    monitor_.log(folder_ + " still holds the checkpoint of another, unfinished run");
}

}  // namespace crescent::inline runs
