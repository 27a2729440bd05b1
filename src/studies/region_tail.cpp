// Four million samples over the region's pixels, 256 a pixel at most; of them all the largest.
#include "studies/region_tail.h"

#include <algorithm>

#include "estimator/estimator.h"

namespace crescent::inline studies {

TailPlan tail_plan(const Box& box) {
    constexpr std::uint64_t most = 4'000'000, most_a_pixel = 256;
    const std::uint64_t pixels = static_cast<std::uint64_t>(box.width()) * static_cast<std::uint64_t>(box.height());
    const std::uint64_t n = std::min(std::max<std::uint64_t>(most / pixels, 1), most_a_pixel);
    const std::size_t length = tail_length(pixels * n);
    return {n, length == 0 ? 0 : length + 1};
}

std::optional<Tail> region_tail(const Scene& scene, const ArmInUse& arm, std::uint32_t seed, const Box& box,
    const std::string& isa, ProgressMonitor& monitor) {
    const TailPlan plan = tail_plan(box);
    if (plan.kept == 0) return std::nullopt;
    std::uint64_t drawn = 0;
    return fit_pooled_tail(largest_samples(scene, arm, plan.n, seed, box, plan.kept, isa, monitor, drawn));
}

}  // namespace crescent::inline studies
