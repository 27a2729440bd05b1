// The cost of tests: under AddressSanitizer everything is about ten times slower, and ./test --matrix runs all cases.
#pragma once

#include <cstddef>
#include <cstdlib>

namespace crescent::test {

#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool sanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif
#else
inline constexpr bool sanitized = false;
#endif

/// Of many similar cases each `every`-th is tested: sanitizers check the code, which is the same in all.
inline constexpr std::size_t every = sanitized ? 3 : 1;

/// Returns whether every case is tested instead of a sample.
inline bool whole_matrix() { return std::getenv("CRESCENT_TEST_MATRIX") != nullptr; }

}  // namespace crescent::test
