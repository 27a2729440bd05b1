// Sorts by 64-bit keys in linear time: digits of 11 bits, the least significant first. A comparison sort of random keys
// spends most of its time on branches that are predicted wrongly.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace crescent::check {

/// A key whose order as an integer is the order of the numbers; -0 is below 0.
inline std::uint64_t sort_key(double x) {
    const auto bits = std::bit_cast<std::uint64_t>(x);
    return bits >> 63 ? ~bits : bits | std::uint64_t{1} << 63;
}

/// Sorts by key(element), a 64-bit integer; equal elements keep their order.
template <class T, class Key> void sort_by_key(std::vector<T>& v, const Key& key) {
    constexpr std::size_t digit_bits = 11, digits = 6, values = std::size_t{1} << digit_bits;
    const auto digit = [&](const T& x, std::size_t d) {
        return static_cast<std::size_t>(key(x) >> (d * digit_bits)) & (values - 1);
    };
    std::vector<std::array<std::uint32_t, values>> counts(digits);
    for (const T& x : v)
        for (std::size_t d = 0; d < digits; ++d) ++counts[d][digit(x, d)];
    std::vector<T> sorted(v.size());
    for (std::size_t d = 0; d < digits; ++d) {
        if (std::ranges::any_of(counts[d], [&](std::uint32_t n) { return n == v.size(); })) continue;  // one value
        std::uint32_t offset = 0;
        for (std::uint32_t& n : counts[d]) offset += std::exchange(n, offset);
        for (const T& x : v) sorted[counts[d][digit(x, d)]++] = x;
        v.swap(sorted);
    }
}

}  // namespace crescent::check
