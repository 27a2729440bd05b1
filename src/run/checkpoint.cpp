// The run's folder is named by the XXH3-64 of its key: version, commit, the files of program and library, the
// experiment's hash, the back end and the seeds. Metrics are CBOR records of a Journal, tiles a file for
// each pass.
#include "run/checkpoint.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
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

/// CBOR keeps every double exactly, including NaN and infinities. Returns none if the record is something else.
std::vector<RunMetrics> metrics_of(Journal::Bytes record) {
    const auto* from = reinterpret_cast<const std::uint8_t*>(record.data());
    try {
        return nlohmann::json::from_cbor(from, from + record.size()).get<std::vector<RunMetrics>>();
    } catch (const nlohmann::json::exception&) { return {}; }
}

bool are_of(const Experiment& experiment, const std::vector<RegionMetrics>& metrics) {
    return std::equal(metrics.begin(), metrics.end(), experiment.regions.begin(), experiment.regions.end(),
        [](const RegionMetrics& m, const Region& region) { return m.region == region.name; });
}

std::string key_of(const Experiment& experiment, const std::string& work) {
    return fmt::format("{} {} {} {:016x} {}", version(), commit(), build_mark(), hash(experiment), work);
}

/// The run's folder must be its own: if a link there leads elsewhere, nothing is kept.
bool leads_elsewhere(const std::string& folder) {
    std::error_code ignored;
    return fs::is_symlink(fs::symlink_status(folder, ignored));
}

bool holds_files(const std::string& folder) {
    std::error_code ignored;
    return fs::exists(folder, ignored) && !fs::is_empty(folder, ignored);
}

}  // namespace

Checkpoint::Checkpoint(const Experiment& experiment, const std::string& work, const std::string& out,
    double checkpoint_after_s, ProgressMonitor& monitor)
    : all_(out + "/.crescent-kept"),
      key_(key_of(experiment, work)),
      folder_(fmt::format("{}/{:016x}", all_, XXH3_64bits(key_.data(), key_.size()))),
      checkpoint_after_s_(checkpoint_after_s),
      monitor_(monitor),
      journal_(folder_ + "/meters", key_, monitor) {
    for (const std::string& folder : {all_, folder_})
        if (leads_elsewhere(folder))
            throw OutputError(
                fmt::format("cannot keep anything in {}: it is a link; expected a folder of crescent's own", folder));
    journal_.read([&](Journal::Bytes record) {
        for (RunMetrics& metric : metrics_of(record))
            if (are_of(experiment, metric.regions)) metrics_.push_back(std::move(metric));
    });
    written_ = metrics_.size();
    if (holds_files(folder_)) monitor_.log("resuming from the checkpoint in " + folder_);
}

Checkpoint::~Checkpoint() {
    if (holds_files(folder_))
        monitor_.log("partial results saved in " + folder_ + ": the same command resumes from them");
}

TileCheckpoint Checkpoint::tiles(const Job& job) {
    const std::string ladder = fmt::format("n{}", fmt::join(job.n, ","));
    const std::string name = fmt::format("{}-s{}-seed{}", job.arm, job.s, job.seed);
    const std::string file = fmt::format("{}-{:08x}", name, XXH3_64bits(ladder.data(), ladder.size()) & 0xffffffffu);
    return {folder_ + "/" + file, key_ + " " + name + " " + ladder, checkpoint_after_s_, monitor_};
}

TileCheckpoint Checkpoint::tiles(const std::string& name) {
    return {folder_ + "/" + name, key_ + " " + name, checkpoint_after_s_, monitor_};
}

std::vector<RunMetrics> Checkpoint::metrics(const Job& job) const {
    std::vector<RunMetrics> out;
    for (const std::uint64_t n : job.n) {
        const RunKey key{job.arm, n, job.s, job.seed};
        const auto metric =
            std::find_if(metrics_.begin(), metrics_.end(), [&](const RunMetrics& m) { return m.key == key; });
        if (metric == metrics_.end()) return {};
        out.push_back(*metric);
    }
    return out;
}

void Checkpoint::add(const std::vector<RunMetrics>& metrics) {
    metrics_.insert(metrics_.end(), metrics.begin(), metrics.end());
    if (start_.seconds() < checkpoint_after_s_) return;
    const std::vector<RunMetrics> fresh(metrics_.begin() + static_cast<std::ptrdiff_t>(written_), metrics_.end());
    const std::vector<std::uint8_t> record = nlohmann::json::to_cbor(fresh);
    journal_.append({std::as_bytes(std::span(record))});
    written_ = metrics_.size();
}

void Checkpoint::discard() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
    if (fs::remove(all_, ignored) || !fs::exists(all_, ignored)) return;
    monitor_.log(all_ + " still holds the checkpoint of another, unfinished run");
}

}  // namespace crescent::inline runs
