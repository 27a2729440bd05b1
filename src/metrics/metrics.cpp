// Runs are found one by one; RunIndex finds them by a table if there are many.
#include "metrics/metrics.h"

#include <algorithm>
#include <functional>
#include <unordered_set>

namespace crescent::inline metrics {

const RegionMetrics* RunMetrics::region(const std::string& name) const {
    const auto at =
        std::find_if(regions.begin(), regions.end(), [&](const RegionMetrics& r) { return r.region == name; });
    return at == regions.end() ? nullptr : &*at;
}

const RunMetrics* Metrics::find(const std::string& arm, std::uint64_t n, double s, std::uint32_t seed) const {
    const RunKey key{arm, n, s, seed};
    const auto at = std::find_if(runs.begin(), runs.end(), [&](const RunMetrics& r) { return r.key == key; });
    return at == runs.end() ? nullptr : &*at;
}

bool Metrics::all_hold() const { return std::ranges::none_of(assertions, &AssertionResult::failed); }

// ---- A hash table from arm, n, s and seed to the run; 0 and -0 are the same s.

std::size_t RunIndex::Hash::operator()(const RunKey& key) const {
    std::size_t h = std::hash<std::string>()(key.arm);
    for (const std::size_t part :
        {std::hash<std::uint64_t>()(key.n), std::hash<double>()(key.s), std::hash<std::uint32_t>()(key.seed)})
        h = h * 1099511628211u + part;  // the prime of FNV-1a
    return h;
}

RunIndex::RunIndex(const std::vector<RunMetrics>& runs) {
    runs_.reserve(runs.size());
    std::unordered_set<std::uint32_t> seen;
    for (const RunMetrics& run : runs) {
        runs_.emplace(run.key, &run);
        if (seen.insert(run.key.seed).second) seeds_.push_back(run.key.seed);
    }
}

const RunMetrics* RunIndex::find(const RunKey& key) const {
    const auto at = runs_.find(key);
    return at == runs_.end() ? nullptr : at->second;
}

}  // namespace crescent::inline metrics
