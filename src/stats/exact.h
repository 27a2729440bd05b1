// Exact two-sided tests of counts: Fisher's of two shares, and the binomial one.
#pragma once

#include <cstdint>

namespace crescent::inline stats {

/// Fisher 1922: ka of na and kb of nb came out; the probability, all ka + kb being as likely on either side, of a split
/// that is no likelier than this one.
double fisher_exact(std::uint64_t ka, std::uint64_t na, std::uint64_t kb, std::uint64_t nb);

/// k of n came out where each does with probability p: twice the smaller tail, at most 1.
double binomial_exact(std::uint64_t k, std::uint64_t n, double p);

}  // namespace crescent::inline stats
