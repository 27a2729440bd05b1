// What is known of each verdict of the list (results/all.h) beside its name and question. A verdict is wrong if a
// family of questions.h that names it fails; what else it looks at is said here.
#pragma once

#include <array>

#include "check/decide/check_at.h"
#include "check/verdict.h"
#include "check/verdict_names.h"

namespace crescent::check {

/// One verdict of the list.
struct VerdictKind {
    /// Whether a sampler provides what the verdict needs; else it is skipped.
    bool (*applies)(const SamplerAdapter&);
    const char* needs = "";  // said of a verdict that is skipped
    /// Adds to the verdict at one w_o what no family says; null: nothing.
    void (*add)(const CheckAt&, Verdict&) = nullptr;
};

namespace kinds {
#define CRESCENT_DECLARED(verdict, question) extern const VerdictKind verdict;
CRESCENT_VERDICTS(CRESCENT_DECLARED)
#undef CRESCENT_DECLARED
}  // namespace kinds

/// In the order of verdict_names.
#define CRESCENT_ADDRESS(verdict, question) &kinds::verdict,
inline constexpr std::array verdict_kinds = {CRESCENT_VERDICTS(CRESCENT_ADDRESS)};
#undef CRESCENT_ADDRESS

}  // namespace crescent::check
