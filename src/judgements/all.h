// The one list of verdicts, in the order in which they are given: the first says whether a sampler can be judged at
// all, and each stands on those before it. A new one is one file in verdicts/, which says all there is to know of it
// (verdict_kind.h), and one word here; the list feeds `crescent check` and all that it writes, --expect, `crescent list
// verdicts`, the bench's own error rates and the laws.
#pragma once

#include <array>
#include <string_view>

// clang-format off: one a line
#define CRESCENT_VERDICTS(verdict) \
    verdict(valid)                 \
    verdict(support)               \
    verdict(normalised)            \
    verdict(density)               \
    verdict(identity)              \
    verdict(physics)               \
    verdict(tail)                  \
    verdict(mean)                  \
    verdict(efficiency)
// clang-format on

namespace crescent::inline judgements {

#define CRESCENT_NAME(verdict) std::string_view(#verdict),
inline constexpr std::array verdict_names = {CRESCENT_VERDICTS(CRESCENT_NAME)};
#undef CRESCENT_NAME

}  // namespace crescent::inline judgements
