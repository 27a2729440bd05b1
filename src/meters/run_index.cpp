// A hash table from arm, n, s and seed to the run; 0 and -0 are one s.
#include "meters/run_index.h"

#include <functional>
#include <unordered_set>

namespace crescent::inline meters {

std::size_t RunIndex::Hash::operator()(const RunKey& key) const {
    std::size_t h = std::hash<std::string>()(key.arm);
    for (const std::size_t part :
        {std::hash<std::uint64_t>()(key.n), std::hash<double>()(key.s), std::hash<std::uint32_t>()(key.seed)})
        h = h * 1099511628211u + part;  // the prime of FNV-1a
    return h;
}

RunIndex::RunIndex(const std::vector<RunMeter>& runs) {
    runs_.reserve(runs.size());
    std::unordered_set<std::uint32_t> seen;
    for (const RunMeter& run : runs) {
        runs_.emplace(run.key, &run);
        if (seen.insert(run.key.seed).second) seeds_.push_back(run.key.seed);
    }
}

const RunMeter* RunIndex::find(const RunKey& key) const {
    const auto at = runs_.find(key);
    return at == runs_.end() ? nullptr : at->second;
}

}  // namespace crescent::inline meters
