#include "studies/region_tail.h"

#include <algorithm>

#include "estimator/estimator.h"

namespace crescent::inline studies {

std::optional<Tail> region_tail(const Scene& scene, const ArmInUse& arm, std::uint32_t seed, const Box& box,
    const std::string& isa, ProgressMonitor& watch) {
    constexpr std::uint64_t most = 4'000'000, most_a_pixel = 256;
    const std::uint64_t pixels = static_cast<std::uint64_t>(box.width()) * static_cast<std::uint64_t>(box.height());
    const std::uint64_t n = std::min(std::max<std::uint64_t>(most / pixels, 1), most_a_pixel);
    const std::size_t length = tail_length(pixels * n);
    std::uint64_t drawn = 0;
    if (length == 0) return std::nullopt;
    return fit_pooled_tail(largest_samples(scene, arm, n, seed, box, length + 1, isa, watch, drawn));
}

}  // namespace crescent::inline studies
