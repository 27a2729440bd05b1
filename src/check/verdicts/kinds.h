// The properties of each verdict of the list besides its name and question. A verdict is wrong if a
// family of questions.h that names it fails; other tests are defined here.
#pragma once

#include <array>

#include "check/decide/check_at.h"
#include "check/verdict.h"

namespace crescent::check {

/// One verdict of the list.
struct VerdictKind {
    /// Whether a sampler provides what the verdict needs; otherwise it is skipped.
    bool (*applies)(const SamplerAdapter&);
    const char* needs = "";  // message of a skipped verdict
    /// Adds to the verdict at one w_o what no family tests; null: nothing.
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
