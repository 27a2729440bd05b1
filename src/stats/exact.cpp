// Hypergeometric probabilities by the ratio of neighbours from one end, so that no factorial is formed; binomial tails
// by the incomplete beta function.
#include "stats/exact.h"

#include <algorithm>
#include <vector>

#include "stats/distributions.h"

namespace crescent::inline stats {

double fisher_exact(std::uint64_t ka, std::uint64_t na, std::uint64_t kb, std::uint64_t nb) {
    const std::uint64_t k = ka + kb, low = k > nb ? k - nb : 0, high = std::min(k, na);
    // P(i + 1)/P(i) = (na - i)(k - i) / ((i + 1)(nb - k + i + 1)). The largest is kept at 1: nothing overflows.
    std::vector<double> weight{1};
    const auto d = [](std::uint64_t x) { return static_cast<double>(x); };
    for (std::uint64_t i = low; i < high; ++i) {
        weight.push_back(weight.back() * d(na - i) * d(k - i) / (d(i + 1) * d(nb + i + 1 - k)));
        if (weight.back() > 1)
            for (const double top = weight.back(); double& w : weight) w /= top;
    }
    constexpr double slack = 1 + 1e-9;  // outcomes that are equally likely differ by rounding
    const double seen = weight[ka - low] * slack;
    double all = 0, extreme = 0;
    for (const double w : weight) all += w, extreme += w <= seen ? w : 0;
    return std::min(1.0, extreme / all);
}

double binomial_exact(std::uint64_t k, std::uint64_t n, double p) {
    if (n == 0) return 1;
    const double kd = static_cast<double>(k), nd = static_cast<double>(n);
    const double above = k == 0 ? 1 : beta_i(kd, nd - kd + 1, p, 1 - p);  // P(N >= k)
    const double below = k == n ? 1 : beta_i(nd - kd, kd + 1, 1 - p, p);  // P(N <= k)
    return std::min(1.0, 2 * std::min(above, below));
}

}  // namespace crescent::inline stats
