// dladdr() finds the file that contains this function.
#include "base/host_program.h"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>
#include <system_error>

#ifdef __linux__
#include <sys/auxv.h>
#endif

namespace crescent {

std::string host_program() {
    if (const char* path = std::getenv("CRESCENT_PLUGIN_HOST")) return path;
    Dl_info ours{};
    if (dladdr(reinterpret_cast<const void*>(&host_program), &ours) == 0) return host_program_name;
#ifdef __linux__
    Dl_info program{};
    if (dladdr(reinterpret_cast<const void*>(getauxval(AT_PHDR)), &program) != 0 && ours.dli_fbase == program.dli_fbase)
        return "/proc/self/exe";
#endif
    const std::filesystem::path host = std::filesystem::path(ours.dli_fname).parent_path() / host_program_name;
    std::error_code unknown;
    return std::filesystem::exists(host, unknown) ? host.string() : host_program_name;
}

}  // namespace crescent
