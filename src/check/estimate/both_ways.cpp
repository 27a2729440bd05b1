// 64 pairs: a function of another kind practically never agrees at all of them by chance.
#include "check/estimate/both_ways.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "check/constants.h"

namespace crescent::check {

namespace {

constexpr int pair_count = 64;
constexpr int fewest = 16;  // pairs with f > 0; fewer show nothing

bool nearly_equal(double a, double b) { return std::fabs(a - b) <= reciprocity_tolerance * std::max(a, b); }

}  // namespace

BothWays both_ways(const SamplerAdapter& adapter, StreamKey key) {
    const Traits traits = adapter.traits();
    if (!adapter.has_f() || traits.eta || !traits.has_surface()) return BothWays::not_known;
    const bool is_two_sided = traits.wo == Traits::WoDomain::both;
    Stream stream(key);
    const auto draw_direction = [&](bool is_below) { return random_direction(stream, is_below, 0.02); };
    std::vector<Pair> forward_pairs, reverse_pairs, crossing_pairs;
    for (int i = 0; i < pair_count; ++i) {
        forward_pairs.push_back({draw_direction(is_two_sided && (i & 1)), draw_direction(is_two_sided && !(i & 1))});
        reverse_pairs.push_back({forward_pairs.back().wi, forward_pairs.back().wo});
        crossing_pairs.push_back({draw_direction(false), draw_direction(true)});
    }
    std::vector<double> f(pair_count), g(pair_count), h(pair_count);
    adapter.f(forward_pairs, f);
    adapter.f(reverse_pairs, g);
    adapter.f(crossing_pairs, h);
    const auto is_positive = [](const std::vector<double>& v) {
        return std::ranges::all_of(v, [](double x) { return x > 0; });
    };
    bool is_phase = is_positive(f) && is_positive(g) && is_positive(h), is_symmetric = is_two_sided;
    int positive = 0;
    for (std::size_t i = 0; i < f.size(); ++i) {
        positive += f[i] > 0;
        is_phase =
            is_phase && nearly_equal(f[i] * std::fabs(forward_pairs[i].wi.z), g[i] * std::fabs(forward_pairs[i].wo.z));
        is_symmetric = is_symmetric && nearly_equal(f[i], g[i]);
    }
    if (is_phase) return BothWays::phase_function;
    return is_symmetric && positive >= fewest ? BothWays::same_f : BothWays::not_known;
}

}  // namespace crescent::check
