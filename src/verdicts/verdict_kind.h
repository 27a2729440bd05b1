// What each verdict of the list says of itself.
#pragma once

#include "judgements/all.h"
#include "trials/trial_context.h"
#include "verdicts/efficiency.h"
#include "verdicts/judge.h"

namespace crescent::inline verdicts {

/// All there is to know of a verdict beside its name.
struct VerdictKind {
    std::string_view question;  // that it answers
    /// Of one trial; null: it holds trials against one another.
    Verdict (*judge)(TrialContext&) = nullptr;
    /// One a trial, from what their samples cost and how they vary.
    std::vector<Verdict> (*compare)(std::span<const Trial>, std::span<const Efficiency>) = nullptr;
    /// How many statistical tests it makes of a trial, which share the family-wise error; null: none.
    std::uint64_t (*tests)(const Trial&) = nullptr;
    bool asked_of_other_seeds = false;  // where the rate of false alarms is measured
    bool may_stay_open = false;         // inconclusive is an answer that a right sampler may get
    bool needs_variance = false;        // inconclusive where theory says that there is none
    bool of_all_light = false;          // where f transmits and was not followed there, it is of the upper half only
};

namespace kinds {
#define CRESCENT_DECLARED(verdict) extern const VerdictKind verdict;
CRESCENT_VERDICTS(CRESCENT_DECLARED)
#undef CRESCENT_DECLARED
}  // namespace kinds

/// In the order of verdict_names.
#define CRESCENT_ADDRESS(verdict) &kinds::verdict,
inline constexpr std::array verdict_kinds = {CRESCENT_VERDICTS(CRESCENT_ADDRESS)};
#undef CRESCENT_ADDRESS

}  // namespace crescent::inline verdicts
