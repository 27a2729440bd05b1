// What this process may use of the machine: processors and memory, within the limits it was started with.
#pragma once

#include <cstdint>
#include <string>

namespace crescent::inline base {

/// Processors that this process may run on, and no more than its control groups grant it time for; 1 at least.
int usable_threads();

/// Bytes that this process can still allocate: what the machine has free, within its control groups (v1, v2) and
/// RLIMIT_AS.
std::uint64_t available_memory();

/// Of this process so far: the most memory that it had, in bytes, and the seconds of all its threads.
struct Usage {
    std::uint64_t peak_memory = 0;
    double cpu_seconds = 0;
};
/// What this process has used so far; zeros where the system does not say.
Usage usage();

/// The processor's name as Linux has it; "" where it does not, and elsewhere.
std::string host_cpu();

/// The file of the running program, "" where the system does not tell.
std::string program_file();

/// ../share/crescent/NAME, seen from the folder of the running program, as `cmake --install` and the Python package lay
/// it out; "" where there is none.
std::string shared_file(const std::string& name);

/// The same read from files below `root` ("" in use), for tests. `own` is the process's /proc/self/cgroup.
double granted_processors(const std::string& root, const std::string& own);     // 0: no limit
std::uint64_t granted_memory(const std::string& root, const std::string& own);  // ~0: no limit

}  // namespace crescent::inline base
