// Version, commit and compiler; cmake/provenance.cmake passes them in, commit.h is made anew at every build.
#include "run/version.h"

#include <commit.h>

#include <fstream>

namespace crescent::inline runs {

std::string version() { return CRESCENT_VERSION; }
std::string commit() { return CRESCENT_COMMIT; }
std::string compiler() { return CRESCENT_COMPILER; }

std::string host_cpu() {
    std::ifstream cpuinfo("/proc/cpuinfo");
    for (std::string line; std::getline(cpuinfo, line);)
        if (line.starts_with("model name") && line.find(": ") != std::string::npos)
            return line.substr(line.find(": ") + 2);
    return "";
}

}  // namespace crescent::inline runs
