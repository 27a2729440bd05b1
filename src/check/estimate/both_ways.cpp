// 64 pairs: an f that is no such function agrees at all of them by chance never, and a glass at next to none.
#include "check/estimate/both_ways.h"

#include <algorithm>
#include <cmath>

#include "check/constants.h"
#include "check/estimate/chart.h"

namespace crescent::check {

namespace {

constexpr int pair_count = 64;
constexpr int fewest = 16;  // pairs with f > 0, fewer show nothing

bool nearly_equal(double a, double b) { return std::fabs(a - b) <= reciprocity_tolerance * std::max(a, b); }

}  // namespace

BothWays both_ways(const SamplerAdapter& adapter, StreamKey key) {
    const Traits traits = adapter.traits();
    if (!adapter.has_f() || traits.eta || traits.wo == Traits::WoDomain::none) return BothWays::not_known;
    const bool both = traits.wo == Traits::WoDomain::both;
    Stream stream(key);
    const auto direction = [&](bool below) { return random_direction(stream, below, 0.02); };
    std::vector<Pair> there, back, through;
    for (int i = 0; i < pair_count; ++i) {
        there.push_back({direction(both && (i & 1)), direction(both && !(i & 1))});
        back.push_back({there.back().wi, there.back().wo});
        through.push_back({direction(false), direction(true)});
    }
    std::vector<double> f(pair_count), g(pair_count), h(pair_count);
    adapter.f(there, f), adapter.f(back, g), adapter.f(through, h);
    const auto everywhere = [](const std::vector<double>& v) {
        return std::ranges::all_of(v, [](double x) { return x > 0; });
    };
    bool phase = everywhere(f) && everywhere(g) && everywhere(h), same = both;
    int positive = 0;
    for (std::size_t i = 0; i < f.size(); ++i) {
        positive += f[i] > 0;
        phase = phase && nearly_equal(f[i] * std::fabs(there[i].wi.z), g[i] * std::fabs(there[i].wo.z));
        same = same && nearly_equal(f[i], g[i]);
    }
    if (phase) return BothWays::phase_function;
    return same && positive >= fewest ? BothWays::same_f : BothWays::not_known;
}

}  // namespace crescent::check
