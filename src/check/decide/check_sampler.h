// A sampler over all its w_o: each w_o by itself on any thread, and the tests that need none or several.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/progress_monitor.h"
#include "check/decide/check_at.h"

namespace crescent::check {

/// What a call asks for.
struct CheckSettings {
    CheckBudget budget = CheckBudget::quick();
    std::uint32_t seed = 1;
    /// Samplers and w_o in the whole call; beyond `questions_covered` families alpha2 is divided.
    double cases = 1;
};

/// Of one sampler.
struct CheckOutcome {
    std::string arm;
    std::vector<std::size_t> trials;       // indices into the call's trials
    std::vector<std::vector<CheckAt>> at;  // by trial and technique
    std::vector<SmallFault> small;         // of the sampler as a whole
    std::uint64_t evaluations = 0;
    bool wrong() const;
};

/// Trials of one or of several samplers; those of one name and subject belong together. Baselines are left out.
std::vector<CheckOutcome> check_samplers(
    std::span<const Trial> trials, const CheckSettings& settings, ProgressMonitor& monitor);

}  // namespace crescent::check
