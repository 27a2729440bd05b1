// Runs are found one by one; run_index.h finds them by a table where there are many.
#include "meters/metrics.h"

#include <algorithm>

namespace crescent::inline meters {

const RegionMeter* RunMeter::region(const std::string& name) const {
    const auto at =
        std::find_if(regions.begin(), regions.end(), [&](const RegionMeter& r) { return r.region == name; });
    return at == regions.end() ? nullptr : &*at;
}

const RunMeter* Metrics::find(const std::string& arm, std::uint64_t n, double s, std::uint32_t seed) const {
    const RunKey key{arm, n, s, seed};
    const auto at = std::find_if(runs.begin(), runs.end(), [&](const RunMeter& r) { return r.key == key; });
    return at == runs.end() ? nullptr : &*at;
}

bool Metrics::all_hold() const { return std::ranges::none_of(assertions, &AssertionResult::failed); }

}  // namespace crescent::inline meters
