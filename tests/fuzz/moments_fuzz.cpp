// Any bytes as a file of moments: it is read, or rejected with an InputError that has a message. Variances that are
// read are finite numbers.
#include <cmath>
#include <cstdint>
#include <string>

#include "compare/moments_reading.h"
#include "compare/plan.h"
#include "compare/renders.h"
#include "memory_file.h"

namespace {

using namespace crescent;

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
    const MemoryFile file(text);
    read_or_refuse([&] { read_all_of(file.path()); });
    return 0;
}
