// The cost of tests: under AddressSanitizer everything is about ten times slower, and ./test --matrix runs all cases.
#pragma once

#include <cstddef>
#include <cstdlib>

#include "base/sanitized.h"

namespace crescent::test {

inline constexpr bool sanitized = CRESCENT_SANITIZED != 0;

/// Of many similar cases each `every`-th is tested: sanitizers check the code, which is the same in all.
inline constexpr std::size_t every = sanitized ? 3 : 1;

/// Returns whether every case is tested instead of a sample.
inline bool whole_matrix() { return std::getenv("CRESCENT_TEST_MATRIX") != nullptr; }

}  // namespace crescent::test
