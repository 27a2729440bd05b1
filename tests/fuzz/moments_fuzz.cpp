// Any bytes as a file of moments: it is read, or rejected with an InputError that has a message. Variances that are
// read are finite numbers.
#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "base/errors.h"
#include "compare/compare.h"
#include "compare/moments.h"
#include "compare/plan.h"
#include "compare/renders.h"

namespace {

using namespace crescent;

/// A file in memory, which is opened by its path.
class MemoryFile {
public:
    MemoryFile(const std::uint8_t* data, std::size_t size) : file_(::memfd_create("moments", 0)) {
        ensure(file_ >= 0, "a file in memory is made");
        while (size > 0) {
            const ssize_t n = ::write(file_, data, size);
            ensure(n > 0, "a file in memory is written");
            data += n;
            size -= static_cast<std::size_t>(n);
        }
    }
    ~MemoryFile() { ::close(file_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }

private:
    int file_;
};

void read_all_of(const std::string& path) {
    static_cast<void>(read_moments_header(path));
    ComparePlan plan;
    plan.file = "fuzz";
    RenderArm& arm = plan.arms.emplace_back();
    arm.name = "baseline";
    arm.files = {path};
    arm.moments = true;
    plan.flip = false;
    ProgressMonitor monitor;
    const RenderStats all = read_all(plan, monitor);
    for (const MeanPlane& plane : all.arms[0].film.planes)
        for (const double x : plane.m2) ensure(std::isfinite(x) && x >= 0, "a variance is a finite number");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    try {
        static_cast<void>(parse_moments_text(text, "fuzz", 8, 8));
    } catch (const InputError&) {  // most bytes are no text of a header
    }
    const MemoryFile file(data, size);
    try {
        read_all_of(file.path());
    } catch (const InputError& error) {
        ensure(!error.diagnostics().empty() && !error.diagnostics().front().message.empty(), "a refusal says why");
    }
    return 0;
}
