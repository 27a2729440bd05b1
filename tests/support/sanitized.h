// Whether tests run under AddressSanitizer, which makes them about ten times slower.
#pragma once

#include <cstddef>

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

}  // namespace crescent::test
