// Processors: sched_getaffinity(), cpu.max or cpu.cfs_quota_us. Memory in bytes: MemAvailable; memory.max or
// memory.limit_in_bytes minus the memory used except caches; RLIMIT_AS minus VmSize. The smallest value of the
// process's group, its parent groups and the machine counts.
#include "base/machine.h"

#include <fmt/format.h>
#include <sched.h>
#include <sys/resource.h>
#ifdef __APPLE__
#include <mach-o/dyld.h>
#endif

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <sstream>
#include <thread>
#include <vector>

#include "base/files.h"

namespace crescent {

namespace {

constexpr std::uint64_t no_limit = std::numeric_limits<std::uint64_t>::max();

/// Returns the folders of the process's group in one hierarchy and of its parent groups, the innermost first.
std::vector<std::string> groups(const std::string& root, const std::string& own_group, const std::string& controller) {
    std::istringstream lines(contents_of(own_group));
    std::vector<std::string> out;
    for (std::string line; std::getline(lines, line);) {
        const std::size_t first = line.find(':'), second = line.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos) continue;
        const std::string names = "," + line.substr(first + 1, second - first - 1) + ",";
        const bool unified = names == ",,";
        if (!unified && names.find("," + controller + ",") == std::string::npos) continue;
        const std::string top = root + "/sys/fs/cgroup" + (unified ? "" : "/" + controller);
        for (std::string path = line.substr(second + 1);; path.resize(path.rfind('/'))) {
            out.push_back(top + (path == "/" ? "" : path));
            if (path.empty() || path.rfind('/') == std::string::npos || path == "/") break;
        }
        out.push_back(top);
    }
    return out;
}

/// Reads the first number of a file; returns false if there is none ("max", or no such file).
bool number_in(const std::string& path, double& value) {
    const std::string text = contents_of(path);
    char* end = nullptr;
    value = std::strtod(text.c_str(), &end);
    return end != text.c_str();
}

double field(const std::string& text, const std::string& name) {
    std::istringstream words(text);
    for (std::string word; words >> word;)
        if (word == name) {
            double value = 0;
            words >> value;
            return value;
        }
    return 0;
}

/// Returns what a group may still allocate: its limit minus its use; cached files are freed when needed.
std::uint64_t left_in(const std::string& group, const char* limit_file, const char* used_file, const char* cached) {
    double limit = 0, use = 0;
    if (!number_in(group + limit_file, limit) || limit >= 9e18) return no_limit;
    number_in(group + used_file, use);
    const double busy = std::max(0.0, use - field(contents_of(group + "/memory.stat"), cached));
    return static_cast<std::uint64_t>(std::max(0.0, limit - busy));
}

std::uint64_t left_in_address_space() {
    rlimit limit{};
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return no_limit;
    const auto size = static_cast<std::uint64_t>(1024 * field(contents_of("/proc/self/status"), "VmSize:"));
    return limit.rlim_cur > size ? limit.rlim_cur - size : 0;
}

}  // namespace

double granted_processors(const std::string& root, const std::string& own_group) {
    double processors = 0;
    const auto grant = [&](double quota, double period) {
        if (quota > 0 && period > 0 && (processors == 0 || quota / period < processors)) processors = quota / period;
    };
    for (const std::string& group : groups(root, own_group, "cpu")) {
        std::istringstream quota_file(contents_of(group + "/cpu.max"));  // "200000 100000" or "max 100000"
        double quota = 0, period = 0;
        if (quota_file >> quota >> period) grant(quota, period);
        if (number_in(group + "/cpu.cfs_quota_us", quota) && number_in(group + "/cpu.cfs_period_us", period))
            grant(quota, period);
    }
    return processors;
}

std::uint64_t granted_memory(const std::string& root, const std::string& own_group) {
    std::uint64_t memory = no_limit;
    for (const std::string& group : groups(root, own_group, "memory")) {
        memory = std::min(memory, left_in(group, "/memory.max", "/memory.current", "inactive_file"));
        memory =
            std::min(memory, left_in(group, "/memory.limit_in_bytes", "/memory.usage_in_bytes", "total_inactive_file"));
    }
    return memory;
}

int usable_threads() {
    int count = static_cast<int>(std::thread::hardware_concurrency());  // 0 if unknown
#ifdef __linux__
    cpu_set_t cpus;
    if (sched_getaffinity(0, sizeof cpus, &cpus) == 0) count = CPU_COUNT(&cpus);
#endif
    if (const double processors = granted_processors("", "/proc/self/cgroup"); processors > 0)
        count = std::min(count, static_cast<int>(std::min(4096.0, std::ceil(processors))));
    return std::max(count, 1);
}

std::uint64_t available_memory() {
    const double free = 1024 * field(contents_of("/proc/meminfo"), "MemAvailable:");
    const std::uint64_t machine = free > 0 ? static_cast<std::uint64_t>(free) : no_limit;
    return std::min({machine, granted_memory("", "/proc/self/cgroup"), left_in_address_space()});
}

std::string host_cpu() {
    std::istringstream lines(contents_of("/proc/cpuinfo"));
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with("model name") && line.find(": ") != std::string::npos)
            return line.substr(line.find(": ") + 2);
    return "";
}

std::string program_file() {
#ifdef __linux__
    return "/proc/self/exe";
#elif defined(__APPLE__)
    char path[4096];
    std::uint32_t room = sizeof path;
    return _NSGetExecutablePath(path, &room) == 0 ? path : "";
#else
    return "";
#endif
}

std::string shared_file(const std::string& name) {
    std::error_code none;
    const std::filesystem::path program = std::filesystem::canonical(program_file(), none),
                                file = program.parent_path().parent_path() / "share" / "crescent" / name;
    return !program.empty() && std::filesystem::exists(file, none) ? file.string() : "";
}

Usage usage() {
    rusage resources{};
    getrusage(RUSAGE_SELF, &resources);
    Usage out;
#ifdef __APPLE__
    out.peak_memory = static_cast<std::uint64_t>(resources.ru_maxrss);
#else
    out.peak_memory = static_cast<std::uint64_t>(resources.ru_maxrss) * 1024;
#endif
    for (const timeval& t : {resources.ru_utime, resources.ru_stime})
        out.cpu_seconds += static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    return out;
}

}  // namespace crescent
