// A check of a sampler at all its w_o, and the tests of the whole sampler. The w_o run on any thread; a program is
// called by one thread, in an order of its own.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/progress.h"
#include "check/decide/check_at.h"
#include "check/decide/small_tests.h"
#include "check/decide/tail.h"
#include "check/verdict.h"

namespace crescent::check {

/// The settings of a call.
struct CheckSettings {
    CheckBudget budget = CheckBudget::quick();
    /// For samplers whose answers are expensive; empty: `budget`.
    std::optional<CheckBudget> limited{};
    const CheckBudget& budget_of_limited() const { return limited ? *limited : budget; }
    std::uint32_t seed = 1;
    double alpha = 1e-3;
    /// Samplers times w_o in the whole call; beyond `questions_covered` families the second level is divided.
    double cases = 1;
    /// Evaluations in all by which the checks of w_o that are not decided may go on, and the most at one w_o.
    double further_in_all = 0, most_at_one = 4e6;
    bool keep_evidence = false;  // also of right w_o, with the weights: for pictures
};

/// The reason why the check of a sampler at some w_o ended early.
struct Cut {
    enum class Why { fault, exited, too_slow } why = Why::fault;
    std::string what;
    bool first_draws = false;  // whether the first draws were examined, see CheckOutcome::checks
};

/// The outcome for one sampler.
struct CheckOutcome {
    std::string arm;
    std::vector<std::size_t> check_cases;      // indices into the call's cases
    std::vector<std::vector<CheckAt>> checks;  // by case and technique; if cut short, the faults of the first draws
    std::vector<WeightTail> tails;             // by case
    std::vector<SmallFault> small;             // faults of the sampler as a whole
    std::uint64_t evaluations = 0;
    std::vector<std::optional<Cut>> cut;  // by case
    std::optional<Cut> whole_cut{};       // of the tests of the whole sampler
    bool wrong() const;
};

/// Checks the cases of one or several samplers, grouped by name and sampler, without baselines. Faults of an external
/// sampler (SamplerError) are stored with the w_o at which they occurred.
std::vector<CheckOutcome> check_samplers(
    std::span<const CheckCase> check_cases, const CheckSettings& settings, ProgressMonitor& monitor);

}  // namespace crescent::check
