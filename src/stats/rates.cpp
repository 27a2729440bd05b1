// Rates with exact binomial intervals.
#include "stats/rates.h"

#include <fmt/format.h>

#include "stats/distributions.h"

namespace crescent::inline stats {

std::pair<double, double> rate_interval(std::uint64_t hits, std::uint64_t of) {
    if (of == 0) return {0, 1};
    const ShareInterval p = binomial_interval(static_cast<double>(of), static_cast<double>(hits), 0.025);
    return {p.low, p.high};
}

std::string rate_text(std::uint64_t hits, std::uint64_t of) {
    const auto [low, high] = rate_interval(hits, of);
    return fmt::format("{} of {} = {:.3g} (95 %: {:.3g} to {:.3g})", hits, of,
        of ? static_cast<double>(hits) / static_cast<double>(of) : 0.0, low, high);
}

}  // namespace crescent::inline stats
