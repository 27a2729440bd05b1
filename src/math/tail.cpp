// The generalised Pareto index k of the largest samples: Zhang & Stephens 2009, with the prior of Vehtari et al. 2024,
// ten exceedances at k = 1/2. Its standard error is that of maximum likelihood, (1 + k)/sqrt(n), where k > -1/2.
#include "math/tail.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "math/functions.h"

namespace crescent::inline statistics {

namespace {

/// The mean of ln(1 - theta v), with one logarithm for a product of many factors, taken before the product leaves the
/// range of doubles (a factor is below 1e108 for any two floats).
double mean_log1p(const std::vector<double>& x, double theta) {
    double sum = 0, product = 1;
    for (double v : x) {
        product *= 1 - theta * v;
        if (product > 1e-200 && product < 1e200) continue;
        sum += math::log(product);
        product = 1;
    }
    return (sum + math::log(product)) / static_cast<double>(x.size());
}

/// Zhang & Stephens' posterior mean of theta = -k/sigma over a grid, x ascending.
double posterior_theta(const std::vector<double>& x) {
    const double n = static_cast<double>(x.size());
    const int grid = 30 + static_cast<int>(std::sqrt(n));
    const double quartile = x[static_cast<std::size_t>(n / 4 + 0.5) - 1];
    std::vector<double> theta, likelihood;
    for (int j = 1; j <= grid; ++j) {
        const double t = 1 / x.back() + (1 - std::sqrt(grid / (j - 0.5))) / (3 * quartile);
        const double k = mean_log1p(x, t);
        theta.push_back(t);
        likelihood.push_back(n * (math::log(-t / k) - k - 1));
    }
    double sum = 0, weights = 0;
    const double top = *std::max_element(likelihood.begin(), likelihood.end());
    for (std::size_t j = 0; j < theta.size(); ++j) {
        const double w = math::exp(likelihood[j] - top);
        if (!(w > 0)) continue;
        sum += w * theta[j];
        weights += w;
    }
    return sum / weights;
}

template <class T> std::optional<Tail> fit(std::span<const T> largest) {
    if (largest.size() < 6) return {};
    const double threshold = static_cast<double>(largest.back());
    std::vector<double> x;
    for (std::size_t i = largest.size() - 1; i-- > 0;) x.push_back(static_cast<double>(largest[i]) - threshold);
    const double spread = 1e-5 * std::fabs(threshold);  // equal float samples differ only by rounding
    if (!std::isfinite(x.back()) || !(x.back() > spread)) return {};
    std::erase_if(x, [spread](double v) { return !(v > spread); });  // ties at the threshold
    if (x.size() < 5) return {};
    const double n = static_cast<double>(x.size());
    constexpr double prior = 10;  // pseudo-exceedances at k = 1/2
    const double k = (n * mean_log1p(x, posterior_theta(x)) + prior * 0.5) / (n + prior);
    // The likelihood is regular for k > -1/2; below, the standard error is the spread of the mean logarithm, which k
    // is.
    return Tail{k, std::max(1 + k, -k) / std::sqrt(n), x.size()};
}

}  // namespace

std::size_t tail_length(std::uint64_t n) {
    const double size = static_cast<double>(n);
    const double length = std::floor(std::min(size / 5, 3 * std::sqrt(size)));
    return length < 5 ? 0 : static_cast<std::size_t>(length);
}

std::optional<Tail> fit_tail(std::span<const float> largest) { return fit(largest); }
std::optional<Tail> fit_tail(std::span<const double> largest) { return fit(largest); }

std::optional<Tail> fit_pooled_tail(std::span<const float> largest) {
    const std::optional<Tail> wide = fit_tail(largest),
                              deep = fit_tail(largest.first(largest.empty() ? 0 : 1 + (largest.size() - 1) / 8));
    if (!wide || !deep) return wide;
    return std::fabs(wide->k - deep->k) > 2 * math::hypot(wide->se, deep->se) ? deep : wide;
}

}  // namespace crescent::inline statistics
