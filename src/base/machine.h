// The processors and memory that this process may use, within the limits it was started with.
#pragma once

#include <cstdint>
#include <string>

namespace crescent {

/// Returns the number of processors that this process may run on, limited by the quota of its control groups; at least
/// 1.
int usable_threads();

/// Returns the bytes that this process can still allocate: the machine's free memory, within its control groups (v1,
/// v2) and RLIMIT_AS.
std::uint64_t available_memory();

/// Of this process so far: its peak memory in bytes, and the CPU seconds of all its threads.
struct Usage {
    std::uint64_t peak_memory = 0;
    double cpu_seconds = 0;
};
/// Returns the use of this process so far; zeros if the system does not report it.
Usage usage();

/// Returns the processor's name on Linux; "" if unknown, and on other systems.
std::string host_cpu();

/// Returns the file of the running program, "" if unknown.
std::string program_file();

/// Returns the path of ../share/crescent/NAME, relative to the folder of the running program, the layout of `cmake
/// --install` and of the Python package; "" if it does not exist.
std::string shared_file(const std::string& name);

/// The limits in files below `root` (in use: ""), for tests. `own_group`: the contents of /proc/self/cgroup.
double granted_processors(const std::string& root, const std::string& own_group);     // 0: no limit
std::uint64_t granted_memory(const std::string& root, const std::string& own_group);  // ~0: no limit

}  // namespace crescent
