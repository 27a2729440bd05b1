// How much a test may cost: under AddressSanitizer everything is about ten times slower, and ./test --matrix tries all.
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

/// Of many cases that are alike each `every`-th is tried: sanitizers look at the code, which is the same in all.
inline constexpr std::size_t every = sanitized ? 3 : 1;

/// Whether every case is tried where ./test tries a sample.
inline bool whole_matrix() { return std::getenv("CRESCENT_TEST_MATRIX") != nullptr; }

}  // namespace crescent::test
