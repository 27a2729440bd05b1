// Runs by key, for who looks up many of them.
#pragma once

#include <unordered_map>
#include <vector>

#include "meters/metrics.h"

namespace crescent::inline meters {

/// Made once of runs that stay where they are.
class RunIndex {
public:
    explicit RunIndex(const std::vector<RunMeter>& runs);
    /// Null where there is no such run.
    const RunMeter* find(const RunKey& key) const;
    /// The seeds that were run, in the order of the runs.
    const std::vector<std::uint32_t>& seeds() const { return seeds_; }

private:
    struct Hash {
        std::size_t operator()(const RunKey& key) const;
    };
    std::unordered_map<RunKey, const RunMeter*, Hash> runs_;
    std::vector<std::uint32_t> seeds_;
};

}  // namespace crescent::inline meters
