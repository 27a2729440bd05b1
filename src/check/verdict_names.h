// The list of verdicts with the question that each answers, in output order. The families of check/verdicts/ name the
// verdict that they make wrong. The list is used by `crescent check` and its output, --expect, `crescent list verdicts`
// and the tests.
#pragma once

#include <array>
#include <string_view>

// clang-format off: one a line
#define CRESCENT_VERDICTS(verdict)                                                                              \
    verdict(valid, "are all densities and weights finite and non-negative, and all directions of unit length?") \
    verdict(support, "is p > 0 wherever f L cos > 0?")                                                          \
    verdict(normalised, "does p integrate to the share of samples that draw a direction?")                      \
    verdict(density, "do the draws follow p?")                                                                  \
    verdict(identity, "do the sampler's functions agree?")                                                      \
    verdict(physics, "is f a BRDF?")                                                                            \
    verdict(tail, "how heavy is the weight f L cos / p?")                                                       \
    verdict(mean, "do the weights average to the integral?")                                                    \
    verdict(efficiency, "how large is variance times cost, against uniform and cosine sampling?")
// clang-format on

namespace crescent::inline results {

#define CRESCENT_NAME(verdict, question) std::string_view(#verdict),
inline constexpr std::array verdict_names = {CRESCENT_VERDICTS(CRESCENT_NAME)};
#undef CRESCENT_NAME
#define CRESCENT_QUESTION(verdict, question) std::string_view(question),
inline constexpr std::array verdict_questions = {CRESCENT_VERDICTS(CRESCENT_QUESTION)};
#undef CRESCENT_QUESTION

}  // namespace crescent::inline results
