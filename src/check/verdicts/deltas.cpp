// density and identity of delta parts: each is drawn as often as it says, by one weight, and there are few of them.
#include <cmath>
#include <functional>

#include "check/constants.h"
#include "check/verdicts/questions.h"
#include "check/verdicts/statistics.h"

namespace crescent::check {

namespace {

/// A number for a part that is the same at both stages: direction, q and weight to three decimals.
int member_of(const DeltaPart& p) {
    std::size_t h = 0;
    for (double v : {p.wi.x, p.wi.y, p.wi.z, p.q, p.weight.x, p.weight.y, p.weight.z})
        h = h * 1099511628211u + std::hash<long long>{}(std::llround(v * 1e3));
    return static_cast<int>((h ^ h >> 16) & 0x7fffffff);
}

/// Draws of a part against q, by Bennett's bound: it holds at every count.
void test_delta_share(const DeltaPart& p, double n, const Visit& visit) {
    const double share = static_cast<double>(p.drawn) / n, floor = detection_floor * p.q, v = p.q * (1 - p.q) / n;
    Answer a{Family::delta_share, member_of(p), share - p.q, std::sqrt(std::max(v, 0.0)), floor, 1, p.q};
    a.p = bennett_p(bennett_z2(std::fabs(a.difference) - floor, std::max(v, 0.0), 1 / n, 1e12));
    visit(a);
}

}  // namespace

void test_deltas(const Evidence& e, const Visit& visit) {
    const Observations& o = e.observations;
    if (o.deltas.empty()) return;
    double sum = 0, otherwise = 0;
    for (const DeltaPart& p : o.deltas.parts(o.independent)) {
        test_delta_share(p, o.independent, visit);
        sum += p.q, otherwise += static_cast<double>(p.otherwise);
    }
    const bool certain = sum > 1 + same_number;
    visit({Family::delta_share, -1, sum - 1, 0, same_number, certain ? 0.0 : 1.0, 1});
    visit({Family::delta_scatter, 0, o.deltas.scattered() ? 1.0 : 0.0, 0, 0, o.deltas.scattered() ? 0.0 : 1.0, 0});
    visit({Family::delta_weight, 0, otherwise, 0, tolerated_breaks, otherwise > tolerated_breaks ? 0.0 : 1.0, 0});
}

}  // namespace crescent::check
